// The state of the view: its kind, the maps, the size, the zoomed window, and the time.
import { FIRST, type Region, type View } from './core/protocol';
import type { Window } from './core/pictures';

/** The kinds of views. */
export const MODES = [
  { id: 'maps', label: 'Maps', about: 'The maps side by side' },
  { id: 'tiled', label: 'Tiled', about: 'Two by two copies: does it repeat well?' },
  { id: 'lit', label: 'Lit', about: 'The material in light' },
  { id: 'node', label: 'Node', about: 'The picture of the selected node' },
  { id: 'seams', label: 'Seams', about: 'How visible the borders of the tile are' },
  { id: 'exact', label: 'Exact', about: 'The preview that the command renders' },
] as const;

export type Mode = (typeof MODES)[number]['id'];

/** Available sizes of the longer side, in pixels. */
export const SIZES = [128, 256, 512, 1024, 2048, 4096];

/** Duration of a loop, in seconds. */
const LOOP = 4;

/** Rendering time in milliseconds above which a frame of a loop counts as slow. */
const SLOW = 40;

/** The view of the recipe. */
export class Looking {
  mode = $state<Mode>('maps');
  maps = $state<string[]>([...FIRST.maps]);
  /** The longer side, in pixels. */
  size = $state(FIRST.size[0]);
  /** The visible window, or null to fit the whole tile. */
  window = $state.raw<Window | null>(null);
  /** Whether a zoomed view requests more pixels. */
  sharp = $state(true);
  /** The size of a view in CSS pixels, set by the views. */
  room = $state.raw<[number, number]>([1, 1]);
  time = $state(0);
  playing = $state(false);
  /** How many times the size of a loop's frames is halved because rendering is slow, at most 2. */
  coarse = $state(0);
  #late = 0;
  paused = $state(false);
  before = $state(false);
  dragging = $state(false);
  shape = $state<'sphere' | 'plane' | 'model'>('sphere');
  exact = $state<'sphere' | 'plane' | 'torus'>('sphere');
  /** Width and height of the tile, in units of the plane. */
  extent = $state.raw<[number, number]>([1, 1]);
  /** The optional maps of the material that the lit view shows. */
  extras = $state.raw<string[]>([]);
  limit = $state(4096);
  whole = $state(4096);

  /** Height of the tile divided by its width. */
  get aspect(): number {
    return this.extent[1] / this.extent[0] || 1;
  }

  /** Columns and rows of the tile. */
  get pixels(): [number, number] {
    return sized(this.size, this.aspect);
  }

  get repeats(): number {
    return this.mode === 'tiled' ? 2 : 1;
  }

  /** Whether the kind of view requests more pixels when zoomed. */
  get zooms(): boolean {
    return this.mode === 'maps' || this.mode === 'node';
  }

  /** The zoom at which the whole tile fits. */
  get fit(): number {
    const [w, h] = this.room;
    return Math.max(8, Math.min(w, h / this.aspect) / this.repeats);
  }

  /** The window that is shown. */
  get shown(): Window {
    return this.window ?? { x: this.repeats / 2, y: this.repeats / 2, zoom: this.fit };
  }

  /** The maps that this kind of view needs. */
  needed(): string[] {
    if (this.mode === 'lit') return ['albedo', 'normal', 'orm', 'height', ...this.extras];
    return this.mode === 'maps' || this.mode === 'tiled' ? [...this.maps] : [];
  }

  /** Returns the view to request. */
  view(selected: string | null): View {
    const { size, region } = this.#detail();
    const node = this.mode === 'node' ? selected : null;
    const paused = this.paused || this.mode === 'seams';
    const exact = this.mode === 'exact' ? { shape: this.exact } : null;
    const rest = { time: this.time, draft: !this.playing, thumbnails: !this.playing, paused, exact };
    return { size, region, maps: this.needed(), node, ...rest };
  }

