// Islands: a box around the bodies that hang together, in the island's colour (the bodies themselves are painted by
// draw/body_painter.ts). Sleeping groups have a fainter box.
import { Color } from 'three';
import { numberColor } from '../draw/palette';
import { type BodyDescription, BodyFlag, type ShapeGeometry } from '../protocol';
import { LineLayer } from './line_layer';
import type { Overlay, OverlayView } from './overlay';

function reach(geometry: ShapeGeometry, vertices: (key: string) => Float32Array | undefined): number {
  switch (geometry.kind) {
    case 'sphere':
      return geometry.radius;
    case 'box':
      return Math.hypot(...geometry.halfExtents);
    case 'capsule':
      return geometry.radius + geometry.halfHeight;
    case 'cylinder':
    case 'cone':
      return Math.hypot(geometry.radius, geometry.halfHeight);
    case 'plane':
      return 0;
    case 'surface': {
      const points = vertices(geometry.surface) ?? new Float32Array(0);
      let far = 0;
      for (let i = 0; i < points.length; i += 3) far = Math.max(far, Math.hypot(points[i]!, points[i + 1]!, points[i + 2]!));
      return far;
    }
  }
}

export class Islands implements Overlay {
  private readonly lines = new LineLayer(1.6, { opacity: 0.9 });
  readonly object = this.lines.object;
  private readonly reaches = new WeakMap<BodyDescription, number>();
  private readonly color = new Color();
  private readonly gray = new Color('#8793a3');

  update({ frame, bodies }: OverlayView): void {
    const islands = frame.overlays.islands;
    this.lines.begin();
    if (islands) {
      const boxes = new Map<number, { low: number[]; high: number[]; awake: boolean }>();
      for (let row = 0; row < islands.length; row++) {
        const island = islands[row]!;
        const body = bodies.known.get(bodies.keys[row]!);
        if (island < 0 || !body) continue;
        const radius = this.reachOf(body, (key) => bodies.surfaces.get(key)?.vertices);
        let box = boxes.get(island);
        if (!box) boxes.set(island, (box = { low: [1e9, 1e9, 1e9], high: [-1e9, -1e9, -1e9], awake: false }));
        for (let i = 0; i < 3; i++) {
          const place = bodies.poses[7 * row + i]!;
          box.low[i] = Math.min(box.low[i]!, place - radius);
          box.high[i] = Math.max(box.high[i]!, place + radius);
        }
        if (frame.flags[row]! & BodyFlag.awake) box.awake = true;
      }
      for (const [island, { low, high, awake }] of boxes) {
        numberColor(island, this.color);
        if (!awake) this.color.lerp(this.gray, 0.65);
        this.lines.box(low[0]!, low[1]!, low[2]!, high[0]!, high[1]!, high[2]!, this.color);
      }
    }
    this.lines.end();
  }

  // Farthest that any shape of the body comes from its origin, whichever way it turns.
  private reachOf(body: BodyDescription, vertices: (key: string) => Float32Array | undefined): number {
    let known = this.reaches.get(body);
    if (known === undefined) {
      known = Math.max(0, ...body.shapes.map((shape) => Math.hypot(...shape.position) + reach(shape.geometry, vertices)));
      this.reaches.set(body, known);
    }
    return known;
  }

  clear(): void {
    this.lines.begin();
    this.lines.end();
  }
}
