// The engine, loaded once for the page: the best build that this browser can run.
import { type Gyre, load } from 'gyre-physics';

let loading: Promise<Gyre> | null = null;

export function engine(): Promise<Gyre> {
  if (!loading) {
    loading = load().then((gyre) => {
      gyre.warmUp();
      return gyre;
    });
    // A failure (no memory, a policy) is told to whoever asks, and the next one may try again.
    loading.catch(() => (loading = null));
  }
  return loading;
}

export function engineWords(gyre: Gyre, threads: number, simdWidth: number): string {
  const builds = {
    threads: 'WebAssembly with SIMD and threads',
    simd: 'WebAssembly with SIMD, one thread',
    plain: 'WebAssembly without SIMD',
  };
  const isolated = gyre.build === 'threads' ? '' : globalThis.crossOriginIsolated ? '' : ' (threads need a page that is cross-origin isolated)';
  const width = simdWidth > 0 ? `, ${simdWidth} ${simdWidth === 1 ? 'lane' : 'lanes'}` : '';
  return `${builds[gyre.build]}, ${threads} of ${gyre.maxThreads} threads in use${width}${isolated}`;
}
