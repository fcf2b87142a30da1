// What carries messages: here a WebSocket to `dapple studio`, and in wasm.ts a worker with WebAssembly. Nothing else in the
// page knows which.
import type { Frame, Reply, Request, View } from './protocol';
import { FIRST, frame } from './protocol';

/** A way to whatever computes. */
export interface Transport {
  /** The view that was asked for before there was a page, if one was. */
  readonly first: View | null;
  send(message: Request): void;
  /** Called with each message. */
  onmessage: (message: Reply) => void;
  /** Called with each picture. */
  onpicture: (picture: Frame) => void;
  /** Called when the way opens and closes. */
  onstate: (state: 'open' | 'closed' | 'refused') => void;
  /** The address of an exported file. */
  exportUrl(id: string, name: string): string;
  close(): void;
}

/** Milliseconds between two tries to connect again. */
const AGAIN = 1000;

/** The token of the address, which leaves it at once; kept until the tab closes. */
export function token(): string {
  const kept = 'dapple-token';
  const given = location.hash.replace(/^#(t=)?/, '');
  if (given !== '') {
    sessionStorage.setItem(kept, given);
    history.replaceState(null, '', location.pathname + location.search);
  }
  return sessionStorage.getItem(kept) ?? '';
}

/** A socket to the server that the page came from. It asks for the first view at once; what arrives waits for the page. */
export class Socket implements Transport {
  readonly first = FIRST;
  onmessage: (message: Reply) => void = () => {};
  onpicture: (picture: Frame) => void = () => {};
  onstate: (state: 'open' | 'closed' | 'refused') => void = () => {};
  #socket: WebSocket | null = null;
  #waiting: Request[] = [];
  #closed = false;
  /** Whether it was open once: a page that comes back asks again for what it shows. */
  #opened = false;

  /** `ready` is over when there is a page, which hears. */
  constructor(
    private readonly token: string,
    private readonly ready: Promise<void>,
  ) {
    this.#connect();
  }

  send(message: Request): void {
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify(message));
    else this.#waiting.push(message);
  }

  exportUrl(id: string, name: string): string {
    return `/export/${encodeURIComponent(id)}/${encodeURIComponent(name)}?t=${encodeURIComponent(this.token)}`;
  }

  close(): void {
    this.#closed = true;
    this.#socket?.close();
  }

  #connect(): void {
    const scheme = location.protocol === 'https:' ? 'wss' : 'ws';
    const view = this.#opened ? '' : `&view=${encodeURIComponent(JSON.stringify(FIRST))}`;
    const socket = new WebSocket(`${scheme}://${location.host}/ws?t=${encodeURIComponent(this.token)}${view}`);
    let opened = false;
    socket.binaryType = 'arraybuffer';
    const tell = (then: () => void) => void this.ready.then(then);
    socket.onopen = () => {
      opened = this.#opened = true;
      tell(() => this.onstate('open'));
      for (const message of this.#waiting.splice(0)) socket.send(JSON.stringify(message));
    };
    socket.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => {
      if (typeof data === 'string') {
        const message = JSON.parse(data) as Reply;
        tell(() => this.onmessage(message));
      } else tell(() => this.onpicture(frame(data)));
    };
    socket.onclose = () => {
      this.#waiting = [];
      if (this.#closed) return;
      tell(() => this.onstate(opened || this.token !== '' ? 'closed' : 'refused'));
      setTimeout(() => this.#connect(), AGAIN);
    };
    this.#socket = socket;
  }
}
