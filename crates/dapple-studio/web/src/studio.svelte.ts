// The state of the page: messages from the studio, the selection, and the user's requests.
import type { Editor } from './core/editor';
import { Draft, newGesture, StudioDocument, type TextHost } from './core/document';
import type { Pictures } from './core/pictures';
import type { Frame, Graph, Hello, Json, Op, Path, Points, Problem, Reply, Request, Seam } from './core/protocol';
import { MAP } from './core/protocol';
import { at, entry, Schemas, type Range } from './core/schema';
import { rangeAt, resolved, sourceOf } from './core/shared';
import { snapped, type Whole } from './core/range';
import type { Transport } from './core/transport';
import { recall, recallOpen, remember, rememberOpen, type Opening, type Unsaved } from './core/unsaved';
import { placed, withPlaces } from './graph/placed';
import { setIn } from './fields/edit';
import { Looking, MODES } from './looking.svelte';
import { Rendering } from './rendering.svelte';

/** A dialog over the page. */
export type Sheet = 'none' | 'keys' | 'export' | 'save' | 'copy' | 'add' | 'start' | 'leave' | 'disk';

/** The end of a link: a node, its input if the link leads to it, and a position in the graph. */
export interface Dropped {
  node: string;
  input: Path | null;
  at: { x: number; y: number };
}

/** Display time of a status message, in milliseconds. */
const NOTED = 6000;

/** Maximum number of values that are tried after a slider was refused. */
const TRIALS = 10;

/** The whole state of the page. */
export class Studio {
  readonly looking = new Looking();
  readonly rendering = new Rendering();
  hello = $state.raw<Hello | null>(null);
  connection = $state<'waiting' | 'open' | 'closed' | 'refused'>('waiting');
  /** The recipe as written. */
  recipe = $state.raw<Json>(null);
  /** The names of the recipe's parameters, in the order of the text. */
  parameters = $state.raw<string[]>([]);
  readonly #resolved = $derived(resolved(this.recipe));
  graph = $state.raw<Graph | null>(null);
  problems = $state.raw<Problem[]>([]);
  seams = $state.raw<Seam[] | null>(null);
  points = $state.raw<Points | null>(null);
  selected = $state<string | null>(null);
  /** The nodes and the links that are selected in the graph. */
  chosen = $state.raw<{ nodes: string[]; links: Path[] }>({ nodes: [], links: [] });
  /** The end of a link that was dropped on empty space, with the place, for the node to add there. */
  dropped = $state.raw<Dropped | null>(null);
  /** Counts recipes that were opened. */
  opened = $state(0);
  sheet = $state<Sheet>('none');
  /** The path of the parameter whose help is open. */
  helped = $state('');
  said = $state('');
  /** The current status message, cleared after some seconds. */
  noted = $state('');
  /** Whether the full-size images belong to the current text, and the text can be edited. */
  settled = $state(false);
  refusal = $state.raw<{ what: string; message: string; hint: string | null } | null>(null);
  name = $state('');
  file = $state.raw<string | null>(null);
  changed = $state(false);
  history = $state.raw<[number, number]>([0, 0]);
  schemas = $derived(this.hello ? new Schemas(this.hello.schema) : null);
  readonly document: StudioDocument;
  /** The recipe to open once the user agrees to discard changes. */
  leaving: Opening | null = null;
  /** The file as changed on disk by another program. */
  disk = $state.raw<{ text: string; hash: string; file: string } | null>(null);
  /** Counts connections, so that views are requested again after each. */
  again = $state(0);
  /** A node to select as soon as the graph contains it. */
  wanted: string | null = null;
  /** The range of a numeric input: any number. */
  readonly free: Range = { min: -Infinity, max: Infinity, open: [false, false], integer: false, soft: null, log: false };
  #noting: ReturnType<typeof setTimeout> | undefined;
  #editor: Editor | null = null;
  /** Holds the text until the editor is loaded. */
  readonly #draft = new Draft();
  /** Collects the edits of a widget that are tried but not applied. */
  #tried: Op[] | null = null;
  /** Time of the last user action that changes the images, until they are painted. */
  #since = performance.now();
  /** Time from the last user action to the full images on the screen, in milliseconds. */
  painted = $state<number | null>(null);
  /** The number of edits that wait for the connection. */
  pending = $state(0);
  /** Called when the studio has accepted or refused the newest text, or with null when another edit was made. */
  #judged: ((accepted: boolean | null) => void) | null = null;
  #verdict = { rev: -1, accepted: true };
  #trying = false;
  #listeners = new Set<(message: Reply) => void>();
  #kept: Unsaved | null = null;
  /** The recipe that was open before the page was reloaded, if it is not the one that the studio opens. */
  #reopened: Opening | null = null;
  /** Whether the connection was restored: the page keeps its text instead of the text of the new session. */
  #resuming = false;

