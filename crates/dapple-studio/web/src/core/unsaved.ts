// Changes that were not saved, kept over a reload of the page in this tab.

/** A text that differs from what was opened, and of which recipe. */
export interface Unsaved {
  name: string;
  file: string | null;
  text: string;
}

const KEY = 'dapple-unsaved';
/** Milliseconds after the last change until it is kept. */
const BREATH = 300;
let waiting: ReturnType<typeof setTimeout> | undefined;

/** Keeps changes; null forgets them. */
export function remember(changes: () => Unsaved | null): void {
  clearTimeout(waiting);
  waiting = setTimeout(() => {
    const kept = changes();
    if (kept) sessionStorage.setItem(KEY, JSON.stringify(kept));
    else sessionStorage.removeItem(KEY);
  }, BREATH);
}

/** What was kept before the reload. */
export function recall(): Unsaved | null {
  const kept = sessionStorage.getItem(KEY);
  return kept === null ? null : (JSON.parse(kept) as Unsaved);
}
