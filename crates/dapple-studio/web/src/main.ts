// Begins the page that `dapple studio` serves.
import { begin } from './begin';
import { Socket, token } from './core/transport';

begin(new Socket(token()));
