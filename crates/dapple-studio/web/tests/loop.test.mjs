// A recipe that moves: its loop is played, in step with what is drawn, and stays where it is stopped.
import assert from 'node:assert/strict';
import { mkdtempSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { endBrowser, hash, open, serve, settled, skip } from './harness.mjs';

const RECIPE = `dapple = 1
name = "moving"
extent = [4.0, 4.0]

[nodes.cells.worley]
motion = { cells = 1 }

[material]
height = "cells"
`;

after(endBrowser);

test('a loop is played and stopped', { skip, timeout: 60_000 }, async () => {
  const folder = mkdtempSync(join(tmpdir(), 'dapple-loop-'));
  writeFileSync(join(folder, 'moving.toml'), RECIPE);
  const studio = await serve(['moving.toml'], 'studio', folder);
  try {
    const page = await open(studio.url);
    await settled(page);
    const start = await hash(page, 'height');
    await page.getByRole('button', { name: 'Play' }).click();
    const seen = new Set();
    for (let i = 0; i < 30; i += 1) {
      await page.waitForTimeout(60);
      seen.add(await hash(page, 'height'));
    }
    await page.getByRole('button', { name: 'Stop' }).click();
    await settled(page);
    assert.ok(seen.size >= 8, `${seen.size} pictures in two seconds`);
    const still = await hash(page, 'height');
    await page.waitForTimeout(300);
    assert.equal(await hash(page, 'height'), still);
    // The end of the loop is its beginning.
    await page.getByRole('slider', { name: 'Time of the loop' }).fill('1');
    await settled(page);
    assert.equal(await hash(page, 'height'), start);
    assert.deepEqual(page.wrong, []);
  } finally {
    studio.end();
  }
});
