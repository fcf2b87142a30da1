// The page without a server, from a plain server of files in a folder of its own: pictures and exports are those of the
// command, a slider is followed, recipes are opened, saved and shared by the browser.
import assert from 'node:assert/strict';
import { createServer } from 'node:http';
import { mkdtempSync, readFileSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { extname, join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { dapple, endBrowser, hash, open, select, settled, skipStatic, STATIC, text } from './harness.mjs';

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml', '.wasm': 'application/wasm' };

describe('the page without a server', { skip: skipStatic, timeout: 240_000 }, () => {
  let server;
  let address;
  before(async () => {
    server = createServer(({ url }, response) => {
      const path = new URL(url, 'http://host').pathname.replace(/^\/some\/where\//, '') || 'index.html';
      try {
        const bytes = readFileSync(join(STATIC, path));
        response.writeHead(200, { 'Content-Type': TYPES[extname(path)] ?? 'application/octet-stream' }).end(bytes);
      } catch {
        response.writeHead(404).end();
      }
    });
    await new Promise((done) => server.listen(0, '127.0.0.1', done));
    address = `http://127.0.0.1:${server.address().port}/some/where/`;
  });
  after(async () => {
    await endBrowser();
    server?.close();
  });

  const folder = () => mkdtempSync(join(tmpdir(), 'dapple-static-'));
  const seed = async (page, value) => {
    await page.getByRole('spinbutton', { name: 'Seed', exact: true }).fill(value);
    await page.keyboard.press('Tab');
    await settled(page);
  };

  test('a slider is followed, and undo brings back the picture', async () => {
    const page = await open(`${address}#flagstone`);
    await settled(page);
    const before = await hash(page, 'height');
    await select(page, 'grain');
    const knob = page.locator('[data-path="nodes.grain.noise.gain"] input[type=range]');
    const box = await knob.boundingBox();
    await page.mouse.move(box.x + box.width * 0.6, box.y + box.height / 2);
    await page.mouse.down();
    for (let i = 0; i <= 20; i += 1) await page.mouse.move(box.x + box.width * (0.6 - i * 0.02), box.y + box.height / 2);
    await page.mouse.up();
    await settled(page);
    assert.notEqual(await hash(page, 'height'), before);
    await page.locator('body').press('Control+z');
    await settled(page);
    assert.equal(await hash(page, 'height'), before);
    assert.deepEqual(page.wrong, []);
  });

  test('an export is byte for byte what bake writes, and is drawn alike', async () => {
    const page = await open(`${address}?recipe=marble`);
    await settled(page);
    await page.keyboard.press('Control+e');
    await page.locator('dialog select').first().selectOption({ label: '512 pixels' });
    await page.locator('dialog select').nth(1).selectOption('png8');
    await page.getByRole('button', { name: /^Bake/ }).click();
    await page.locator('dialog ul a').first().waitFor({ timeout: 20_000 });
    const links = await page.locator('dialog ul a').all();
    assert.equal(links.length, 5);
    const out = folder();
    writeFileSync(join(out, 'marble.toml'), await text(page));
    dapple('bake', join(out, 'marble.toml'), '--size', '512', '--format', 'png8', '-o', `${out}/maps/`);
    for (const link of links) {
      const [download] = await Promise.all([page.waitForEvent('download'), link.click()]);
      const name = download.suggestedFilename();
      assert.ok(readFileSync(await download.path()).equals(readFileSync(join(out, 'maps', name))), name);
    }
    await page.keyboard.press('Escape');
    await page.locator('.tools select').first().selectOption({ label: '256 px' });
    await settled(page);
    await page.getByRole('button', { name: '1:1' }).click();
    await page.waitForTimeout(300);
    dapple('bake', 'marble', '--size', '256', '--maps', 'albedo', '--format', 'png8', '-o', `${out}/small.png`);
    const same = await page.evaluate(async (base64) => {
      const image = await createImageBitmap(new Blob([Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0))]), { colorSpaceConversion: 'none' });
      const pixels = (source, x, y) => {
        const canvas = new OffscreenCanvas(image.width, image.height);
        canvas.getContext('2d').drawImage(source, -x, -y);
        return canvas.getContext('2d').getImageData(0, 0, image.width, image.height).data.join();
      };
      const seen = document.querySelector('canvas[data-map=albedo]');
      const [x, y] = [Math.round((seen.width - image.width) / 2), Math.round((seen.height - image.height) / 2)];
      return pixels(image, 0, 0) === pixels(seen, x, y);
    }, readFileSync(join(out, 'small.png')).toString('base64'));
    assert.ok(same, 'the canvas has other pixels than the bake');
    assert.deepEqual(page.wrong, []);
  });

  test('a recipe is downloaded, opened from a file, and shared by its address', async () => {
    const page = await open(address);
    await page.locator('dialog .upload input').waitFor({ state: 'attached' });
    await page.keyboard.press('Escape');
    await page.goto(`${address}#giraffe`);
    await page.waitForFunction(() => document.title.includes('giraffe'));
    await settled(page);
    await seed(page, '4711');
    const changed = await text(page);
    await page.keyboard.press('Control+s');
    const [download] = await Promise.all([page.waitForEvent('download'), page.locator('dialog').getByRole('button', { name: 'Download' }).click()]);
    assert.equal(download.suggestedFilename(), 'giraffe.toml');
    assert.equal(readFileSync(await download.path(), 'utf8'), changed);
    await page.getByRole('button', { name: 'Copy as…' }).click();
    await page.waitForFunction(() => document.querySelector('dialog textarea').value.includes('#toml='));
    const link = await page.locator('dialog textarea').inputValue();
    await page.keyboard.press('Escape');
    await page.keyboard.press('Control+o');
    const file = join(folder(), 'mine.toml');
    writeFileSync(file, changed.replace('4711', '12'));
    await page.locator('dialog .upload input').setInputFiles(file);
    await settled(page);
    assert.equal(await text(page), changed.replace('4711', '12'));
    const other = await open(link);
    await settled(other);
    assert.equal(await text(other), changed);
    assert.deepEqual([...page.wrong, ...other.wrong], []);
  });
});
