// The editor of the text: CodeMirror with TOML, problems at their places, and the history of the document.
//
// It lives in a shadow root, so that its styles are adopted sheets, which a strict content security policy allows.
import { autocompletion, closeBrackets, completionKeymap } from '@codemirror/autocomplete';
import { defaultKeymap, history, historyKeymap, redo, redoDepth, undo, undoDepth } from '@codemirror/commands';
import { bracketMatching, HighlightStyle, StreamLanguage, syntaxHighlighting } from '@codemirror/language';
import { toml } from '@codemirror/legacy-modes/mode/toml';
import { lintGutter, setDiagnostics } from '@codemirror/lint';
import { highlightSelectionMatches, searchKeymap } from '@codemirror/search';
import { Annotation, Compartment, EditorState, type Extension } from '@codemirror/state';
import { drawSelection, EditorView, highlightActiveLine, keymap, lineNumbers } from '@codemirror/view';
import { tags } from '@lezer/highlight';
import { complete, type Known } from './complete';
import type { TextHost } from './document';
import type { Change, Problem } from './protocol';

/** What the editor tells of. */
export interface EditorEvents {
  typed(): void;
  /** The text changed, by whatever. */
  changed(): void;
  /** What completion may offer. */
  known(): Known;
  /** The caret was moved by a person. */
  caret(position: number): void;
}

const joined = Annotation.define<boolean>();
const remote = Annotation.define<boolean>();

/** Milliseconds between keys up to which they are one step of undo. */
const TYPING = 500;

const colors = HighlightStyle.define([
  { tag: [tags.propertyName, tags.definition(tags.name), tags.standard(tags.name)], color: 'var(--code-key)' },
  { tag: tags.atom, color: 'var(--code-head)', fontWeight: '600' },
  { tag: [tags.string, tags.special(tags.string)], color: 'var(--code-string)' },
  { tag: [tags.number, tags.bool], color: 'var(--code-number)' },
  { tag: tags.comment, color: 'var(--code-comment)', fontStyle: 'italic' },
]);

const theme = EditorView.theme({
  '&': { height: '100%', fontSize: '12.5px', color: 'var(--ink)', backgroundColor: 'var(--field)' },
  '&.cm-focused': { outline: 'none' },
  '.cm-scroller': { fontFamily: 'var(--mono)', lineHeight: '1.55' },
  '.cm-content': { caretColor: 'var(--accent)', padding: '6px 0' },
  '.cm-cursor': { borderLeftColor: 'var(--accent)', borderLeftWidth: '2px' },
  '.cm-gutters': { backgroundColor: 'var(--field)', color: 'var(--faint)', border: 'none' },
  '.cm-activeLine': { backgroundColor: 'var(--row)' },
  '.cm-selectionBackground, &.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground': {
    backgroundColor: 'var(--selection)',
  },
  '.cm-selectionMatch': { backgroundColor: 'var(--match)' },
  '.cm-tooltip': { backgroundColor: 'var(--panel)', border: '1px solid var(--line)', color: 'var(--ink)' },
  '.cm-tooltip-autocomplete > ul > li[aria-selected]': { background: 'var(--accent-soft)', color: 'var(--accent)' },
  '.cm-completionInfo': { maxWidth: '320px', padding: '6px 10px', fontFamily: 'var(--sans)' },
  '.cm-panels': { backgroundColor: 'var(--panel)', color: 'var(--ink)', borderColor: 'var(--line)' },
  '.cm-textfield, .cm-button': { color: 'var(--ink)', background: 'var(--field)', borderColor: 'var(--line)' },
  '.cm-lintRange-error': { backgroundImage: 'none', borderBottom: '2px solid var(--error)' },
  '.cm-diagnostic-error': { borderLeftColor: 'var(--error)', whiteSpace: 'pre-wrap', maxWidth: '420px' },
  '.cm-lineNumbers .cm-gutterElement': { padding: '0 6px 0 10px' },
});

/** An editor in an element of the page. */
export class Editor implements TextHost {
  readonly view: EditorView;
  readonly #locked = new Compartment();
  #gesture: number | null = null;
  #last = 0;
  #quiet = false;

