// Picks the build of the engine and starts it. The WebAssembly modules are inside JavaScript files, so that there is no second
// address that a bundler or a server could get wrong.
import { bindingsVersion } from './generated.js';
import type { Build, Engine, EngineExports } from './runtime.js';
import { decompress } from './unzstd.js';

export interface LoadOptions {
  /**
   * Which build: 'threads' needs a page that is cross-origin isolated (or Node), 'simd' any present browser, 'plain' runs everywhere.
   * By default the first of these that runs here; in Node 'simd', since a program's threads cost it start-up time.
   */
  build?: Build | undefined;
  /** Threads besides the caller's for build 'threads'; by default one less than there are cores, at most 7. */
  workers?: number | undefined;
}

// A function that adds two vectors (WebAssembly core specification 2.0, 4.4.3): valid only where there is SIMD.
const simdProbe = new Uint8Array([
  0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11,
]);

interface Surroundings {
  crossOriginIsolated?: boolean;
  process?: { versions?: { node?: string } };
  navigator?: { hardwareConcurrency?: number };
}
const here = globalThis as unknown as Surroundings;
const inNode = typeof here.process?.versions?.node === 'string' && typeof (globalThis as { window?: unknown }).window === 'undefined';

/** The builds that can run here, the best first. */
export function usableBuilds(): Build[] {
  const builds: Build[] = [];
  const simd = WebAssembly.validate(simdProbe);
  if (simd && typeof SharedArrayBuffer !== 'undefined' && (inNode || here.crossOriginIsolated === true)) builds.push('threads');
  if (simd) builds.push('simd');
  builds.push('plain');
  return builds;
}

async function cores(): Promise<number> {
  if (here.navigator?.hardwareConcurrency) return here.navigator.hardwareConcurrency;
  if (!inNode) return 1;
  const os = (await import(/* @vite-ignore */ nodeModule('os'))) as { availableParallelism?: () => number; cpus(): unknown[] };
  return os.availableParallelism?.() ?? os.cpus().length;
}

// Hidden from bundlers, which would look for it.
function nodeModule(name: string): string {
  return `node:${name}`;
}

type Variant = typeof import('./engine/simd.js');
const variants: Record<Build, () => Promise<Variant>> = {
  simd: () => import('./engine/simd.js'),
  threads: () => import('./engine/threads.js'),
  plain: () => import('./engine/plain.js'),
};

function unpack(variant: Variant): Uint8Array<ArrayBuffer> {
  const text = atob(variant.wasm);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return decompress(bytes);
}

/** @internal Starts a module of the package. */
export async function instantiate(variant: Variant, more: Record<string, unknown> = {}): Promise<Pick<Engine, 'exports' | 'memory'>> {
  const made = await variant.default({
    wasmBinary: unpack(variant),
    print: (text: string) => console.log(text),
    printErr: (text: string) => {
      // Said of the thread that waits for a world's workers to end. They do so at once.
      if (!text.startsWith('Blocking on the main thread')) console.warn(text);
    },
    ...more,
  });
  return { exports: made as unknown as EngineExports, memory: made['wasmMemory'] as WebAssembly.Memory };
}

interface ThreadWorker {
  onmessage: ((event: { data: unknown }) => void) | null;
  onerror: ((event: unknown) => void) | null;
  postMessage(message: unknown): void;
  terminate(): unknown;
}

/** The workers of one engine: how to make them, and how to end them. */
interface Workshop {
  create(): ThreadWorker;
  /** When all have started: they no longer keep a program running. */
  settle(): void;
  close(): void;
}

