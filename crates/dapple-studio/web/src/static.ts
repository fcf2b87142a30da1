// Begins the page without a server: its studio is a worker.
import { begin } from './begin';
import { Wasm } from './core/wasm';

begin(new Wasm());
