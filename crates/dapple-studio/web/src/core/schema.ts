// Derives the widgets of values from the JSON Schema of recipes.
//
// A schema is converted to a `Shape`, one of a few kinds with a widget each. References are followed. Descriptions and
// defaults next to a reference take precedence. Values that may be null or omitted are optional.
import type { Json } from './protocol';

/** The subset of JSON Schema that recipes use. */
export interface JsonSchema {
  $ref?: string;
  $defs?: Record<string, JsonSchema>;
  type?: string | string[];
  description?: string;
  default?: Json;
  deprecated?: boolean;
  const?: Json;
  enum?: Json[];
  pattern?: string;
  format?: string;
  minimum?: number;
  maximum?: number;
  exclusiveMinimum?: number;
  exclusiveMaximum?: number;
  minItems?: number;
  maxItems?: number;
  items?: JsonSchema;
  properties?: Record<string, JsonSchema>;
  additionalProperties?: boolean | JsonSchema;
  required?: string[];
  oneOf?: JsonSchema[];
  anyOf?: JsonSchema[];
  'x-dapple'?: { unit?: string; soft?: [number, number]; scale?: string; widget?: string };
}

/** The allowed range of a number, and the range of its slider. */
export interface Range {
  min: number;
  max: number;
  /** Whether each end of the range is excluded. */
  open: [boolean, boolean];
  integer: boolean;
  soft: [number, number] | null;
  log: boolean;
}

/** A variant of a union. */
export interface Variant {
  label: string;
  about: string;
  /** The key of the table that is the variant, or null for a plain value. */
  key: string | null;
  schema: JsonSchema;
}

/** A property of a table. */
export interface Part {
  key: string;
  about: string;
  schema: JsonSchema;
  required: boolean;
  fallback: Json | undefined;
}

/** The kinds of values that a schema allows. */
export type Shape =
  | { kind: 'number'; range: Range; unit: string }
  | { kind: 'boolean' }
  | { kind: 'choice'; options: { value: Json; about: string }[] }
  | { kind: 'color' | 'input' | 'seed' | 'text' | 'points' | 'nothing' }
  | { kind: 'ramp' | 'table'; parts: Part[] }
  | { kind: 'list'; item: JsonSchema; min: number; max: number }
  | { kind: 'union'; variants: Variant[] };

const named: Record<string, Shape> = {
  Input: { kind: 'input' },
  ColorOf: { kind: 'color' },
  NodeSeed: { kind: 'seed' },
  Tile: { kind: 'nothing' },
};

/** Names of numbers that get logarithmic sliders, such as frequencies. */
const RATIOS = /^(frequency|spacing|density|distance|distances|count|relief|feature_size|extent|exponent)$/;

/** Largest angle of a slider, in degrees. */
const HALF_TURN = 180;

/** Maximum of an allowed range in units of the plane; small lengths in a larger range need a logarithmic slider. */
const LONG = 1000;

/** Properties that are listed first, in this order. */
const FIRST = [
  'input', 'inputs', 'from', 'to', 'by', 'x', 'y', 'height', 'albedo', 'roughness', 'metallic', 'relief', 'value',
  'basis', 'spacing', 'frequency', 'octaves', 'gain', 'lacunarity', 'scatter', 'metric', 'name', 'extent', 'wrap',
];

/** Reads schemas and resolves references to the definitions of one document. */
export class Schemas {
  constructor(readonly root: JsonSchema) {}

  /** Resolves references and removes `null` from a schema. */
  plain(schema: JsonSchema): JsonSchema {
    const name = definition(schema);
    if (name !== null) {
      const { $ref: _, ...beside } = schema;
      return { ...this.plain(this.root.$defs?.[name] ?? {}), ...beside };
    }
    const some = schema.anyOf?.filter((one) => one.type !== 'null');
    if (some && some.length === 1 && some[0] && schema.anyOf?.length === 2) {
      const { anyOf: _, ...beside } = schema;
      return { ...this.plain(some[0]), ...beside };
    }
    return schema;
  }

