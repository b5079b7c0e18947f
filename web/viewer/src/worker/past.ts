// The past of a live scene: everything a visitor did, and now and then a snapshot. Any step can be come back to by loading the
// snapshot before it and doing again what was done since; the engine is deterministic, so it is the same state to the bit.
// Acting in the past cuts the future off.
import type { Command } from '../protocol';
import { type HandState, moved } from './hand';

export interface Keyframe {
  step: number;
  bytes: Uint8Array;
  hand: HandState | null;
}

const WORK_BETWEEN = 60; // ms of stepping that coming back may cost
const STEPS_BETWEEN = 120;
const MOST_BYTES = 192e6; // of snapshots; then every second one of the older half goes

export class Past {
  lastStep = 0;
  private keyframes: Keyframe[] = [];
  private readonly done = new Map<number, Command[]>();
  private work = 0;
  private bytes = 0;

  // What was done after `step` steps, in order.
  at(step: number): readonly Command[] {
    return this.done.get(step) ?? [];
  }

  // Something new is done at `step`, after `kept` things that were done there before. What lay ahead never happens.
  add(step: number, kept: number, command: Command): void {
    this.cut(step);
    this.done.set(step, [...this.at(step).slice(0, kept), command]);
  }

  cut(step: number): void {
    if (this.lastStep > step) {
      for (const at of this.done.keys()) if (at > step) this.done.delete(at);
      this.keyframes = this.keyframes.filter((frame) => frame.step <= step);
      this.bytes = this.keyframes.reduce((sum, frame) => sum + frame.bytes.length, 0);
    }
    this.lastStep = step;
  }

  // After a step that took so long (ms): whether a snapshot is due.
  due(step: number, cost: number): boolean {
    this.work += cost;
    const last = this.keyframes.at(-1)?.step ?? -Infinity;
    return step > last && (this.work > WORK_BETWEEN || step - last >= STEPS_BETWEEN);
  }

  keep(frame: Keyframe): void {
    this.work = 0;
    this.keyframes.push(frame);
    this.bytes += frame.bytes.length;
    if (this.bytes > MOST_BYTES) this.thin();
  }

  // The last snapshot at or before a step.
  before(step: number): Keyframe {
    let found = this.keyframes[0]!;
    for (const frame of this.keyframes) if (frame.step <= step) found = frame;
    return found;
  }

  private thin(): void {
    const half = Math.floor(this.keyframes.length / 2);
    this.keyframes = this.keyframes.filter((_, i) => i === 0 || i >= half || i % 2 === 0);
    this.bytes = this.keyframes.reduce((sum, frame) => sum + frame.bytes.length, 0);
  }

  // The ids that a hand holds are now those of another world.
  moveWorld(by: number): void {
    this.keyframes = this.keyframes.map((frame) => ({ ...frame, hand: moved(frame.hand, by) }));
  }
}