  constructor(
    parent: HTMLElement,
    private readonly events: EditorEvents,
  ) {
    const root = parent.shadowRoot ?? parent.attachShadow({ mode: 'open' });
    this.view = new EditorView({ root, parent: root, state: EditorState.create({ extensions: this.#extensions() }) });
  }

  text(): string {
    return this.view.state.doc.toString();
  }

  apply(changes: Change[], gesture: number | null): void {
    const goesOn = gesture !== null && gesture === this.#gesture;
    this.#gesture = gesture;
    this.view.dispatch({ changes, annotations: [remote.of(true), joined.of(goesOn)] });
  }

  reset(text: string): void {
    const locked = this.view.state.readOnly;
    this.view.setState(EditorState.create({ doc: text, extensions: this.#extensions() }));
    this.lock(locked);
    this.events.changed();
  }

  /** Whether the text can only be read. */
  lock(locked: boolean): void {
    const extension = [EditorState.readOnly.of(locked), EditorView.editable.of(!locked)];
    this.view.dispatch({ effects: this.#locked.reconfigure(extension) });
  }

  undo(): void {
    undo(this.view);
  }

  redo(): void {
    redo(this.view);
  }

  /** How many steps can be undone, and done again. */
  depth(): [number, number] {
    return [undoDepth(this.view.state), redoDepth(this.view.state)];
  }

  /** Marks what is wrong. */
  problems(items: Problem[]): void {
    const end = this.view.state.doc.length;
    const marks = items.map(({ from, to, message, nearest, hint }) => ({
      from: Math.min(from, end),
      to: Math.min(Math.max(to, from), end),
      severity: 'error' as const,
      message: [message, nearest && `did you mean ${nearest}?`, hint].filter(Boolean).join('\n'),
    }));
    this.view.dispatch(setDiagnostics(this.view.state, marks));
    // The list of problems takes room: the caret is to stay in sight.
    if (marks.length > 0 && this.view.hasFocus) setTimeout(() => this.view.dispatch({ effects: EditorView.scrollIntoView(this.view.state.selection.main.head, { yMargin: 28 }) }), 30);
  }

  /** Puts the caret somewhere, without telling of it. */
  goTo(position: number, focus = false): void {
    const anchor = Math.min(position, this.view.state.doc.length);
    this.#quiet = true;
    this.view.dispatch({ selection: { anchor }, effects: EditorView.scrollIntoView(anchor, { y: 'start', yMargin: 24 }) });
    this.#quiet = false;
    if (focus) this.view.focus();
  }

  #extensions(): Extension[] {
    return [
      lineNumbers(),
      lintGutter(),
      history({ newGroupDelay: Number.MAX_SAFE_INTEGER, joinToEvent: (tr, near) => this.#joins(tr.annotation(joined), near) }),
      drawSelection(),
      bracketMatching(),
      closeBrackets(),
      highlightActiveLine(),
      highlightSelectionMatches(),
      autocompletion({ override: [(context) => complete(context, this.events.known())] }),
      StreamLanguage.define(toml),
      syntaxHighlighting(colors),
      theme,
      EditorView.contentAttributes.of({ 'aria-label': 'Recipe, as TOML', tabindex: '0' }),
      keymap.of([...defaultKeymap, ...historyKeymap, ...searchKeymap, ...completionKeymap]),
      this.#locked.of([]),
      EditorView.updateListener.of((update) => {
        if (update.docChanged) {
          const ours = update.transactions.some((tr) => tr.annotation(remote));
          if (!ours) this.#gesture = null;
          if (!ours) this.events.typed();
          this.events.changed();
        }
        if (update.selectionSet && !update.docChanged && !this.#quiet) {
          this.events.caret(update.state.selection.main.head);
        }
      }),
    ];
  }

  /** Whether a change joins the last step of undo: of the same gesture, or typed soon after beside it. */
  #joins(goesOn: boolean | undefined, near: boolean): boolean {
    if (goesOn !== undefined) this.#last = 0;
    if (goesOn !== undefined) return goesOn;
    const now = performance.now();
    const soon = now - this.#last < TYPING;
    this.#last = now;
    return near && soon;
  }
}
