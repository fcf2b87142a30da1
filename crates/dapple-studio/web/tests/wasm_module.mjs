// Calls the studio in WebAssembly from Node, as the worker of the page does.
import { readFileSync } from 'node:fs';

/** A studio: send it messages, and read what it made once its work is done. */
export class WasmStudio {
  static async load(path) {
    const { instance } = await WebAssembly.instantiate(readFileSync(path), { worker: { now: () => performance.now() } });
    return Object.assign(new WasmStudio(), { wasm: instance.exports });
  }

  send(message) {
    const bytes = new TextEncoder().encode(JSON.stringify(message));
    const place = this.wasm.alloc(bytes.length);
    new Uint8Array(this.wasm.memory.buffer, place, bytes.length).set(bytes);
    this.wasm.receive();
  }

  /** Works for one piece; false when nothing is left to be done. */
  step() {
    return this.wasm.step() !== 0;
  }

  /** All that was made: messages, pictures as { head, pixels }, files as bytes. */
  *made() {
    for (let kind = this.wasm.poll(); kind !== 0; kind = this.wasm.poll()) {
      const at = this.wasm.reply();
      const bytes = Buffer.from(this.wasm.memory.buffer.slice(at, at + this.wasm.reply_length()));
      if (kind === 1) yield JSON.parse(bytes.toString());
      else if (kind === 2) yield { type: 'picture', generation: bytes.readUInt32LE(4), map: bytes.readUInt16LE(8), draft: (bytes[30] & 1) !== 0, last: (bytes[30] & 2) !== 0, pixels: bytes.subarray(32) };
      else yield { type: 'file', bytes };
    }
  }

  /** Works until all is done, and gives all that was made. */
  finish() {
    while (this.step());
    return [...this.made()];
  }
}
