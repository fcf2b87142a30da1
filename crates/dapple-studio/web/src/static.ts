// Entry point of the page without a server: the studio runs in a worker.
import { begin } from './begin';
import { Wasm } from './core/wasm';

begin(new Wasm());
