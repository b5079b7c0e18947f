// A recording that is played: the poses of its track, frame by frame, forward and back. What poses do not tell comes from the world
// behind them, where the recording holds its commands too (replayed_world.ts).
import { type Gyre, type PoseTrack, type TrackFrame, type World, BodyType, ErrorCode, GyreError } from 'gyre-physics';
import {
  type BodyDescription,
  BodyFlag,
  type BodyReport,
  type Box,
  type Command,
  type DoubleVec3,
  type FrameMessage,
  type NewWorldSettings,
  type OverlayName,
  type Quat,
  type SceneDescription,
  type Stats,
  type Structure,
  type Vec3,
} from '../protocol';
import { Describer, typeName } from './describe';
import { extent } from './extent';
import { Keys, placeOf, worldPart } from './keys';
import { ReplayedWorld, trackOf } from './replayed_world';
import type { Session } from './session';
import { readLinks, readOverlays, readRows, readStats, reportOn, withNames } from './world_reader';

const NO_STATS: Stats = {
  stepMs: 0, stageMs: [], bodies: 0, awake: 0, pairs: 0, touching: 0, contactPoints: 0, kinetic: 0, potential: 0, elastic: 0,
  linear: [0, 0, 0], angular: [0, 0, 0], maxPenetration: 0,
};

const NEEDS_WORLD: ReadonlySet<OverlayName> = new Set<OverlayName>(['contacts', 'friction', 'bounds', 'tree', 'islands', 'mass', 'joints', 'velocities']);

// What `gyre simulate` writes down beside the poses.
interface SceneNote {
  name?: string;
  view?: { eye: number[]; target: number[]; field_of_view?: number } | null;
}

export class TrackSession implements Session {
  private readonly track: PoseTrack;
  private readonly describer: Describer;
  private readonly models: ReturnType<PoseTrack['models']>;
  private readonly keys = new Keys();
  private readonly note: SceneNote;
  private readonly frames: number;
  private readonly origin: Vec3;
  private readonly sent = new Map<number, number>(); // key to model, as the page knows it
  private set = -1;
  private structure = 0;
  private readonly behind: ReplayedWorld | string;
  private overlays: ReadonlySet<OverlayName> = new Set();
  private weighed = false; // whether the page has been told the masses

  constructor(
    private readonly gyre: Gyre,
    bytes: Uint8Array,
    private readonly file: string,
  ) {
    this.track = openTrack(gyre, bytes);
    this.frames = this.track.frameCount();
    this.models = this.track.models();
    this.behind = ReplayedWorld.open(gyre, bytes);
    this.describer = new Describer(gyre);
    this.note = readNote(this.track.note('scene'));
    const { positions } = this.track.frame();
    const middle: Vec3 = [0, 0, 0];
    for (let i = 0; i < positions.length; i++) middle[i % 3]! += (3 * positions[i]!) / positions.length;
    this.origin = middle.every((value) => Math.abs(value) < 1000) ? [0, 0, 0] : (middle.map(Math.round) as Vec3);
  }

  describe(): SceneDescription {
    const { view } = this.note;
    const here = (place: readonly number[]): Vec3 => place.map((value, i) => value - this.origin[i]!) as Vec3;
    const accuracy = this.track.accuracy();
    return {
      title: this.note.name || this.file,
      file: this.file,
      live: false,
      origin: this.origin,
      bounds: this.bounds(),
      view: view ? { eye: here(view.eye), target: here(view.target), fieldOfView: view.field_of_view ?? 0.7 } : null,
      stages: this.behind instanceof ReplayedWorld ? this.behind.stages : [],
      settings: {
        gravity: [0, -9.81, 0],
        substeps: 0,
        sleeping: true,
        timeStep: this.frames > 1 ? this.track.time(1) - this.track.time(0) : 1 / 60,
        solver: '', integrator: '', broadPhase: '', threads: 1, simdWidth: 0,
      },
      choices: { solver: [], integrator: [], broadPhase: [], simdWidth: [], maxThreads: 1 },
      engine: `Poses as recorded, to within ${(1000 * accuracy.position).toPrecision(2)} mm and ${(1000 * accuracy.orientation).toPrecision(2)} mrad`,
      lastStep: this.frames - 1,
      truncated: this.track.truncated() || (this.behind instanceof ReplayedWorld && this.behind.truncated),
      posesOnly: this.behind instanceof ReplayedWorld ? '' : this.behind,
    };
  }

  private bounds(): Box {
    const at = this.track.frame();
    const bodies = Array.from(at.ids, (id, row) => this.describeBody(id, 0, at.models[row]!));
    return extent(bodies, this.poses(at), (surface) => this.describer.vertices(surface));
  }

  advance(steps: number, _commands: readonly Command[]): FrameMessage {
    return this.seek(this.track.position() + steps);
  }

  seek(step: number): FrameMessage {
    const wanted = Math.min(Math.max(step, 0), this.frames - 1);
    if (wanted !== this.track.position()) this.track.seek(wanted);
    return this.frame();
  }

