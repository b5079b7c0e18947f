// A recording that is played: its poses, frame by frame, forward and back (poses.ts). What poses do not tell comes from the world
// behind them, where there is one (world_behind.ts).
import {
  type BodyDescription,
  BodyFlag,
  type BodyReport,
  type Box,
  type Command,
  type DoubleVec3,
  type FluidDescription,
  type FrameMessage,
  type NewWorldSettings,
  type OverlayName,
  type Quat,
  type SceneDescription,
  type SoftDescription,
  type SoftReport,
  type Stats,
  type Structure,
  type Vec3,
} from '../protocol';
import { extent } from './extent';
import { Keys } from './keys';
import type { PoseFrame, PoseSource } from './poses';
import type { Session } from './session';
import type { WorldAtFrame, WorldBehind } from './world_behind';

const NO_STATS: Stats = {
  stepMs: 0, stageMs: [], bodies: 0, awake: 0, pairs: 0, touching: 0, contactPoints: 0, kinetic: 0, potential: 0, elastic: 0,
  linear: [0, 0, 0], angular: [0, 0, 0], maxPenetration: 0, softs: 0, softVertices: 0, fluids: 0,
};

const NEEDS_WORLD: ReadonlySet<OverlayName> = new Set<OverlayName>(['contacts', 'friction', 'bounds', 'tree', 'islands', 'mass', 'joints', 'velocities', 'flow', 'speed', 'particles', 'stress', 'strain']);

// What `gyre simulate` writes down beside the poses.
interface SceneNote {
  name?: string;
  view?: { eye: number[]; target: number[]; field_of_view?: number } | null;
}

export class TrackSession implements Session {
  private readonly keys = new Keys();
  private readonly softKeys = new Keys();
  private readonly note: SceneNote;
  private readonly sent = new Map<number, number>(); // key to model, as the page knows it
  private set = -1;
  private structure = 0;
  private fluids: FluidDescription[] = []; // as the world behind had them last
  private overlays: ReadonlySet<OverlayName> = new Set();
  private weighed = false; // whether the page has been told the masses

  private constructor(
    private readonly source: PoseSource,
    private readonly behind: WorldBehind | string, // or in words why there is none
    private readonly file: string,
    private position: number,
    private at: PoseFrame,
  ) {
    this.note = readNote(source.note);
  }

  static async open(source: PoseSource, behind: WorldBehind | string, file: string): Promise<TrackSession> {
    return new TrackSession(source, behind, file, 0, await source.frame(0));
  }

  describe(): SceneDescription {
    const { view } = this.note;
    const { origin, accuracy, frames, truncated, timeStep } = this.source;
    const here = (place: readonly number[]): Vec3 => place.map((value, i) => value - origin[i]!) as Vec3;
    return {
      title: this.note.name || this.file,
      notes: [],
      file: this.file,
      live: false,
      origin,
      bounds: this.bounds(),
      view: view ? { eye: here(view.eye), target: here(view.target), fieldOfView: view.field_of_view ?? 0.7 } : null,
      stages: typeof this.behind === 'string' ? [] : this.behind.stages,
      settings: {
        gravity: [0, -9.81, 0],
        substeps: 0,
        sleeping: true,
        timeStep,
        solver: '', integrator: '', broadPhase: '', threads: 1, simdWidth: 0,
      },
      choices: { solver: [], integrator: [], broadPhase: [], simdWidth: [], maxThreads: 1 },
      engine: `Poses as recorded, to within ${(1000 * accuracy.position).toPrecision(2)} mm and ${(1000 * accuracy.orientation).toPrecision(2)} mrad`,
      lastStep: frames - 1,
      truncated: truncated || (typeof this.behind !== 'string' && this.behind.truncated),
      posesOnly: typeof this.behind === 'string' ? this.behind : '',
    };
  }

  private bounds(): Box {
    const { ids, models, poses, softVertices } = this.at;
    const bodies = Array.from(ids, (id, row) => this.describeBody(id, 0, models[row]!));
    return extent(bodies, poses, (surface) => this.source.vertices(surface), softVertices);
  }

  advance(steps: number, _commands: readonly Command[]): Promise<FrameMessage> {
    return this.seek(this.position + steps);
  }

  async seek(step: number): Promise<FrameMessage> {
    const wanted = Math.min(Math.max(step, 0), this.source.frames - 1);
    this.at = await this.source.frame(wanted);
    this.position = wanted;
    return this.frame();
  }

  frame(fresh = false): FrameMessage {
    const { ids, models, awake, poses, time, softIds, softVertices } = this.at;
    const world = this.world(this.fluids.length > 0 || [...this.overlays].some((name) => NEEDS_WORLD.has(name)));
    const structure = this.restructure(world, fresh);
    const count = ids.length;
    const flags = new Uint8Array(count);
    let awakeCount = 0;
    for (let row = 0; row < count; row++) {
      const { type } = this.source.model(models[row]!);
      flags[row] = (type === 'dynamic' ? BodyFlag.dynamic : type === 'kinematic' ? BodyFlag.kinematic : 0) | (awake[row] ? BodyFlag.awake : 0);
      if (awake[row]) awakeCount++;
    }
    return {
      frame: {
        step: this.position,
        time,
        lastStep: this.source.frames - 1,
        structure: this.structure,
        poses: poses.slice(), // the page takes it over
        velocities: world ? world.velocities() : new Float32Array(6 * count),
        flags,
        softVertices: softVertices.slice(),
        fluids: world ? world.fluidStates(this.overlays.has('speed')) : [],
        stats: world ? world.stats() : { ...NO_STATS, bodies: count, awake: awakeCount, softs: softIds.length, softVertices: softVertices.length / 3 },
        measured: world !== null,
        links: world ? world.links() : new Float32Array(0),
        overlays: world ? world.overlays(this.overlays) : {},
        settings: null,
        problem: null,
      },
      structure,
    };
  }