async function start(build: Build, workers: number): Promise<Engine> {
  const variant = await variants[build]();
  if (variant.wasm === '') throw new Error(`load: the build '${build}' was left out of this copy of the package`);
  const module: Record<string, unknown> = {};
  let workshop: Workshop | undefined;
  if (build === 'threads') {
    workshop = inNode ? await nodeWorkshop(variant.worker) : pageWorkshop(variant.worker);
    module['workers'] = workers;
    module['cores'] = await cores();
    module['createWorker'] = () => workshop!.create();
  }
  try {
    const { exports, memory } = await instantiate(variant, module);
    workshop?.settle();
    if (exports['_gyre_bindings_version']?.() !== bindingsVersion) {
      throw new Error(`load: the build '${build}' was made from other headers than this JavaScript: run tools/build_web.sh`);
    }
    return {
      exports,
      memory,
      build,
      workers,
      close: () => workshop?.close(),
    };
  } catch (error) {
    workshop?.close();
    throw error;
  }
}

function pageWorkshop(code: string): Workshop {
  const address = URL.createObjectURL(new Blob([code], { type: 'text/javascript' }));
  const made: Worker[] = [];
  return {
    create: () => {
      const worker = new Worker(address);
      made.push(worker);
      return worker as unknown as ThreadWorker;
    },
    settle: () => {},
    close: () => {
      for (const worker of made) worker.terminate();
      URL.revokeObjectURL(address);
    },
  };
}

// What a worker of Node lacks of a worker of a page.
const nodePrelude = `const { parentPort } = require('node:worker_threads');
globalThis.self = globalThis;
globalThis.postMessage = (message) => parentPort.postMessage(message);
parentPort.on('message', (data) => globalThis.onmessage({ data }));
`;

async function nodeWorkshop(code: string): Promise<Workshop> {
  const { Worker: NodeWorker } = (await import(/* @vite-ignore */ nodeModule('worker_threads'))) as typeof import('node:worker_threads');
  const made: InstanceType<typeof NodeWorker>[] = [];
  return {
    create: () => {
      const worker = new NodeWorker(nodePrelude + code, { eval: true });
      made.push(worker);
      const wrapped: ThreadWorker = {
        onmessage: null,
        onerror: null,
        postMessage: (message) => worker.postMessage(message),
        terminate: () => worker.terminate(),
      };
      worker.on('message', (data: unknown) => wrapped.onmessage?.({ data }));
      worker.on('error', (error: unknown) => wrapped.onerror?.(error));
      return wrapped;
    },
    settle: () => made.forEach((worker) => worker.unref()),
    close: () => made.forEach((worker) => void worker.terminate()),
  };
}

export async function loadEngine(options: LoadOptions): Promise<Engine> {
  const usable = usableBuilds();
  const wanted = options.build;
  if (wanted !== undefined && !(wanted in variants)) {
    throw new TypeError(`load: build: found ${JSON.stringify(wanted)}, expected 'simd', 'threads' or 'plain'`);
  }
  if (wanted !== undefined && !usable.includes(wanted)) {
    throw new Error(
      wanted === 'threads'
        ? "load: the build 'threads' needs a page that is cross-origin isolated (Cross-Origin-Opener-Policy: same-origin and " +
            'Cross-Origin-Embedder-Policy: require-corp)'
        : `load: the build '${wanted}' does not run here; usable are ${usable.join(', ')}`,
    );
  }
  const workers = options.workers ?? Math.min(7, (await cores()) - 1);
  if (!Number.isInteger(workers) || workers < 0 || workers > 63) {
    throw new TypeError(`load: workers: found ${String(workers)}, expected a whole number from 0 to 63`);
  }
  if (wanted !== undefined) return start(wanted, wanted === 'threads' ? workers : 0);
  for (const build of usable) {
    if (build === 'threads' && (inNode || workers === 0)) continue;
    try {
      return await start(build, build === 'threads' ? workers : 0);
    } catch (error) {
      // A page may forbid workers or their memory; the next build needs less.
      if (build === 'plain') throw error;
      console.warn(`gyre-physics: the build '${build}' did not start, trying the next (${String(error)})`);
    }
  }
  throw new Error('load: no build of the engine runs here');
}
