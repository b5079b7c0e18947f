// The world of a recording, for what its poses do not tell: contacts, forces, trees, islands, joints, masses, energies. A recording
// that also holds commands is simulated again beside its track, to the last bit; one that holds poses only has no such world.
import type { Gyre, Replay, World } from 'gyre-physics';

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

export class ReplayedWorld {
  private msPerStep = 0.5;
  private readonly firstStep: number;
  private readonly world: World;
  stepMs = 0; // of the last way here, a step

  private constructor(private readonly replay: Replay) {
    this.world = replay.world();
    this.world.setTiming(true);
    this.firstStep = Number(this.world.stepCount());
  }

  // The world, or in words why there is none.
  static open(gyre: Gyre, bytes: Uint8Array): ReplayedWorld | string {
    try {
      return new ReplayedWorld(gyre.openReplay(bytes));
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

  // The world after so many steps (as it counts them itself); null where the commands end before, or the way there is long and
  // nothing depends on it. Going back is short: keyframes are kept on the way.
  at(step: number, needed: boolean): World | null {
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