  /** Returns the shape of a value. `key` is its name, which determines the range of its slider. */
  shape(schema: JsonSchema, key = ''): Shape {
    const name = this.name(schema);
    if (name !== null && named[name]) return named[name];
    const all = this.plain(schema);
    const type = Array.isArray(all.type) ? all.type.find((one) => one !== 'null') : all.type;
    if (all.enum) return { kind: 'choice', options: all.enum.map((value) => ({ value, about: '' })) };
    const options = choices(all);
    if (options) return { kind: 'choice', options };
    if (all.oneOf ?? all.anyOf) return { kind: 'union', variants: this.variants(all) };
    if (type === 'boolean') return { kind: 'boolean' };
    if (type === 'number' || type === 'integer') return numberShape(all, key);
    if (type === 'string') return { kind: 'text' };
    if (type === 'array' && all.items) {
      if (this.name(all.items) === 'ControlPoint') return { kind: 'points' };
      // Numbers of a list have the unit that the list's description names.
      const item = (all.items.type === 'number' || all.items.type === 'integer') && all.description !== undefined ? { description: all.description, ...all.items } : all.items;
      return { kind: 'list', item, min: all.minItems ?? 0, max: all.maxItems ?? Infinity };
    }
    if (!all.properties) return { kind: 'nothing' };
    const parts = this.parts(all);
    const ramp = parts.some((part) => part.key === 'colors') && parts.some((part) => part.key === 'positions');
    return { kind: ramp ? 'ramp' : 'table', parts };
  }

  /**
   * Returns the properties of a table, except deprecated ones. Their defaults come from `given`, the default of the
   * table, if it has them.
   */
  parts(schema: JsonSchema, given?: Json): Part[] {
    const all = this.plain(schema);
    return Object.entries(all.properties ?? {})
      .filter(([, part]) => !this.plain(part).deprecated)
      .map(([key, part]) => ({
        key,
        about: part.description ?? this.plain(part).description ?? '',
        schema: part,
        required: all.required?.includes(key) ?? false,
        fallback: entry(given, key) ?? part.default ?? this.plain(part).default,
      }))
      .sort((a, b) => rank(a) - rank(b));
  }

  /** Returns the variants of a union. */
  variants(schema: JsonSchema): Variant[] {
    const all = this.plain(schema);
    return (all.oneOf ?? all.anyOf ?? []).flatMap((one) => this.#variant(one));
  }

  /** Finds the variant of a value. */
  variantOf(variants: Variant[], value: Json | undefined): Variant | undefined {
    return variants.find((variant) => this.#is(variant, value));
  }

  /** Returns a minimal valid value. */
  sample(schema: JsonSchema, key = ''): Json {
    const all = this.plain(schema);
    if (all.default !== undefined && all.default !== null) return all.default;
    if (all.const !== undefined) return all.const;
    const shape = this.shape(schema, key);
    switch (shape.kind) {
      case 'number':
        return startOf(shape.range);
      case 'boolean':
        return false;
      case 'choice':
        return shape.options[0]?.value ?? null;
      case 'color':
        return '#808080';
      case 'input':
        return 0.5;
      case 'seed':
        return 0;
      case 'text':
        return '';
      case 'points':
        return [{ x: 0.5, y: 0.5, value: 1 }];
      case 'list': {
        const item = this.sample(shape.item, key);
        const count = Math.max(shape.min, 1);
        return Array.from({ length: count }, () => item);
      }
      case 'union': {
        const first = shape.variants[0];
        return first ? this.variantSample(first) : null;
      }
      case 'ramp':
        return { ...this.#required(shape.parts), colors: ['#202020', '#e0e0e0'] };
      case 'table':
        return this.#required(shape.parts);
      case 'nothing':
        return {};
    }
  }

  /** Returns a minimal valid value of a variant. */
  variantSample(variant: Variant): Json {
    const inner = this.sample(variant.schema);
    return variant.key === null ? inner : { [variant.key]: inner };
  }

  /** The name of the definition that a schema refers to, even if the value may also be `null`. */
  name(schema: JsonSchema): string | null {
    const direct = definition(schema);
    if (direct !== null) return direct;
    const some = schema.anyOf?.filter((one) => one.type !== 'null');
    return some?.length === 1 && some[0] ? definition(some[0]) : null;
  }

  #required(parts: Part[]): { [key: string]: Json } {
    const needed = parts.filter((part) => part.required);
    return Object.fromEntries(needed.map((part) => [part.key, this.sample(part.schema, part.key)]));
  }

  #variant(one: JsonSchema): Variant[] {
    const all = this.plain(one);
    const about = one.description ?? all.description ?? '';
    if (all.const !== undefined) return [{ label: String(all.const), about, key: null, schema: all }];
    if (all.enum) {
      return all.enum.map((value) => ({ label: String(value), about, key: null, schema: { const: value } }));
    }
    const keys = Object.keys(all.properties ?? {}).filter((key) => all.required?.includes(key));
    const [key] = keys;
    if (all.type === 'object' && keys.length === 1 && key !== undefined) {
      const schema = all.properties?.[key] ?? {};
      return [{ label: words(key), about: about || (this.plain(schema).description ?? ''), key, schema }];
    }
    return [{ label: plainLabel(all), about, key: null, schema: one }];
  }

  #is(variant: Variant, value: Json | undefined): boolean {
    if (variant.key !== null) return entry(value, variant.key) !== undefined;
    const all = this.plain(variant.schema);
    if (all.const !== undefined) return all.const === value;
    if (all.enum) return all.enum.includes(value ?? null);
    if (all.type === 'array') return Array.isArray(value);
    if (all.type === 'object') return typeof value === 'object' && value !== null && !Array.isArray(value);
    return typeof value === (all.type === 'integer' ? 'number' : all.type);
  }
}

