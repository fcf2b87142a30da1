// Named parameters: an option that refers to one has its value everywhere on the page, and edits change the parameter.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, describe, test } from 'node:test';
import ts from 'typescript';
import { endBrowser, hash, open, pageSchema, select, serve, settled, skip, text } from './harness.mjs';

const RECIPE = `dapple = 1
seed = "$luck"
extent = ["$width", 1.0]
wrap = ["$wraps", true]

[parameters]
luck = { value = 7, range = [0, 20], doc = "Chance." }
width = 2.0
wraps = true
cells = 4
depth = { value = 0.3, range = [0.0, 1.0], doc = "Height of the stones." }
green = "directx"
tint = "#b06030"
edge = 0.4

[nodes.stones.worley]
frequency = "$cells"

[nodes.sum]
add = ["stones", "$edge"]

[nodes.tone.ramp]
input = "stones"
colors = ["#202020", "$tint", "#f0e0c0"]
positions = [0.0, "$edge", 1.0]

[material]
height = "sum"
relief = "$depth"
albedo = "tone"
normal_y = "$green"
`;

/** Returns the address of a module of the page. `imports` has the addresses of the modules that it imports. */
function address(name, imports = {}) {
  const source = readFileSync(new URL(`../src/core/${name}.ts`, import.meta.url), 'utf8');
  const { outputText } = ts.transpileModule(source, { compilerOptions: { module: ts.ModuleKind.ESNext, target: ts.ScriptTarget.ES2022 } });
  const linked = outputText.replace(/from '\.\/(\w+)'/g, (_, other) => `from '${imports[other]}'`);
  return `data:text/javascript,${encodeURIComponent(linked).replaceAll("'", '%27')}`;
}

const schemaModule = address('schema');
const { Schemas } = await import(schemaModule);
const { rangeAt, resolved, sharedParameters, sourceOf } = await import(address('shared', { schema: schemaModule }));

async function within(recipe, then) {
  const folder = mkdtempSync(join(tmpdir(), 'dapple-parameters-'));
  writeFileSync(join(folder, 'mine.toml'), recipe);
  const studio = await serve(['mine.toml'], 'studio', folder);
  try {
    const page = await open(studio.url);
    await settled(page);
    await then(page);
    assert.deepEqual(page.wrong, []);
    await page.context().close();
  } finally {
    studio.end();
  }
}

const row = (page, path) => page.locator(`[data-path="${path}"]`);

/** The value of a parameter, as written. */
const line = async (page, name) => (await text(page)).match(new RegExp(`^${name} = (.*)$`, 'm'))?.[1];

