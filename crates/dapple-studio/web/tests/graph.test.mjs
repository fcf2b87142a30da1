// The graph by mouse and keyboard: moving nodes, links, several nodes, and adding a node where a link is dropped.
import assert from 'node:assert/strict';
import { mkdtempSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { endBrowser, open, select, serve, settled, skip, text } from './harness.mjs';

const RECIPE = `dapple = 1

[nodes.base.noise]

[nodes.moss_mask_of_the_north_side.levels]
input = "base"

[nodes.sum]
add = ["base", "moss_mask_of_the_north_side"]

[material]
height = "sum"
`;

describe('the graph', { skip, timeout: 240_000 }, () => {
  let studio;
  before(async () => {
    const folder = mkdtempSync(join(tmpdir(), 'dapple-graph-'));
    writeFileSync(join(folder, 'mine.toml'), RECIPE);
    studio = await serve(['mine.toml'], 'studio', folder);
  });
  after(async () => {
    await endBrowser();
    studio?.end();
  });

  const node = (page, name) => page.locator(`.svelte-flow__node[data-id="${name}"]`);
  const middle = async (locator) => {
    const box = await locator.boundingBox();
    return [box.x + box.width / 2, box.y + box.height / 2];
  };
  async function drag(page, [x, y], [toX, toY]) {
    await page.mouse.move(x, y);
    await page.mouse.down();
    for (let i = 1; i <= 8; i += 1) await page.mouse.move(x + ((toX - x) * i) / 8, y + ((toY - y) * i) / 8);
    await page.mouse.up();
  }
  async function begin() {
    const page = await open(studio.url);
    await settled(page);
    await node(page, 'base').waitFor();
    await page.waitForTimeout(400);
    return page;
  }

  test('a moved node stays in its place, which is one step of undo and survives renaming', async () => {
    const page = await begin();
    const [x, y] = await middle(node(page, 'base'));
    await drag(page, [x, y], [x + 20, y + 60]);
    await settled(page);
    assert.match(await text(page), /\n\n# layout: base = -?\d+ -?\d+, .*#material = -?\d+ -?\d+\n$/);
    const [, nowY] = await middle(node(page, 'base'));
    // The first pixels of a drag only begin it.
    assert.ok(nowY - y > 40 && nowY - y < 63, `${nowY - y}`);
    const before = await text(page);
    await select(page, 'base');
    const name = page.locator('.parameters .name');
    await name.fill('ground');
    await name.press('Enter');
    await node(page, 'ground').waitFor();
    assert.match(await text(page), /# layout: ground = /);
    await page.locator('body').press('Control+z');
    await node(page, 'base').waitFor();
    assert.equal(await text(page), before);
    await page.locator('body').press('Control+z');
    await settled(page);
    assert.equal(await text(page), RECIPE);
    await node(page, 'base').focus();
    for (const key of ['Enter', 'ArrowDown', 'ArrowDown']) await page.keyboard.press(key);
    await settled(page);
    assert.match(await text(page), /# layout: base = /);
    await page.getByRole('button', { name: 'Tidy' }).click();
    await settled(page);
    assert.equal(await text(page), RECIPE);
    assert.deepEqual(page.wrong, []);
  });

  test('a link is selected and deleted', async () => {
    const page = await begin();
    await page.getByRole('group', { name: 'Link from base to sum' }).focus();
    await page.keyboard.press('Enter');
    await page.keyboard.press('Delete');
    await page.waitForFunction(() => document.querySelectorAll('.svelte-flow__edge').length === 3);
    await settled(page);
    assert.match(await text(page), /add = \[0\.0, "moss_mask_of_the_north_side"\]/);
    assert.deepEqual(page.wrong, []);
  });

  test('several nodes are copied, pasted and deleted', async () => {
    const page = await begin();
    await node(page, 'base').click();
    await node(page, 'moss_mask_of_the_north_side').click({ modifiers: ['Control'] });
    await page.keyboard.press('Control+d');
    await node(page, 'moss_mask_of_the_north_side_2').waitFor();
    await settled(page);
    assert.match(await text(page), /\[nodes\.moss_mask_of_the_north_side_2\.levels\]\ninput = "base_2"/);
    await page.keyboard.press('Control+z');
    await node(page, 'base_2').waitFor({ state: 'detached' });
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
    await node(page, 'moss_mask_of_the_north_side_2').waitFor();
    assert.match(await text(page), /input = "base_2"/);
    await page.locator('body').press('Control+z');
    await node(page, 'base_2').waitFor({ state: 'detached' });
    await node(page, 'base').click();
    await node(page, 'sum').click({ modifiers: ['Control'] });
    await page.keyboard.press('Delete');
    await page.waitForFunction(() => document.querySelectorAll('.svelte-flow__node').length === 2);
    await settled(page);
    assert.doesNotMatch(await text(page), /base|sum/);
    assert.equal(await page.locator('.status .bad').count(), 0);
    assert.deepEqual(page.wrong, []);
  });

  test('a link dropped on empty space adds a node', async () => {
    const page = await begin();
    const from = await middle(node(page, 'sum').locator('.svelte-flow__handle.source'));
    await drag(page, from, [from[0] + 30, from[1] + 120]);
    await page.locator('dialog[open]').waitFor();
    await page.keyboard.type('power');
    await page.keyboard.press('Enter');
    await node(page, 'power').waitFor();
    await settled(page);
    assert.match(await text(page), /\[nodes\.power\.power\]\n(?:exponent = .*\n)?input = "sum"/);
    assert.deepEqual(page.wrong, []);
  });

  test('long names are told apart, and kinds are seen from afar', async () => {
    const page = await begin();
    const seen = await node(page, 'moss_mask_of_the_north_side').locator('strong').evaluate((words) => words.scrollHeight <= words.clientHeight + 1);
    assert.ok(seen, 'the whole name is seen');
    await page.evaluate(() => document.querySelector('.graph').classList.add('far'));
    assert.ok(await node(page, 'base').locator('.dim').isVisible());
  });
});
