// The rendered images, their cost, and whether they belong to the newest text and view.
import { Pictures, type Picture } from './core/pictures';
import { MAP, type Began, type Frame, type Rendered, type View } from './core/protocol';

/** Number of generations that are remembered. */
const GENERATIONS = 8;

/** The images of a recipe, with their statistics. */
export class Rendering {
  readonly pictures = new Pictures();
  /** The last message `rendered`. */
  last = $state.raw<Rendered | null>(null);
  /** Rendering time of each node, in milliseconds. */
  took = $state.raw<Map<string, number>>(new Map());
  /** The values shown as black and as white in the images of nodes. */
  ranges = $state.raw<Map<string, [number, number] | null>>(new Map());
  /** The images that newer ones are compared with. */
  mark = $state.raw<Map<string, Picture>>(new Map());
  #began = new Map<number, Began>();
  #view: View | null = null;
  #marking = true;
  /**
   * Whether the newest view was rendered in full. `#drawn` also counts drafts. `#full` is the newest revision rendered
   * in full.
   */
  #seen = false;
  #drawn = false;
  #full = -1;
  #generation = 0;

  /** Whether the newest view has been rendered, at least as a draft. */
  get drawn(): boolean {
    return this.#drawn;
  }

  /** Records a request for another view. */
  asked(view: View): void {
    this.#view = view;
    this.#seen = this.#drawn = false;
  }

  /** Resets the state when another recipe is opened. */
  reset(): void {
    this.pictures.forget((name) => !/^(builtin|file):/.test(name));
    this.#marking = true;
    this.#full = -1;
  }

  /** Whether the full-size images belong to at least this revision and to the newest view. */
  shows(rev: number): boolean {
    return this.#seen && this.#full >= rev && this.#areThere();
  }

  began(message: Began): void {
    this.#began.set(message.generation, message);
    const [oldest] = this.#began.keys();
    if (this.#began.size > GENERATIONS && oldest !== undefined) this.#began.delete(oldest);
  }

  /** Handles a message `rendered`. If it has no revision, `rev` is used. */
  rendered(message: Rendered, rev: number): void {
    this.last = message;
    if (message.nodes) this.#cost(message.nodes);
    const isOfView = this.#isOfView(message.generation);
    this.#drawn ||= isOfView;
    if (message.draft) return;
    this.#seen ||= isOfView;
    this.#full = message.rev ?? rev;
    this.#generation = message.generation;
    this.#marks();
  }

  /** Stores the current images for comparison with later ones, as soon as they are not drafts. */
  markNow(): void {
    this.#marking = true;
    this.#marks();
  }

  #marks(): void {
    if (!this.#marking || !this.#seen || !this.#areThere()) return;
    this.#marking = false;
    this.mark = this.pictures.snapshot();
  }

  /** Adds a frame to the image with this name. */
  picture(name: string, frame: Frame): void {
    const alone = frame.map === MAP.preview || frame.map >= MAP.thumbnail;
    const size = this.#began.get(frame.generation)?.size ?? this.#view?.size ?? [frame.w, frame.h];
    this.pictures.add(name, frame, alone ? [frame.w * frame.scale, frame.h * frame.scale] : size);
    this.#marks();
  }

  /** Whether all images of the last report have arrived. An image delayed by flow control arrives after the report. */
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
    // Compare `draft`, too: the last frame of a stopped loop does not answer the new view, whose draft is still to
    // come.
    const told = (one: Began | View) => JSON.stringify([one.size, one.region, one.node, one.time, one.draft]);
    const [has, wants] = [began, this.#view].map((one) => one && told(one));
    return began === undefined || has === wants;
  }

  /** Records the rendering times of nodes. A node taken from a cache keeps the time of its last computation. */
  #cost(nodes: NonNullable<Rendered['nodes']>): void {
    const cost = ({ name, ms }: { name: string; ms: number }) => (ms < 0.05 ? Math.max(ms, this.took.get(name) ?? 0) : ms);
    this.took = new Map(nodes.map((node) => [node.name, cost(node)]));
    this.ranges = new Map(nodes.map(({ name, range }) => [name, range ?? null]));
  }
}
