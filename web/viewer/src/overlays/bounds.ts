// The axis-aligned box of every shape, as the broad phase keeps it.
import { overlayColors } from '../draw/palette';
import { LineLayer } from './line_layer';
import type { Overlay, OverlayView } from './overlay';

export class Bounds implements Overlay {
  private readonly lines = new LineLayer(1.2, { opacity: 0.75 });
  readonly object = this.lines.object;

  update({ frame }: OverlayView): void {
    const boxes = frame.overlays.bounds ?? new Float32Array(0);
    this.lines.begin();
    for (let i = 0; i < boxes.length; i += 6) {
      this.lines.box(boxes[i]!, boxes[i + 1]!, boxes[i + 2]!, boxes[i + 3]!, boxes[i + 4]!, boxes[i + 5]!, overlayColors.bounds);
    }
    this.lines.end();
  }

  clear(): void {
    this.lines.begin();
    this.lines.end();
  }
}
