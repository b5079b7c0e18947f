// What the charts show: the numbers of every step that was seen, by step. Scrubbing moves a mark over them; a new future
// overwrites the old one.
import type { Frame } from '../protocol';

export interface Sample {
  step: number;
  time: number;
  stepMs: number;
  stageMs: number[];
  kinetic: number;
  potential: number;
  elastic: number;
  linear: number;
  angular: number;
  contacts: number;
  touching: number;
  awake: number;
}

const LONGEST = 20000; // samples; older ones are dropped

export class History {
  samples: Sample[] = [];
  version = 0; // counts changes

  clear(): void {
    this.samples = [];
    this.version++;
  }

  add(frame: Frame, jumped: boolean): void {
    const { samples } = this;
    // Looking back changes nothing; going on from there comes by again and overwrites.
    if (jumped && samples.length > 0 && frame.step <= samples.at(-1)!.step) return;
    const { stats } = frame;
    const sample: Sample = {
      step: frame.step,
      time: frame.time,
      stepMs: stats.stepMs,
      stageMs: stats.stageMs,
      kinetic: stats.kinetic,
      potential: stats.potential,
      elastic: stats.elastic,
      linear: Math.hypot(...stats.linear),
      angular: Math.hypot(...stats.angular),
      contacts: stats.contactPoints,
      touching: stats.touching,
      awake: stats.awake,
    };
    let at = samples.length;
    while (at > 0 && samples[at - 1]!.step >= frame.step) at--;
    if (samples[at]?.step === frame.step) samples[at] = sample;
    else samples.splice(at, 0, sample);
    while (samples.length > 0 && samples.at(-1)!.step > frame.lastStep) samples.pop();
    if (samples.length > LONGEST) samples.splice(0, samples.length - LONGEST);
    this.version++;
  }
}
