// The poses of a recording, decoded by the engine in the page. See poses.ts.
import { ErrorCode, type Gyre, GyreError, type PoseTrack, type TrackLabel } from 'gyre-physics';
import type { Surface, Vec3 } from '../protocol';
import { Describer, typeName } from './describe';
import { placeOf } from './keys';
import { type Model, originOf, type PoseFrame, type PoseLabel, type PoseSource, type SoftSurface } from './poses';
import { trackOf } from './replayed_world';
import { softKindName } from './softs';

export class DecodedPoses implements PoseSource {
  readonly frames: number;
  readonly truncated: boolean;
  readonly timeStep: number;
  readonly origin: Vec3;
  readonly accuracy: { position: number; orientation: number };
  readonly note: string;
  private readonly track: PoseTrack;
  private readonly describer: Describer;
  private readonly models: ReturnType<PoseTrack['models']>;
  private readonly described: Model[] = [];
  private readonly softs: SoftSurface[];

  constructor(gyre: Gyre, bytes: Uint8Array) {
    this.track = openTrack(gyre, bytes);
    this.describer = new Describer(gyre);
    this.models = this.track.models();
    this.softs = this.track.softs().map(({ kind, radius, vertices, triangles }) => ({ kind: softKindName(kind), radius, vertices, triangles: triangles.slice() }));
    this.frames = this.track.frameCount();
    this.truncated = this.track.truncated();
    this.timeStep = this.frames > 1 ? this.track.time(1) - this.track.time(0) : 1 / 60;
    this.origin = originOf(this.track.frame().positions);
    this.accuracy = this.track.accuracy();
    this.note = this.track.note('scene');
  }

  frame(index: number): PoseFrame {
    if (index !== this.track.position()) this.track.seek(index);
    const { step, time, setVersion, ids, models, awake, positions, orientations, softIds, softs, vertices } = this.track.frame();
    const poses = new Float32Array(7 * ids.length);
    for (let row = 0; row < ids.length; row++) {
      for (let i = 0; i < 3; i++) poses[7 * row + i] = positions[3 * row + i]! - this.origin[i]!;
      for (let i = 0; i < 4; i++) poses[7 * row + 3 + i] = orientations[4 * row + i]!;
    }
    return {
      step: Number(step),
      time,
      set: Number(setVersion),
      ids: Float64Array.from(ids, placeOf),
      models: models.slice(),
      awake: awake.slice(),
      poses,
      softIds: Float64Array.from(softIds, placeOf),
      softs: softs.slice(),
      softVertices: Float32Array.from(vertices, (value, i) => value - this.origin[i % 3]!),
    };
  }

  model(index: number): Model {
    return (this.described[index] ??= this.describe(index));
  }

  private describe(index: number): Model {
    const { type, shapes } = this.models[index]!;
    return {
      type: typeName(type),
      shapes: shapes.map((shape) => ({ ...this.describer.shape(shape.geometry, shape.local), sensor: shape.sensor })),
    };
  }

  label(id: number): PoseLabel {
    return labelOf(this.track.label(id));
  }

  soft(index: number): SoftSurface {
    return this.softs[index]!;
  }

  softLabel(id: number): PoseLabel {
    return labelOf(this.track.softLabel(id));
  }

  vertices(surface: string): Float32Array | undefined {
    return this.describer.vertices(surface);
  }

  takeSurfaces(): Surface[] {
    return this.describer.takeSurfaces();
  }

  close(): void {
    this.track.dispose();
  }
}

function labelOf({ name, colors }: TrackLabel): PoseLabel {
  return { name, colors: Array.from({ length: colors.count }, (_, i) => (colors.red[i]! << 16) | (colors.green[i]! << 8) | colors.blue[i]!) };
}

function openTrack(gyre: Gyre, bytes: Uint8Array): PoseTrack {
  try {
    return gyre.openPoseTrack(bytes);
  } catch (error) {
    if (!(error instanceof GyreError) || error.code !== ErrorCode.unsupported) throw error;
    return gyre.openPoseTrack(trackOf(gyre, bytes)); // it holds commands only
  }
}