describe('parameters', { skip, timeout: 240_000 }, () => {
  after(endBrowser);

  test('references are resolved, in lists and tables, too', () => {
    const recipe = { parameters: { a: 0.5, list: [1, 2], b: { value: 3, range: [2, 4] } }, material: { relief: '$a', x: ['$b', 1] }, extent: '$list', name: '$none' };
    const { parameters: _, ...others } = resolved(recipe);
    assert.deepEqual(others, { material: { relief: 0.5, x: [3, 1] }, extent: [1, 2], name: '$none' });
    assert.deepEqual(sourceOf(recipe, ['material', 'relief']), ['parameters', 'a']);
    assert.deepEqual(sourceOf(recipe, ['material', 'x', 0]), ['parameters', 'b', 'value']);
    assert.deepEqual(sourceOf(recipe, ['extent', 1]), ['parameters', 'list', 1]);
    assert.deepEqual(sourceOf(recipe, ['material', 'x', 1]), ['material', 'x', 1]);
    assert.deepEqual(rangeAt(recipe, ['parameters', 'b', 'value']), [2, 4]);
    assert.equal(rangeAt(recipe, ['parameters', 'a']), null);
    const plain = { material: { relief: 1 } };
    assert.equal(resolved(plain), plain);
  });

  test('a parameter has the widget of its options', () => {
    const schemas = new Schemas(pageSchema());
    const recipe = {
      parameters: { cells: 4, tint: '#b06030', edge: { value: 0.4, range: [0, 1] }, part: 0.5 },
      nodes: { stones: { worley: { frequency: '$cells' } }, sum: { add: ['stones', '$part'] }, tone: { ramp: { input: 'stones', colors: ['#202020', '$tint'], positions: [0, '$edge'] } } },
      material: { relief: '$edge' },
    };
    const found = sharedParameters(recipe, schemas, ['tint', 'cells', 'edge', 'part']);
    assert.deepEqual(found.map(({ name }) => name), ['tint', 'cells', 'edge', 'part']);
    assert.deepEqual(found.map(({ schema }) => schemas.shape(schema).kind), ['color', 'number', 'number', 'number']);
    assert.deepEqual(found[2].uses, [['nodes', 'tone', 'ramp', 'positions', 1], ['material', 'relief']]);
    const { min, max, log } = schemas.shape(found[2].schema, 'relief').range;
    assert.deepEqual([min, max, log], [0, 1, false]);
  });

  test('all parts of the page show the values', () => within(RECIPE, async (page) => {
    const labels = await page.locator('.parameters .about').allTextContents();
    assert.deepEqual(labels.slice(0, 8), ['luck', 'width', 'wraps', 'cells', 'depth', 'green', 'tint', 'edge']);
    const seed = page.getByRole('spinbutton', { name: 'Seed', exact: true });
    assert.equal(await seed.inputValue(), '7');
    assert.match(await page.locator('.status span').first().textContent(), /^512 × 256/);
    await seed.fill('9');
    await seed.press('Tab');
    await settled(page);
    assert.match(await line(page, 'luck'), /^\{ value = 9, range = \[0, 20\]/);
    assert.match(await text(page), /^seed = "\$luck"$/m);
    for (let i = 0; i < 3; i += 1) {
      await page.locator('body').press('r');
      await settled(page);
    }
    assert.equal(await page.locator('.status .bad').count(), 0);
    // Frequencies that repeat have whole numbers of cells on both sides, of 2 and 1.
    await row(page, 'parameters.cells').locator('input[type=range]').focus();
    for (let i = 0; i < 3; i += 1) await page.keyboard.press('ArrowRight');
    await settled(page);
    assert.match(await line(page, 'cells'), /^[5-9]$/);
    assert.equal(await page.locator('.status .bad').count(), 0);
  }));

  test('the lit view has the relief of a parameter', () => within(RECIPE, async (page) => {
    await page.locator('#tab-lit').click({ noWaitAfter: true });
    await page.locator('.lit canvas').waitFor({ timeout: 60_000 });
    await settled(page, 60_000);
    if ((await page.locator('.lit .wrong').count()) > 0) return; // This browser has no WebGL, and the page says so.
    await page.waitForTimeout(1500);
    const picture = (await page.locator('.lit canvas').screenshot()).toString('base64');
    const [red, , blue] = await page.evaluate(async (data) => {
      const image = await createImageBitmap(new Blob([Uint8Array.from(atob(data), (c) => c.charCodeAt(0))]));
      const context = new OffscreenCanvas(1, 1).getContext('2d');
      context.drawImage(image, -image.width / 2, -image.height / 2);
      return [...context.getImageData(0, 0, 1, 1).data];
    }, picture);
    // The stones are brown, and the background is gray.
    assert.ok(red > blue + 10, `${red} and ${blue}`);
  }));

  test('a ramp shows and changes the parameters of its colors', () => within(RECIPE, async (page) => {
    await select(page, 'tone');
    const colors = page.locator('.ramp .color .mono');
    assert.deepEqual(await colors.evaluateAll((all) => all.map(({ value }) => value)), ['#202020', '#b06030', '#f0e0c0']);
    const positions = page.locator('.ramp li input[type=number]');
    assert.equal(await positions.nth(1).inputValue(), '0.4');
    await colors.nth(1).fill('#00ff00');
    await colors.nth(1).press('Tab');
    await settled(page);
    await positions.nth(1).fill('0.6');
    await positions.nth(1).press('Tab');
    await settled(page);
    assert.equal(await line(page, 'tint'), '"#00ff00"');
    assert.equal(await line(page, 'edge'), '0.6');
    assert.match(await text(page), /colors = \["#202020", "\$tint", "#f0e0c0"\]/);
  }));

  test('an option is shared, joined by another, and detached', () => within('dapple = 1\n\n[nodes.a.noise]\ngain = 0.6\n\n[nodes.b.noise]\n\n[nodes.sum]\nadd = ["a", "b"]\n\n[material]\nheight = "sum"\n', async (page) => {
    const before = await text(page);
    const share = async (node, name) => {
      await select(page, node);
      await row(page, `nodes.${node}.noise.gain`).locator('.about').click();
      const field = page.getByLabel('Name of the parameter for gain');
      assert.equal(await field.inputValue(), node === 'a' ? 'gain' : 'gain_2');
      await field.fill(name);
      await page.getByRole('button', { name: 'Share', exact: true }).click();
      await settled(page);
    };
    await share('a', 'gain');
    assert.match(await text(page), /^dapple = 1\n\n\[parameters\]\ngain = 0\.6\n\n\[nodes\.a\.noise\]\ngain = "\$gain"$/m);
    const [height] = [await hash(page, 'height')];
    await share('b', 'gain');
    assert.match(await text(page), /\[nodes\.b\.noise\]\ngain = "\$gain"/);
    assert.notEqual(await hash(page, 'height'), height);
    // The help of a shared option shows the value and changes the parameter.
    await row(page, 'nodes.b.noise.gain').locator('.strip button').first().click();
    await settled(page);
    assert.notEqual(await line(page, 'gain'), '0.6');
    assert.match(await text(page), /\[nodes\.b\.noise\]\ngain = "\$gain"/);
    await page.locator('body').press('Control+z');
    await settled(page);
    await page.getByRole('button', { name: 'Detach gain from gain' }).click();
    await settled(page);
    assert.match(await text(page), /\[nodes\.b\.noise\]\ngain = 0\.6/);
    assert.match(await text(page), /\[parameters\]\ngain = 0\.6/);
    await page.locator('body').press('Control+z');
    await settled(page);
    // Removing the parameter leaves its value in both options.
    await page.locator('body').press('Escape');
    await row(page, 'parameters.gain').locator('.about').click();
    await page.getByText('2 options have this value.').waitFor();
    await page.getByRole('button', { name: 'Remove the parameter' }).click();
    await settled(page);
    assert.equal(await text(page), before.replace('[nodes.b.noise]\n', '[nodes.b.noise]\ngain = 0.6\n'));
    assert.equal(await page.locator('.status .bad').count(), 0);
    for (let i = 0; i < 3; i += 1) await page.locator('body').press('Control+z');
    await settled(page);
    assert.equal(await text(page), before);
  }));

  test('a node leaves with the parameters that it alone used', () => within(RECIPE, async (page) => {
    await page.locator('.svelte-flow__node[data-id=tone]').focus();
    await page.keyboard.press('Enter');
    await page.keyboard.press('Delete');
    await page.locator('.svelte-flow__node[data-id=tone]').waitFor({ state: 'detached' });
    await settled(page);
    assert.equal(await line(page, 'tint'), undefined);
    assert.equal(await line(page, 'edge'), '0.4');
    assert.equal(await page.locator('.status .bad').count(), 0);
    // A copied node keeps its references.
    await select(page, 'sum');
    await page.locator('.svelte-flow__node[data-id=sum]').focus();
    const copied = await page.evaluate(() => {
      const data = new DataTransfer();
      document.body.dispatchEvent(new ClipboardEvent('copy', { clipboardData: data, bubbles: true }));
      return data.getData('text/plain');
    });
    await page.evaluate((text) => {
      const data = new DataTransfer();
      data.setData('text/plain', text);
      document.body.dispatchEvent(new ClipboardEvent('paste', { clipboardData: data, bubbles: true }));
    }, copied);
    await page.locator('.svelte-flow__node[data-id=sum_2]').waitFor();
    assert.match(await text(page), /\[nodes\.sum_2\]\nadd = \["stones", "\$edge"\]/);
  }));
});
