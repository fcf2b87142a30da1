// Begins the page.
import '@xyflow/svelte/dist/style.css';
import './app.css';
import { mount } from 'svelte';
import App from './App.svelte';
import { Socket, token, type Transport } from './core/transport';
import { Studio } from './studio.svelte';

const given = (globalThis as { dappleTransport?: Transport }).dappleTransport;
const target = document.getElementById('app');
if (target) mount(App, { target, props: { studio: new Studio(given ?? new Socket(token())) } });
