// The world of a recording, for what its poses do not tell: contacts, forces, trees, islands, joints, masses, energies. A recording
// that also holds commands is simulated again beside its track, to the last bit; one that holds poses only has no such world.
import type { Gyre, Replay, World } from 'gyre-physics';
import type { BodyDescription, BodyReport, FluidDescription, FluidState, OverlayData, OverlayName, SoftReport, Stats, Vec3 } from '../protocol';
import { FluidReader } from './fluids';
import { placeOf, slotOf, worldPart } from './keys';
import type { PoseFrame } from './poses';
import { reportOnSoft } from './softs';
import type { WorldAtFrame, WorldBehind } from './world_behind';
import { readLinks, readOverlays, readRows, readStats, reportOn, withNames } from './world_reader';

const PATIENCE = 80; // ms that a frame may wait for numbers that nobody asked for

// The track that a recording without one would have: all of it is simulated once.
export function trackOf(gyre: Gyre, commands: Uint8Array): Uint8Array {
  const replay = gyre.openReplay(commands);
  const recorder = replay.world().record({ commands: false });
  while (replay.step());
  const track = recorder.finish();
  replay.dispose();
  return track;
}

export class ReplayedWorld implements WorldBehind {
  private msPerStep = 0.5;
  private readonly firstStep: number;
  private readonly world: World;
  private stepMs = 0; // of the last way here, a step
  private readonly fluids: FluidReader;

  private constructor(
    private readonly gyre: Gyre,
    private readonly replay: Replay,
    private readonly origin: Vec3,
  ) {
    this.world = replay.world();
    this.fluids = new FluidReader(origin);
    this.world.setTiming(true);
    this.firstStep = Number(this.world.stepCount());
  }

  // The world, or in words why there is none.
  static open(gyre: Gyre, bytes: Uint8Array, origin: Vec3): ReplayedWorld | string {
    try {
      return new ReplayedWorld(gyre, gyre.openReplay(bytes), origin);
    } catch (error) {
      return (error as Error).message;
    }
  }

  get truncated(): boolean {
    return this.replay.truncated();
  }

  get stages(): string[] {
    return this.world.readTimes().stages.name;
  }

  at(frame: PoseFrame, needed: boolean): WorldAtFrame | null {
    const world = this.after(frame.step, needed);
    const own = world?.bodies().ids;
    if (!world || !own || own.length !== frame.ids.length) return null;
    if (!own.every((id, row) => placeOf(id) === frame.ids[row])) return null;
    return new WorldAtStep(this.gyre, world, this.origin, frame.ids, this.stepMs, this.fluids);
  }

  // The world after so many steps (as it counts them itself); null where the commands end before, or the way there is long and
  // nothing depends on it. Going back is short: keyframes are kept on the way.
  private after(step: number, needed: boolean): World | null {
    const { replay } = this;
    const target = step - this.firstStep;
    if (target < 0 || target > replay.stepCount()) return null;
    const ahead = target - replay.position();
    if (ahead === 0) return this.world;
    if (!needed && ahead * this.msPerStep > PATIENCE) return null;
    const begin = performance.now();
    try {
      replay.seek(target);
    } catch {
      return null; // damaged in a way that checksums do not find: the poses still show
    }
    if (ahead > 0) {
      this.stepMs = (performance.now() - begin) / ahead;
      this.msPerStep += (this.stepMs - this.msPerStep) / 4;
    }
    return this.world;
  }

  close(): void {
    this.replay.dispose();
  }
}

class WorldAtStep implements WorldAtFrame {
  constructor(
    private readonly gyre: Gyre,
    private readonly world: World,
    private readonly origin: Vec3,
    private readonly ids: ArrayLike<number>,
    private readonly stepMs: number,
    private readonly fluidReader: FluidReader,
  ) {}

  velocities(): Float32Array {
    return readRows(this.world, this.origin).velocities;
  }

  stats(): Stats {
    return readStats(this.world, this.stepMs);
  }

  links(): Float32Array {
    return readLinks(this.world, this.origin);
  }

  overlays(names: ReadonlySet<OverlayName>): OverlayData {
    return readOverlays(this.world, names, this.origin, false);
  }

  fluids(): FluidDescription[] {
    const describe = (id: number): FluidDescription =>
      this.fluidReader.describe(this.world, id, { key: placeOf(id), name: `fluid ${slotOf(id) + 1}`, color: null });
    return Array.from(this.world.fluids().slice(), describe);
  }

  fluidStates(speeds: boolean): FluidState[] {
    return Array.from(this.world.fluids().slice(), (id) => this.fluidReader.read(this.world, id, speeds));
  }

  mass(id: number): Pick<BodyDescription, 'mass' | 'centerOfMass' | 'inertia'> {
    const { mass, center, inertia } = this.world.massProperties(id + worldPart(this.world.bodies().ids[0] ?? 0));
    return { mass, centerOfMass: center, inertia };
  }

  softReport(place: number, key: number, name: string): SoftReport | null {
    const id = this.world.softs().find((one) => placeOf(one) === place);
    return id === undefined ? null : reportOnSoft(this.world, id, key, name);
  }

  report(row: number, key: number, nameOf: (id: number) => string): BodyReport {
    const id = this.world.bodies().ids[row]!;
    const words = withNames(this.world.explain(id).words, this.ids, nameOf);
    return reportOn(this.gyre, this.world, id, key, nameOf(placeOf(id)), words);
  }
}
