// Islands: a box around the bodies that hang together, in the island's colour (the bodies themselves are painted by
// draw/body_painter.ts). Sleeping groups have a fainter box.
import { Color } from 'three';
import { emptyBox, include, moved, shapeBox } from '../boxes';
import { numberColor } from '../draw/palette';
import { type BodyDescription, BodyFlag, type Box, type Quat, type Vec3 } from '../protocol';
import { LineLayer } from './line_layer';
import type { Overlay, OverlayView } from './overlay';

export class Islands implements Overlay {
  private readonly lines = new LineLayer(1.6, { opacity: 0.9 });
  readonly object = this.lines.object;
  private readonly own = new WeakMap<BodyDescription, Box[]>(); // boxes of its shapes, in the body's frame
  private readonly color = new Color();
  private readonly gray = new Color('#8793a3');

  update({ frame, bodies }: OverlayView): void {
    this.lines.begin();
    const found = new Map<number, { box: Box; awake: boolean }>();
    (frame.overlays.islands ?? []).forEach((number, row) => {
      const body = bodies.known.get(bodies.keys[row]!);
      if (number < 0 || !body) return;
      let island = found.get(number);
      if (!island) found.set(number, (island = { box: emptyBox(), awake: false }));
      const pose = Array.from(bodies.poses.subarray(7 * row, 7 * row + 7));
      for (const own of this.boxesOf(body, (key) => bodies.surfaces.get(key)?.vertices)) {
        include(island.box, moved(own, pose.slice(0, 3) as Vec3, pose.slice(3) as Quat));
      }
      if (frame.flags[row]! & BodyFlag.awake) island.awake = true;
    });
    for (const [number, { box, awake }] of found) {
      numberColor(number, this.color);
      if (!awake) this.color.lerp(this.gray, 0.65);
      this.lines.box(...box.low, ...box.high, this.color);
    }
    this.lines.end();
  }

  private boxesOf(body: BodyDescription, vertices: (key: string) => Float32Array | undefined): Box[] {
    let own = this.own.get(body);
    if (!own) {
      own = body.shapes.map((shape) => shapeBox(shape, vertices)).filter((box) => box !== null);
      this.own.set(body, own);
    }
    return own;
  }

  clear(): void {
    this.lines.begin();
    this.lines.end();
  }
}
