// Velocities at the centre of mass: linear, the way of a quarter of a second; angular, along the axis of turning, a quarter of the
// scene's radius for a whole turn a second, up to twice that. What stands still has none.
import { Quaternion, Vector3 } from 'three';
import { overlayColors } from '../draw/palette';
import { LineLayer } from './line_layer';
import type { Overlay, OverlayView } from './overlay';

const SECONDS = 1 / 4;

export class Velocities implements Overlay {
  private readonly lines = new LineLayer(2, { onTop: true });
  readonly object = this.lines.object;

  update({ frame, bodies, scale }: OverlayView): void {
    const { lines } = this;
    const center = new Vector3();
    const turn = new Quaternion();
    const still = 0.002 * scale;
    const perTurn = (0.25 * scale) / (2 * Math.PI);
    const longest = 0.5 * scale;
    lines.begin();
    for (let row = 0; row < frame.flags.length; row++) {
      const body = bodies.known.get(bodies.keys[row]!);
      if (!body || body.type === 'fixed') continue;
      const v = frame.velocities.subarray(6 * row, 6 * row + 6);
      turn.fromArray(bodies.poses, 7 * row + 3);
      center.set(...body.centerOfMass).applyQuaternion(turn);
      const x = bodies.poses[7 * row]! + center.x;
      const y = bodies.poses[7 * row + 1]! + center.y;
      const z = bodies.poses[7 * row + 2]! + center.z;
      if (SECONDS * Math.hypot(v[0]!, v[1]!, v[2]!) > still) {
        lines.arrow(x, y, z, SECONDS * v[0]!, SECONDS * v[1]!, SECONDS * v[2]!, overlayColors.linear);
      }
      const spin = Math.hypot(v[3]!, v[4]!, v[5]!);
      if (perTurn * spin > still) {
        const unit = Math.min(perTurn, longest / spin);
        lines.arrow(x, y, z, unit * v[3]!, unit * v[4]!, unit * v[5]!, overlayColors.angular);
      }
    }
    lines.end();
  }

  clear(): void {
    this.lines.begin();
    this.lines.end();
  }
}
