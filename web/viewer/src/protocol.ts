// What the page and the worker say to each other. The engine lives in the worker (worker/); the page draws (draw/), and neither
// imports the other: this file is all they share. Lengths in m, times in s, angles in rad; quaternions x, y, z, w.
//
// Drawn places are 32-bit and counted from `origin`, so that a scene far from zero is drawn as well as one that is near.

export type Vec3 = [number, number, number];
export type Quat = [number, number, number, number];
export interface Box {
  low: Vec3;
  high: Vec3;
}

// ------------------------------------------------------------------------------------------------------------- what there is

export type ShapeGeometry =
  | { kind: 'sphere'; radius: number }
  | { kind: 'box'; halfExtents: Vec3; rounding: number }
  | { kind: 'capsule' | 'cylinder' | 'cone'; radius: number; halfHeight: number }
  | { kind: 'plane'; normal: Vec3; offset: number }
  | { kind: 'surface'; surface: string };

// A hull, a mesh or a height field, sent once; shapes name it by key.
export interface Surface {
  key: string;
  kind: 'hull' | 'mesh' | 'height_field';
  vertices: Float32Array; // x, y, z each
  indices: Uint32Array; // three a triangle
}

export interface ShapeDescription {
  geometry: ShapeGeometry;
  position: Vec3; // in the body's frame
  rotation: Quat;
  material: string; // its name, empty if it has none
  color: number | null; // sRGB, 0xrrggbb; null: the page picks one
  sensor: boolean;
}

export type BodyType = 'fixed' | 'kinematic' | 'dynamic';

export interface BodyDescription {
  key: number; // names the body in requests; never used twice while the scene is open
  name: string;
  type: BodyType;
  mass: number; // kg, 0 unless dynamic
  centerOfMass: Vec3; // in the body's frame
  inertia: [number, number, number, number, number, number]; // xx, yy, zz, xy, xz, yz about the centre of mass, body axes
  shapes: ShapeDescription[];
}

export type SoftKind = 'rope' | 'cloth' | 'solid';

// A rope, a cloth or a solid: vertices that move one by one.
export interface SoftDescription {
  key: number; // names it in requests; another count than that of bodies, never used twice while the scene is open
  name: string;
  kind: SoftKind;
  vertices: number;
  radius: number; // m: that of a rope, half the thickness of a cloth, 0 of a solid
  triangles: Uint32Array; // the surface, three vertices each, counter-clockwise from outside; none of a rope
  color: number | null; // sRGB, 0xrrggbb; null: the page picks one
}

export type FluidKind = 'gas' | 'liquid';

// A gas or a liquid: fields in a box of cells.
export interface FluidDescription {
  key: number; // another count than that of bodies, never used twice while the scene is open
  name: string;
  kind: FluidKind;
  cells: Vec3;
  box: Box; // relative to origin
  flat: 0 | 1 | 2 | null; // the axis with one cell
  color: number | null; // sRGB, 0xrrggbb, of smoke or liquid; null: the page picks one
  smoky: boolean; // a gas in which there may be smoke or heat to see
  extinction: number; // 1/m, of the thickest smoke
}

// The state of a fluid in a frame.
export interface FluidState {
  // Of a gas, 4 numbers a cell, x fastest, then y, then z: smoke, heat, light of the sun that is left, and speed where it is shown. 255 is the
  // thickest smoke, the hottest emitter, all light, and `fastest`.
  voxels: Uint8Array;
  fastest: number; // m/s
  // The surface of a liquid.
  vertices: Float32Array; // 3 a vertex
  normals: Float32Array; // 3 a vertex
  indices: Uint32Array; // 3 a triangle, counter-clockwise seen from outside
}

// Those that commands change in the course of a run, and that are others again in its past.
export interface RunSettings {
  gravity: Vec3;
  substeps: number;
  sleeping: boolean;
}

export interface WorldSettings extends RunSettings {
  timeStep: number;
  solver: string;
  integrator: string;
  broadPhase: string;
  threads: number;
  simdWidth: number;
}

// What each setting can be set to in this build and on this page.
export interface SettingChoices {
  solver: string[];
  integrator: string[];
  broadPhase: string[];
  simdWidth: number[];
  maxThreads: number;
}

