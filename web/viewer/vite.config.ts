import { resolve } from 'node:path';
import { defineConfig, type Plugin } from 'vite';
import { gyreScenes } from './vite.scenes.ts';

// A page that shares memory between workers must be cross-origin isolated; `gyre view` sends the same headers.
const isolated = {
  'Cross-Origin-Opener-Policy': 'same-origin',
  'Cross-Origin-Embedder-Policy': 'require-corp',
};

const worker = resolve(import.meta.dirname, 'src/worker');

// By this file `gyre view` sees that the page runs no scenes.
function sayWithoutEngine(): Plugin {
  return {
    name: 'gyre-without-engine',
    generateBundle() {
      this.emitFile({ type: 'asset', fileName: 'without_engine.txt', source: 'This page plays recordings that gyre view decodes; it runs no scenes.\n' });
    },
  };
}

// `--mode recordings`: the page without the engine, for which neither emscripten nor the package gyre-physics is needed.
export default defineConfig(({ mode }) => {
  const live = mode !== 'recordings';
  return {
    plugins: [live ? gyreScenes() : sayWithoutEngine()],
    base: './', // works below any address
    resolve: { alias: live ? [] : [{ find: /^\.\/with_engine$/, replacement: resolve(worker, 'without_engine.ts') }] },
    build: { target: 'es2022', chunkSizeWarningLimit: 1200, outDir: live ? 'dist' : 'dist-recordings' },
    worker: { format: 'es' },
    server: { headers: isolated, fs: { allow: ['../..'] } },
    preview: { headers: isolated },
  };
});
