// Messages between the page and the studio, which is a process behind a socket or a worker.
//
// Text messages are JSON objects with a `type`. Images are binary messages with a header of 32 bytes. Positions in
// texts are UTF-16 code units, as counted by JavaScript.
import type { JsonSchema } from './schema';

/** A JSON value. */
export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };

/** The path of a value in the recipe: keys and array indices, such as `["nodes", "grain", "noise", "gain"]`. */
export type Path = (string | number)[];

/** A small edit of the recipe. */
export type Op =
  | { op: 'set'; path: Path; value: Json }
  | { op: 'remove'; path: Path }
  | { op: 'insert'; path: Path; index: number; value: Json }
  | { op: 'add_node'; name: string; kind: string; value: Json }
  | { op: 'remove_node'; name: string }
  | { op: 'rename_node'; name: string; to: string }
  | { op: 'duplicate_node'; name: string; to: string }
  | { op: 'connect'; node: string; input: Path; from: Json }
  | { op: 'disconnect'; path: Path }
  | { op: 'make_points'; node: string };

/** A rectangle of the tile in pixels: its first column and row, and its size. */
export interface Region {
  first: [number, number];
  size: [number, number];
}

/** Options of the exact preview, which the command renders. */
export interface Exact {
  shape: 'sphere' | 'plane' | 'torus';
}

/** The complete description of the images that a page shows. */
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

/** The initial view, requested before the page is loaded. The fields have the same order as in `Looking.view`. */
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

/** A message from the page. */
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

/** The formats in which a recipe can be copied. */
export type CodeKind = 'toml' | 'json' | 'rust' | 'python' | 'command' | 'wgsl';

/** Options of an export, as in `dapple bake`. */
export interface ExportOptions {
  size: [number, number];
  maps?: string[];
  preset?: string;
  /** The format, such as `png8`. Not allowed together with a preset. */
  format?: string;
  /** The number of frames of a loop. */
  frames?: number;
  /** A folder beside the recipe, into which the files are written. */
  folder?: string;
  overwrite?: boolean;
}

/** A kind of node. */
export interface Kind {
  name: string;
  group: string;
  /** Words of other programs for the kind. */
  tags?: string;
  value?: Json;
}

/** A name with its description. */
export interface Named {
  name: string;
  about: string;
}

/** The first message: the recipes, nodes and maps that the studio offers. */
export interface Hello {
  type: 'hello';
  version: string;
  mode: 'studio' | 'watch' | 'static';
  builtins: (Named & { tags: string[] })[];
  files: string[];
  schema: JsonSchema;
  kinds: Kind[];
  maps: Named[];
  /** The names of the maps that a material may lack. */
  optional_maps: string[];
  presets: (string | Named)[];
  limits: { size: number; whole?: number };
  open: string | null;
}

/** The reply to opening a text. */
export interface Opened {
  type: 'document';
  rev: number;
  text: string;
  name: string;
  file: string | null;
  hash: string | null;
}

/** A replacement in a text. */
export interface Change {
  from: number;
  to: number;
  insert: string;
}

/** An error in the text, with its range. */
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
  /** Whether the points can be written into the text. */
  can_be_editable: boolean;
  /** The number of layers of points. `points` belong to the coarsest layer. */
  layers: number;
  extent: [number, number];
  wrap: [boolean, boolean];
  points: ControlPoint[];
  /** The values of labels. */
  values: number[];
  edges: [number, number, number, number][];
}

/** The seam report of a map. */
export interface Seam {
  name: string;
  text: string;
}

/** A message from the studio. */
export type Reply =
  | Hello
  | Opened
  | { type: 'edits'; rev: number; changes: Change[]; drag: boolean }
  | { type: 'stale'; rev: number }
  | { type: 'diagnostics'; rev: number; items: Problem[] }
  | Graph
  | { type: 'values'; rev: number; recipe: Json; parameters: string[] }
  | Began
  | Rendered
  | { type: 'seams'; maps: Seam[] }
  | Points
  | { type: 'code'; kind: CodeKind; text: string }
  | { type: 'exported'; id: string; files: { name: string; bytes: number }[] }
  | { type: 'saved'; file: string; hash: string }
  | { type: 'disk'; text: string; hash: string; file: string }
  | { type: 'refused'; what: string; message: string; hint: string | null; reason?: string };

/** Announces a generation whose images follow. */
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

/** All images of a generation have been sent. */
export interface Rendered {
  type: 'rendered';
  generation: number;
  rev?: number;
  ms: number;
  draft: boolean;
  nodes: { name: string; ms: number; range?: [number, number] | null }[] | null;
}

/** Codes of images other than maps. Maps are coded by their index in `hello.maps`. */
export const MAP = { node: 100, preview: 101, thumbnail: 200, builtin: 1000, file: 2000, strip: 3000 } as const;

/** An image, or a part of one. */
export interface Frame {
  generation: number;
  map: number;
  x: number;
  y: number;
  w: number;
  h: number;
  /** Reduction factor of the image relative to the tile. */
  scale: number;
  draft: boolean;
  last: boolean;
  pixels: Uint8ClampedArray<ArrayBuffer>;
}

/** Length of an image's header in bytes. */
const HEADER = 32;
/** Bytes per pixel of each format: with alpha, without alpha, and gray. */
const WIDTHS = [4, 3, 1];
/** An alpha of 255. It is in the highest byte, since browsers run on little-endian processors. */
const OPAQUE = 0xff000000;

/** Decodes a binary message to an image. */
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

/** Converts pixels of one or three bytes to red, green, blue and alpha. */
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