export interface SceneDescription {
  title: string;
  file: string;
  notes: string[]; // of an imported file: what is not simulated
  live: boolean; // false: a recording, which can be looked at but not changed
  origin: Vec3;
  bounds: Box; // around what there is to see; relative to origin
  view: { eye: Vec3; target: Vec3; fieldOfView: number } | null; // where the scene wants to be looked at from; rad
  stages: string[]; // names of Frame.stats.stageMs
  settings: WorldSettings;
  choices: SettingChoices;
  engine: string; // one line: build, threads, SIMD
  lastStep: number; // of a recording: its length; of a live scene: 0
  truncated: boolean; // the recording ends before its closing chunk
  posesOnly: string; // of a recording without a world behind its poses, in words why; empty if there is one
}

// Sent whenever bodies or soft matter came or went. Row i of every frame with this number belongs to keys[i], and the frame's
// softVertices are those of softs[0], then those of softs[1], and so on; its fluids are those of the structure.
export interface Structure {
  number: number;
  keys: Uint32Array;
  added: BodyDescription[]; // those the page does not know yet, or knows differently
  surfaces: Surface[]; // likewise
  softs: SoftDescription[]; // all that there are
  fluids: FluidDescription[]; // likewise
}

// --------------------------------------------------------------------------------------------------------------- what happens

export const BodyFlag = { awake: 1, dynamic: 2, kinematic: 4 } as const;

export interface Stats {
  stepMs: number; // mean over the steps of this frame
  stageMs: number[];
  bodies: number;
  awake: number;
  pairs: number;
  touching: number;
  contactPoints: number;
  kinetic: number; // J
  potential: number;
  elastic: number;
  linear: Vec3; // kg m/s
  angular: Vec3; // kg m^2/s, about the world's origin
  maxPenetration: number; // m
  softs: number; // ropes, cloths and solids
  softVertices: number;
  fluids: number; // gases and liquids
}

export type OverlayName =
  | 'contacts'
  | 'friction'
  | 'bounds'
  | 'tree'
  | 'islands'
  | 'mass'
  | 'joints'
  | 'velocities'
  | 'hulls'
  | 'flow'
  | 'speed'
  | 'particles'
  | 'stress'
  | 'strain';

// Overlay data that only the engine knows, flat as the engine's tables are ("3 a point"), in the frame's coordinates. Present
// when its switch is on.
export interface ContactData {
  positions: Float32Array; // 3 a point
  normals: Float32Array; // 3 a point: unit, from a to b
  tangents: Float32Array; // 6 a point: two unit vectors
  forces: Float32Array; // 1 a point: N, along the normal
  frictionForces: Float32Array; // 3 a point: N, on b
  scales: Float32Array; // 1 a point: m, size of the smaller shape
  sliding: Uint8Array; // 1 a point
}
export interface JointData {
  anchors: Float32Array; // 6 a joint: on a, on b
  frames: Float32Array; // 8 a joint: quaternions of its frame on a and on b, x along the axis
  rigid: Uint8Array; // 1 a joint: whether the anchors ought to coincide
  ways: Uint8Array; // 1 a joint: how limits and motor are shown: 0 not, 1 about x of the frame on a, 2 along it
  limits: Float32Array; // 2 a joint: rad or m; NaN without
  positions: Float32Array; // 1 a joint: rad or m
  motors: Float32Array; // 1 a joint: where its motor drives it, rad/s, m/s or the way that is left; 0 without
}
// The velocity of a fluid on a slice through its middle.
export interface FlowData {
  points: Float32Array; // 3 a point
  velocities: Float32Array; // 3 a point: m/s
  spacing: number; // m, between two points
  across: 0 | 1 | 2; // the axis that the slice stands on
}
export interface OverlayData {
  contacts?: ContactData;
  bounds?: Float32Array; // 6 a box: lower and upper corner
  tree?: { corners: Float32Array; depths: Uint8Array }; // 6 a box, 1 a box
  islands?: Int32Array; // one a body: its island or sleeping group, -1 if it has none
  joints?: JointData;
  flow?: FlowData[]; // one a fluid
  particles?: Float32Array; // 3 a particle, of all liquids
  readings?: Float32Array; // 1 a vertex of softVertices: stress (Pa) if that is switched on, else strain; NaN where there is none
}

