// glTF files to scene files. The reader is a WebAssembly module of its own, fetched when it is first used.
import { instantiate } from './load.js';
import { Runtime } from './runtime.js';
import type { Bytes } from './stream.js';

export interface GltfOptions {
  /** Named in errors; the scene gets its name from it. */
  file?: string;
  /** The buffers that a .gltf file names, by the names that it gives them. A .glb file needs none. */
  files?: Readonly<Record<string, Bytes>>;
  /** Refuses a file with anything that is not simulated. */
  strict?: boolean;
  /** A concave mesh on a moving body becomes several hulls; by default it becomes its convex hull. */
  decompose?: boolean;
}

export interface ImportedScene {
  /** A scene file, for openScene(). */
  text: string;
  /** What is not simulated, in words. */
  notes: string[];
}

let loading: Promise<Runtime> | undefined;

async function load(): Promise<Runtime> {
  const variant = await import('./engine/gltf.js');
  if (variant.wasm === '') throw new Error('importGltf: the reader of glTF was left out of this copy of the package');
  return new Runtime({ ...(await instantiate(variant)), build: 'plain', workers: 0, close: () => {} });
}

function reader(): Promise<Runtime> {
  if (loading === undefined) {
    loading = load();
    loading.catch(() => (loading = undefined)); // the next call tries again
  }
  return loading;
}

/** Reads a glTF 2.0 file (.glb or .gltf) with KHR_physics_rigid_bodies and KHR_implicit_shapes, as `gyre convert` does. */
export async function importGltf(bytes: Bytes, options: GltfOptions = {}): Promise<ImportedScene> {
  for (const key in options) {
    if (!['file', 'files', 'strict', 'decompose'].includes(key)) throw new TypeError(`importGltf: no option is named "${key}"`);
  }
  const runtime = await reader();
  const w = runtime.begin();
  w.bytes(bytes, 'importGltf: bytes');
  w.text(options.file ?? 'scene.glb', 'importGltf: file');
  w.boolean(options.strict ?? false, 'importGltf: strict');
  w.boolean(options.decompose ?? false, 'importGltf: decompose');
  const files = Object.entries(options.files ?? {});
  w.integer(files.length, 0, 1e6, 'importGltf: files');
  for (const [name, content] of files) {
    w.text(name, 'importGltf: files');
    w.bytes(content, `importGltf: files.${name}`);
  }
  const answer = runtime.call('gyre_import_gltf', 0);
  const text = new TextDecoder().decode(answer.bytes());
  return { text, notes: answer.list((r) => r.text()) };
}
