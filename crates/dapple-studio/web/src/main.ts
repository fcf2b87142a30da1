// Entry point of the page served by `dapple studio`. The connection to the server opens while the page loads.
import { Socket, token } from './core/transport';

const page = import('./begin');
const socket: Socket = new Socket(token(), page.then(({ begin }) => begin(socket)));
