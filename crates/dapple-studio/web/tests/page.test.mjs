// The page against the real command: text, sliders, undo, problems, the graph by keyboard, export, accessibility.
import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { createRequire } from 'node:module';
import { after, before, describe, test } from 'node:test';
import { dapple, endBrowser, hash, open, select, serve, settled, skip, text } from './harness.mjs';

const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

describe('the page', { skip, timeout: 240_000 }, () => {
  let studio;
  before(async () => (studio = await serve(['flagstone'])));
  after(async () => {
    await endBrowser();
    studio?.end();
  });

  const slider = (page, path) => page.locator(`[data-path="${path}"] input[type=range]`);

  test('the first view is asked for by the address of the socket, and not again', async () => {
    const page = await open('about:blank');
    const asked = [];
    page.on('websocket', (socket) => {
      asked.push(new URL(socket.url()).searchParams.get('view'));
      socket.on('framesent', ({ payload }) => JSON.parse(payload).type === 'view' && asked.push(payload));
    });
    await page.goto(studio.url);
    await settled(page);
    assert.equal(asked.length, 1, asked.join());
    assert.deepEqual(JSON.parse(asked[0]).maps, ['height', 'normal', 'albedo']);
    assert.deepEqual(page.wrong, []);
  });

  test('a dragged slider changes pixels and text, and is one step of undo', async () => {
    const page = await open(studio.url);
    await settled(page);
    const [textBefore, before] = [await text(page), await hash(page, 'height')];
    await select(page, 'grain');
    const knob = slider(page, 'nodes.grain.noise.gain');
    const box = await knob.boundingBox();
    await page.mouse.move(box.x + box.width * 0.65, box.y + box.height / 2);
    await page.mouse.down();
    for (let i = 0; i <= 30; i += 1) await page.mouse.move(box.x + box.width * (0.65 - i * 0.015), box.y + box.height / 2);
    await page.waitForTimeout(700);
    for (let i = 0; i <= 10; i += 1) await page.mouse.move(box.x + box.width * (0.2 - i * 0.01), box.y + box.height / 2);
    await page.mouse.up();
    await settled(page);
    const now = await text(page);
    assert.match(now, /# The fine grain, and slow swells of the ground\.\n\[nodes\.grain\.noise\]/);
    const gain = Number(now.match(/octaves = 5\ngain = ([\d.]+)/)[1]);
    assert.ok(gain < 0.2, `gain ${gain}`);
    assert.equal(await page.locator('[data-path="nodes.grain.noise.gain"] input[type=number]').inputValue(), String(gain));
    assert.notEqual(await hash(page, 'height'), before);
    await page.keyboard.press('Control+z');
    await settled(page);
    assert.equal(await text(page), textBefore);
    assert.equal(await hash(page, 'height'), before);
    await page.keyboard.press('Control+Shift+z');
    await settled(page);
    assert.equal(await text(page), now);
    assert.deepEqual(page.wrong, []);
  });

  test('a problem is marked at its line, and the last picture stays', async () => {
    const page = await open(studio.url);
    await settled(page);
    const before = await hash(page, 'height');
    await page.locator('.cm-content').click();
    await page.keyboard.press('Control+Home');
    for (let line = 0; line < 8; line += 1) await page.keyboard.press('ArrowDown');
    await page.keyboard.press('End');
    for (let i = 0; i < 3; i += 1) await page.keyboard.press('ArrowLeft');
    await page.keyboard.type('x');
    await page.locator('.problems li').first().waitFor();
    await page.waitForTimeout(300);
    const mark = page.locator('.cm-lintRange-error').first();
    assert.match(await mark.textContent(), /f2_minus_xf1|f2_minus_fx1|f2_minusx|x/);
    assert.match(await page.locator('.page + div[role=status], .page div[role=status]').first().textContent(), /^Error: /);
    assert.equal(await hash(page, 'height'), before);
    await page.keyboard.press('Control+z');
    await page.locator('.problems').waitFor({ state: 'detached' });
    assert.deepEqual(page.wrong, []);
  });

  test('what is seen are the pixels of a bake in 8 bits', async () => {
    const page = await open(studio.url);
    await settled(page);
    await page.locator('.tools select').first().selectOption({ label: '256 px' });
    await settled(page);
    await page.getByRole('button', { name: '1:1' }).click();
    await page.waitForTimeout(300);
    const folder = mkdtempSync(join(tmpdir(), 'dapple-bake-'));
    dapple('bake', 'flagstone', '--size', '256', '--maps', 'height,normal,albedo', '--format', 'png8', '-o', `${folder}/`);
    for (const map of ['height', 'normal', 'albedo']) {
      const png = readFileSync(join(folder, `flagstone_${map}.png`)).toString('base64');
      const different = await page.evaluate(async ([name, data]) => {
        const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${data}`).catch(() => null))?.blob() ?? new Blob([Uint8Array.from(atob(data), (c) => c.charCodeAt(0))]), { colorSpaceConversion: 'none' });
        const canvas = document.querySelector(`canvas[data-map=${name}]`);
        const copy = new OffscreenCanvas(image.width, image.height);
        copy.getContext('2d').drawImage(image, 0, 0);
        const expected = copy.getContext('2d').getImageData(0, 0, image.width, image.height).data;
        const [x, y] = [Math.round((canvas.width - image.width) / 2), Math.round((canvas.height - image.height) / 2)];
        const seen = canvas.getContext('2d').getImageData(x, y, image.width, image.height).data;
        return seen.reduce((count, byte, index) => count + (byte === expected[index] ? 0 : 1), 0);
      }, [map, png]);
      assert.equal(different, 0, `${different} bytes of ${map} differ`);
    }
  });

  test('nodes are added, connected, renamed, doubled and removed by keyboard alone', async () => {
    const page = await open(studio.url);
    await settled(page);
    await page.locator('body').press('a');
    await page.keyboard.type('power');
    await page.keyboard.press('Enter');
    await page.locator('.svelte-flow__node[data-id=power]').waitFor();
    assert.match(await text(page), /\[nodes\.power\.power\]/);
    await page.getByText('Nothing is made of this node yet').waitFor();
    const input = page.locator('[data-path="nodes.power.power.input"] select');
    await input.focus();
    await input.selectOption('grain');
    await settled(page);
    assert.match(await text(page), /\[nodes\.power\.power\]\n(?:exponent = .*\n)?input = "grain"/);
    const name = page.locator('.parameters .name');
    await name.fill('darker');
    await name.press('Enter');
    await page.locator('.svelte-flow__node[data-id=darker]').waitFor();
    await page.locator('.svelte-flow__node[data-id=darker]').focus();
    await page.keyboard.press('Control+d');
    await page.locator('.svelte-flow__node[data-id=darker_2]').waitFor();
    await page.locator('.svelte-flow__node[data-id=darker_2]').focus();
    await page.keyboard.press('Delete');
    await page.locator('.svelte-flow__node[data-id=darker_2]').waitFor({ state: 'detached' });
    assert.deepEqual(page.wrong, []);
  });

  test('the lit view shows the material and follows a change', async () => {
    const page = await open(studio.url);
    await settled(page);
    await page.locator('#tab-lit').click();
    const canvas = page.locator('.lit canvas');
    await canvas.waitFor();
    await settled(page);
    if ((await page.locator('.lit .wrong').count()) > 0) return; // This browser has no WebGL, and the page says so.
    const picture = async () => (await canvas.screenshot()).toString('base64');
    await page.waitForTimeout(1500);
    const before = await picture();
    await page.locator('body').press('r');
    await settled(page);
    await page.waitForTimeout(1500);
    assert.notEqual(await picture(), before);
    assert.deepEqual(page.wrong, []);
  });

  test('the help of a parameter shows it at other values, and a click takes one', async () => {
    const page = await open(studio.url);
    await settled(page);
    await select(page, 'grain');
    const before = await text(page);
    await page.getByRole('button', { name: 'gain', exact: true }).click();
    const strip = page.getByRole('group', { name: 'Values of gain' });
    await strip.waitFor();
    const values = await strip.getByRole('button').allTextContents();
    assert.equal(values.length, 5);
    assert.ok(values.map((one) => one.trim()).includes('0.65'), values.join());
    const drawn = (index) => strip.locator('canvas').nth(index).evaluate((canvas) => canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.join());
    await page.waitForFunction(() => [...document.querySelectorAll('.strip canvas')].every((canvas) => canvas.getContext('2d').getImageData(9, 9, 1, 1).data[3] === 255));
    assert.notEqual(await drawn(0), await drawn(4));
    assert.equal(await text(page), before);
    await strip.getByRole('button').last().click();
    await settled(page);
    assert.match(await text(page), new RegExp(`octaves = 5\\ngain = ${values.at(-1).trim()}(\\.0)?\\n`));
    await page.keyboard.press('Control+z');
    await settled(page);
    assert.equal(await text(page), before);
    assert.deepEqual(page.wrong, []);
  });

  test('the whole graph is framed, also in a pane that was hidden at first', async () => {
    for (const viewport of [{ width: 1600, height: 1000 }, { width: 800, height: 900 }]) {
      const page = await open(studio.url, { viewport });
      await settled(page);
      if (viewport.width < 820) await page.getByRole('tab', { name: 'Graph' }).click();
      await page.locator('.svelte-flow__node').first().waitFor();
      await page.waitForTimeout(300);
      const outside = await page.evaluate(() => {
        const pane = document.querySelector('.graph').getBoundingClientRect();
        const out = (box) => box.left < pane.left || box.right > pane.right || box.top < pane.top || box.bottom > pane.bottom;
        return [...document.querySelectorAll('.svelte-flow__node')].filter((one) => out(one.getBoundingClientRect())).map((one) => one.dataset.id);
      });
      assert.deepEqual(outside, [], `${viewport.width}`);
      await page.context().close();
    }
  });

  test('an export is byte for byte what bake writes', async () => {
    const page = await open(studio.url);
    await settled(page);
    await page.keyboard.press('Control+e');
    await page.locator('dialog select').first().selectOption({ label: '256 pixels' });
    await page.getByRole('button', { name: /^Bake/ }).click();
    await page.locator('dialog ul a').first().waitFor({ timeout: 20_000 });
    const links = await page.locator('dialog ul a').all();
    assert.equal(links.length, 5);
    const folder = mkdtempSync(join(tmpdir(), 'dapple-bake-'));
    const recipe = join(folder, 'flagstone.toml');
    writeFileSync(recipe, await text(page));
    mkdirSync(join(folder, 'out'));
    dapple('bake', recipe, '--size', '256', '-o', `${folder}/out/`);
    for (const link of links) {
      const [download] = await Promise.all([page.waitForEvent('download'), link.click()]);
      const name = download.suggestedFilename();
      assert.ok(readFileSync(await download.path()).equals(readFileSync(join(folder, 'out', name))), name);
    }
    assert.equal(readdirSync(join(folder, 'out')).length, 5);
    await page.evaluate(() => document.activeElement.blur());
    await page.keyboard.press('Escape');
    await page.locator('dialog').waitFor({ state: 'detached' });
  });

  test('the shader to copy is what the command prints', async () => {
    const page = await open(studio.url);
    await settled(page);
    const file = join(mkdtempSync(join(tmpdir(), 'dapple-shader-')), 'flagstone.toml');
    writeFileSync(file, await text(page));
    await page.getByRole('button', { name: 'Copy as…' }).click();
    await page.locator('dialog').getByRole('button', { name: 'WGSL' }).click();
    await page.waitForFunction(() => document.querySelector('dialog textarea').value.includes('fn material('));
    const shader = await page.locator('dialog textarea').inputValue();
    assert.ok(shader.endsWith(dapple('recipe', file, '--wgsl', '--textures')));
    assert.match(shader.slice(0, shader.indexOf('fn ')), /texture `data`/);
    assert.deepEqual(page.wrong, []);
  });

  test('axe finds no violation in any view, in light and in dark, wide and narrow', async () => {
    for (const [colorScheme, viewport] of [['light', { width: 1440, height: 900 }], ['dark', { width: 1440, height: 900 }], ['light', { width: 480, height: 900 }]]) {
      const page = await open(studio.url, { colorScheme, viewport });
      await settled(page);
      await page.evaluate(axe);
      const clean = async (where) => {
        const found = await page.evaluate(() => axe.run(document, { resultTypes: ['violations'] }));
        const short = found.violations.map(({ id, nodes }) => `${id}: ${nodes.slice(0, 3).map((one) => one.html.slice(0, 160)).join(' | ')}`);
        assert.deepEqual(short, [], `${where}, ${colorScheme}, ${viewport.width}`);
      };
      await clean('maps');
      for (const key of ['2', '3', '4', '5', '6']) {
        await page.locator('body').press(key);
        await page.waitForTimeout(key === '3' ? 1500 : 300);
        await clean(`view ${key}`);
      }
      await page.locator('body').press('1');
      for (const [keys, what] of [['?', 'keys'], ['Control+e', 'export'], ['Control+s', 'save'], ['Control+o', 'recipes'], ['a', 'add']]) {
        await page.locator('body').press(keys);
        await page.locator('dialog[open]').waitFor();
        await clean(what);
        await page.keyboard.press('Escape');
        await page.locator('dialog').waitFor({ state: 'detached' });
      }
      await page.locator('body').press(']');
      await clean('node');
      await page.context().close();
    }
  });
});
