// Where the poses of a recording come from: from its file, which the engine in the page decodes (decoded_poses.ts), or from a server
// that decodes it (served_poses.ts). Ids are those of the engine without the number of the world (keys.ts).
import type { BodyType, ShapeDescription, SoftDescription, Surface, Vec3 } from '../protocol';

// One frame: parallel arrays over all bodies that exist in it, and over all ropes, cloths and solids, by ascending slot.
export interface PoseFrame {
  step: number; // steps that the world had done
  time: number; // s
  set: number; // two frames with the same number have the same ids, models, softIds and softs
  ids: ArrayLike<number>;
  models: ArrayLike<number>;
  awake: ArrayLike<number>;
  poses: Float32Array; // 7 a row, relative to the origin
  softIds: ArrayLike<number>;
  softs: ArrayLike<number>; // which surface
  softVertices: Float32Array; // 3 a vertex, of all of them one after the other, relative to the origin
}

export interface Model {
  type: BodyType;
  shapes: ShapeDescription[]; // without colours, which are the body's
}

export interface PoseLabel {
  name: string; // empty if it has none
  colors: number[]; // of the first shapes, 0xrrggbb
}

export type SoftSurface = Pick<SoftDescription, 'kind' | 'radius' | 'vertices' | 'triangles'>;

export interface PoseSource {
  readonly frames: number; // at least 1
  readonly truncated: boolean;
  readonly timeStep: number; // s between the first two frames
  readonly origin: Vec3;
  readonly accuracy: { position: number; orientation: number }; // m, rad
  readonly note: string; // what `gyre simulate` notes under "scene", as JSON
  frame(index: number): PoseFrame | Promise<PoseFrame>;
  model(index: number): Model;
  label(id: number): PoseLabel;
  soft(index: number): SoftSurface;
  softLabel(id: number): PoseLabel;
  vertices(surface: string): Float32Array | undefined;
  takeSurfaces(): Surface[]; // those that it has not given yet
  close(): void;
}

// Drawn places are 32-bit: a scene far from zero is drawn around its middle.
export function originOf(positions: ArrayLike<number>): Vec3 {
  const middle: Vec3 = [0, 0, 0];
  for (let i = 0; i < positions.length; i++) middle[i % 3]! += (3 * positions[i]!) / positions.length;
  return middle.every((value) => Math.abs(value) < 1000) ? [0, 0, 0] : (middle.map(Math.round) as Vec3);
}
