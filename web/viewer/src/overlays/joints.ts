// Joint frames: the anchor on each body with three axes (red is the joint's own), and a line between the two: grey for
// rods, ropes and springs, pink for what ought to be one point and is not. Limits are an arc or a stretch in the light color of
// axis y, with a hand where the joint is; what its motor is after goes on from there in that of axis x.
import { type Color, Group, Quaternion, Vector3 } from 'three';
import { overlayColors } from '../draw/palette';
import type { JointData } from '../protocol';
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
  private readonly from = new Vector3();

  constructor() {
    this.object.add(this.lines.object, this.marks.object);
  }

  update({ frame, scale }: OverlayView): void {
    this.lines.begin();
    this.marks.begin();
    const joints = frame.overlays.joints;
    if (joints) {
      const { anchors, frames, rigid, ways } = joints;
      for (let i = 0; i < rigid.length; i++) {
        this.frameAt(anchors, 6 * i, frames, 8 * i, 0.06 * scale);
        this.frameAt(anchors, 6 * i + 3, frames, 8 * i + 4, 0.042 * scale);
        const [ax, ay, az, bx, by, bz] = anchors.subarray(6 * i, 6 * i + 6);
        this.lines.line(ax!, ay!, az!, bx!, by!, bz!, rigid[i] ? overlayColors.gap : overlayColors.link);
        if (ways[i]) this.travel(joints, i, 0.1 * scale);
      }
    }
    this.lines.end();
    this.marks.end();
  }

  // What the joint may do along or about the x of its frame on a.
  private travel(joints: JointData, i: number, reach: number): void {
    const [x, y, z] = joints.anchors.subarray(6 * i, 6 * i + 3);
    this.turn.fromArray(joints.frames, 8 * i);
    const turns = joints.ways[i] === 1;
    // Where the place `at` on the axis is drawn, `share` of the reach away.
    const spot = (at: number, share: number): Vector3 =>
      (turns ? this.axis.set(0, Math.cos(at), Math.sin(at)).multiplyScalar(share * reach) : this.axis.set(at, 0, 0))
        .applyQuaternion(this.turn)
        .add(this.from.set(x!, y!, z!))
        .clone();
    const draw = (a: Vector3, b: Vector3, color: Color): void => this.lines.line(a.x, a.y, a.z, b.x, b.y, b.z, color);
    const along = (low: number, high: number, share: number, color: Color): void => {
      const parts = turns ? Math.max(2, Math.ceil(Math.abs(high - low) / 0.2)) : 1;
      for (let k = 0; k < parts; k++) {
        draw(spot(low + ((high - low) * k) / parts, share), spot(low + ((high - low) * (k + 1)) / parts, share), color);
      }
    };
    const [low, high] = joints.limits.subarray(2 * i, 2 * i + 2);
    const now = joints.positions[i]!;
    const limited = !Number.isNaN(low!);
    if (limited) along(low!, high!, 1, overlayColors.axisY);
    const drive = Math.max(-1, Math.min(1, joints.motors[i]!)) * (turns ? 1 : reach);
    if (drive !== 0) along(now, now + drive, 0.8, overlayColors.axisX);
    if (turns && (limited || drive !== 0)) draw(this.from.set(x!, y!, z!).clone(), spot(now, 1), overlayColors.center);
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
