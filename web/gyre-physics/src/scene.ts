// Scene files: the engine's own reader and runner.
import { type BodyId, type FluidId, type JointId, type RecordOptions, type SoftId, type SteppingInput, type Vec3, writeStepping } from './generated.js';
import type { Runtime } from './runtime.js';
import type { Bytes, VectorInput } from './stream.js';
import { type Recorder, World } from './world.js';

export interface SceneOptions {
  /** Named in errors. */
  file?: string;
  /** The mesh files that the scene names, by the names that it gives them. */
  files?: Readonly<Record<string, Bytes | string>>;
  /** Workers of the world; more than one only where the engine runs with threads. */
  threads?: number;
  /** Lanes of the solver's kernels: 1 or 4; 0, the default, is the best of the build. Never changes a bit of the result. */
  simdWidth?: number;
  /** Settings of the world instead of those that the scene gives. */
  settings?: SceneSettings;
}

export interface SceneSettings {
  /** m/s^2 */
  gravity?: VectorInput;
  /** Seconds of a step. */
  timeStep?: number;
  sleeping?: boolean;
  /** Only what is given changes. */
  stepping?: SteppingInput;
}

/** Where a picture is taken from. */
export interface SceneView {
  /** m */
  eye: Vec3;
  /** What stands in the middle of the picture, m. */
  target: Vec3;
  /** rad, from bottom to top of the picture. */
  fieldOfView: number;
}

/** A vertex that the scene pins, or attaches to a body. */
export interface SceneHold {
  vertex: number;
  /** Into sceneBodies; -1: the vertex stays where it is in the world. */
  body: number;
}

/** A world made from a scene file. It knows the scene's names, and its step() plays the scene's timed forces. */
export class Scene extends World {
  readonly name: string;
  /** Seconds of a step. */
  readonly timeStep: number;
  /** In the order of the scene; ids stay in their places when a body is removed. */
  readonly sceneBodies: readonly BodyId[];
  readonly bodyNames: readonly string[];
  readonly sceneJoints: readonly JointId[];
  readonly jointNames: readonly string[];
  /** Ropes, cloths and soft bodies, in this order; ids stay in their places when one is removed. */
  readonly sceneSofts: readonly SoftId[];
  readonly softNames: readonly string[];
  /** Of each of them: its colour as 0xrrggbb. */
  readonly softColors: readonly number[];
  /** Of each of them: the vertices that it is held by. */
  readonly softHolds: readonly (readonly SceneHold[])[];
  /** Gases and liquids, in this order; ids stay in their places when one is removed. */
  readonly sceneFluids: readonly FluidId[];
  readonly fluidNames: readonly string[];
  /** Of each of them: its colour as 0xrrggbb. */
  readonly fluidColors: readonly number[];
  /** Of each shape of each body, in the order of the scene: the name of its material, empty if it has none. */
  readonly materialNames: readonly (readonly string[])[];
  /** Of each shape of each body: its colour as 0xrrggbb. What the scene leaves open has a colour from a fixed cycle. */
  readonly colors: readonly (readonly number[])[];
  /** Where a good picture is taken from, if the scene says it. */
  readonly view: SceneView | undefined;

  /** @internal Made by Gyre.openScene(). */
  constructor(runtime: Runtime, pointer: number) {
    super(runtime, pointer);
    runtime.begin();
    const r = runtime.call('gyre_scene_info', pointer);
    this.name = r.text();
    this.timeStep = r.number();
    this.sceneBodies = Array.from(r.array(Float64Array, 1));
    this.bodyNames = r.texts(this.sceneBodies.length);
    this.sceneJoints = Array.from(r.array(Float64Array, 1));
    this.jointNames = r.texts(this.sceneJoints.length);
    runtime.begin();
    const looks = runtime.call('gyre_scene_looks', pointer);
    const names: string[][] = [];
    const colors: number[][] = [];
    for (let i = 0; i < this.sceneBodies.length; ++i) {
      const shapes = looks.number();
      names.push([]);
      colors.push([]);
      for (let k = 0; k < shapes; ++k) {
        colors[i]!.push(looks.number());
        names[i]!.push(looks.text());
      }
    }
    this.materialNames = names;
    this.colors = colors;
    this.view = looks.boolean()
      ? { eye: looks.vector(3) as Vec3, target: looks.vector(3) as Vec3, fieldOfView: looks.number() }
      : undefined;
    runtime.begin();
    const softs = runtime.call('gyre_scene_softs', pointer);
    this.sceneSofts = Array.from(softs.array(Float64Array, 1));
    const all = this.sceneSofts.map(() => ({
      name: softs.text(),
      color: softs.number(),
      holds: softs.list((r) => ({ vertex: r.number(), body: r.number() })),
    }));
    this.softNames = all.map(({ name }) => name);
    this.softColors = all.map(({ color }) => color);
    this.softHolds = all.map(({ holds }) => holds);
    runtime.begin();
    const fluids = runtime.call('gyre_scene_fluids', pointer);
    this.sceneFluids = Array.from(fluids.array(Float64Array, 1));
    const looksOfFluids = this.sceneFluids.map(() => ({ name: fluids.text(), color: fluids.number() }));
    this.fluidNames = looksOfFluids.map(({ name }) => name);
    this.fluidColors = looksOfFluids.map(({ color }) => color);
  }

