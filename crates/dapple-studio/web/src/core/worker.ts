// The worker of the page without a server: runs the studio in WebAssembly and processes messages between steps of
// work.
//
// It receives the address of the module first, then messages. It sends messages and images. The files of an export are
// sent with the message that lists them. After a failure of the module, a new instance starts, and the page keeps its
// own text.
import type { Reply, Request } from './protocol';

/** The exports of the WebAssembly module: see crates/dapple-web/src/abi.rs. */
interface Module {
  memory: WebAssembly.Memory;
  alloc(length: number): number;
  receive(): void;
  step(): number;
  poll(): number;
  reply(): number;
  reply_length(): number;
}

/** Time in milliseconds within which a second failure is final. */
const AGAIN = 5000;
const [MESSAGE, PICTURE] = [1, 2];

let program: WebAssembly.Module | null = null;
let module: Module | null = null;
let failed = -Infinity;
const waiting: Request[] = [];
// A message that the worker sends to itself is queued after the pending messages of the page.
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
  module = instance.exports as unknown as Module;
  give(module);
  for (const message of waiting.splice(0)) send(module, message);
  ring();
}

function send(module: Module, message: Request): void {
  const bytes = new TextEncoder().encode(JSON.stringify(message));
  const place = module.alloc(bytes.length);
  new Uint8Array(module.memory.buffer, place, bytes.length).set(bytes);
  module.receive();
}

/** Sends all queued results to the page. */
function give(module: Module): void {
  const bytesOfReply = () => module.memory.buffer.slice(module.reply(), module.reply() + module.reply_length()) as ArrayBuffer;
  for (let kind = module.poll(); kind !== 0; kind = module.poll()) {
    const bytes = bytesOfReply();
    if (kind === PICTURE) postMessage(bytes, { transfer: [bytes] });
    if (kind !== MESSAGE) continue;
    const reply = JSON.parse(new TextDecoder().decode(bytes)) as Reply;
    const files = reply.type !== 'exported' ? [] : reply.files.map(() => (module.poll(), bytesOfReply()));
    postMessage({ reply, files }, { transfer: files });
  }
}

/** Calls the module. After a failure, a new instance starts. */
function attempt(part: (module: Module) => void): void {
  if (!module) return;
  try {
    part(module);
  } catch (error) {
    module = null;
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
  attempt((module) => {
    const more = module.step() !== 0;
    give(module);
    if (more) ring();
  });
};

onmessage = ({ data }: MessageEvent<Request | string>) => {
  if (typeof data === 'string') {
    load(data).catch((error: unknown) => postMessage({ failed: String(error) }));
  } else if (module) {
    attempt((module) => {
      send(module, data);
      give(module);
      ring();
    });
  } else waiting.push(data);
};
