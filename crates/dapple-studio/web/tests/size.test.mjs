// How large the page is: all of it, compressed, within its budget.
import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { DIST, skip } from './harness.mjs';

/** KiB of all files together, each compressed by gzip. */
const BUDGET = 450;

test('the page stays within its budget', { skip }, () => {
  const files = readdirSync(DIST, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile() && !entry.name.endsWith('.gz'));
  const sizes = files.map((entry) => [entry.name, gzipSync(readFileSync(join(entry.parentPath ?? entry.path, entry.name))).length / 1024]);
  const all = sizes.reduce((sum, [, size]) => sum + size, 0);
  console.log(sizes.map(([name, size]) => `${name} ${size.toFixed(1)}`).join(' · '), `· all ${all.toFixed(1)} KiB`);
  assert.ok(all <= BUDGET, `${all.toFixed(1)} KiB`);
});