  /** @internal */
  static open(runtime: Runtime, text: string, options: SceneOptions = {}): Scene {
    const w = runtime.begin();
    w.text(text, 'openScene: text');
    w.text(options.file ?? 'scene', 'openScene: file');
    w.integer(options.threads ?? 1, 0, 64, 'openScene: threads');
    w.integer(options.simdWidth ?? 0, 0, 16, 'openScene: simdWidth');
    const files = Object.entries(options.files ?? {});
    w.integer(files.length, 0, 1e6, 'openScene: files');
    for (const [name, bytes] of files) {
      w.text(name, 'openScene: files');
      if (typeof bytes === 'string') {
        w.text(bytes, `openScene: files.${name}`);
      } else {
        w.bytes(bytes, `openScene: files.${name}`);
      }
    }
    const settings = options.settings ?? {};
    for (const key in settings) {
      if (!['gravity', 'timeStep', 'sleeping', 'stepping'].includes(key)) throw new TypeError(`openScene: no setting is named "${key}"`);
    }
    if (w.given(settings.gravity)) w.vector(settings.gravity, 3, 'openScene: gravity');
    if (w.given(settings.timeStep)) w.number(settings.timeStep, 'openScene: timeStep');
    if (w.given(settings.sleeping)) w.boolean(settings.sleeping, 'openScene: sleeping');
    if (w.given(settings.stepping)) writeStepping(w, settings.stepping);
    return new Scene(runtime, runtime.call('gyre_scene_open', 0).number());
  }

  /**
   * With no argument, one step of the scene: the timed forces of this moment act, then the world moves on by the scene's time step.
   * Throws when the state is no longer finite, with the body's name. With an argument, one step of the world alone.
   */
  override step(seconds?: number): void {
    if (seconds !== undefined) return super.step(seconds);
    this.runtime.begin();
    this.runtime.call('gyre_scene_step', this.pointer);
  }

  /** Records; bodies are labelled with the scene's names and colours, and its name and view are noted. */
  override record(options?: RecordOptions): Recorder {
    const recorder = super.record(options);
    const { name, view } = this;
    const noted = view && { eye: view.eye, target: view.target, field_of_view: view.fieldOfView };
    recorder.note('scene', JSON.stringify({ name, view: noted }));
    const parts = (color: number) => ({ red: color >> 16, green: (color >> 8) & 255, blue: color & 255 });
    this.sceneBodies.forEach((body, i) => {
      if (this.bodyExists(body)) recorder.label(body, this.bodyNames[i]!, this.colors[i]!.map(parts));
    });
    this.sceneSofts.forEach((soft, i) => {
      if (this.softExists(soft)) recorder.labelSoft(soft, this.softNames[i]!, parts(this.softColors[i]!));
    });
    return recorder;
  }

  /** The name of a body of this scene; empty for others. */
  bodyName(body: BodyId): string {
    return this.bodyNames[this.sceneBodies.indexOf(body)] ?? '';
  }

  /** Steps of the scene that were done. */
  get steps(): number {
    this.runtime.begin();
    return this.runtime.call('gyre_scene_progress', this.pointer).number();
  }

  /** The scene as it stands now, as a scene file to go on from. Bodies and joints that were added by hand are not in it. */
  toJson(): string {
    this.runtime.begin();
    return new TextDecoder().decode(this.runtime.call('gyre_scene_write', this.pointer).bytes());
  }
}
