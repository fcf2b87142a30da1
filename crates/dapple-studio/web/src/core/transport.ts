// What carries messages: here a WebSocket to `dapple studio`, and in wasm.ts a worker with WebAssembly. Nothing else in the
// page knows which.
import type { Frame, Reply, Request } from './protocol';
import { frame } from './protocol';

/** A way to whatever computes. */
export interface Transport {
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

/** A socket to the server that the page came from. */
export class Socket implements Transport {
  onmessage: (message: Reply) => void = () => {};
  onpicture: (picture: Frame) => void = () => {};
  onstate: (state: 'open' | 'closed' | 'refused') => void = () => {};
  #socket: WebSocket | null = null;
  #waiting: Request[] = [];
  #closed = false;

  constructor(private readonly token: string) {
    queueMicrotask(() => this.#connect());
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
    const socket = new WebSocket(`${scheme}://${location.host}/ws?t=${encodeURIComponent(this.token)}`);
    let opened = false;
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => {
      opened = true;
      this.onstate('open');
      for (const message of this.#waiting.splice(0)) socket.send(JSON.stringify(message));
    };
    socket.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => {
      if (typeof data === 'string') this.onmessage(JSON.parse(data) as Reply);
      else this.onpicture(frame(data));
    };
    socket.onclose = () => {
      this.#waiting = [];
      if (this.#closed) return;
      this.onstate(opened || this.token !== '' ? 'closed' : 'refused');
      setTimeout(() => this.#connect(), AGAIN);
    };
    this.#socket = socket;
  }
}
