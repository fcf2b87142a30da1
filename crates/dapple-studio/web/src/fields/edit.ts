// Edits of the recipe by widgets. An edit names a path; a table that is not written yet is created with its defaults.
import type { Json, Path } from '../core/protocol';
import type { Part, Shape } from '../core/schema';

/** Sets a value of the recipe, or removes it if the value is undefined. */
export type Edit = (path: Path, value: Json | undefined, gesture?: number | null, drag?: boolean) => void;

/** Properties of every widget. */
export interface FieldProps {
  schema: import('../core/schema').JsonSchema;
  path: Path;
  label: string;
  about: string;
  value: Json | undefined;
  fallback: Json | undefined;
  required: boolean;
  edit: Edit;
}

/** Properties of the widgets of lists and unions. */
export interface InnerProps<K extends Shape['kind']> extends Omit<FieldProps, 'schema' | 'about' | 'required'> {
  shape: Extract<Shape, { kind: K }>;
  depth: number;
}

/** Returns a copy of a value in which the value at a path is replaced. */
export function setIn(value: Json | undefined, path: Path, inner: Json | undefined): Json {
  const [key, ...rest] = path;
  if (key === undefined) return inner ?? null;
  if (Array.isArray(value)) return value.map((one, index) => (index === Number(key) ? setIn(one, rest, inner) : one));
  const table = typeof value === 'object' && value !== null ? value : {};
  if (rest.length === 0 && inner === undefined) {
    const { [key]: _, ...others } = table as { [key: string]: Json };
    return others;
  }
  return { ...table, [key]: setIn((table as { [key: string]: Json })[key], rest, inner) };
}

/**
 * Edits within a value that may not be written yet. In that case its default is written, without the properties that
 * equal their defaults.
 */
export function within(edit: Edit, path: Path, value: Json | undefined, fallback: Json | undefined, parts: Part[] = []): Edit {
  if (value !== undefined || fallback === undefined || fallback === null) return edit;
  return (inner, next, gesture, drag) => {
    const full = setIn(fallback, inner.slice(path.length), next);
    edit(path, trim(full, parts), gesture, drag);
  };
}

function trim(value: Json, parts: Part[]): Json {
  if (typeof value !== 'object' || value === null || Array.isArray(value)) return value;
  const same = (key: string, inner: Json) => {
    const part = parts.find((one) => one.key === key);
    return part && !part.required && JSON.stringify(part.schema.default) === JSON.stringify(inner);
  };
  return Object.fromEntries(Object.entries(value).filter(([key, inner]) => !same(key, inner)));
}

/** The label of an element of a list. */
export function elementLabel(key: string, index: number, count: number): string {
  const axes = /^(extent|center|along|frequency|copies|axes|wrap|orientation|away_from|borders|origin|size)$/;
  if (count === 2 && axes.test(key)) return index === 0 ? 'x' : 'y';
  if (count === 2 && /^(from|to|values|range|probabilities|distances|points_per_cell|pairs)$/.test(key)) return index === 0 ? 'a' : 'b';
  return String(index + 1);
}
