// Numbers at which a wrapping tile contains whole numbers of cells: frequencies of nodes, and extents of the tile.
import { entry } from '../core/schema';
import { wholeCells, wholeSide, type Whole } from '../core/range';
import type { Json, Path } from '../core/protocol';
import type { Studio } from '../studio.svelte';

/** Whether a node has cells of one size, and whether their number must be even. */
function cells(kind: string, options: Json | undefined): { wavelet: boolean } | null {
  const basis = entry(options, 'basis') ?? 'pups';
  if (kind === 'noise' && basis === 'pups') return null;
  if (!['worley', 'wavelet', 'noise'].includes(kind)) return null;
  return { wavelet: kind === 'wavelet' || basis === 'wavelet' };
}

function wraps(studio: Studio): boolean[] {
  return (studio.resolved(['wrap']) ?? [true, true]) as boolean[];
}

/** The frequencies that a node may have. The path of the frequency ends with the axis if there is one for each. */
export function wholeFrequency(studio: Studio, node: string, path: Path): Whole | null {
  const kind = String(path[2]);
  const of = cells(kind, studio.resolved(['nodes', node, kind]));
  const axis = path.at(-1);
  const sides = studio.looking.extent.filter((_, index) => wraps(studio)[index] && (typeof axis !== 'number' || axis === index));
  return of && wholeCells(sides, of.wavelet);
}

/** The extents along an axis at which the frequencies of all nodes fit. */
export function wholeExtent(studio: Studio, axis: string | number | undefined): Whole | null {
  if (typeof axis !== 'number' || !wraps(studio)[axis]) return null;
  const variants = studio.schemas?.variants({ $ref: '#/$defs/Node' }) ?? [];
  const frequencies = (studio.graph?.nodes ?? []).flatMap(({ name, kind }) => {
    const options = studio.resolved(['nodes', name, kind]);
    const of = cells(kind, options);
    const variant = variants.find(({ key }) => key === kind);
    if (!of || !variant) return [];
    const fallback = studio.schemas?.parts(variant.schema).find(({ key }) => key === 'frequency')?.fallback;
    const given = entry(options, 'frequency') ?? fallback;
    const frequency = Number(Array.isArray(given) ? given[axis] : given);
    return frequency > 0 ? [{ frequency, ...of }] : [];
  });
  return wholeSide(frequencies);
}
