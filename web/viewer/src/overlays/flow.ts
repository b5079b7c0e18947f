// The velocity of fluids on a slice: arrows that grow with the speed, up to a little more than the way to the next arrow, coloured from still
// (blue) to fast (red). Full is the fastest that was shown since the overlay was switched on.
import { Color } from 'three';
import { heatColor } from '../draw/palette';
import { LineLayer } from './line_layer';
import type { Overlay, OverlayView } from './overlay';

const LONGEST = 1.5; // spacings
const STILL = 0.02; // of the fastest

export class Flow implements Overlay {
  private readonly lines = new LineLayer(1.6, { onTop: true });
  readonly object = this.lines.object;
  private readonly color = new Color();
  private fastest = 0; // m/s

  update({ frame }: OverlayView): void {
    this.lines.begin();
    for (const { points: p, velocities: v, spacing } of frame.overlays.flow ?? []) {
      for (let i = 0; i < v.length; i += 3) this.fastest = Math.max(this.fastest, Math.hypot(v[i]!, v[i + 1]!, v[i + 2]!));
      const scale = (LONGEST * spacing) / (this.fastest || 1);
      for (let i = 0; i < v.length; i += 3) {
        const part = Math.hypot(v[i]!, v[i + 1]!, v[i + 2]!) / (this.fastest || 1);
        if (part < STILL) continue;
        heatColor(part, this.color);
        this.lines.arrow(p[i]!, p[i + 1]!, p[i + 2]!, scale * v[i]!, scale * v[i + 1]!, scale * v[i + 2]!, this.color);
      }
    }
    this.lines.end();
  }

  clear(): void {
    this.fastest = 0;
    this.lines.begin();
    this.lines.end();
  }
}
