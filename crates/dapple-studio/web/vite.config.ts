// The build: one page into ../dist, six files or so without hashes in their names, which the command embeds; those that
// are large beside them once more, compressed, which is what it embeds then.
// `vite build --mode static` makes the page without a server, which `cargo xtask web` completes: the same but for its entry,
// the worker, and a content security policy in the page, since its host is anybody's.
// The development server hands the socket and the files on to a running `dapple studio`, whose address is
// DAPPLE_STUDIO (http://127.0.0.1:7878 by default).
import { svelte } from '@sveltejs/vite-plugin-svelte';
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';
import { defineConfig, type Plugin } from 'vite';

const studio = process.env['DAPPLE_STUDIO'] ?? 'http://127.0.0.1:7878';
const behind = { target: studio, changeOrigin: true, headers: { origin: studio } };

const ignored = new URL('../dist/.gitignore', import.meta.url);
const kept = readFileSync(ignored);

/** Writes each script and style once more as NAME.gz, and keeps the file that hides the folder from git. */
function compressed(): Plugin {
  return {
    name: 'compressed',
    apply: 'build',
    writeBundle({ dir = '' }) {
      writeFileSync(ignored, kept);
      for (const name of readdirSync(dir, { recursive: true, encoding: 'utf8' })) {
        if (!/\.(js|css)$/.test(name)) continue;
        writeFileSync(join(dir, `${name}.gz`), gzipSync(readFileSync(join(dir, name)), { level: 9 }));
      }
    },
  };
}

/** Loads the page beside its entry, which asks for it later. */
function preloaded(): Plugin {
  return {
    name: 'preloaded',
    transformIndexHtml: {
      order: 'post',
      handler: (_, { bundle = {} }) => {
        const chunks = Object.values(bundle).filter((file) => file.type === 'chunk');
        const begin = chunks.find(({ name }) => name === 'begin');
        const files = begin ? [begin.fileName, ...begin.imports] : [];
        const later = files.filter((file) => !chunks.some(({ isEntry, fileName }) => isEntry && fileName === file));
        return later.map((file) => ({ tag: 'link', attrs: { rel: 'modulepreload', href: `./${file}` }, injectTo: 'head' as const }));
      },
    },
  };
}

/** What the page without a server may load and run. */
const POLICY = [
  "default-src 'self'",
  "script-src 'self' 'wasm-unsafe-eval'",
  "img-src 'self' blob: data:",
  "object-src 'none'",
  "base-uri 'none'",
  "form-action 'none'",
].join('; ');

/** The page with another entry and its policy. */
function withoutServer(): Plugin {
  return {
    name: 'without-server',
    transformIndexHtml: {
      order: 'pre',
      handler: (html) => ({
        html: html.replace('/src/main.ts', '/src/static.ts'),
        tags: [{ tag: 'meta', attrs: { 'http-equiv': 'content-security-policy', content: POLICY }, injectTo: 'head-prepend' }],
      }),
    },
  };
}

export default defineConfig(({ mode }) => ({
  plugins: [svelte(), ...(mode === 'static' ? [withoutServer()] : [preloaded(), compressed()])],
  // The page without a server may lie in any folder.
  base: './',
  worker: { format: 'es', rollupOptions: { output: { entryFileNames: 'assets/worker.js' } } },
  build: {
    outDir: '../dist',
    emptyOutDir: true,
    target: 'es2022',
    modulePreload: { polyfill: false },
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 800,
    cssCodeSplit: false,
    // The licenses of all that is in the page, which are served with it.
    license: { fileName: 'licenses.md' },
    rollupOptions: {
      output: {
        entryFileNames: 'assets/studio.js',
        chunkFileNames: 'assets/[name].js',
        assetFileNames: 'assets/[name][extname]',
      },
    },
  },
  server: { proxy: { '/ws': { ...behind, ws: true }, '/export': behind, '/image': behind } },
}));
