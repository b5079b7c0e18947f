// Joint frames: the anchor on each body with three axes (red is the joint's own), and a line between the two: grey for
// rods, ropes and springs, pink for what ought to be one point and is not.
import { Group, Quaternion, Vector3 } from 'three';
import { overlayColors } from '../draw/palette';
import { LineLayer } from './line_layer';
import { Marks } from './marks';
import type { Overlay, OverlayView } from './overlay';

const AXES = [
  [new Vector3(1, 0, 0), overlayColors.axisX],
  [new Vector3(0, 1, 0), overlayColors.axisY],
  [new Vector3(0, 0, 1), overlayColors.axisZ],
] as const;

export class Joints implements Overlay {
  readonly object = new Group();
  private readonly lines = new LineLayer(2.4, { onTop: true });
  private readonly marks = new Marks();
  private readonly turn = new Quaternion();
  private readonly axis = new Vector3();

  constructor() {
    this.object.add(this.lines.object, this.marks.object);
  }

  update({ frame, scale }: OverlayView): void {
    this.lines.begin();
    this.marks.begin();
    const joints = frame.overlays.joints;
    if (joints) {
      const { anchors, frames, rigid } = joints;
      for (let i = 0; i < rigid.length; i++) {
        this.frameAt(anchors, 6 * i, frames, 8 * i, 0.06 * scale);
        this.frameAt(anchors, 6 * i + 3, frames, 8 * i + 4, 0.042 * scale);
        const [ax, ay, az, bx, by, bz] = anchors.subarray(6 * i, 6 * i + 6);
        this.lines.line(ax!, ay!, az!, bx!, by!, bz!, rigid[i] ? overlayColors.gap : overlayColors.link);
      }
    }
    this.lines.end();
    this.marks.end();
  }

  private frameAt(places: Float32Array, at: number, turns: Float32Array, turnAt: number, reach: number): void {
    const [x, y, z] = [places[at]!, places[at + 1]!, places[at + 2]!];
    this.turn.fromArray(turns, turnAt);
    for (const [direction, color] of AXES) {
      this.axis.copy(direction).applyQuaternion(this.turn).multiplyScalar(reach);
      this.lines.line(x, y, z, x + this.axis.x, y + this.axis.y, z + this.axis.z, color);
    }
    this.marks.add(x, y, z, 0.1 * reach, overlayColors.center);
  }

  clear(): void {
    this.lines.begin();
    this.lines.end();
    this.marks.begin();
    this.marks.end();
  }
}
