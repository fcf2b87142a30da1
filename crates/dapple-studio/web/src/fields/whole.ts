// Numbers at which a wrapping tile contains whole numbers of cells: frequencies of nodes, and extents of the tile.
import { entry, type Part } from '../core/schema';
import { wholeCells, wholeSide, type Whole } from '../core/range';
import type { Json, Path } from '../core/protocol';
import type { Studio } from '../studio.svelte';

/** The frequency of a kind of node, if it counts cells per unit of the plane. That of `transform` is relative. */
function frequencyOf(studio: Studio, kind: string): Part | null {
  const { schemas } = studio;
  const variant = schemas?.variants({ $ref: '#/$defs/Node' }).find(({ key }) => key === kind);
  const part = variant && schemas?.parts(variant.schema).find(({ key }) => key === 'frequency');
  return part && kind !== 'transform' && schemas?.name(part.schema) === 'Frequency' ? part : null;
}

/** Whether a node has cells of one size, and whether their number must be even. */
function cells(studio: Studio, kind: string, options: Json | undefined): { wavelet: boolean } | null {
  const basis = entry(options, 'basis') ?? 'pups';
  if ((kind === 'noise' && basis === 'pups') || !frequencyOf(studio, kind)) return null;
  return { wavelet: kind === 'wavelet' || basis === 'wavelet' };
}

function wraps(studio: Studio): boolean[] {
  return (studio.resolved(['wrap']) ?? [true, true]) as boolean[];
}

/** The frequencies that a node may have. The path of the frequency ends with the axis if there is one for each. */
export function wholeFrequency(studio: Studio, node: string, path: Path): Whole | null {
  const kind = String(path[2]);
  const of = cells(studio, kind, studio.resolved(['nodes', node, kind]));
  const axis = path.at(-1);
  const sides = studio.looking.extent.filter((_, index) => wraps(studio)[index] && (typeof axis !== 'number' || axis === index));
  return of && wholeCells(sides, of.wavelet);
}

/** The extents along an axis at which the frequencies of all nodes fit. */
export function wholeExtent(studio: Studio, axis: string | number | undefined): Whole | null {
  if (typeof axis !== 'number' || !wraps(studio)[axis]) return null;
  const frequencies = (studio.graph?.nodes ?? []).flatMap(({ name, kind }) => {
    const options = studio.resolved(['nodes', name, kind]);
    const of = cells(studio, kind, options);
    if (!of) return [];
    const given = entry(options, 'frequency') ?? frequencyOf(studio, kind)?.fallback;
    const frequency = Number(Array.isArray(given) ? given[axis] : given);
    return frequency > 0 ? [{ frequency, ...of }] : [];
  });
  return wholeSide(frequencies);
}
