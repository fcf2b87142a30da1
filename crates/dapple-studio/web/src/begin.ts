// Starts the page with a transport to the studio.
import '@xyflow/svelte/dist/style.css';
import './app.css';
import { mount } from 'svelte';
import App from './App.svelte';
import type { Transport } from './core/transport';
import { Studio } from './studio.svelte';

export function begin(transport: Transport): void {
  const target = document.getElementById('app');
  if (target) mount(App, { target, props: { studio: new Studio(transport) } });
}
