// The live scenes of the course (../course) as one plain script, without modules: a page opened as a file may load no modules.
import { resolve } from 'node:path';
import { defineConfig, type Plugin } from 'vite';

const course = resolve(import.meta.dirname, '../course');

// Of the engine only the build with SIMD: every browser of today runs it, and a page that is a file has no threads.
function simdAlone(): Plugin {
  return {
    name: 'gyre-simd-alone',
    enforce: 'pre',
    load(id) {
      if (/gyre-physics\/dist\/engine\/(plain|threads)\.js$/.test(id)) return "export default undefined; export const wasm = ''; export const worker = '';";
      return undefined;
    },
  };
}

export default defineConfig({
  plugins: [simdAlone()],
  resolve: {
    alias: [{ find: /^\.\/start_worker$/, replacement: resolve(course, 'src/start_worker.ts') }],
    dedupe: ['three', 'gyre-physics', '@preact/signals', 'preact'],
  },
  build: {
    target: 'es2022',
    outDir: resolve(course, 'dist'),
    emptyOutDir: true,
    copyPublicDir: false,
    chunkSizeWarningLimit: 4000,
    lib: { entry: resolve(course, 'src/main.ts'), formats: ['iife'], name: 'gyreCourse', fileName: () => 'live.js' },
  },
  define: { 'process.env.NODE_ENV': '"production"' },
  worker: { format: 'iife', plugins: () => [simdAlone()] },
});
