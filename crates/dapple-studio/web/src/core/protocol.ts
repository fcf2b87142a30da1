// Messages between the page and whatever computes: a process behind a socket, or a worker.
//
// Text messages are JSON objects with a `type`; pictures are binary, with a header of 32 bytes. Positions in texts are
// UTF-16 code units, as JavaScript counts them.
import type { JsonSchema } from './schema';

/** A JSON value. */
export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };

/** Keys and array indices down to a value of the recipe, such as `["nodes", "grain", "noise", "gain"]`. */
export type Path = (string | number)[];

/** A small change of the recipe. */
export type Op =
  | { op: 'set'; path: Path; value: Json }
  | { op: 'remove'; path: Path }
  | { op: 'insert'; path: Path; index: number; value: Json }
  | { op: 'add_node'; name: string; kind: string; value: Json }
  | { op: 'remove_node'; name: string }
  | { op: 'rename_node'; name: string; to: string }
  | { op: 'duplicate_node'; name: string; to: string }
  | { op: 'connect'; node: string; input: Path; from: Json }
  | { op: 'make_points'; node: string };

/** Pixels of a tile: the first, and how many there are. */
export interface Region {
  first: [number, number];
  size: [number, number];
}

/** The shape of the exact preview. */
export interface Exact {
  shape: 'sphere' | 'plane' | 'torus';
}

/** What is to be seen; always all of it. */
export interface View {
  size: [number, number];
  maps: string[];
  region: Region | null;
  node: string | null;
  time: number;
  draft: boolean;
  thumbnails: boolean;
  paused: boolean;
  exact: Exact | null;
}

/** What a page shows at first: it asks for it before its parts are there. The order is that of `Looking.view`. */
export const FIRST: View = {
  size: [512, 512],
  region: null,
  maps: ['height', 'normal', 'albedo'],
  node: null,
  time: 0,
  draft: true,
  thumbnails: true,
  paused: false,
  exact: null,
};

/** What the page asks. */
export type Request =
  | { type: 'open'; builtin?: string; file?: string; text?: string }
  | { type: 'doc'; rev: number; text: string }
  | { type: 'patch'; rev: number; ops: Op[]; drag: boolean }
  | ({ type: 'view' } & View)
  | { type: 'ack'; generation: number; map: number }
  | { type: 'gallery'; size: number }
  | { type: 'strip'; node: string | null; changes: Op[][]; size: number }
  | { type: 'seams'; size: [number, number] }
  | { type: 'points'; node: string }
  | { type: 'code'; kind: CodeKind; size: [number, number]; maps: string[] }
  | ({ type: 'export' } & ExportOptions)
  | { type: 'stop' }
  | { type: 'save'; text: string; file: string; overwrite: boolean; seen: string | null };

/** What a recipe can be copied as. */
export type CodeKind = 'toml' | 'json' | 'rust' | 'python' | 'command';

/** Options of an export, as those of `dapple bake`. */
export interface ExportOptions {
  size: [number, number];
  maps?: string[];
  preset?: string;
  /** Such as `png8`; not beside a preset. */
  format?: string;
}

/** A node that recipes may have. */
export interface Kind {
  name: string;
  group: string;
  value?: Json;
}

/** A name with what it means. */
export interface Named {
  name: string;
  about: string;
}

/** The first message: what there is. */
export interface Hello {
  type: 'hello';
  version: string;
  mode: 'studio' | 'watch' | 'static';
  builtins: Named[];
  files: string[];
  schema: JsonSchema;
  kinds: Kind[];
  maps: Named[];
  presets: (string | Named)[];
  limits: { size: number; whole?: number };
  open: string | null;
}

/** A text that was opened. */
export interface Opened {
  type: 'document';
  rev: number;
  text: string;
  name: string;
  file: string | null;
  hash: string | null;
}

/** A part of a text that another replaces. */
export interface Change {
  from: number;
  to: number;
  insert: string;
}

/** Something wrong with the text, and where. */
export interface Problem {
  from: number;
  to: number;
  node: string | null;
  message: string;
  nearest: string | null;
  hint: string | null;
}

/** An input of a node or of the material. */
export interface GraphInput {
  label: string;
  path: Path;
  node: string | null;
  value: Json;
}

/** A node of the recipe. */
export interface GraphNode {
  name: string;
  kind: string;
  is_color: boolean;
  is_global: boolean;
  span: [number, number];
  inputs: GraphInput[];
}

/** The nodes of a valid recipe. */
export interface Graph {
  type: 'graph';
  rev: number;
  nodes: GraphNode[];
  material: Record<string, { node: string | null; value: Json }>;
  order: string[];
}