/** The entry of a value at a key or index. */
export function entry(value: Json | undefined, key: string | number): Json | undefined {
  if (typeof value !== 'object' || value === null) return undefined;
  return Array.isArray(value) ? value[Number(key)] : value[key];
}

/** The value at a path. */
export function at(value: Json | undefined, path: (string | number)[]): Json | undefined {
  return path.reduce<Json | undefined>((inner, key) => entry(inner, key), value);
}

/** Converts a key to words. */
export function words(key: string): string {
  return key.replaceAll('_', ' ');
}

/**
 * Sort key of properties: listed names first, then required ones, those with a default, those without, and the seed
 * last.
 */
function rank({ key, required, fallback }: Part): number {
  const first = FIRST.indexOf(key);
  if (first >= 0) return first;
  return key === 'seed' ? 400 : required ? 100 : fallback === undefined || fallback === null ? 300 : 200;
}

function definition(schema: JsonSchema): string | null {
  return schema.$ref?.match(/^#\/\$defs\/(.+)$/)?.[1] ?? null;
}

function choices(all: JsonSchema): { value: Json; about: string }[] | null {
  const each = all.oneOf ?? all.anyOf;
  if (!each?.every((one) => one.const !== undefined)) return null;
  return each.map((one) => ({ value: one.const ?? null, about: one.description ?? '' }));
}

function plainLabel(all: JsonSchema): string {
  if (all.type === 'array') return all.maxItems === 2 ? 'for each axis' : 'coefficients';
  if (all.enum) return 'name';
  return all.type === 'string' ? 'text' : 'number';
}

function numberShape(all: JsonSchema, key: string): Shape {
  const hint = all['x-dapple'];
  const integer = all.type === 'integer';
  const min = all.exclusiveMinimum ?? all.minimum ?? -Infinity;
  const max = all.exclusiveMaximum ?? all.maximum ?? Infinity;
  const open: [boolean, boolean] = [all.exclusiveMinimum !== undefined, all.exclusiveMaximum !== undefined];
  const unit = hint?.unit ?? unitOf(all.description ?? '');
  const isLength = (key === 'radius' && max > LONG) || (integer && unit === 'px' && max === Infinity);
  const log = hint?.scale === 'log' || (hint?.scale === undefined && (RATIOS.test(key) || isLength) && min >= 0);
  const turn: [number, number] | null = unit === '°' ? [Math.max(min, -HALF_TURN), Math.min(max, HALF_TURN)] : null;
  return { kind: 'number', range: { min, max, open, integer, soft: hint?.soft ?? turn, log }, unit };
}

/** The unit named in a description, or an empty string. */
function unitOf(about: string): string {
  if (/radians/.test(about)) return 'rad';
  if (/in degrees/.test(about)) return '°';
  if (/in pixels|how many (more )?pixels/i.test(about)) return 'px';
  if (/in units of the (plane|domain)|units of the plane/.test(about)) return 'u';
  return '';
}

function startOf(range: Range): number {
  const low = range.open[0] ? Math.max(range.min, 0) + (range.integer ? 1 : 0.1) : range.min;
  return Number.isFinite(low) ? Math.max(low, range.integer ? Math.max(1, low) : low) : 0.5;
}
