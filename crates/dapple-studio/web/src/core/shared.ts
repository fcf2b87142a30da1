// The named parameters of a recipe, whose values options share as "$name".
import type { Json, Path } from './protocol';
import { entry, type JsonSchema, type Schemas } from './schema';

/** A parameter of the recipe, with the schema of its value. */
export interface Shared {
  name: string;
  /** Where the value is written. */
  path: Path;
  value: Json;
  about: string;
  schema: JsonSchema;
  /** The name of the first option that refers to it, which determines the usual range of its slider. */
  option: string;
}

/** Returns the name of the parameter that a value refers to, or null. */
export function reference(value: Json | undefined): string | null {
  return typeof value === 'string' && /^\$./.test(value) ? value.slice(1) : null;
}

/** Returns the parameters of a recipe, in the order of its text. */
export function sharedParameters(recipe: Json | undefined, schemas: Schemas): Shared[] {
  const named = entry(recipe, 'parameters');
  if (typeof named !== 'object' || named === null || Array.isArray(named)) return [];
  return Object.entries(named).map(([name, given]) => {
    const isTable = typeof given === 'object' && given !== null && !Array.isArray(given);
    const value = isTable ? (given['value'] ?? null) : given;
    const range = isTable && Array.isArray(given['range']) ? given['range'].map(Number) : null;
    const use = firstUse(recipe, `$${name}`, []);
    const found = use ? schemaAt(schemas, use) : null;
    const option = String(use?.findLast((step) => typeof step === 'string') ?? name);
    return {
      name,
      path: isTable ? ['parameters', name, 'value'] : ['parameters', name],
      value,
      about: isTable && typeof given['doc'] === 'string' ? given['doc'] : (found?.description ?? ''),
      schema: within(found ? schemas.plain(found) : schemaOf(value), range),
      option,
    };
  });
}

/** Narrows the schema of a number to the range of a parameter. */
function within(schema: JsonSchema, range: number[] | null): JsonSchema {
  const [min, max] = range ?? [];
  if (min === undefined || max === undefined) return schema;
  const { exclusiveMinimum: _low, exclusiveMaximum: _high, ...others } = schema;
  return { ...others, minimum: min, maximum: max, 'x-dapple': { ...others['x-dapple'], soft: [min, max] } };
}

/** The path of the first option with this value, outside of the parameters. */
function firstUse(value: Json | undefined, text: string, path: Path): Path | null {
  if (value === text) return path;
  if (typeof value !== 'object' || value === null) return null;
  const entries: [string | number, Json][] = Array.isArray(value) ? value.map((inner, index) => [index, inner]) : Object.entries(value);
  for (const [key, inner] of entries) {
    if (path.length === 0 && key === 'parameters') continue;
    const found = firstUse(inner, text, [...path, key]);
    if (found) return found;
  }
  return null;
}

/** The schema of the value at a path of the recipe, or null. */
function schemaAt(schemas: Schemas, path: Path): JsonSchema | null {
  let schema: JsonSchema | null = schemas.root;
  for (const step of path) {
    if (!schema) return null;
    schema = typeof step === 'number' ? itemOf(schemas, schema) : propertyOf(schemas, schema, step);
  }
  return schema;
}

function itemOf(schemas: Schemas, schema: JsonSchema): JsonSchema | null {
  const all = schemas.plain(schema);
  const list = all.items ? all : (all.oneOf ?? all.anyOf ?? []).map((one) => schemas.plain(one)).find((one) => one.items);
  return list?.items ?? null;
}

function propertyOf(schemas: Schemas, schema: JsonSchema, key: string): JsonSchema | null {
  const all = schemas.plain(schema);
  const own = all.properties?.[key];
  if (own) return own;
  if (typeof all.additionalProperties === 'object') return all.additionalProperties;
  for (const one of all.oneOf ?? all.anyOf ?? []) {
    const found = propertyOf(schemas, one, key);
    if (found) return found;
  }
  return null;
}

function schemaOf(value: Json): JsonSchema {
  if (typeof value === 'boolean') return { type: 'boolean' };
  if (typeof value === 'number') return { type: 'number' };
  if (Array.isArray(value)) return { type: 'array', items: { type: 'number' } };
  return typeof value === 'string' && value.startsWith('#') ? { $ref: '#/$defs/ColorOf' } : { type: 'string' };
}
