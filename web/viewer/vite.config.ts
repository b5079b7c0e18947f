import { defineConfig } from 'vite';
import { gyreScenes } from './vite.scenes.ts';

// A page that shares memory between workers must be cross-origin isolated; `gyre view` sends the same headers.
const isolated = {
  'Cross-Origin-Opener-Policy': 'same-origin',
  'Cross-Origin-Embedder-Policy': 'require-corp',
};

export default defineConfig({
  plugins: [gyreScenes()],
  base: './', // works below any address
  build: { target: 'es2022', chunkSizeWarningLimit: 1200 },
  worker: { format: 'es' },
  server: { headers: isolated, fs: { allow: ['../..'] } },
  preview: { headers: isolated },
});