export interface Frame {
  step: number;
  time: number;
  lastStep: number; // the end of what can be scrubbed to
  structure: number;
  poses: Float32Array; // 7 a row: x, y, z, qx, qy, qz, qw
  velocities: Float32Array; // 6 a row: linear of the centre of mass, angular
  flags: Uint8Array; // BodyFlag a row
  softVertices: Float32Array; // 3 a vertex
  fluids: FluidState[];
  stats: Stats;
  measured: boolean; // whether a world stands behind the numbers; without, only bodies are counted
  links: Float32Array; // rods, ropes and springs: 6 each, the anchors on a and on b
  overlays: OverlayData;
  settings: RunSettings | null; // as they are at this step; null in a recording
  problem: string | null; // the engine's words, when the state is no longer finite or a call was refused
}

export interface BodyReport {
  key: number;
  name: string;
  type: BodyType;
  awake: boolean;
  mass: number;
  principalMoments: Vec3;
  position: DoubleVec3; // of the origin
  centerOfMass: DoubleVec3;
  rotation: Quat;
  linear: Vec3;
  angular: Vec3;
  kinetic: number;
  words: string; // why it is awake or asleep, by the engine
}
export interface SoftReport {
  key: number;
  name: string;
  kind: SoftKind;
  vertices: number;
  triangles: number; // of the surface
  // Of a recording without a world behind it there is no more.
  state: { mass: number; kinetic: number; elastic: number; contacts: number } | null;
}
export type DoubleVec3 = [number, number, number];

// ------------------------------------------------------------------------------------------------------------------ requests

export type Source =
  | { kind: 'url'; url: string; name: string }
  | { kind: 'bytes'; name: string; bytes: Uint8Array };

export type Throwable = 'ball' | 'box' | 'capsule' | 'cylinder' | 'cone';

// What a visitor does to a live world. Every one is kept with the step at which it was done, so that scrubbing back and playing
// again repeats it.
export type Command =
  | { do: 'grab'; key: number; at: Vec3 }
  | { do: 'grab_soft'; key: number; at: Vec3 } // its vertex that is nearest
  | { do: 'pull'; to: Vec3 }
  | { do: 'release' }
  | { do: 'stir'; key: number; at: Vec3; velocity: Vec3 } // a gas around a place moves so, until the next command about it
  | { do: 'still'; key: number } // nobody stirs it any more
  | { do: 'throw'; what: Throwable; size: number; density: number; from: Vec3; velocity: Vec3 }
  | { do: 'remove'; key: number }
  | { do: 'remove_soft'; key: number }
  | { do: 'push'; key: number; at: Vec3; impulse: Vec3 }
  | { do: 'wake'; key: number; awake: boolean }
  | { do: 'gravity'; value: Vec3 }
  | { do: 'substeps'; value: number }
  | { do: 'sleeping'; value: boolean };

// Settings that need a new world, which goes on from where the old one stood.
export type NewWorldSettings = Partial<Pick<WorldSettings, 'broadPhase' | 'simdWidth' | 'threads' | 'solver' | 'integrator'>>;

export interface Requests {
  open: { ask: { source: Source; settings: NewWorldSettings }; answer: { scene: SceneDescription; frame: FrameMessage } };
  advance: { ask: { steps: number; commands: Command[] }; answer: FrameMessage }; // the commands first
  seek: { ask: { step: number }; answer: FrameMessage };
  overlays: { ask: { names: OverlayName[] }; answer: FrameMessage };
  configure: { ask: { settings: NewWorldSettings }; answer: { scene: SceneDescription; frame: FrameMessage } };
  inspect: { ask: { key: number }; answer: BodyReport | null };
  inspect_soft: { ask: { key: number }; answer: SoftReport | null };
  hash: { ask: Record<string, never>; answer: string };
  save: { ask: { what: 'scene' | 'snapshot' }; answer: { name: string; bytes: Uint8Array } };
}
export type RequestName = keyof Requests;

export interface FrameMessage {
  frame: Frame;
  structure: Structure | null; // when it is another than that of the frame before
}

export interface RequestMessage<N extends RequestName = RequestName> {
  id: number;
  name: N;
  ask: Requests[N]['ask'];
}
export type AnswerMessage =
  | { id: number; ok: true; answer: unknown }
  | { id: number; ok: false; error: string }
  | { id: -1; ok: false; error: string };
