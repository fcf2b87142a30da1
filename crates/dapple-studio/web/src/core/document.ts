// The document: a text, its revision, and the small changes of it that are made elsewhere.
//
// The text with its one undo history lives in an editor behind `TextHost`. A change by a widget is a patch: the other
// side makes it a change of the text, which comes back as edits and becomes one transaction here. At most one patch is
// on its way; of those that wait, a later one of the same gesture replaces the one before, so that the newest wins.
import type { Change, Op, Reply, Request } from './protocol';

/** The editor that holds the text. */
export interface TextHost {
  text(): string;
  /** Applies changes; those of one gesture are a single step of undo. */
  apply(changes: Change[], gesture: number | null): void;
  /** Begins with another text, without history. */
  reset(text: string): void;
}

/** The text before there is an editor, which is told of all that was done. */
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

  /** Does in an editor what was done here. */
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

/** A new gesture: a drag, or arrow keys pressed in a row. */
export function newGesture(): number {
  gestures += 1;
  return gestures;
}

/** A text with its revision, kept the same here and on the other side. */
export class StudioDocument {
  rev = 0;
  /** The revision at which the text last changed; patches that change nothing count up, too. */
  made = 0;
  name = '';
  file: string | null = null;
  /** The hash of the file as it was read or written. */
  hash: string | null = null;
  /** The text as it was opened or saved. */
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

  /** Whether the text differs from what was opened or saved. */
  get changed(): boolean {
    return this.text !== this.kept;
  }

  /** Whether patches are on their way. */
  get busy(): boolean {
    return this.#flight !== null || this.#waiting.length > 0;
  }

  /** Called by the editor when its text changed by typing, undo or redo. */
  typed(): void {
    this.rev += 1;
    this.made = this.rev;
    this.sendText();
  }

  /** Sends all of the text. */
  sendText(): void {
    this.send({ type: 'doc', rev: this.rev, text: this.text });
  }

  /** Changes the recipe by a widget. Those of one gesture are a single step of undo. */
  patch(ops: Op[], gesture: number | null = null, drag = false): void {
    const last = this.#waiting.at(-1);
    if (last && gesture !== null && last.gesture === gesture) this.#waiting.pop();
    this.#waiting.push({ ops, gesture, drag });
    this.#next();
  }

  /** Takes a message that concerns the text; false if it does not. */
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

  /** Replaces the whole text, as one step of undo. */
  replace(text: string): void {
    this.host.apply([{ from: 0, to: this.text.length, insert: text }], null);
    this.typed();
  }

  /** After the way to the other side was lost and found. */
  resume(): void {
    this.#flight = null;
    this.sendText();
    this.#next();
  }

  #edited(rev: number, changes: Change[]): void {
    const flight = this.#flight;
    if (!flight || this.rev !== flight.base || rev !== flight.base + 1) return this.#again(rev);
    this.rev = rev;
    if (changes.length > 0) this.made = rev;
    if (changes.length > 0) this.host.apply(changes, flight.gesture);
    this.#done();
  }

  /** The patch met another text: sends ours, then the patch once more. */
  #again(rev: number): void {
    const flight = this.#flight;
    this.#flight = null;
    this.rev = Math.max(this.rev, rev) + 1;
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
