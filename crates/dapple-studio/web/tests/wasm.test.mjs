// The studio in WebAssembly, under Node: its bits are those of the command, and its work comes in short pieces.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { before, describe, test } from 'node:test';
import { WasmStudio } from './wasm_module.mjs';
import { dapple, skipStatic, STATIC } from './harness.mjs';

const MAPS = ['height', 'normal', 'albedo', 'roughness', 'ao'];
const VIEW = { type: 'view', size: [256, 256], maps: ['height'], region: null, node: null, time: 0, draft: true, thumbnails: false, paused: false, exact: null };
const NOISE = 'dapple = 1\nname = "swells"\nseed = 7\n\n[nodes.swells.noise]\nfrequency = 9\noctaves = 5\n\n[material]\nheight = "swells"\n';

describe('the studio in WebAssembly', { skip: skipStatic, timeout: 240_000 }, () => {
  let studio;
  before(async () => (studio = await WasmStudio.load(join(STATIC, 'dapple.wasm'))));

  const opened = (what) => {
    studio.send({ ...VIEW, paused: true });
    studio.send({ type: 'open', ...what });
    return studio.finish().find(({ type }) => type === 'document').text;
  };

  test('it says what there is, in the mode without a server', () => {
    const [hello] = studio.made();
    assert.equal(hello.type, 'hello');
    assert.equal(hello.mode, 'static');
    assert.deepEqual(hello.presets, []);
  });

  for (const [name, what] of [['flagstone'], ['marble'], ['giraffe'], ['swells', { text: NOISE }]].map(([name, what]) => [name, what ?? { builtin: name }])) {
    test(`all maps of ${name} have the bits of a bake, in each format`, () => {
      const folder = mkdtempSync(join(tmpdir(), 'dapple-wasm-'));
      const recipe = join(folder, `${name}.toml`);
      writeFileSync(recipe, opened(what));
      for (const format of ['npy', 'png16', 'png8']) {
        studio.send({ type: 'export', size: [256, 256], maps: MAPS, format });
        const [exported, ...files] = studio.finish().filter(({ type }) => type !== 'picture');
        assert.equal(exported.type, 'exported', exported.message);
        assert.equal(files.length, MAPS.length);
        dapple('bake', recipe, '--size', '256', '--maps', MAPS.join(','), '--format', format, '-o', `${folder}/${format}/`);
        for (const [index, file] of exported.files.entries()) {
          assert.ok(files[index].bytes.equals(readFileSync(join(folder, format, file.name))), `${format}: ${file.name}`);
        }
      }
    });
  }

  test('pictures come after a draft, each once', () => {
    opened({ builtin: 'flagstone' });
    studio.send({ ...VIEW, size: [512, 512], maps: ['height', 'albedo'] });
    const made = studio.finish();
    const kinds = made.map(({ type }) => type);
    assert.equal(kinds.filter((type) => type === 'began').length, 1);
    assert.deepEqual(made.filter(({ type }) => type === 'rendered').map(({ draft }) => draft), [true, false]);
    const pictures = made.filter(({ type, draft }) => type === 'picture' && !draft);
    assert.deepEqual(pictures.map(({ map, last }) => [map, last]), [[0, true], [4, true]]);
    const whole = Buffer.concat(pictures.filter(({ map }) => map === 0).map(({ pixels }) => pixels));
    assert.equal(whole.length, 512 * 512 * 4);
    studio.send({ ...VIEW, size: [512, 512], node: 'grain' });
    const node = studio.finish().filter(({ type, draft }) => type === 'picture' && !draft);
    assert.equal(node.length, 1);
  });

  test('the newest change wins', () => {
    opened({ builtin: 'giraffe' });
    studio.send({ ...VIEW, size: [1024, 1024] });
    studio.step();
    studio.send({ type: 'view', ...VIEW, size: [64, 64] });
    const rendered = studio.finish().filter(({ type, draft }) => type === 'rendered' && !draft);
    assert.equal(rendered.length, 1);
  });

  test('what cannot be made here is refused in words', () => {
    opened({ builtin: 'flagstone' });
    for (const message of [
      { type: 'export', size: [64, 64], maps: ['height'], format: 'exr' },
      { type: 'export', size: [64, 64], preset: 'unity' },
      { type: 'save', text: '', file: 'a.toml', seen: null },
      { type: 'open', file: 'a.toml' },
      { type: 'export', size: [1e6, 64], maps: ['height'] },
      { type: 'nonsense' },
    ]) {
      studio.send(message);
      const [refused] = studio.finish();
      assert.equal(refused.type, 'refused', JSON.stringify(message));
      assert.ok(refused.message.length > 10);
    }
  });
});
