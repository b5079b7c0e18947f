// Stress or strain of soft matter as its colour, from the lowest (blue) to the highest (red) that was shown since the overlay was switched on, zero
// included; of each picture the outermost hundredth is left out, so that one element does not make all others look alike.
import { Group } from 'three';
import type { Softs } from '../draw/softs';
import * as store from '../state/store';
import type { Overlay, OverlayView } from './overlay';

const BEYOND = 0.01;

export class Reading implements Overlay {
  readonly object = new Group();
  private low = 0;
  private high = 0;
  private softs: Softs | null = null;

  constructor(private readonly what: 'stress' | 'strain') {}

  update({ frame, softs }: OverlayView): void {
    const { readings } = frame.overlays;
    if (!readings) return;
    this.softs = softs;
    const sorted = readings.filter(Number.isFinite).sort();
    const beyond = Math.floor(BEYOND * sorted.length);
    this.low = Math.min(this.low, sorted[beyond] ?? 0);
    this.high = Math.max(this.high, sorted[sorted.length - 1 - beyond] ?? 0);
    // An end that is below a thousandth of the other is rounding.
    const { what } = this;
    const least = 1e-3 * (this.high - this.low);
    const low = this.low > -least ? 0 : this.low;
    const high = this.high < least ? 0 : this.high;
    softs.read(readings, low, high);
    const known = store.readingKey.peek();
    if (known?.what !== what || known.low !== low || known.high !== high) store.readingKey.value = { what, low, high };
  }

  clear(): void {
    this.low = this.high = 0;
    this.softs?.read(null, 0, 0);
    if (store.readingKey.peek()?.what === this.what) store.readingKey.value = null;
  }
}