  /** Zooms by a factor about a point, given in CSS pixels from the center of the view. */
  zoomBy(factor: number, [x, y]: [number, number] = [0, 0]): void {
    const now = this.shown;
    const zoom = Math.min(Math.max(now.zoom * factor, 16), 1 << 20);
    const [px, py] = [x / now.zoom, y / (now.zoom * this.aspect)];
    const k = 1 - now.zoom / zoom;
    this.#look({ x: now.x + px * k, y: now.y + py * k, zoom });
  }

  /** Moves the view by an offset in CSS pixels. */
  panBy(x: number, y: number): void {
    const now = this.shown;
    this.#look({ x: now.x - x / now.zoom, y: now.y - y / (now.zoom * this.aspect), zoom: now.zoom });
  }

  /** Shows the image at one image pixel per screen pixel. */
  oneToOne(): void {
    this.window = { x: this.repeats / 2, y: this.repeats / 2, zoom: this.pixels[0] / devicePixelRatio };
  }

  /** Shows or hides a map. At least one map stays visible. */
  toggle(map: string, order: string[]): void {
    const has = this.maps.includes(map);
    if (has && this.maps.length === 1) return;
    const chosen = has ? this.maps.filter((one) => one !== map) : [...this.maps, map];
    this.maps = order.filter((one) => chosen.includes(one));
  }

  /** Records the rendering time of a loop's frame. After several slow frames, the following ones are smaller. */
  took(ms: number): void {
    this.#late = Math.max(0, this.#late + (ms > SLOW ? 1 : -1));
    if (this.#late < 3 || this.coarse === 2) return;
    this.coarse += 1;
    this.#late = 0;
  }

  /** Plays the loop in real time, but waits for frames that are not rendered yet. Returns a function that stops it. */
  play(isDrawn: () => boolean): () => void {
    this.coarse = this.#late = 0;
    let last = performance.now();
    let id = requestAnimationFrame(function step(this: void, now: number) {
      if (isDrawn()) {
        looking.time = (looking.time + (now - last) / 1000 / LOOP) % 1;
        last = now;
      }
      id = requestAnimationFrame(step);
    });
    const looking = this;
    return () => cancelAnimationFrame(id);
  }

  #look(window: Window): void {
    const keep = (v: number) => Math.min(Math.max(v, 0), this.repeats);
    this.window = { x: keep(window.x), y: keep(window.y), zoom: window.zoom };
  }

  /** The size and region that give one image pixel per screen pixel. */
  #detail(): { size: [number, number]; region: Region | null } {
    const plain = { size: sized(this.playing ? this.size >> this.coarse : this.size, this.aspect), region: null };
    const now = this.window;
    if (!now || !this.sharp || !this.zooms) return plain;
    const wanted = now.zoom * devicePixelRatio;
    if (wanted <= this.pixels[0] * 1.01) return plain;
    const steps = Math.min(Math.ceil(Math.log2(wanted / this.pixels[0])), Math.floor(Math.log2(this.whole / this.size)));
    if (steps < 1) return plain;
    const size = sized(this.size * 2 ** steps, this.aspect);
    const region = this.#seen(now, size);
    return region ? { size, region } : plain;
  }

  /** The visible pixels of the tile. */
  #seen(now: Window, [w, h]: [number, number]): Region | null {
    const half = [this.room[0] / now.zoom / 2, this.room[1] / (now.zoom * this.aspect) / 2] as const;
    const [x0, x1] = span(now.x - half[0], now.x + half[0], w);
    const [y0, y1] = span(now.y - half[1], now.y + half[1], h);
    const fits = x1 > x0 && y1 > y0 && Math.max(x1 - x0, y1 - y0) <= this.limit;
    return fits ? { first: [x0, y0], size: [x1 - x0, y1 - y0] } : null;
  }
}

function span(from: number, to: number, pixels: number): [number, number] {
  return [Math.max(0, Math.floor(from * pixels)), Math.min(pixels, Math.ceil(to * pixels))];
}

function sized(longer: number, aspect: number): [number, number] {
  const [w, h] = aspect <= 1 ? [longer, longer * aspect] : [longer / aspect, longer];
  return [Math.max(1, Math.round(w)), Math.max(1, Math.round(h))];
}