  constructor(readonly transport: Transport) {
    const host = {
      text: () => (this.#editor ?? this.#draft).text(),
      apply: (...given: Parameters<TextHost['apply']>) => (this.#editor ?? this.#draft).apply(...given),
      reset: (text: string) => (this.#editor ?? this.#draft).reset(text),
    };
    this.document = new StudioDocument(host, (message) => this.send(message));
    if (transport.first) this.rendering.asked(transport.first);
    transport.onmessage = (message) => this.#receive(message);
    transport.onpicture = (picture) => this.#picture(picture);
    transport.onstate = (state) => {
      this.connection = state;
      this.pending = this.document.pending;
      if (state === 'open') this.again += 1;
    };
  }

  get pictures(): Pictures {
    return this.rendering.pictures;
  }

  get reading(): boolean {
    return this.hello?.mode === 'watch';
  }

  /** Whether there is no server, so that the browser opens and saves files. */
  get alone(): boolean {
    return this.hello?.mode === 'static';
  }

  /** The available kinds of views. The exact preview needs the command and so a server. */
  get modes(): readonly (typeof MODES)[number][] {
    return MODES.filter(({ id }) => id !== 'exact' || !this.alone);
  }

  get valid(): boolean {
    return this.problems.length === 0;
  }

  send(message: Request): void {
    if (message.type === 'view') this.rendering.asked(message);
    if (message.type === 'view' || message.type === 'doc' || message.type === 'patch') this.settled = false;
    if (message.type === 'view' || message.type === 'doc') this.#since = performance.now();
    this.transport.send(message);
  }

  /** Calls `then` for each message. Returns a function that removes the listener. */
  listen(then: (message: Reply) => void): () => void {
    this.#listeners.add(then);
    return () => this.#listeners.delete(then);
  }

  /** Connects the document to its editor. */
  attach(editor: Editor): void {
    this.#draft.replay(editor);
    this.#editor = editor;
    editor.lock(this.reading);
    editor.problems(this.problems);
    this.textChanged();
    this.#settle();
  }

  /** Called when the text changed, for any reason. */
  textChanged(): void {
    this.changed = this.document.changed;
    const { name, file, text } = this.document;
    if (!this.reading) remember(() => (this.document.changed ? { name, file, text } : null));
    this.history = this.#editor?.depth() ?? [0, 0];
  }

  undo(): void {
    this.#editor?.undo();
  }

  redo(): void {
    this.#editor?.redo();
  }

  /** The value at a path of the recipe as it is written there, which may refer to a parameter. */
  value(path: Path): Json | undefined {
    return at(this.recipe, path);
  }

  /** The value at a path of the recipe, if it is written there. A reference has the value of its parameter. */
  resolved(path: Path): Json | undefined {
    return at(this.#resolved, path);
  }

  /** The path at which the value is written that `resolved` returns: that of a parameter for a reference. */
  source(path: Path): Path {
    return sourceOf(this.recipe, path);
  }

  #values(recipe: Json, parameters: string[]): void {
    this.recipe = recipe;
    this.parameters = parameters;
    this.looking.extent = extentOf(this.resolved(['extent']));
    // A view is requested again only if the optional maps of the lit view change.
    const extras = (this.hello?.optional_maps ?? []).filter((name) => (this.value(['material', name]) ?? null) !== null);
    if (extras.join() !== this.looking.extras.join()) this.looking.extras = extras;
  }

  /** Changes the recipe from a widget. */
  patch(ops: Op[], gesture: number | null = null, drag = false): void {
    if (this.#tried) return void this.#tried.push(...ops);
    if (this.reading) return;
    if (!this.#trying) this.#judged?.(null);
    this.looking.dragging = drag;
    this.#since = performance.now();
    this.document.patch(ops, gesture, drag);
    this.pending = this.document.pending;
  }

  set(path: Path, value: Json, gesture: number | null = null, drag = false): void {
    this.patch([{ op: 'set', path, value }], gesture, drag);
  }

  /**
   * Called when a slider has set a number to `wanted`. If the recipe is refused then, sets the nearest accepted number
   * between `good` and `wanted`, or the nearest one with a whole number of cells. Another edit ends the search.
   */
  async settle(name: string, good: number, wanted: number, { integer, whole }: { integer: boolean; whole: Whole | null }, set: (value: number) => void): Promise<void> {
    const accepts = (value: number): Promise<boolean | null> => {
      this.#judged?.(null);
      this.#trying = true;
      set(value);
      this.#trying = false;
      return new Promise((done) => {
        this.#judged = done;
        this.#judge();
      });
    };
    let bad = wanted;
    let accepted = await accepts(wanted);
    if (accepted !== false) return;
    const why = this.problems[0]?.message ?? '';
    const unit = whole ? whole.unit / whole.side : 0;
    for (let i = 0; whole && i < TRIALS; i += 1) {
      // Some patterns alternate or repeat after several cells. Try numbers at increasing distances, first toward `good`.
      const away = (Math.floor(i / 2) + 1) * unit * (i % 2 === 0 ? Math.sign(good - wanted) : Math.sign(wanted - good));
      const other = snapped(wanted + away, whole);
      accepted = await accepts(other);
      if (accepted === null) return;
      if (accepted) return this.say(`${name} stays at ${other}: ${why}`);
    }
    for (let i = 0; !whole && i < TRIALS; i += 1) {
      const middle = integer ? Math.trunc((good + bad) / 2) : Number(((good + bad) / 2).toPrecision(2));
      if (middle === good || middle === bad) break;
      accepted = await accepts(middle);
      if (accepted === null) return;
      if (accepted) good = middle;
      else bad = middle;
    }
    if ((await accepts(good)) === true) this.say(`${name} stays at ${good}: ${why}`);
  }

  /** Reports whether the newest text was accepted, once that is known. */
  #judge(): void {
    if (this.document.pending > 0 || this.#verdict.rev < this.document.made) return;
    this.#judged?.(this.#verdict.accepted);
    this.#judged = null;
  }

  /** Returns the edits that `change` would make, without applying them. */
  tried(change: () => void): Op[] {
    const ops: Op[] = [];
    this.#tried = ops;
    try {
      change();
    } finally {
      this.#tried = null;
    }
    return ops;
  }

  /** Sets a random seed. */
  shuffle(): void {
    const path = this.source(['seed']);
    const [low, high] = rangeAt(this.recipe, path) ?? [0, 9999];
    this.set(path, low + Math.floor(Math.random() * (high - low + 1)), newGesture());
  }

  /** Selects a node, or the recipe. The caret moves to the node unless `follow` is false. */
  select(name: string | null, follow = true): void {
    this.selected = name;
    const span = this.graph?.nodes.find((node) => node.name === name)?.span;
    if (follow && span) this.#editor?.goTo(span[0]);
  }

  /** Selects the next or the previous node. */
  step(way: number): void {
    const order = this.graph?.order ?? [];
    const now = this.selected === null ? (way > 0 ? -1 : 0) : order.indexOf(this.selected);
    this.select(order[(now + way + order.length) % order.length] ?? null);
  }

  /** Selects the node at the caret. */
  caret(position: number): void {
    const node = this.graph?.nodes.find(({ span }) => span[0] <= position && position <= span[1]);
    if (node) this.selected = node.name;
  }

  /** Moves the caret to an error. */
  goTo(position: number): void {
    this.#editor?.goTo(position, true);
  }

  /** Opens a recipe and discards changes. */
  open(what: Opening): void {
    this.sheet = 'none';
    this.selected = null;
    this.#reopened = null;
    this.send({ type: 'open', ...what });
  }

  /** Asks before discarding changes, then opens a recipe. */
  leave(what: Opening): void {
    this.leaving = what;
    this.sheet = 'leave';
  }

  /** Shows a status message for a while and announces it to screen readers. */
  say(text: string): void {
    this.said = this.noted = text;
    clearTimeout(this.#noting);
    this.#noting = setTimeout(() => (this.noted = ''), NOTED);
  }

  /** Stores the current images, for comparison with later ones. */
  markNow(): void {
    this.rendering.markNow();
    this.say('Marked: hold B to compare with what is seen now');
  }

  /** Removes the selected links or nodes. Returns whether there were any. */
  remove(): boolean {
    const { nodes, links } = this.chosen;
    const names = nodes.length > 0 || links.length > 0 ? nodes : this.selected === null ? [] : [this.selected];
    const ops: Op[] = [...links.map((path): Op => ({ op: 'disconnect', path })), ...names.map((name): Op => ({ op: 'remove_node', name }))];
    if (ops.length > 0) this.patch(ops);
    return ops.length > 0;
  }

  /** Adds copies of the selected nodes. Links among them are copied, too. */
  duplicate(): void {
    const many = this.chosen.nodes.length > 1;
    if (!many && this.selected !== null) return this.#name('duplicate_node', this.selected, this.freeName(this.selected));
    const to = this.#freeNames(this.chosen.nodes);
    const copies = [...to].map(([name, copy]): Op => ({ op: 'duplicate_node', name, to: copy }));
    const links = (this.graph?.nodes ?? []).filter(({ name }) => to.has(name)).flatMap(({ name, inputs }) => inputs.flatMap(({ path, node }): Op[] => {
      const copy = to.get(node ?? '');
      return copy === undefined ? [] : [{ op: 'set', path: ['nodes', to.get(name) ?? '', ...path], value: copy }];
    }));
    this.patch([...copies, ...links]);
  }

  /** Returns the selected nodes as text for the clipboard. */
  copied(): string | null {
    const names = this.chosen.nodes.length > 0 ? this.chosen.nodes : this.selected === null ? [] : [this.selected];
    const nodes = (this.graph?.nodes ?? []).filter(({ name }) => names.includes(name));
    const copies = nodes.map(({ name, kind, inputs }) => ({ name, kind, value: this.value(['nodes', name, kind]), links: inputs.filter(({ node }) => node !== null).map(({ path, node }) => [path.slice(1), node]) }));
    return copies.length > 0 ? JSON.stringify({ dapple_nodes: copies }) : null;
  }

  /** Adds nodes from the text of the clipboard. Returns whether there were any. */
  paste(text: string): boolean {
    if (!text.startsWith('{"dapple_nodes":') || this.reading) return false;
    const { dapple_nodes: nodes } = JSON.parse(text) as { dapple_nodes: { name: string; kind: string; value: Json; links: [Path, string][] }[] };
    const to = this.#freeNames(nodes.map(({ name }) => name));
    // A link to a node that was not copied stays if this recipe has a node of that name.
    const target = (name: string): Json => to.get(name) ?? (this.graph?.order.includes(name) ? name : 0.5);
    const ops = nodes.map(({ name, kind, value, links }): Op => {
      const linked = links.reduce((inner, [path, node]) => setIn(inner, path, target(node)), value);
      return { op: 'add_node', name: to.get(name) ?? name, kind, value: linked };
    });
    this.wanted = to.values().next().value ?? null;
    this.patch(ops);
    return true;
  }

  /** Positions of nodes that were moved by hand. */
  get places(): ReturnType<typeof placed> {
    return placed(this.document.text);
  }

  /** Keeps positions of nodes in the text, or none for the automatic layout. */
  place(spots: ReturnType<typeof placed>, gesture: number | null = null): void {
    if (!this.reading) this.document.replace(withPlaces(this.document.text, spots), gesture);
  }

  #freeNames(names: string[]): Map<string, string> {
    const taken = new Set(this.graph?.order ?? []);
    const free = (name: string) => {
      const found = this.freeName(name, taken);
      taken.add(found);
      return found;
    };
    return new Map(names.map((name) => [name, free(name)]));
  }

  /** Renames the selected node. */
  rename(to: string): void {
    if (this.selected !== null) this.#name('rename_node', this.selected, to);
  }

  #name(op: 'duplicate_node' | 'rename_node', name: string, to: string): void {
    this.wanted = to;
    const gesture = newGesture();
    const places = this.places;
    const place = places.get(name);
    if (place && op === 'rename_node') this.place(new Map([...places].map(([key, at]) => [key === name ? to : key, at])), gesture);
    this.patch([{ op, name, to }], gesture);
    const pups = this.value(['nodes', name, 'pups']);
    if (pups !== undefined && entry(pups, 'points') === undefined) this.say(`A pups texture draws by its name: ${to} looks different`);
  }

  /** Returns an unused name for a node. */
  freeName(wanted: string, taken = new Set(this.graph?.order ?? [])): string {
    const names = [wanted, ...Array.from({ length: 999 }, (_, i) => `${wanted}_${i + 2}`)];
    return names.find((name) => !taken.has(name)) ?? `${wanted}_${Date.now()}`;
  }

  #receive(message: Reply): void {
    if (message.type === 'document' && this.#resuming) return this.#resume();
    this.document.receive(message);
    this.#take(message);
    this.pending = this.document.pending;
    this.#settle();
    this.#judge();
    for (const then of this.#listeners) then(message);
  }

  #settle(): void {
    const before = this.settled;
    this.settled = this.#editor !== null && this.document.pending === 0 && this.rendering.shows(this.document.made);
    if (!this.settled || before) return;
    // The images are painted in the next frame; the task after it runs when the frame is done.
    const since = this.#since;
    requestAnimationFrame(() => setTimeout(() => (this.painted = performance.now() - since)));
  }

  #take(message: Reply): void {
    switch (message.type) {
      case 'hello':
        return this.#hello(message);
      case 'document':
        this.opened += 1;
        this.looking.window = null;
        this.rendering.reset();
        this.#named();
        return this.#restore();
      case 'diagnostics':
        return this.#problems(message.rev, message.items);
      case 'graph':
        this.graph = message;
        if (this.wanted !== null && message.order.includes(this.wanted)) {
          this.select(this.wanted);
          this.wanted = null;
        }
        if (this.selected !== null && !message.order.includes(this.selected)) this.selected = null;
        return;
      case 'values':
        return this.#values(message.recipe, message.parameters);
      case 'began':
        return this.rendering.began(message);
      case 'rendered':
        this.rendering.rendered(message, this.document.rev);
        if (message.rev !== undefined) this.#verdict = { rev: message.rev, accepted: true };
        if (this.looking.playing) this.looking.took(message.ms);
        if (!message.draft && !this.looking.playing && !this.looking.dragging) this.said = `Rendered in ${Math.round(message.ms)} ms`;
        return;
      case 'seams':
        this.seams = message.maps;
        return;
      case 'points':
        this.points = settle(message, this.points);
        return;
      case 'saved':
        Object.assign(this.document, { file: message.file, hash: message.hash, kept: this.document.text });
        this.say(`Saved ${message.file}`);
        this.#listed(message.file);
        return this.#named();
      case 'disk':
        return this.#onDisk(message);
      case 'refused':
        if (message.what === 'save' && this.sheet === 'save') return;
        this.refusal = message;
        this.say(message.message);
        return;
      default:
        return;
    }
  }

  #hello(message: Hello): void {
    const again = this.hello !== null;
    this.hello = message;
    this.looking.limit = message.limits.size;
    this.looking.whole = message.limits.whole ?? message.limits.size;
    this.#editor?.lock(this.reading);
    this.#resuming = again && this.document.text !== '';
    if (!again && message.open === null) this.sheet = 'start';
    if (!again && !this.reading && !this.alone) this.#reopened = recallOpen(message.open);
    if (!again && !this.reading) this.#kept = recall();
    if (this.#reopened) {
      this.sheet = 'none';
      this.send({ type: 'open', ...this.#reopened });
    }
    if (this.#resuming && message.open === null) this.#resume();
    this.send({ type: 'gallery', size: 128 });
  }

  /** Adds a file to the list of recipes, and requests its thumbnail. */
  #listed(file: string): void {
    if (!this.hello || this.hello.files.includes(file)) return;
    this.hello = { ...this.hello, files: [...this.hello.files, file].sort() };
    this.send({ type: 'gallery', size: 128 });
  }

  /** Continues with the text of this page in a new session. */
  #resume(): void {
    this.#resuming = false;
    this.document.resume();
  }

  /**
   * Handles a change of the file on disk. Without local changes the new text is loaded; otherwise the user is asked.
   */
  #onDisk(message: { text: string; hash: string; file: string }): void {
    if (message.text === this.document.text) {
      Object.assign(this.document, { hash: message.hash, kept: message.text });
      return this.textChanged();
    }
    this.disk = message;
    if (this.reading || !this.changed) this.takeDisk();
    else this.sheet = 'disk';
  }

  /** Loads the text of the file from disk. Undo restores the previous text. */
  takeDisk(): void {
    if (!this.disk) return;
    Object.assign(this.document, { hash: this.disk.hash, kept: this.disk.text });
    this.document.replace(this.disk.text);
    this.disk = null;
    this.sheet = 'none';
    this.textChanged();
  }

  /** Restores unsaved changes after a reload. Undo reverts them. */
  #restore(): void {
    const kept = this.#kept;
    const opened = this.#reopened;
    // The recipe of the command line comes first. Wait for the one that was open before the reload.
    if (opened && (opened.file ?? opened.builtin) !== (this.document.file ?? this.document.name)) return;
    this.#reopened = this.#kept = null;
    if (!kept || kept.name !== this.document.name || kept.file !== this.document.file) return;
    this.document.replace(kept.text);
    this.say('Changes from before the reload are back');
  }

  #named(): void {
    this.name = this.document.name;
    this.file = this.document.file;
    const what = this.file !== null ? { file: this.file } : { builtin: this.name };
    const known = this.file !== null || this.hello?.builtins.some(({ name }) => name === this.name);
    if (this.hello && !this.#reopened) rememberOpen(this.hello.open, known ? what : null);
    this.textChanged();
  }

  #problems(rev: number, items: Problem[]): void {
    if (rev < this.document.made) return;
    this.#verdict = { rev, accepted: items.length === 0 };
    const before = this.problems.length;
    this.problems = items;
    this.#editor?.problems(items);
    const [first] = items;
    if (first) this.say(`Error: ${first.message}`);
    else if (before > 0) this.say('The recipe is valid again');
  }