/** A control point of a texture, in units of the plane. */
export interface ControlPoint {
  x: number;
  y: number;
  value: number;
  label?: number | null;
  orientation?: number[] | null;
}

/** The control points of a node. */
export interface Points {
  type: 'points';
  node: string;
  editable: boolean;
  /** Whether the points can be put into the text. */
  can_be_editable: boolean;
  /** The number of nets of points; the points are those of the coarsest. */
  layers: number;
  extent: [number, number];
  wrap: [boolean, boolean];
  points: ControlPoint[];
  /** The values of labels. */
  values: number[];
  edges: [number, number, number, number][];
}

/** How a map joins where the tile repeats. */
export interface Seam {
  name: string;
  text: string;
}

/** What the page is told. */
export type Reply =
  | Hello
  | Opened
  | { type: 'edits'; rev: number; changes: Change[]; drag: boolean }
  | { type: 'stale'; rev: number }
  | { type: 'diagnostics'; rev: number; items: Problem[] }
  | Graph
  | { type: 'values'; rev: number; recipe: Json }
  | Began
  | Rendered
  | { type: 'seams'; maps: Seam[] }
  | Points
  | { type: 'code'; kind: CodeKind; text: string }
  | { type: 'exported'; id: string; files: { name: string; bytes: number }[] }
  | { type: 'saved'; file: string; hash: string }
  | { type: 'disk'; text: string; hash: string; file: string }
  | { type: 'refused'; what: string; message: string; hint: string | null; reason?: string };

/** The pictures of a generation follow: what they show. */
export interface Began {
  type: 'began';
  generation: number;
  size: [number, number];
  region: Region | null;
  node: string | null;
  time: number;
  /** Whether a draft may come first. */
  draft: boolean;
}

/** All pictures of a generation are there. */
export interface Rendered {
  type: 'rendered';
  generation: number;
  rev?: number;
  ms: number;
  draft: boolean;
  nodes: { name: string; ms: number; range?: [number, number] | null }[] | null;
}

/** Numbers of maps that are none of `hello.maps`. */
export const MAP = { node: 100, preview: 101, thumbnail: 200, builtin: 1000, file: 2000, strip: 3000 } as const;

/** A picture, or a window of one. */
export interface Frame {
  generation: number;
  map: number;
  x: number;
  y: number;
  w: number;
  h: number;
  /** The picture is the tile's size divided by this. */
  scale: number;
  draft: boolean;
  last: boolean;
  pixels: Uint8ClampedArray<ArrayBuffer>;
}

/** Bytes before the pixels of a picture. */
const HEADER = 32;
/** Bytes of a pixel in each format: with alpha, without, and gray. */
const WIDTHS = [4, 3, 1];
/** An alpha of 255; processors that browsers run on have it in the highest byte. */
const OPAQUE = 0xff000000;

/** The picture of a binary message. */
export function frame(bytes: ArrayBuffer): Frame {
  if (bytes.byteLength < HEADER) throw new Error('a picture is too short');
  const head = new DataView(bytes);
  const version = head.getUint32(0, true);
  if (version !== 1) throw new Error(`pictures of version ${version} are not known`);
  const [w, h] = [head.getUint32(20, true), head.getUint32(24, true)];
  const format = head.getUint16(10, true);
  const width = WIDTHS[format];
  if (width === undefined || bytes.byteLength !== HEADER + w * h * width) throw new Error(`a picture of ${w} × ${h} has another length`);
  const flags = head.getUint16(30, true);
  return {
    generation: head.getUint32(4, true),
    map: head.getUint16(8, true),
    x: head.getUint32(12, true),
    y: head.getUint32(16, true),
    w,
    h,
    scale: Math.max(1, head.getUint16(28, true)),
    draft: (flags & 1) !== 0,
    last: (flags & 2) !== 0,
    pixels: width === 4 ? new Uint8ClampedArray(bytes, HEADER) : widened(new Uint8Array(bytes, HEADER), width),
  };
}

/** Pixels of one or three bytes as red, green, blue and alpha. */
function widened(bytes: Uint8Array<ArrayBuffer>, width: number): Uint8ClampedArray<ArrayBuffer> {
  const pixels = new Uint32Array(bytes.length / width);
  if (width === 1) for (let i = 0; i < pixels.length; i += 1) pixels[i] = OPAQUE | ((bytes[i] as number) * 0x010101);
  else {
    for (let i = 0, at = 0; i < pixels.length; i += 1, at += 3) {
      pixels[i] = OPAQUE | ((bytes[at + 2] as number) << 16) | ((bytes[at + 1] as number) << 8) | (bytes[at] as number);
    }
  }
  return new Uint8ClampedArray(pixels.buffer);
}