  frame(fresh = false): FrameMessage {
    const at = this.track.frame();
    const world = this.world(at, [...this.overlays].some((name) => NEEDS_WORLD.has(name)));
    const structure = this.restructure(at, world, fresh);
    const count = at.ids.length;
    const flags = new Uint8Array(count);
    for (let row = 0; row < count; row++) {
      const type = this.models[at.models[row]!]!.type;
      flags[row] = (type === BodyType.dynamic ? BodyFlag.dynamic : type === BodyType.kinematic ? BodyFlag.kinematic : 0) | (at.awake[row] ? BodyFlag.awake : 0);
    }
    return {
      frame: {
        step: this.track.position(),
        time: at.time,
        lastStep: this.frames - 1,
        structure: this.structure,
        poses: this.poses(at),
        velocities: world ? readRows(world, this.origin).velocities : new Float32Array(6 * count),
        flags,
        stats: world ? readStats(world, (this.behind as ReplayedWorld).stepMs) : { ...NO_STATS, bodies: count, awake: at.awake.reduce((sum, awake) => sum + awake, 0) },
        measured: world !== null,
        links: world ? readLinks(world, this.origin) : new Float32Array(0),
        overlays: world ? readOverlays(world, this.overlays, this.origin) : {},
        settings: null,
        problem: null,
      },
      structure,
    };
  }

  // The world at this frame, if there is one and its bodies are those of the frame. `needed`: however long the way there is.
  private world({ step, ids }: TrackFrame, needed: boolean): World | null {
    if (!(this.behind instanceof ReplayedWorld)) return null;
    const world = this.behind.at(Number(step), needed);
    const own = world?.bodies().ids;
    if (!world || !own || own.length !== ids.length) return null;
    return own.every((id, row) => placeOf(id) === placeOf(ids[row]!)) ? world : null;
  }

  private poses({ ids, positions, orientations }: TrackFrame): Float32Array {
    const poses = new Float32Array(7 * ids.length);
    for (let row = 0; row < ids.length; row++) {
      for (let i = 0; i < 3; i++) poses[7 * row + i] = positions[3 * row + i]! - this.origin[i]!;
      for (let i = 0; i < 4; i++) poses[7 * row + 3 + i] = orientations[4 * row + i]!;
    }
    return poses;
  }

  private restructure(at: TrackFrame, world: World | null, fresh: boolean): Structure | null {
    const weigh = world !== null && !this.weighed;
    if (at.setVersion === this.set && !fresh && !weigh) return null;
    this.set = at.setVersion;
    if (fresh || weigh) this.sent.clear();
    this.weighed = world !== null;
    const keys = Uint32Array.from(at.ids, (id) => this.keys.key(id));
    const added: BodyDescription[] = [];
    keys.forEach((key, row) => {
      const model = at.models[row]!;
      if (this.sent.get(key) === model) return;
      this.sent.set(key, model);
      added.push({ ...this.describeBody(at.ids[row]!, key, model), ...(world ? massOf(world, at.ids[row]!) : {}) });
    });
    return { number: ++this.structure, keys, added, surfaces: this.describer.takeSurfaces() };
  }

  private nameOf(id: number): string {
    return this.track.label(id).name || `body ${this.keys.key(id)}`;
  }

  private describeBody(id: number, key: number, index: number): BodyDescription {
    const model = this.models[index]!;
    const { colors } = this.track.label(id);
    const shapes = model.shapes.map((shape, i) => ({
      ...this.describer.shape(shape.geometry, shape.local),
      sensor: shape.sensor,
      color: i < colors.count ? (colors.red[i]! << 16) | (colors.green[i]! << 8) | colors.blue[i]! : null,
    }));
    return { key, name: this.nameOf(id), type: typeName(model.type), mass: 0, centerOfMass: [0, 0, 0], inertia: [0, 0, 0, 0, 0, 0], shapes };
  }

  setOverlays(names: readonly OverlayName[]): void {
    this.overlays = new Set(names);
  }

  configure(_settings: NewWorldSettings): void {
    throw new Error('A recording is played as it was made: its settings cannot be changed.');
  }

  inspect(key: number): BodyReport | null {
    const at = this.track.frame();
    const row = at.ids.findIndex((id) => this.keys.key(id) === key);
    if (row < 0) return null;
    const world = this.world(at, true);
    if (world) {
      const id = placeOf(at.ids[row]!) + worldPart(world.bodies().ids[row]!);
      return reportOn(this.gyre, world, id, key, this.nameOf(id), withNames(world.explain(id).words, at.ids, (other) => this.nameOf(other)));
    }
    const position = Array.from(at.positions.slice(3 * row, 3 * row + 3)) as DoubleVec3;
    return {
      key,
      name: this.nameOf(at.ids[row]!),
      type: typeName(this.models[at.models[row]!]!.type),
      awake: at.awake[row] !== 0,
      mass: 0,
      principalMoments: [0, 0, 0],
      position,
      centerOfMass: position,
      rotation: Array.from(at.orientations.slice(4 * row, 4 * row + 4)) as Quat,
      linear: [0, 0, 0],
      angular: [0, 0, 0],
      kinetic: 0,
      words: '',
    };
  }

  hash(): string {
    throw new Error('A recording of poses has no state to hash.');
  }

  save(): never {
    throw new Error('A recording cannot be saved from here: it is a file already.');
  }

  close(): void {
    if (this.behind instanceof ReplayedWorld) this.behind.close();
    this.track.dispose();
  }
}

function openTrack(gyre: Gyre, bytes: Uint8Array): PoseTrack {
  try {
    return gyre.openPoseTrack(bytes);
  } catch (error) {
    if (!(error instanceof GyreError) || error.code !== ErrorCode.unsupported) throw error;
    return gyre.openPoseTrack(trackOf(gyre, bytes)); // it holds commands only
  }
}

function massOf(world: World, id: number): Pick<BodyDescription, 'mass' | 'centerOfMass' | 'inertia'> {
  const { mass, center, inertia } = world.massProperties(placeOf(id) + worldPart(world.bodies().ids[0] ?? 0));
  return { mass, centerOfMass: center, inertia };
}

function readNote(text: string): SceneNote {
  try {
    return (JSON.parse(text) as SceneNote | null) ?? {};
  } catch {
    return {}; // no note, or one by another program
  }
}
