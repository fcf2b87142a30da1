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
  #again: ReturnType<typeof setTimeout> | undefined;
  /** Whether it was open once: a page that comes back asks again for what it shows. */
  #opened = false;

  /** `ready` is over when there is a page, which hears. */
  constructor(
    private token: string,
    private readonly ready: Promise<void>,
  ) {
    this.#connect();
    // The address of a new run, pasted into this tab, differs from that of the last one in what follows # alone.
    addEventListener('hashchange', () => this.#renew());
  }

  send(message: Request): void {
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify(message));
    else this.#waiting.push(message);
  }

  exportUrl(id: string, name: string): string {
    return `export/${encodeURIComponent(id)}/${encodeURIComponent(name)}?t=${encodeURIComponent(this.token)}`;
  }

  close(): void {
    this.#closed = true;
    this.#socket?.close();
  }

  /** Goes on with the token of the address, if it is another one. */
  #renew(): void {
    const given = token();
    if (given === this.token || this.#closed) return;
    this.token = given;
    clearTimeout(this.#again);
    const before = this.#socket;
    this.#connect();
    before?.close();
  }

  #connect(): void {
    const view = this.#opened ? '' : `&view=${encodeURIComponent(JSON.stringify(FIRST))}`;
    // Beside the page, since a proxy may have put it below a path.
    const url = new URL(`ws?t=${encodeURIComponent(this.token)}${view}`, location.href);
    url.protocol = location.protocol === 'https:' ? 'wss:' : 'ws:';
    const socket = (this.#socket = new WebSocket(url));
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
    socket.onclose = async () => {
      if (this.#closed || this.#socket !== socket) return;
      this.#waiting = [];
      const state = !opened && (await answers()) ? 'refused' : 'closed';
      if (this.#closed || this.#socket !== socket) return;
      tell(() => this.onstate(state));
      this.#again = setTimeout(() => this.#connect(), AGAIN);
    };
  }
}

/** Whether there is a server: where it refuses the socket, it has another secret. */
async function answers(): Promise<boolean> {
  try {
    return (await fetch(location.pathname, { method: 'HEAD' })).ok;
  } catch {
    return false;
  }
}
