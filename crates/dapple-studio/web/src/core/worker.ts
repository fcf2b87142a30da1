// The worker of the page without a server: the studio in WebAssembly, which hears messages and works between them.
//
// It is told the address of the program first, then messages. It sends messages and pictures; files of an export come with
// the message that names them. Where the program fails, a new one begins, and the page goes on with its own text.
import type { Reply, Request } from './protocol';

/** What the program gives and takes: see crates/dapple-web/src/door.rs. */
interface Door {
  memory: WebAssembly.Memory;
  room(length: number): number;
  hear(): void;
  step(): number;
  take(): number;
  taken(): number;
  taken_length(): number;
}

/** Milliseconds within which a second failure ends it. */
const AGAIN = 5000;
const [MESSAGE, PICTURE] = [1, 2];

let program: WebAssembly.Module | null = null;
let door: Door | null = null;
let failed = -Infinity;
const waiting: Request[] = [];
// A message to itself comes after those of the page that came before.
const { port1: bell, port2: rope } = new MessageChannel();
let rung = false;

function ring(): void {
  if (!rung) rope.postMessage(0);
  rung = true;
}

async function load(address: string): Promise<void> {
  const response = await fetch(address);
  if (!response.ok) throw new Error(`${address}: ${response.status}`);
  const streams = response.headers.get('content-type') === 'application/wasm';
  program = await (streams ? WebAssembly.compileStreaming(response) : WebAssembly.compile(await response.arrayBuffer()));
  await begin();
}

async function begin(): Promise<void> {
  if (!program) return;
  const instance = await WebAssembly.instantiate(program, { worker: { now: () => performance.now() } });
  door = instance.exports as unknown as Door;
  give(door);
  for (const message of waiting.splice(0)) hear(door, message);
  ring();
}

function hear(door: Door, message: Request): void {
  const bytes = new TextEncoder().encode(JSON.stringify(message));
  const place = door.room(bytes.length);
  new Uint8Array(door.memory.buffer, place, bytes.length).set(bytes);
  door.hear();
}

/** Gives the page what was made. */
function give(door: Door): void {
  const taken = () => door.memory.buffer.slice(door.taken(), door.taken() + door.taken_length()) as ArrayBuffer;
  for (let kind = door.take(); kind !== 0; kind = door.take()) {
    const bytes = taken();
    if (kind === PICTURE) postMessage(bytes, { transfer: [bytes] });
    if (kind !== MESSAGE) continue;
    const reply = JSON.parse(new TextDecoder().decode(bytes)) as Reply;
    const files = reply.type !== 'exported' ? [] : reply.files.map(() => (door.take(), taken()));
    postMessage({ reply, files }, { transfer: files });
  }
}

/** Runs a part of the program; after a failure another one begins. */
function attempt(part: (door: Door) => void): void {
  if (!door) return;
  try {
    part(door);
  } catch (error) {
    door = null;
    console.error(error);
    const often = performance.now() - failed < AGAIN;
    failed = performance.now();
    const message = 'this failed, which is a defect of dapple';
    const reply: Reply = { type: 'refused', what: 'view', message, hint: often ? 'change the text, then load the page again' : null };
    postMessage({ reply, files: [] });
    if (!often) void begin();
  }
}

bell.onmessage = () => {
  rung = false;
  attempt((door) => {
    const more = door.step() !== 0;
    give(door);
    if (more) ring();
  });
};

onmessage = ({ data }: MessageEvent<Request | string>) => {
  if (typeof data === 'string') {
    load(data).catch((error: unknown) => postMessage({ failed: String(error) }));
  } else if (door) {
    attempt((door) => {
      hear(door, data);
      give(door);
      ring();
    });
  } else waiting.push(data);
};
