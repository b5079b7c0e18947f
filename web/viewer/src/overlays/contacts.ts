// Contact points, and their normals as arrows from body a to body b: longer with more load, shortest where nothing presses.
// Yellow bears load, red slides.
import { Group } from 'three';
import { overlayColors } from '../draw/palette';
import { LineLayer } from './line_layer';
import { Marks } from './marks';
import type { Overlay, OverlayView } from './overlay';

export class Contacts implements Overlay {
  readonly object = new Group();
  private readonly marks = new Marks();
  private readonly lines = new LineLayer(2.2, { onTop: true });

  constructor() {
    this.object.add(this.marks.object, this.lines.object);
  }

  update({ frame }: OverlayView): void {
    this.clear();
    const points = frame.overlays.contacts;
    if (!points) return;
    const { positions: at, normals, forces, scales, sliding } = points;
    const strongest = forces.reduce((most, force) => Math.max(most, force), 1e-9);
    for (let i = 0; i < forces.length; i++) {
      const load = Math.sqrt(forces[i]! / strongest);
      const size = scales[i]!;
      const length = size * (0.25 + 1.2 * load);
      const color = sliding[i] ? overlayColors.slides : forces[i]! > 0 ? overlayColors.bears : overlayColors.near;
      const [x, y, z] = [at[3 * i]!, at[3 * i + 1]!, at[3 * i + 2]!];
      this.marks.add(x, y, z, 0.07 * size, color);
      this.lines.arrow(x, y, z, length * normals[3 * i]!, length * normals[3 * i + 1]!, length * normals[3 * i + 2]!, color);
    }
    this.marks.end();
    this.lines.end();
  }

  clear(): void {
    this.marks.begin();
    this.marks.end();
    this.lines.begin();
    this.lines.end();
  }
}
