// Gyre for JavaScript: load() gives the engine, and everything else is made from that.
import { BodyType, box, GyreBase, sphere } from './generated.js';
import { loadEngine, type LoadOptions } from './load.js';
import { type Build, Runtime } from './runtime.js';
import { Scene, type SceneOptions } from './scene.js';

export * from './generated.js';
export { type GltfOptions, type ImportedScene, importGltf } from './gltf.js';
export type { LoadOptions } from './load.js';
export type { Build } from './runtime.js';
export { Scene, type SceneHold, type SceneOptions, type SceneSettings, type SceneView } from './scene.js';
export { GyreError } from './stream.js';
export type { Bytes, Numbers, QuaternionInput, VectorInput, WritableNumbers } from './stream.js';
export { Recorder, World } from './world.js';

/** A loaded engine. */
export class Gyre extends GyreBase {
  /** Which build runs: with SIMD and threads, with SIMD, or plain. */
  get build(): Build {
    return this.runtime.build;
  }

  /** The most workers that a world of this engine can have; 1 without threads. */
  get maxThreads(): number {
    return 1 + this.runtime.engine.workers;
  }

  /** A world from the text of a scene file. */
  openScene(text: string, options: SceneOptions = {}): Scene {
    return Scene.open(this.runtime, text, options);
  }

  /**
   * Steps a small hidden world, so that the browser has compiled the engine's inner loops before the first step that counts. It takes
   * some hundredths of a second; call it while something else loads.
   */
  warmUp(steps = 60): void {
    const world = this.createWorld({ sleeping: false });
    try {
      world.addBody({ type: BodyType.fixed, pose: { position: [0, -0.5, 0] } }, { geometry: box({ halfExtents: [20, 0.5, 20] }) });
      for (let i = 0; i < 60; ++i) {
        const place = [(i % 4) * 0.9, 0.5 + Math.floor(i / 4), 0.3 * (i % 3)];
        world.addBody({ pose: { position: place } }, { geometry: i % 5 === 0 ? sphere() : box() });
      }
      for (let i = 0; i < steps; ++i) world.step(1 / 60);
    } finally {
      world.dispose();
    }
  }

  /** Ends the engine and its threads at once. Nothing made from it works afterwards. */
  close(): void {
    this.runtime.close();
  }
}

/** Loads the engine: the best build for where this runs, or the one that is asked for. */
export async function load(options: LoadOptions = {}): Promise<Gyre> {
  return new Gyre(new Runtime(await loadEngine(options)));
}

/** The name of an enumerator: nameOf(BodyType, 2) is 'dynamic'. */
export function nameOf(kind: Readonly<Record<string, number>>, value: number): string {
  for (const name in kind) if (kind[name] === value) return name;
  return String(value);
}

export default load;
