// The keyboard shortcuts of the page.
import type { Studio } from './studio.svelte';

/** The list of shortcuts, grouped by context. */
export const KEYS: { title: string; keys: [string, string][] }[] = [
  {
    title: 'Everywhere',
    keys: [
      ['Ctrl Z', 'Undo, also what sliders did'],
      ['Ctrl Shift Z', 'Redo'],
      ['Ctrl S', 'Save'],
      ['Ctrl E', 'Export'],
      ['Ctrl O', 'Recipes'],
      ['F6', 'To the next part of the page'],
      ['?', 'This sheet'],
      ['Esc', 'Close; to the recipe'],
    ],
  },
  {
    title: 'View',
    keys: [
      ['1 … 6', 'Maps, Tiled, Lit, Node, Seams, Exact'],
      ['+ -', 'Zoom'],
      ['0', 'Fit'],
      ['← → ↑ ↓', 'Move the picture that has the focus'],
      ['B', 'While it is held: as it was marked'],
      ['Shift B', 'Mark what is seen now'],
      ['P', 'Pause'],
      ['Space', 'Play the loop'],
      ['R', 'Another seed by chance'],
    ],
  },
  {
    title: 'Nodes',
    keys: [
      ['A', 'Add a node'],
      ['Ctrl D', 'Duplicate the selected nodes'],
      ['Ctrl C, Ctrl V', 'Copy and paste them, also into another recipe'],
      ['Delete', 'Remove the selected nodes or links'],
      ['← → ↑ ↓', 'Move the node that has the focus'],
      ['Shift, drag', 'Select all nodes in a rectangle; Ctrl adds one'],
      ['[ ]', 'Select the node before or after'],
    ],
  },
  {
    title: 'Points, and stops of ramps',
    keys: [
      ['← → ↑ ↓', 'Move; with Shift ten times as far'],
      ['Delete', 'Remove'],
      ['Tab', 'To the next'],
    ],
  },
];

/** The sections of the page that F6 cycles through. */
const PARTS = '.top button, .viewer [role=tab][aria-selected=true], .graph .add button, .parameters input, .text .editor';

/** Copies the selected nodes, unless text is selected or typed. */
export function copying(studio: Studio, event: ClipboardEvent): void {
  const text = busy(event.target) || !(getSelection()?.isCollapsed ?? true) ? null : studio.copied();
  if (text === null) return;
  event.clipboardData?.setData('text/plain', text);
  event.preventDefault();
}

/** Pastes nodes. */
export function pasting(studio: Studio, event: ClipboardEvent): void {
  if (!busy(event.target) && studio.paste(event.clipboardData?.getData('text/plain') ?? '')) event.preventDefault();
}

/** Whether the focused element uses keys itself, for typing or selecting. */
function busy(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target.shadowRoot) return true;
  const input = target instanceof HTMLInputElement && !['checkbox', 'range', 'color', 'button'].includes(target.type);
  return input || target.closest('select, textarea, dialog, [contenteditable=true]') !== null;
}

/** Handles a key. Returns true if the key had an effect. */
export function pressed(studio: Studio, event: KeyboardEvent): boolean {
  const { looking } = studio;
  if (event.ctrlKey || event.metaKey) return withControl(studio, event);
  // A dialog handles keys itself, even if nothing in it has the focus.
  if (studio.sheet !== 'none' || event.altKey) return false;
  if (event.key === 'F6') return nextPart(event.shiftKey);
  if (busy(event.target)) return false;
  const mode = studio.modes[Number(event.key) - 1];
  if (mode && /^[1-6]$/.test(event.key)) {
    if ((mode.id === 'tiled') !== (looking.mode === 'tiled')) looking.window = null;
    looking.mode = mode.id;
    return true;
  }
  const onButton = event.target instanceof HTMLButtonElement || event.target instanceof HTMLInputElement;
  switch (event.key) {
    case '?':
      studio.sheet = 'keys';
      return true;
    case 'a':
      if (!studio.reading) studio.sheet = 'add';
      return true;
    case 'b':
      looking.before = true;
      return true;
    case 'B':
      studio.markNow();
      return true;
    case 'p':
      looking.paused = !looking.paused;
      return true;
    case 'r':
      studio.shuffle();
      return true;
    case ' ':
      if (onButton) return false;
      looking.playing = !looking.playing;
      return true;
    case '+':
    case '=':
      looking.zoomBy(1.25);
      return true;
    case '-':
      looking.zoomBy(0.8);
      return true;
    case '0':
      looking.window = null;
      return true;
    case '[':
    case ']':
      studio.step(event.key === ']' ? 1 : -1);
      return true;
    case 'Delete':
      return !event.defaultPrevented && !studio.reading && studio.remove();
    case 'Escape':
      studio.select(null);
      return true;
    default:
      return false;
  }
}

function withControl(studio: Studio, event: KeyboardEvent): boolean {
  const key = event.key.toLowerCase();
  const inText = event.target instanceof HTMLElement && event.target.shadowRoot !== null;
  if (key === 'z' || key === 'y') {
    if (inText) return false;
    if (key === 'y' || event.shiftKey) studio.redo();
    else studio.undo();
    return true;
  }
  if (key === 'd' && studio.selected !== null && !inText) {
    studio.duplicate();
    return true;
  }
  const sheet = ({ s: 'save', e: 'export', o: 'start' } as const)[key as 's' | 'e' | 'o'];
  if (!sheet || (sheet === 'save' && studio.reading)) return false;
  studio.sheet = sheet;
  return true;
}

function nextPart(back: boolean): boolean {
  const parts = [...new Map([...document.querySelectorAll<HTMLElement>(PARTS)].map((part) => [part.closest('header.top, section'), part])).values()];
  const now = parts.findIndex((part) => part.closest('header.top, section')?.contains(document.activeElement));
  const next = parts[(now + (back ? -1 : 1) + parts.length) % parts.length];
  const inner = next?.shadowRoot?.querySelector<HTMLElement>('[role=textbox]');
  (inner ?? next)?.focus();
  return true;
}
