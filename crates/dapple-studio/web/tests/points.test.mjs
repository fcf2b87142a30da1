// Control points on the picture: made editable, moved, inserted and deleted, by mouse and by keys.
import assert from 'node:assert/strict';
import { mkdtempSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { endBrowser, hash, open, select, serve, settled, skip, text } from './harness.mjs';

const RECIPE = `dapple = 1
name = "dots"
extent = [2.0, 2.0]

# A dozen of points.
[nodes.dots.pups.cells]
spacing = 0.5

[material]
height = "dots"
`;

const LABELED = `dapple = 1
name = "patches"
extent = [2.0, 2.0]

[nodes.dots.pups.cells]
spacing = 0.4
points_per_cell = [3, 4]

[material]
height = "dots"
`;

/** Shows the points of the node `dots`. */
async function look(page) {
  await settled(page);
  await select(page, 'dots');
  await page.locator('#tab-node').click();
  await page.locator('svg .point').first().waitFor();
  await settled(page);
}

describe('control points', { skip, timeout: 120_000 }, () => {
  const folder = mkdtempSync(join(tmpdir(), 'dapple-points-'));
  let studio;
  let other;
  let page;
  before(async () => {
    writeFileSync(join(folder, 'dots.toml'), RECIPE);
    studio = await serve(['dots.toml'], 'studio', folder);
    page = await open(studio.url);
    await look(page);
  });
  after(async () => {
    await endBrowser();
    studio?.end();
    other?.end();
  });

  /** The point nearest to a place, in pixels from the middle of the picture. */
  const nearest = (x, y) =>
    page.evaluate(([x, y]) => {
      const box = document.querySelector('canvas[data-map=node]').getBoundingClientRect();
      const far = [...document.querySelectorAll('svg .point')].map((one) => {
        const at = one.getBoundingClientRect();
        return Math.hypot(at.x + at.width / 2 - box.x - box.width / 2 - x, at.y + at.height / 2 - box.y - box.height / 2 - y);
      });
      return far.indexOf(Math.min(...far));
    }, [x, y]);
  const count = () => page.locator('svg .point').count();

  test('a texture becomes its points with the same picture', async () => {
    const before = await hash(page, 'node');
    assert.equal(await page.locator('svg.open').count(), 0);
    await page.getByRole('button', { name: 'Make points editable' }).click();
    await page.locator('svg.open .point').first().waitFor();
    await settled(page);
    assert.match(await text(page), /# A dozen of points\.\n\[nodes\.dots\.pups\.points\]/);
    assert.equal(await hash(page, 'node'), before);
  });

  test('a dragged point moves, and one undo brings it back', async () => {
    const [before, old] = [await hash(page, 'node'), await text(page)];
    const middle = await nearest(0, 0);
    const box = await page.locator('svg .point').nth(middle).boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    for (let i = 1; i <= 20; i += 1) await page.mouse.move(box.x + box.width / 2 + i * 2, box.y + box.height / 2 + i);
    await page.mouse.up();
    await settled(page);
    assert.notEqual(await hash(page, 'node'), before);
    const now = await page.locator('svg .point').nth(middle).boundingBox();
    assert.ok(Math.abs(now.x - box.x - 40) < 2 && Math.abs(now.y - box.y - 20) < 2, `${now.x - box.x}, ${now.y - box.y}`);
    await page.keyboard.press('Control+z');
    await settled(page);
    assert.equal(await text(page), old);
    assert.equal(await hash(page, 'node'), before);
  });

  test('points are added by a double-click, moved by arrows and deleted', async () => {
    const many = await count();
    // Beside a point, but not on it.
    const near = await page.locator('svg .point').nth(await nearest(0, 0)).boundingBox();
    await page.mouse.dblclick(near.x + near.width / 2 + 24, near.y + near.height / 2 - 3);
    await settled(page);
    await page.waitForFunction((n) => document.querySelectorAll('svg .point').length === n, many + 1);
    const last = page.locator('svg .point').nth(many);
    const label = await last.getAttribute('aria-label');
    await last.focus();
    await page.keyboard.press('Shift+ArrowRight');
    await settled(page);
    assert.notEqual(await last.getAttribute('aria-label'), label);
    await page.keyboard.press('Delete');
    await page.waitForFunction((n) => document.querySelectorAll('svg .point').length === n, many);
    assert.deepEqual(page.wrong, []);
  });

  test('points with labels keep them, and take others', async () => {
    writeFileSync(join(folder, 'patches.toml'), LABELED);
    other = await serve(['patches.toml'], 'studio', folder);
    const page = await open(other.url);
    await look(page);
    await page.getByRole('button', { name: 'Make points editable' }).click();
    await page.locator('svg.open .point').first().waitFor();
    await settled(page);
    const [, values] = /\nvalues = \[(.*)\]/.exec(await text(page));
    const last = values.split(',').length - 1;
    await page.locator('svg .point').first().focus();
    await page.locator('.value select').selectOption(String(last));
    await settled(page);
    assert.match(await text(page), new RegExp(`points = \\[\\n {4}\\{[^}]*label = ${last}\\b`));
    const before = await hash(page, 'node');
    await page.getByLabel('its value').fill('0.125');
    await page.keyboard.press('Tab');
    await settled(page);
    assert.match(await text(page), /\nvalues = \[.*0\.125\]/);
    assert.notEqual(await hash(page, 'node'), before);
    assert.deepEqual(page.wrong, []);
  });
});
