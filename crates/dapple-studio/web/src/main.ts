// Begins the page that `dapple studio` serves. The way to the server opens while the page is loaded.
import { Socket, token } from './core/transport';

const page = import('./begin');
const socket: Socket = new Socket(token(), page.then(({ begin }) => begin(socket)));
