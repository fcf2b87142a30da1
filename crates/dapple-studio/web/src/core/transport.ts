// Transports of messages: here a WebSocket to `dapple studio`, and in wasm.ts a WebAssembly worker. The rest of the
// page is independent of the transport.
import type { Frame, Reply, Request, View } from './protocol';
import { FIRST, frame } from './protocol';

/** A connection to the studio. */
export interface Transport {
  /** The view that was requested before the page was loaded, if any. */
  readonly first: View | null;
  send(message: Request): void;
  /** Called for each message. */
  onmessage: (message: Reply) => void;
  /** Called for each image. */
  onpicture: (picture: Frame) => void;
  /** Called when the connection opens, closes or is refused. */
  onstate: (state: 'open' | 'closed' | 'refused') => void;
  /** The address of an exported file. */
  exportUrl(id: string, name: string): string;
  close(): void;
}

/** Messages about the state of the page, which it sends again after reconnecting. */
const STATE = ['doc', 'patch', 'view', 'ack'];

/** Delay in milliseconds before reconnecting. */
const AGAIN = 1000;

/** Returns the token from the address, and removes it from the address. The token is stored until the tab closes. */
export function token(): string {
  const kept = 'dapple-token';
  const given = location.hash.replace(/^#(t=)?/, '');
  if (given !== '') {
    sessionStorage.setItem(kept, given);
    history.replaceState(null, '', location.pathname + location.search);
  }
  return sessionStorage.getItem(kept) ?? '';
}

/**
 * A socket to the server of the page. It requests the initial view at once. Messages that arrive early wait for the
 * page.
 */
export class Socket implements Transport {
  readonly first = FIRST;
  onmessage: (message: Reply) => void = () => {};
  onpicture: (picture: Frame) => void = () => {};
  onstate: (state: 'open' | 'closed' | 'refused') => void = () => {};
  #socket: WebSocket | null = null;
  #waiting: Request[] = [];
  #closed = false;
  #again: ReturnType<typeof setTimeout> | undefined;
  /** Whether the socket was open before. After reconnecting, the page requests its current view itself. */
  #opened = false;

  /** `ready` resolves when the page is loaded and can receive messages. */
  constructor(
    private token: string,
    private readonly ready: Promise<void>,
  ) {
    this.#connect();
    // The address of a new run, pasted into this tab, may differ from the last one only in its fragment.
    addEventListener('hashchange', () => this.#renew());
  }

  send(message: Request): void {
    if (this.#socket?.readyState === WebSocket.OPEN) this.#socket.send(JSON.stringify(message));
    else if (!this.#opened || !STATE.includes(message.type)) this.#waiting.push(message);
  }

  exportUrl(id: string, name: string): string {
    return `export/${encodeURIComponent(id)}/${encodeURIComponent(name)}?t=${encodeURIComponent(this.token)}`;
  }

  close(): void {
    this.#closed = true;
    this.#socket?.close();
  }

  /** Reconnects with the token in the address, if it differs. */
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
    // The path is relative, since a proxy may serve the page below a path.
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
      const state = !opened && (await answers()) ? 'refused' : 'closed';
      if (this.#closed || this.#socket !== socket) return;
      tell(() => this.onstate(state));
      this.#again = setTimeout(() => this.#connect(), AGAIN);
    };
  }
}

/** Whether the server responds. If it does but refuses the socket, the token is wrong. */
async function answers(): Promise<boolean> {
  try {
    return (await fetch(location.pathname, { method: 'HEAD' })).ok;
  } catch {
    return false;
  }
}
