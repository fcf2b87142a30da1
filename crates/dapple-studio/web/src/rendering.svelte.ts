// What was drawn: the pictures, what they cost, and whether they are those of the newest text and view.
import { Pictures, type Picture } from './core/pictures';
import { MAP, type Began, type Frame, type Rendered, type View } from './core/protocol';

/** So many generations are remembered. */
const GENERATIONS = 8;

/** The pictures of a recipe, and what is known of them. */
export class Rendering {
  readonly pictures = new Pictures();
  /** The last report. */
  last = $state.raw<Rendered | null>(null);
  /** Milliseconds of each node. */
  took = $state.raw<Map<string, number>>(new Map());
  /** The numbers that are black and white in the pictures of nodes. */
  ranges = $state.raw<Map<string, [number, number] | null>>(new Map());
  /** The pictures that newer ones are compared with. */
  mark = $state.raw<Map<string, Picture>>(new Map());
  #began = new Map<number, Began>();
  #view: View | null = null;
  #marking = true;
  /** Whether the newest view was drawn, and the newest revision that was drawn in full. */
  #seen = false;
  #drawn = false;
  #full = -1;
  #generation = 0;

  /** Whether a picture of the newest view has come, be it a draft. */
  get drawn(): boolean {
    return this.#drawn;
  }

  /** Another view was asked for. */
  asked(view: View): void {
    this.#view = view;
    this.#seen = this.#drawn = false;
  }

  /** Another recipe was opened. */
  reset(): void {
    this.pictures.forget((name) => !/^(builtin|file):/.test(name));
    this.#marking = true;
    this.#full = -1;
  }

  /** Whether the full pictures are those of a revision and of the newest view. */
  shows(rev: number): boolean {
    return this.#seen && this.#full >= rev && this.#areThere();
  }

  began(message: Began): void {
    this.#began.set(message.generation, message);
    const [oldest] = this.#began.keys();
    if (this.#began.size > GENERATIONS && oldest !== undefined) this.#began.delete(oldest);
  }

  /** Takes a report; `rev` is that of the text if the report does not say. */
  rendered(message: Rendered, rev: number): void {
    this.last = message;
    if (message.nodes) this.#cost(message.nodes);
    const isOfView = this.#isOfView(message.generation);
    this.#drawn ||= isOfView;
    if (message.draft) return;
    this.#seen ||= isOfView;
    this.#full = message.rev ?? rev;
    this.#generation = message.generation;
    if (!this.#marking || this.pictures.names().length === 0) return;
    this.markNow();
    this.#marking = false;
  }

  /** Keeps the pictures of now, to be compared with later ones. */
  markNow(): void {
    this.mark = this.pictures.snapshot();
  }

  /** Takes a picture. */
  picture(name: string, frame: Frame): void {
    const alone = frame.map === MAP.preview || frame.map >= MAP.thumbnail;
    const size = this.#began.get(frame.generation)?.size ?? this.#view?.size ?? [frame.w, frame.h];
    this.pictures.add(name, frame, alone ? [frame.w * frame.scale, frame.h * frame.scale] : size);
  }

  /** Whether the pictures of the last report have come: one that waits for others comes after it. */
  #areThere(): boolean {
    const { node = null, exact = null, maps = [] } = this.#view ?? {};
    const names = node !== null ? ['node'] : exact ? ['preview'] : maps;
    return names.every((name) => {
      const picture = this.pictures.get(name);
      return picture !== undefined && picture.generation === this.#generation && !picture.draft && picture.coming.length === 0;
    });
  }

  #isOfView(generation: number): boolean {
    const began = this.#began.get(generation);
    // When a loop is stopped, the last of its pictures is not the answer: a draft is yet to come.
    const told = (one: Began | View) => JSON.stringify([one.size, one.region, one.node, one.time, one.draft]);
    const [has, wants] = [began, this.#view].map((one) => one && told(one));
    return began === undefined || has === wants;
  }

  /** Milliseconds of nodes: those of the last time they were computed, where they come from a cache now. */
  #cost(nodes: NonNullable<Rendered['nodes']>): void {
    const cost = ({ name, ms }: { name: string; ms: number }) => (ms < 0.05 ? Math.max(ms, this.took.get(name) ?? 0) : ms);
    this.took = new Map(nodes.map((node) => [node.name, cost(node)]));
    this.ranges = new Map(nodes.map(({ name, range }) => [name, range ?? null]));
  }
}
