// The transport to the studio in WebAssembly, in a worker. The address may name a recipe: `#marble` or
// `?recipe=marble` for a built-in recipe, or `#toml=…` with the text of any recipe.
import type { Reply, Request } from './protocol';
import { frame } from './protocol';
import { download, textOf } from './share';
import type { Transport } from './transport';

/** A result of the worker: an image, a message with the files that it lists, or the error of loading the module. */
type Sent = ArrayBuffer | { reply: Reply; files: ArrayBuffer[] } | { failed: string };

/** The studio in a worker of this page. */
export class Wasm implements Transport {
  readonly first = null;
  onmessage: Transport['onmessage'] = () => {};
  onpicture: Transport['onpicture'] = () => {};
  onstate: Transport['onstate'] = () => {};
  #worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });
  #urls = new Map<string, string>();
  #exports = 0;
  #greeted = false;

  constructor() {
    this.#worker.onmessage = ({ data }: MessageEvent<Sent>) => void this.#take(data);
    this.#worker.postMessage(new URL('dapple.wasm', document.baseURI).href);
    addEventListener('hashchange', () => location.reload());
  }

  send(message: Request): void {
    if (message.type === 'save') this.#save(message.text, message.file);
    else if (message.type !== 'ack') this.#worker.postMessage(message);
  }

  exportUrl(id: string, name: string): string {
    return this.#urls.get(`${id}/${name}`) ?? '';
  }

  close(): void {
    this.#worker.terminate();
  }

  async #take(sent: Sent): Promise<void> {
    if (sent instanceof ArrayBuffer) return this.onpicture(frame(sent));
    if ('failed' in sent) {
      const message = `the studio cannot be loaded: ${sent.failed}`;
      return this.onmessage({ type: 'refused', what: 'open', message, hint: null });
    }
    const { reply, files } = sent;
    if (reply.type === 'hello') return this.#greet(reply);
    if (reply.type === 'exported') reply.id = this.#keep(reply.files.map(({ name }) => name), files);
    this.onmessage(reply);
  }

  /** Forwards the greeting and opens the recipe of the address. */
  async #greet(hello: Reply & { type: 'hello' }): Promise<void> {
    const first = this.#greeted ? null : await named(hello.builtins.map(({ name }) => name));
    this.#greeted = true;
    hello.open = first ? (first.builtin ?? '') : null;
    this.onstate('open');
    this.onmessage(hello);
    if (first) this.send({ type: 'open', ...first });
  }

  /** Stores the files of an export, replacing the previous ones, and returns the id of the export. */
  #keep(names: string[], files: ArrayBuffer[]): string {
    for (const url of this.#urls.values()) URL.revokeObjectURL(url);
    const id = String((this.#exports += 1));
    this.#urls = new Map(names.map((name, index) => [`${id}/${name}`, URL.createObjectURL(new Blob([files[index] ?? '']))]));
    return id;
  }

  #save(text: string, file: string): void {
    download(text, file);
    this.onmessage({ type: 'saved', file, hash: '' });
  }
}

/** The recipe in the address, if any. */
async function named(builtins: string[]): Promise<{ builtin?: string; text?: string } | null> {
  const text = await textOf(location.hash);
  if (text !== null) return { text };
  const name = location.hash.slice(1) || new URLSearchParams(location.search).get('recipe');
  return name !== null && builtins.includes(name) ? { builtin: name } : null;
}
