// The state of the page, shared with all components.
import { getContext, setContext } from 'svelte';
import type { Studio } from './studio.svelte';

const key = Symbol('studio');

export function provide(studio: Studio): void {
  setContext(key, studio);
}

export function useStudio(): Studio {
  return getContext<Studio>(key);
}
