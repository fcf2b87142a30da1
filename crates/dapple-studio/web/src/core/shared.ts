// The named parameters of a recipe, whose values options share as "$name".
import type { Json, Path } from './protocol';
import { at, entry, type JsonSchema, type Schemas } from './schema';

/** A parameter of the recipe, with the schema of its value. */
export interface Shared {
  name: string;
  /** Where the value is written. */
  path: Path;
  value: Json;
  about: string;
  schema: JsonSchema;
  /** The paths of the options that refer to it. The first one determines the usual range of its slider. */
  uses: Path[];
}

/** Returns the name of the parameter that a value refers to, or null. */
export function reference(value: Json | undefined): string | null {
  return typeof value === 'string' && /^\$./.test(value) ? value.slice(1) : null;
}

/** Returns a recipe in which references are replaced by the values of their parameters. */
export function resolved(recipe: Json): Json {
  const replaced = (value: Json): Json => {
    const path = parameterPath(recipe, reference(value));
    if (path) return at(recipe, path) ?? null;
    if (typeof value !== 'object' || value === null) return value;
    if (Array.isArray(value)) return value.map(replaced);
    return Object.fromEntries(Object.entries(value).map(([key, inner]) => [key, replaced(inner)]));
  };
  return entry(recipe, 'parameters') === undefined ? recipe : replaced(recipe);
}

/** Returns the path at which a value is written: in a parameter, if the option or a list around it refers to one. */
export function sourceOf(recipe: Json, path: Path): Path {
  for (let length = 1; length <= path.length; length += 1) {
    const source = parameterPath(recipe, reference(at(recipe, path.slice(0, length))));
    if (source) return [...source, ...path.slice(length)];
  }
  return path;
}

/** Returns the smallest and the largest number that the parameter at a path of `sourceOf` allows, or null. */
export function rangeAt(recipe: Json, path: Path): [number, number] | null {
  const range = path[0] === 'parameters' ? at(recipe, [...path.slice(0, 2), 'range']) : undefined;
  return Array.isArray(range) ? [Number(range[0]), Number(range[1])] : null;
}

/** The path of a parameter's value, or null if there is no parameter of this name. */
function parameterPath(recipe: Json, name: string | null): Path | null {
  const given = name === null ? undefined : at(recipe, ['parameters', name]);
  if (name === null || given === undefined) return null;
  return isTable(given) ? ['parameters', name, 'value'] : ['parameters', name];
}

function isTable(value: Json | undefined): value is { [key: string]: Json } {
  return typeof value === 'object' && value !== null && !Array.isArray(value);
}

/** Returns the parameters of a recipe. `order` lists their names in the order of the text. */
export function sharedParameters(recipe: Json, schemas: Schemas, order: string[]): Shared[] {
  return order.flatMap((name) => {
    const path = parameterPath(recipe, name);
    if (!path) return [];
    const given = at(recipe, ['parameters', name]);
    const value = at(recipe, path) ?? null;
    const uses = usesOf(recipe, `$${name}`, []);
    const found = uses[0] ? schemaAt(schemas, uses[0]) : null;
    const doc = entry(given, 'doc');
    return [{
      name,
      path,
      value,
      about: typeof doc === 'string' ? doc : (found?.description ?? ''),
      schema: within(schemas, (found && variantFor(schemas, found, value)) ?? schemaOf(value), rangeAt(recipe, path)),
      uses,
    }];
  });
}

/** The schema of the kind of value that a parameter has, among those that its option allows. Null if it can be any. */
function variantFor(schemas: Schemas, schema: JsonSchema, value: Json): JsonSchema | null {
  const shape = schemas.shape(schema);
  if (shape.kind === 'input' && typeof value !== 'object') return null;
  if (shape.kind !== 'union') return schema;
  const variant = schemas.variantOf(shape.variants, value);
  return variant?.key === null ? variantFor(schemas, variant.schema, value) : schema;
}

/** Narrows the schema of a number to the range of a parameter. */
function within(schemas: Schemas, schema: JsonSchema, range: [number, number] | null): JsonSchema {
  if (!range) return schema;
  const [min, max] = range;
  const { exclusiveMinimum: _low, exclusiveMaximum: _high, ...others } = schemas.plain(schema);
  // A slider with a logarithmic scale does not reach 0.
  const scale = min > 0 ? {} : { scale: 'linear' };
  return { ...others, minimum: min, maximum: max, 'x-dapple': { ...others['x-dapple'], soft: [min, max], ...scale } };
}

/** The paths of the options with this value, outside of the parameters. */
function usesOf(value: Json, text: string, path: Path): Path[] {
  if (value === text) return [path];
  if (typeof value !== 'object' || value === null) return [];
  const entries: [string | number, Json][] = Array.isArray(value) ? value.map((inner, index) => [index, inner]) : Object.entries(value);
  return entries.flatMap(([key, inner]) => (path.length === 0 && key === 'parameters' ? [] : usesOf(inner, text, [...path, key])));
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
