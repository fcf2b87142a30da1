// The text editor: CodeMirror with TOML, error markers, and the undo history of the document.
//
// It is inside a shadow root, so that its styles are adopted style sheets, which a strict content security policy
// allows.
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

/** Callbacks of the editor. */
export interface EditorEvents {
  typed(): void;
  /** The text changed, for any reason. */
  changed(): void;
  /** Returns the data for completion. */
  known(): Known;
  /** The user moved the caret. */
  caret(position: number): void;
}

const joined = Annotation.define<boolean>();
const remote = Annotation.define<boolean>();

/** Maximum time between keystrokes of one undo step, in milliseconds. */
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

  /** Makes the text read-only or editable. */
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

  /** The number of undo steps and of redo steps. */
  depth(): [number, number] {
    return [undoDepth(this.view.state), redoDepth(this.view.state)];
  }

  /** Marks errors in the text. */
  problems(items: Problem[]): void {
    const end = this.view.state.doc.length;
    const marks = items.map(({ from, to, message, nearest, hint }) => ({
      from: Math.min(from, end),
      to: Math.min(Math.max(to, from), end),
      severity: 'error' as const,
      message: [message, nearest && `did you mean ${nearest}?`, hint].filter(Boolean).join('\n'),
    }));
    this.view.dispatch(setDiagnostics(this.view.state, marks));
    // The list of errors shrinks the editor, so scroll the caret back into view.
    if (marks.length > 0 && this.view.hasFocus) setTimeout(() => this.view.dispatch({ effects: EditorView.scrollIntoView(this.view.state.selection.main.head, { yMargin: 28 }) }), 30);
  }

  /** Moves the caret without a callback. */
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
          // A quotation mark typed over a completed one leaves the text as it is. The studio answers changed texts alone.
          if (!ours && !update.startState.doc.eq(update.state.doc)) this.events.typed();
          this.events.changed();
        }
        if (update.selectionSet && !update.docChanged && !this.#quiet) {
          this.events.caret(update.state.selection.main.head);
        }
      }),
    ];
  }

  /**
   * Whether a change joins the last undo step: it is of the same gesture, or typed soon after it at an adjacent
   * position.
   */
  #joins(goesOn: boolean | undefined, near: boolean): boolean {
    if (goesOn !== undefined) this.#last = 0;
    if (goesOn !== undefined) return goesOn;
    const now = performance.now();
    const soon = now - this.#last < TYPING;
    this.#last = now;
    return near && soon;
  }
}
