// What stands behind the poses of a recording, for what they do not tell: contacts, forces, trees, islands, joints, masses, energies.
// The engine in the page has it where the file holds commands (replayed_world.ts); otherwise there is none, and a word why.
import type { BodyDescription, BodyReport, FluidDescription, FluidState, OverlayData, OverlayName, SoftReport, Stats } from '../protocol';
import type { PoseFrame } from './poses';

// The world at one frame, good until the next one is asked for.
export interface WorldAtFrame {
  velocities(): Float32Array; // 6 a row
  stats(): Stats;
  links(): Float32Array;
  overlays(names: ReadonlySet<OverlayName>): OverlayData;
  fluids(): FluidDescription[];
  fluidStates(speeds: boolean): FluidState[]; // of fluids(); `speeds`: wanted beside the smoke
  mass(id: number): Pick<BodyDescription, 'mass' | 'centerOfMass' | 'inertia'>;
  report(row: number, key: number, nameOf: (id: number) => string): BodyReport;
  softReport(id: number, key: number, name: string): SoftReport | null; // null if it is not there
}

export interface WorldBehind {
  readonly stages: string[];
  readonly truncated: boolean;
  // Null where the world ends before, or its bodies are others. `needed`: however long the way there is.
  at(frame: PoseFrame, needed: boolean): WorldAtFrame | null;
  close(): void;
}
