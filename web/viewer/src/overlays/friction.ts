// The basis of friction at each contact point (two tangents), and the friction of its manifold as an arrow.
import { overlayColors } from '../draw/palette';
import { LineLayer } from './line_layer';
import type { Overlay, OverlayView } from './overlay';

export class Friction implements Overlay {
  private readonly lines = new LineLayer(2, { onTop: true });
  readonly object = this.lines.object;

  update({ frame }: OverlayView): void {
    const { lines } = this;
    lines.begin();
    const points = frame.overlays.contacts;
    if (points) {
      const { positions: at, tangents: t, frictionForces: f, scales } = points;
      let strongest = 1e-9;
      for (let i = 0; i < f.length; i += 3) strongest = Math.max(strongest, Math.hypot(f[i]!, f[i + 1]!, f[i + 2]!));
      for (let i = 0; i < scales.length; i++) {
        const [x, y, z] = [at[3 * i]!, at[3 * i + 1]!, at[3 * i + 2]!];
        const reach = 0.9 * scales[i]!;
        lines.line(x, y, z, x + reach * t[6 * i]!, y + reach * t[6 * i + 1]!, z + reach * t[6 * i + 2]!, overlayColors.tangent1);
        lines.line(x, y, z, x + reach * t[6 * i + 3]!, y + reach * t[6 * i + 4]!, z + reach * t[6 * i + 5]!, overlayColors.tangent2);
        const size = (3 * scales[i]!) / strongest;
        lines.arrow(x, y, z, size * f[3 * i]!, size * f[3 * i + 1]!, size * f[3 * i + 2]!, overlayColors.friction);
      }
    }
    lines.end();
  }

  clear(): void {
    this.lines.begin();
    this.lines.end();
  }
}
