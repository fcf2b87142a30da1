// Unsaved changes, kept in this tab across a reload of the page.

/** An unsaved text and the recipe that it belongs to. */
export interface Unsaved {
  name: string;
  file: string | null;
  text: string;
}

const KEY = 'dapple-unsaved';
/** Delay in milliseconds from the last change until it is stored. */
const BREATH = 300;
let waiting: ReturnType<typeof setTimeout> | undefined;

/** Stores the unsaved changes after a delay. Null removes them. */
export function remember(changes: () => Unsaved | null): void {
  clearTimeout(waiting);
  waiting = setTimeout(() => {
    const kept = changes();
    if (kept) sessionStorage.setItem(KEY, JSON.stringify(kept));
    else sessionStorage.removeItem(KEY);
  }, BREATH);
}

/** Returns the changes stored before the reload. */
export function recall(): Unsaved | null {
  const kept = sessionStorage.getItem(KEY);
  return kept === null ? null : (JSON.parse(kept) as Unsaved);
}

/** A recipe to open: exactly one of these. */
export interface Opening {
  builtin?: string;
  file?: string;
  text?: string;
}

const OPEN = 'dapple-open';

/** Stores which recipe is open in this tab, and which one the command line of the studio names. */
export function rememberOpen(named: string | null, what: Opening | null): void {
  if (what && (what.file ?? what.builtin) !== named) sessionStorage.setItem(OPEN, JSON.stringify({ named, what }));
  else sessionStorage.removeItem(OPEN);
}

/** Returns the recipe that was open before the reload, unless the studio was started with another one since. */
export function recallOpen(named: string | null): Opening | null {
  const kept = JSON.parse(sessionStorage.getItem(OPEN) ?? 'null') as { named: string | null; what: Opening } | null;
  return kept?.named === named ? kept.what : null;
}
