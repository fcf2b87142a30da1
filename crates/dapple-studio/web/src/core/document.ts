// The document: a text, its revision, and patches to it.
//
// The text and its single undo history belong to an editor behind `TextHost`. A widget changes the text by a patch.
// The studio converts the patch to edits of the text and sends them back, and they become one transaction here. At
// most one patch is in flight. A waiting patch is replaced by a later one of the same gesture, so the newest wins.
import type { Change, Op, Reply, Request } from './protocol';

/** The editor that holds the text. */
export interface TextHost {
  text(): string;
  /** Applies changes. Changes of the same gesture form a single undo step. */
  apply(changes: Change[], gesture: number | null): void;
  /** Replaces the text and clears the history. */
  reset(text: string): void;
}

/** The text before the editor is loaded. It records all operations and replays them in the editor. */
export class Draft implements TextHost {
  #text = '';
  #done: ((editor: TextHost) => void)[] = [];

  text(): string {
    return this.#text;
  }

  apply(changes: Change[], gesture: number | null): void {
    const parts: string[] = [];
    let at = 0;
    for (const { from, to, insert } of changes) {
      parts.push(this.#text.slice(at, from), insert);
      at = to;
    }
    this.#text = parts.join('') + this.#text.slice(at);
    this.#done.push((editor) => editor.apply(changes, gesture));
  }

  reset(text: string): void {
    this.#text = text;
    this.#done = [(editor) => editor.reset(text)];
  }

  /** Replays the recorded operations in an editor. */
  replay(editor: TextHost): void {
    for (const done of this.#done) done(editor);
  }
}

interface Patch {
  ops: Op[];
  gesture: number | null;
  drag: boolean;
}

let gestures = 0;

/** Returns the id of a new gesture, such as a drag or a sequence of arrow keys. */
export function newGesture(): number {
  gestures += 1;
  return gestures;
}

/** A text and its revision, synchronized with the studio. */
export class StudioDocument {
  rev = 0;
  /** The revision at which the text last changed. Patches without an effect also increment `rev`. */
  made = 0;
  name = '';
  file: string | null = null;
  /** The hash of the file when it was last read or written. */
  hash: string | null = null;
  /** The text when it was last opened or saved. */
  kept = '';
  #flight: (Patch & { base: number }) | null = null;
  #waiting: Patch[] = [];

  constructor(
    private readonly host: TextHost,
    private readonly send: (message: Request) => void,
  ) {}

  get text(): string {
    return this.host.text();
  }

  /** Whether the text differs from the opened or saved text. */
  get changed(): boolean {
    return this.text !== this.kept;
  }

  /** The number of patches that are not part of the text yet. */
  get pending(): number {
    return this.#waiting.length + (this.#flight ? 1 : 0);
  }

  /** Called by the editor when its text changed by typing, undo or redo. */
  typed(): void {
    this.rev += 1;
    this.made = this.rev;
    this.sendText();
  }

  /** Sends the whole text. */
  sendText(): void {
    this.send({ type: 'doc', rev: this.rev, text: this.text });
  }

  /** Changes the recipe from a widget. Changes of the same gesture form a single undo step. */
  patch(ops: Op[], gesture: number | null = null, drag = false): void {
    const last = this.#waiting.at(-1);
    if (last && gesture !== null && last.gesture === gesture) this.#waiting.pop();
    this.#waiting.push({ ops, gesture, drag });
    this.#next();
  }

  /** Handles a message. Returns true if it concerns only the text. */
  receive(message: Reply): boolean {
    switch (message.type) {
      case 'document':
        this.#flight = null;
        this.#waiting = [];
        Object.assign(this, { rev: message.rev, made: message.rev, name: message.name, file: message.file, hash: message.hash });
        this.kept = message.text;
        this.host.reset(message.text);
        return true;
      case 'edits':
        this.#edited(message.rev, message.changes);
        return true;
      case 'stale':
        this.#again(message.rev);
        return true;
      case 'refused':
        if (message.what === 'patch') this.#done();
        return false;
      default:
        return false;
    }
  }

  /** Replaces the text in a single undo step, or in that of a gesture. Equal ends of the texts stay untouched. */
  replace(text: string, gesture: number | null = null): void {
    const old = this.text;
    if (text === old) return;
    let from = 0;
    while (from < old.length && old[from] === text[from]) from += 1;
    let tail = 0;
    while (tail < Math.min(old.length, text.length) - from && old.at(-1 - tail) === text.at(-1 - tail)) tail += 1;
    this.host.apply([{ from, to: old.length - tail, insert: text.slice(from, text.length - tail) }], gesture);
    this.typed();
  }

  /** Resumes after the connection was lost and restored. */
  resume(): void {
    this.rev += 1;
    this.#resend();
  }

  #edited(rev: number, changes: Change[]): void {
    const flight = this.#flight;
    if (!flight || this.rev !== flight.base || rev !== flight.base + 1) return this.#again(rev);
    this.rev = rev;
    if (changes.length > 0) this.made = rev;
    if (changes.length > 0) this.host.apply(changes, flight.gesture);
    this.#done();
  }

  /** Resends the text and then the patch, because the patch was based on another revision. */
  #again(rev: number): void {
    this.rev = Math.max(this.rev, rev) + 1;
    this.#resend();
  }

  #resend(): void {
    const flight = this.#flight;
    this.#flight = null;
    this.sendText();
    if (flight) this.#waiting.unshift(flight);
    this.#next();
  }

  #done(): void {
    this.#flight = null;
    this.#next();
  }

  #next(): void {
    if (this.#flight) return;
    const patch = this.#waiting.shift();
    if (!patch) return;
    this.#flight = { ...patch, base: this.rev };
    this.send({ type: 'patch', rev: this.rev, ops: patch.ops, drag: patch.drag });
  }
}