  #picture(picture: Frame): void {
    const name = this.#pictureName(picture.map);
    if (name === null) return;
    this.rendering.picture(name, picture);
    this.#settle();
    // Acknowledge on arrival rather than when the image is drawn: undrawn images are simply replaced, and the next one
    // need not wait for a frame.
    this.send({ type: 'ack', generation: picture.generation, map: picture.map });
  }

  #pictureName(map: number): string | null {
    if (map === MAP.node) return 'node';
    if (map === MAP.preview) return 'preview';
    if (map >= MAP.strip) return `strip:${map - MAP.strip}`;
    if (map >= MAP.file) return `file:${this.hello?.files[map - MAP.file]}`;
    if (map >= MAP.builtin) return `builtin:${this.hello?.builtins[map - MAP.builtin]?.name}`;
    if (map >= MAP.thumbnail) return `thumb:${this.graph?.nodes[map - MAP.thumbnail]?.name}`;
    return this.hello?.maps[map]?.name ?? null;
  }
}

/** Reuses the previous points where they are equal, so that unchanged points are not drawn again. */
function settle(now: Points, before: Points | null): Points {
  if (before?.node !== now.node) return now;
  const points = now.points.map((point, index) => {
    const old = before.points[index];
    return old && JSON.stringify(old) === JSON.stringify(point) ? old : point;
  });
  return { ...now, points };
}

function extentOf(value: Json | undefined): [number, number] {
  const [w, h] = (value ?? [1, 1]) as number[];
  return typeof w === 'number' && typeof h === 'number' && w > 0 && h > 0 ? [w, h] : [1, 1];
}
