// Every number of every kind of node has a slider with a finite range that holds its default, and a fine step.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { describe, test } from 'node:test';
import ts from 'typescript';
import { pageSchema, skip } from './harness.mjs';

/** Loads a module of the page that imports types alone. */
async function load(name) {
  const text = readFileSync(new URL(`../src/core/${name}.ts`, import.meta.url), 'utf8');
  const { outputText } = ts.transpileModule(text, { compilerOptions: { module: ts.ModuleKind.ESNext, target: ts.ScriptTarget.ES2022 } });
  return import(`data:text/javascript,${encodeURIComponent(outputText)}`);
}

const { slide } = await load('range');
const { Schemas } = await load('schema');

/** Calls `visit` with each number in a schema: its path, its range, its name and its default. */
function numbers(schemas, schema, path, fallback, visit) {
  if (path.length > 9) return;
  const key = String(path.findLast((step) => step !== '*') ?? '');
  const shape = schemas.shape(schema, key);
  if (shape.kind === 'number') return visit(path, shape, key, fallback);
  if (shape.kind === 'list') return numbers(schemas, shape.item, [...path, '*'], Array.isArray(fallback) ? fallback[0] : undefined, visit);
  if (shape.kind === 'table' || shape.kind === 'ramp') {
    for (const part of schemas.parts(schema, fallback)) numbers(schemas, part.schema, [...path, part.key], part.fallback, visit);
  }
  if (shape.kind === 'union') {
    for (const { key: name, schema: inner } of shape.variants) {
      const given = name === null ? fallback : fallback?.[name];
      numbers(schemas, inner, name === null ? path : [...path, name], given, visit);
    }
  }
}

describe('sliders', { skip, timeout: 60_000 }, () => {
  test('every number of a recipe has a usable slider', () => {
    const schemas = new Schemas(pageSchema());
    const wrong = [];
    let count = 0;
    const visit = (path, { range, unit }, key, fallback) => {
      count += 1;
      const start = typeof fallback === 'number' ? fallback : schemas.sample({ type: range.integer ? 'integer' : 'number' }, key);
      const { low, high, step, log } = slide(range, key, start, typeof fallback === 'number' ? fallback : undefined);
      const steps = (high - low) / step;
      const holds =
        Number.isFinite(low) && Number.isFinite(high) && low < high && low >= range.min && high <= range.max && step > 0 &&
        (log ? low > 0 : steps <= 1000) && (typeof fallback !== 'number' || fallback < range.min || (fallback >= low - step && fallback <= high + step)) &&
        (!range.integer || step === 1) && unit.length <= 5 &&
        // An angle turns far, an exponent reaches both sides of 1, and a small radius can be set.
        (unit !== '°' || high - low >= 90) && (key !== 'exponent' || (low < 1 && high > 2)) && (key !== 'radius' || range.max < 1000 || range.max === Infinity || log);
      if (!holds) wrong.push(`${path.join('.')}: ${JSON.stringify({ low, high, step, log, fallback, range })}`);
    };
    for (const { key, schema } of schemas.variants({ $ref: '#/$defs/Node' })) numbers(schemas, schema, [key], undefined, visit);
    numbers(schemas, { $ref: '#/$defs/Material' }, ['material'], undefined, visit);
    assert.ok(count > 200, `only ${count} numbers were found`);
    assert.deepEqual(wrong, []);
  });
});
