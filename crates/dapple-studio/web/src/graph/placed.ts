// Positions of nodes that were moved by hand, kept in comments at the end of the recipe's text.
//
// A comment is read by every version of the program, changes no bit of a bake, and is part of the only undo history. A
// table in the recipe was rejected: it would be an option of every reader and writer of recipes.
import type { Spots } from './layout';

const LINES = /^# layout: .*(\n|$)/gm;
/** Maximum length of a line with positions. */
const LONGEST = 100;

/** Reads the positions. A node that was never moved by hand has none. */
export function placed(text: string): Spots {
  const entries = [...text.matchAll(LINES)].flatMap(([line]) => [...line.matchAll(/([\w#-]+) = (-?\d+) (-?\d+)/g)]);
  return new Map(entries.map(([, name = '', x, y]) => [name, { x: Number(x), y: Number(y) }]));
}

/** Returns the text with these positions in place of the earlier ones. */
export function withPlaces(text: string, spots: Spots): string {
  const body = text.replace(LINES, '').trimEnd();
  const lines = [''];
  for (const [name, { x, y }] of spots) {
    const entry = `${name} = ${Math.round(x)} ${Math.round(y)}`;
    const longer = [lines.at(-1), entry].filter(Boolean).join(', ');
    if (longer.length > LONGEST) lines.push(entry);
    else lines[lines.length - 1] = longer;
  }
  const comments = lines.filter(Boolean).map((line) => `# layout: ${line}\n`);
  return [`${body}\n`, ...(comments.length > 0 ? ['\n'] : []), ...comments].join('');
}
