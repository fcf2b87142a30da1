// Ranges of sliders, which are narrower than the allowed ranges, and rounding and formatting of numbers.
import type { Range } from './schema';

/** The range of a slider and its step. */
export interface Slide {
  low: number;
  high: number;
  step: number;
  log: boolean;
}

/** Usual ranges of numbers by name, where the schema allows far more than is useful. */
const USUAL: [RegExp, number, number][] = [
  [/^(roughness|metallic|height|by|mask|fade|weight|radius|gain|persistence|jitter|strength|probability|probabilities|width|contrast|opacity)$/, 0, 1],
  [/^frequency$/, 0.25, 64],
  [/^octaves$|^count$|^layers$|^iterations$/, 1, 12],
  [/^lacunarity$/, 1, 4],
  [/^density$/, 0.25, 9],
  [/^exponent$/, 0.1, 8],
  [/^emission_strength$/, 0, 20],
  [/^(spacing|distance|distances)$/, 0.02, 2],
  [/^relief$/, 0.002, 2],
  [/^extent$/, 0.5, 16],
  [/^feature_size$/, 0.02, 4],
  [/^(angle|phase)$/, 0, 1],
  [/^(occlusion_radius|curvature_radius)$/, 0, 1],
  [/^(from|to|values|value|range)$/, 0, 1],
  [/^(margin|frozen|levels)$/, 0, 64],
];

/** Maximum width of an allowed range that is used as the range of a slider. */
const WIDE = 100;

/** Returns the slider range for a number with this name whose current value is `value`. */
export function slide(range: Range, key: string, value: number, fallback: number | undefined): Slide {
  const usual = USUAL.find(([name]) => name.test(key));
  const bounded = Number.isFinite(range.min) && Number.isFinite(range.max) && range.max - range.min <= WIDE;
  let [low, high] = range.soft ?? (usual ? [usual[1], usual[2]] : bounded ? [range.min, range.max] : around(fallback ?? value));
  if (!range.soft && bounded) [low, high] = [Math.max(low, range.min), Math.min(high, range.max)];
  low = Math.max(Math.min(low, nice(value)), range.min);
  high = Math.min(Math.max(high, nice(value)), range.max);
  const log = range.log && (low > 0 || range.min >= 0);
  if (log && low <= 0) low = Math.min(high / 1000, Math.abs(value) || high / 1000);
  const step = range.integer ? 1 : stepOf(high - low);
  if (range.open[0] && low <= range.min) low = log ? low : range.min + step;
  if (range.open[1] && high >= range.max) high = range.max - step;
  return { low, high, step, log };
}

function around(value: number): [number, number] {
  const size = nice(Math.abs(value) * 2) || 1;
  return value < 0 ? [-Math.abs(size), Math.abs(size)] : [0, Math.abs(size)];
}

/**
 * Rounds numbers of magnitude above 1 away from zero to the next 1, 2, 5, 10, and so on. Smaller numbers are
 * unchanged.
 */
function nice(value: number): number {
  const size = Math.abs(value);
  if (size <= 1) return value;
  const ten = 10 ** Math.floor(Math.log10(size));
  const round = [1, 2, 5, 10].map((one) => one * ten).find((one) => one >= size) ?? size;
  return Math.sign(value) * round;
}

/** A step of about 1/200 of a span: a power of ten times 1, 2 or 5. */
export function stepOf(span: number): number {
  const raw = Math.abs(span) / 200 || 0.01;
  const ten = 10 ** Math.floor(Math.log10(raw));
  return tidy(([1, 2, 5, 10].find((one) => one * ten >= raw * 0.999) ?? 10) * ten);
}

/** Rounds a number to 6 digits, which removes floating-point noise. */
export function tidy(value: number): number {
  return Number(value.toPrecision(6));
}

/** The position of a value on a slider, from 0 to 1. */
export function toSlider({ low, high, log }: Slide, value: number): number {
  const t = log ? Math.log(Math.max(value, low) / low) / Math.log(high / low) : (value - low) / (high - low);
  return Math.min(1, Math.max(0, t));
}

/** The rounded value at a position of a slider. */
export function fromSlider({ low, high, step, log }: Slide, t: number): number {
  if (!log) return tidy(Math.min(high, Math.max(low, Math.round((low + t * (high - low)) / step) * step)));
  const value = low * (high / low) ** t;
  return step === 1 ? Math.round(value) : Number(value.toPrecision(value < 1 ? 2 : 3));
}

/** Formats a number for display. */
export function shown(value: number): string {
  return Number.isFinite(value) ? String(tidy(value)) : '';
}

/**
 * Numbers at which a wrapping tile contains a whole number of cells: multiples of `unit` / `side`, at least
 * `least` / `side`.
 */
export interface Whole {
  unit: number;
  side: number;
  least: number;
}

/** Rounds a number to the nearest one with a whole number of cells. */
export function snapped(value: number, whole: Whole | null): number {
  if (!whole) return value;
  return Math.max(whole.least, Math.round((value * whole.side) / whole.unit) * whole.unit) / whole.side;
}

/**
 * The valid frequencies for wrapping sides, if all sides are multiples of the shortest. Wavelets need an even number
 * of cells, at least 4.
 */
export function wholeCells(sides: number[], wavelet: boolean): Whole | null {
  const side = Math.min(...sides);
  if (sides.length === 0 || sides.some((one) => Math.abs(one / side - Math.round(one / side)) > 1e-9)) return null;
  return wavelet ? { unit: 2, side, least: 4 } : { unit: 1, side, least: 1 };
}

/** Maximum number of cells of a node along the shortest side that fits all nodes. */
const MOST_CELLS = 240;

/** The sides of a wrapping tile that fit all these frequencies. Wavelets need an even number of cells, at least 4. */
export function wholeSide(nodes: { frequency: number; wavelet: boolean }[]): Whole | null {
  const pairs = nodes.map(({ frequency, wavelet }) => (wavelet ? frequency / 2 : frequency));
  const [first] = pairs;
  if (first === undefined) return null;
  const fits = (side: number) => pairs.every((one) => Math.abs(one * side - Math.round(one * side)) < 1e-9);
  const shortest = Array.from({ length: MOST_CELLS }, (_, index) => (index + 1) / first).find(fits);
  if (shortest === undefined) return null;
  const twice = nodes.some(({ wavelet }, index) => wavelet && Math.round((pairs[index] ?? 0) * shortest) < 2);
  return { unit: 1, side: 1 / shortest, least: twice ? 2 : 1 };
}
