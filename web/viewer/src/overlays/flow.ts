// The velocity of fluids on a slice: arrows that grow with the speed, up to the way to the next arrow, coloured from still
// (blue) to fast (red). Full is the fastest that was shown since the overlay was switched on.
import { Color } from 'three';
import { heatColor } from '../draw/palette';
import { LineLayer } from './line_layer';
import type { Overlay, OverlayView } from './overlay';

const LONGEST = 1.0; // spacings
const STILL = 0.02; // of the fastest
const HEAD = 0.2; // half the width of the head, in lengths of the arrow

export class Flow implements Overlay {
  private readonly lines = new LineLayer(1.6, { onTop: true });
  readonly object = this.lines.object;
  private readonly color = new Color();
  private fastest = 0; // m/s

  update({ frame }: OverlayView): void {
    this.lines.begin();
    for (const { points: p, velocities: v, spacing, across } of frame.overlays.flow ?? []) {
      for (let i = 0; i < v.length; i += 3) this.fastest = Math.max(this.fastest, Math.hypot(v[i]!, v[i + 1]!, v[i + 2]!));
      const scale = (LONGEST * spacing) / (this.fastest || 1);
      for (let i = 0; i < v.length; i += 3) {
        const part = Math.hypot(v[i]!, v[i + 1]!, v[i + 2]!) / (this.fastest || 1);
        if (part < STILL) continue;
        heatColor(part, this.color);
        this.arrow(p.subarray(i, i + 3), [scale * v[i]!, scale * v[i + 1]!, scale * v[i + 2]!], across);
      }
    }
    this.lines.end();
  }

  // Its head lies in the slice.
  private arrow(from: Float32Array, way: readonly [number, number, number], across: 0 | 1 | 2): void {
    const { lines, color } = this;
    const to = from.map((value, k) => value + way[k]!);
    lines.line(from[0]!, from[1]!, from[2]!, to[0]!, to[1]!, to[2]!, color);
    const [a, b] = [(across + 1) % 3, (across + 2) % 3] as [number, number];
    for (const side of [HEAD, -HEAD]) {
      const end = from.map((value, k) => value + (1 - 1.6 * HEAD) * way[k]!);
      end[a]! += side * way[b]!;
      end[b]! -= side * way[a]!;
      lines.line(to[0]!, to[1]!, to[2]!, end[0]!, end[1]!, end[2]!, color);
    }
  }

  clear(): void {
    this.fastest = 0;
    this.lines.begin();
    this.lines.end();
  }
}
