// A recording that is played: the poses of its track, frame by frame, forward and back. Nothing is simulated.
import { type Gyre, type PoseTrack, type TrackFrame, BodyType } from 'gyre-physics';
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
import { Keys } from './keys';
import type { Session } from './session';

const NO_STATS: Stats = {
  stepMs: 0, stageMs: [], bodies: 0, awake: 0, pairs: 0, touching: 0, contactPoints: 0, kinetic: 0, potential: 0, elastic: 0,
  linear: [0, 0, 0], angular: [0, 0, 0], maxPenetration: 0,
};

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

  constructor(
    gyre: Gyre,
    bytes: Uint8Array,
    private readonly file: string,
  ) {
    this.track = gyre.openPoseTrack(bytes);
    this.frames = this.track.frameCount();
    this.models = this.track.models();
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
      stages: [],
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
      truncated: this.track.truncated(),
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
    const structure = this.restructure(at, fresh);
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
        velocities: new Float32Array(6 * count),
        flags,
        stats: { ...NO_STATS, bodies: count, awake: at.awake.reduce((sum, awake) => sum + awake, 0) },
        links: new Float32Array(0),
        overlays: {},
        settings: null,
        problem: null,
      },
      structure,
    };
  }

  private poses({ ids, positions, orientations }: TrackFrame): Float32Array {
    const poses = new Float32Array(7 * ids.length);
    for (let row = 0; row < ids.length; row++) {
      for (let i = 0; i < 3; i++) poses[7 * row + i] = positions[3 * row + i]! - this.origin[i]!;
      for (let i = 0; i < 4; i++) poses[7 * row + 3 + i] = orientations[4 * row + i]!;
    }
    return poses;
  }

  private restructure(at: TrackFrame, fresh: boolean): Structure | null {
    if (at.setVersion === this.set && !fresh) return null;
    this.set = at.setVersion;
    if (fresh) this.sent.clear();
    const keys = Uint32Array.from(at.ids, (id) => this.keys.key(id));
    const added: BodyDescription[] = [];
    keys.forEach((key, row) => {
      const model = at.models[row]!;
      if (this.sent.get(key) === model) return;
      this.sent.set(key, model);
      added.push(this.describeBody(at.ids[row]!, key, model));
    });
    return { number: ++this.structure, keys, added, surfaces: this.describer.takeSurfaces() };
  }

  private describeBody(id: number, key: number, index: number): BodyDescription {
    const model = this.models[index]!;
    const { name, colors } = this.track.label(id);
    const shapes = model.shapes.map((shape, i) => ({
      ...this.describer.shape(shape.geometry, shape.local),
      sensor: shape.sensor,
      color: i < colors.count ? (colors.red[i]! << 16) | (colors.green[i]! << 8) | colors.blue[i]! : null,
    }));
    return { key, name: name || `body ${key}`, type: typeName(model.type), mass: 0, centerOfMass: [0, 0, 0], inertia: [0, 0, 0, 0, 0, 0], shapes };
  }

  setOverlays(_names: readonly OverlayName[]): void {} // a track has nothing for them

  configure(_settings: NewWorldSettings): void {
    throw new Error('A recording is played as it was made: its settings cannot be changed.');
  }

  inspect(key: number): BodyReport | null {
    const at = this.track.frame();
    const row = at.ids.findIndex((id) => this.keys.key(id) === key);
    if (row < 0) return null;
    const position = Array.from(at.positions.slice(3 * row, 3 * row + 3)) as DoubleVec3;
    return {
      key,
      name: this.track.label(at.ids[row]!).name || `body ${key}`,
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
    this.track.dispose();
  }
}

function readNote(text: string): SceneNote {
  try {
    return (JSON.parse(text) as SceneNote | null) ?? {};
  } catch {
    return {}; // no note, or one by another program
  }
}
