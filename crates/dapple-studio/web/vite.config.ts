// The build: one page into ../dist, six files or so without hashes in their names, which the command embeds.
// The development server hands the socket and the files on to a running `dapple studio`, whose address is
// DAPPLE_STUDIO (http://127.0.0.1:7878 by default).
import { svelte } from '@sveltejs/vite-plugin-svelte';
import { defineConfig } from 'vite';

const studio = process.env['DAPPLE_STUDIO'] ?? 'http://127.0.0.1:7878';
const behind = { target: studio, changeOrigin: true, headers: { origin: studio } };

export default defineConfig({
  plugins: [svelte()],
  build: {
    outDir: '../dist',
    emptyOutDir: true,
    target: 'es2022',
    modulePreload: { polyfill: false },
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 800,
    cssCodeSplit: false,
    rollupOptions: {
      output: {
        entryFileNames: 'assets/studio.js',
        chunkFileNames: 'assets/[name].js',
        assetFileNames: 'assets/[name][extname]',
      },
    },
  },
  server: { proxy: { '/ws': { ...behind, ws: true }, '/export': behind, '/image': behind } },
});
