// Completion in the text, derived from the schema: keys of the current table, kinds in headings, and keywords and
// names of nodes in strings.
import type { Completion, CompletionContext, CompletionResult } from '@codemirror/autocomplete';
import type { JsonSchema, Schemas } from './schema';

/** Data for completion. */
export interface Known {
  schemas: Schemas | null;
  nodes: string[];
}

/**
 * Input that keeps the current list of completions. While keys are typed fast, Enter then accepts the highlighted
 * item.
 */
const WORD = /^[\w-]*$/;

/** Returns the completions at a position of the text. */
export function complete(context: CompletionContext, { schemas, nodes }: Known): CompletionResult | null {
  if (!schemas) return null;
  const line = context.state.doc.lineAt(context.pos);
  const before = line.text.slice(0, context.pos - line.from);
  const heading = before.match(/^\s*\[([\w.-]*)$/);
  if (heading) return ofHeading(context, schemas, heading[1] ?? '');
  const table = schemaAt(schemas, tableOf(context, line.number));
  const quoted = before.match(/([\w-]+)\s*=\s*(?:\[[^\]]*)?"([^"]*)$/) ?? before.match(/(\w*)[[,{]\s*"([^"]*)$/);
  if (quoted) return ofString(context, schemas, table, quoted[1] ?? '', quoted[2] ?? '', nodes);
  const key = before.match(/^\s*([\w-]*)$/);
  if (!key || !table || (!context.explicit && key[1] === '')) return null;
  const options = schemas.parts(table).map(({ key: label, about, required }) => ({ label, info: about, apply: `${label} = `, boost: required ? 1 : 0, type: 'property' }));
  return { from: context.pos - (key[1]?.length ?? 0), options, validFor: WORD };
}

/** The heading of the table that contains a line. */
function tableOf(context: CompletionContext, number: number): string[] {
  for (let at = number; at > 0; at -= 1) {
    const found = context.state.doc.line(at).text.match(/^\s*\[+([\w.-]+)\]/);
    if (found) return (found[1] ?? '').split('.');
  }
  return [];
}

function ofHeading(context: CompletionContext, schemas: Schemas, typed: string): CompletionResult | null {
  const path = typed.split('.');
  const last = path.pop() ?? '';
  const options = keysBelow(schemas, path);
  return options.length > 0 ? { from: context.pos - last.length, options, validFor: WORD } : null;
}

function keysBelow(schemas: Schemas, path: string[]): Completion[] {
  if (path.length === 0) return ['nodes', 'material'].map((label) => ({ label }));
  const below = path.length === 2 && path[0] === 'nodes' ? { $ref: '#/$defs/Node' } : schemaAt(schemas, path);
  if (!below || path.length < 2) return [];
  return schemas.variants(below).flatMap(({ key, about }) => (key === null ? [] : [{ label: key, info: about, type: 'class' }]));
}

function ofString(context: CompletionContext, schemas: Schemas, table: JsonSchema | null, key: string, typed: string, nodes: string[]): CompletionResult {
  const part = table && schemas.parts(table).find((one) => one.key === key);
  const shape = part ? schemas.shape(part.schema, key) : null;
  const words: Completion[] =
    shape?.kind === 'choice' ? shape.options.map(({ value, about }) => ({ label: String(value), info: about, type: 'enum' }))
    : shape?.kind === 'union' ? shape.variants.filter(({ schema }) => schema.const !== undefined).map(({ schema, about }) => ({ label: String(schema.const), info: about, type: 'enum' }))
    : nodes.map((label) => ({ label, type: 'variable' }));
  return { from: context.pos - typed.length, options: words, validFor: WORD };
}

/** The schema of the table with this heading. */
function schemaAt(schemas: Schemas, path: string[]): JsonSchema | null {
  if (path.length === 0) return schemas.root;
  const [first, , ...rest] = path;
  if (first === 'material') return { $ref: '#/$defs/Material' };
  if (first !== 'nodes' || path.length < 3) return null;
  return rest.reduce<JsonSchema | null>((schema, key) => (schema ? below(schemas, schema, key) : null), { $ref: '#/$defs/Node' });
}

function below(schemas: Schemas, schema: JsonSchema, key: string): JsonSchema | null {
  const all = schemas.plain(schema);
  const direct = all.properties?.[key];
  return direct ?? schemas.variants(all).find((variant) => variant.key === key)?.schema ?? null;
}
