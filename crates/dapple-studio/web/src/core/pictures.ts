// Received images by name, with their positions in the tile.
//
// An image may arrive in pieces. Pieces of the newest generation are drawn over the last complete image, which is
// removed when the last piece has arrived. So the visible area never shrinks.
import type { Frame, Region } from './protocol';

/** A rectangle in the tile, whose coordinates range from 0 to 1 along both axes. */
export interface Rect {
  x: number;
  y: number;
  w: number;
  h: number;
}

/**
 * A piece of an image. Its canvas is created on first use, since many pieces are never drawn while a slider is
 * dragged.
 */
export class Piece {
  #canvas: HTMLCanvasElement | null = null;

  constructor(
    readonly rect: Rect,
    readonly width: number,
    readonly height: number,
    readonly pixels: Uint8ClampedArray<ArrayBuffer>,
  ) {}

  get canvas(): HTMLCanvasElement {
    if (this.#canvas) return this.#canvas;
    const canvas = Object.assign(document.createElement('canvas'), { width: this.width, height: this.height });
    const context = canvas.getContext('2d', { willReadFrequently: this.width <= SMALL });
    context?.putImageData(new ImageData(this.pixels, this.width, this.height), 0, 0);
    this.#canvas = canvas;
    return canvas;
  }
}

/** Canvases up to this width are kept in main memory, which is faster for many small ones. */
const SMALL = 128;

/** An image: the last one that covers the tile, the last complete one, and the received pieces of the next one. */
export interface Picture {
  base: Piece[];
  whole: Piece[];
  coming: Piece[];
  generation: number;
  draft: boolean;
  /** The columns and rows of the whole tile at the scale of this image. */
  size: [number, number];
}

/** The size and region of the images of a generation. */
export interface Shown {
  size: [number, number];
  region: Region | null;
}

/** Images by name, with listeners. */
export class Pictures {
  readonly #pictures = new Map<string, Picture>();
  readonly #listeners = new Map<string, Set<() => void>>();

  get(name: string): Picture | undefined {
    return this.#pictures.get(name);
  }

  names(): string[] {
    return [...this.#pictures.keys()];
  }

  /** Calls `then` whenever the image changes. Returns a function that removes the listener. */
  listen(name: string, then: () => void): () => void {
    const all = this.#listeners.get(name) ?? new Set();
    this.#listeners.set(name, all.add(then));
    return () => all.delete(then);
  }

  /** Whether the image has listeners. */
  seen(name: string): boolean {
    return (this.#listeners.get(name)?.size ?? 0) > 0;
  }

  /** Adds a frame. `size` is the size of the whole tile before scaling. */
  add(name: string, frame: Frame, size: [number, number]): void {
    const before = this.#pictures.get(name);
    const scaled: [number, number] = [Math.ceil(size[0] / frame.scale), Math.ceil(size[1] / frame.scale)];
    const piece = pieceOf(frame, scaled);
    const goesOn = before && before.generation === frame.generation && before.draft === frame.draft;
    const coming = [...(goesOn ? before.coming : []), piece];
    const whole = frame.last ? coming : (before?.whole ?? []);
    const base = frame.last && covers(coming) ? [] : (before?.base.length ? before.base : covers(whole) ? whole : []);
    const rest = { generation: frame.generation, draft: frame.draft, size: scaled };
    this.#pictures.set(name, { base, whole, coming: frame.last ? [] : coming, ...rest });
    this.#tell(name);
  }

  /** Removes the images whose names satisfy `which`. */
  forget(which: (name: string) => boolean): void {
    for (const name of this.names()) {
      if (!which(name)) continue;
      this.#pictures.delete(name);
      this.#tell(name);
    }
  }

  /** Returns the current images, for comparison with later ones. */
  snapshot(): Map<string, Picture> {
    return new Map(this.#pictures);
  }

  #tell(name: string): void {
    for (const then of this.#listeners.get(name) ?? []) then();
  }
}

function pieceOf(frame: Frame, [width, height]: [number, number]): Piece {
  const rect = { x: frame.x / width, y: frame.y / height, w: frame.w / width, h: frame.h / height };
  return new Piece(rect, frame.w, frame.h, frame.pixels);
}

/** The visible window of the tile: its center in the tile, and the width of the tile in CSS pixels. */
export interface Window {
  x: number;
  y: number;
  zoom: number;
}

/**
 * Draws the part of an image given by `window` into a canvas. The tile is repeated `repeats` times along each axis.
 */
export function draw(target: HTMLCanvasElement, picture: Picture, window: Window, aspect: number, repeats: number): void {
  const context = target.getContext('2d');
  if (!context) return;
  const ratio = devicePixelRatio;
  const [w, h] = [window.zoom * ratio, window.zoom * aspect * ratio];
  const left = Math.round(target.width / 2 - window.x * w);
  const top = Math.round(target.height / 2 - window.y * h);
  context.clearRect(0, 0, target.width, target.height);
  // Skip pieces that are hidden by a complete image.
  const below = covers(picture.whole) ? [] : picture.base;
  for (let row = 0; row < repeats; row += 1) {
    for (let column = 0; column < repeats; column += 1) {
      for (const piece of [...below, ...picture.whole, ...picture.coming]) {
        place(context, piece, { x: left + column * w, y: top + row * h, w, h });
      }
    }
  }
}

/** Draws a piece with its edges rounded to whole pixels, so that adjacent pieces meet. */
function place(context: CanvasRenderingContext2D, piece: Piece, tile: Rect): void {
  const x = Math.round(tile.x + piece.rect.x * tile.w);
  const y = Math.round(tile.y + piece.rect.y * tile.h);
  const w = Math.round(tile.x + (piece.rect.x + piece.rect.w) * tile.w) - x;
  const h = Math.round(tile.y + (piece.rect.y + piece.rect.h) * tile.h) - y;
  context.imageSmoothingEnabled = w !== piece.width && w < 3 * piece.width;
  context.imageSmoothingQuality = w < piece.width ? 'high' : 'low';
  context.drawImage(piece.canvas, x, y, w, h);
}

/** Whether pieces cover the whole tile. */
function covers(pieces: Piece[]): boolean {
  return pieces.reduce((area, { rect }) => area + rect.w * rect.h, 0) > 0.999;
}