  private world(needed: boolean): WorldAtFrame | null {
    return typeof this.behind === 'string' ? null : this.behind.at(this.at, needed);
  }

  private restructure(world: WorldAtFrame | null, fresh: boolean): Structure | null {
    const { ids, models, set } = this.at;
    const weigh = world !== null && !this.weighed;
    const fluids = world ? world.fluids() : this.fluids;
    const sameFluids = fluids.length === this.fluids.length && fluids.every(({ key }, i) => key === this.fluids[i]!.key);
    if (set === this.set && !fresh && !weigh && sameFluids) return null;
    this.fluids = fluids;
    this.set = set;
    if (fresh || weigh) this.sent.clear();
    this.weighed = world !== null;
    const keys = Uint32Array.from(ids, (id) => this.keys.key(id));
    const added: BodyDescription[] = [];
    keys.forEach((key, row) => {
      const model = models[row]!;
      if (this.sent.get(key) === model) return;
      this.sent.set(key, model);
      added.push({ ...this.describeBody(ids[row]!, key, model), ...(world ? world.mass(ids[row]!) : {}) });
    });
    return { number: ++this.structure, keys, added, surfaces: this.source.takeSurfaces(), softs: this.describeSofts(), fluids };
  }

  private describeSofts(): SoftDescription[] {
    const { softIds, softs } = this.at;
    return Array.from(softIds, (id, i) => {
      const key = this.softKeys.key(id);
      const surface = this.source.soft(softs[i]!);
      return { ...surface, key, name: this.softName(id, surface.kind), color: this.source.softLabel(id).colors[0] ?? null };
    });
  }

  private softName(id: number, kind: string): string {
    return this.source.softLabel(id).name || `${kind} ${this.softKeys.key(id) + 1}`;
  }

  private nameOf(id: number): string {
    return this.source.label(id).name || `body ${this.keys.key(id)}`;
  }

  private describeBody(id: number, key: number, index: number): BodyDescription {
    const { type, shapes } = this.source.model(index);
    const { colors } = this.source.label(id);
    return {
      key, name: this.nameOf(id), type, mass: 0, centerOfMass: [0, 0, 0], inertia: [0, 0, 0, 0, 0, 0],
      shapes: shapes.map((shape, i) => ({ ...shape, color: colors[i] ?? null })),
    };
  }

  setOverlays(names: readonly OverlayName[]): void {
    this.overlays = new Set(names);
  }

  configure(_settings: NewWorldSettings): void {
    throw new Error('A recording is played as it was made: its settings cannot be changed.');
  }

  inspect(key: number): BodyReport | null {
    const { ids, models, awake, poses } = this.at;
    const row = Array.prototype.findIndex.call(ids, (id: number) => this.keys.key(id) === key);
    if (row < 0) return null;
    const world = this.world(true);
    if (world) return world.report(row, key, (id) => this.nameOf(id));
    const position = this.source.origin.map((value, i) => value + poses[7 * row + i]!) as DoubleVec3;
    return {
      key,
      name: this.nameOf(ids[row]!),
      type: this.source.model(models[row]!).type,
      awake: awake[row] !== 0,
      mass: 0,
      principalMoments: [0, 0, 0],
      position,
      centerOfMass: position,
      rotation: Array.from(poses.slice(7 * row + 3, 7 * row + 7)) as Quat,
      linear: [0, 0, 0],
      angular: [0, 0, 0],
      kinetic: 0,
      words: '',
    };
  }

  inspectSoft(key: number): SoftReport | null {
    const { softIds, softs } = this.at;
    const row = Array.prototype.findIndex.call(softIds, (id: number) => this.softKeys.key(id) === key);
    if (row < 0) return null;
    const { kind, vertices, triangles } = this.source.soft(softs[row]!);
    const name = this.softName(softIds[row]!, kind);
    const report = this.world(true)?.softReport(softIds[row]!, key, name);
    return report ?? { key, name, kind, vertices, triangles: triangles.length / 3, state: null };
  }

  hash(): string {
    throw new Error('A recording of poses has no state to hash.');
  }

  save(): never {
    throw new Error('A recording cannot be saved from here: it is a file already.');
  }

  close(): void {
    if (typeof this.behind !== 'string') this.behind.close();
    this.source.close();
  }
}

function readNote(text: string): SceneNote {
  try {
    return (JSON.parse(text) as SceneNote | null) ?? {};
  } catch {
    return {}; // no note, or one by another program
  }
}
