// The broad phase's tree: one box a node, coloured by depth from the root (warm) to the leaves (cold).
import { Color } from 'three';
import { heatColor } from '../draw/palette';
import { LineLayer } from './line_layer';
import type { Overlay, OverlayView } from './overlay';

export class Tree implements Overlay {
  private readonly lines = new LineLayer(1.2, { opacity: 0.7 });
  readonly object = this.lines.object;
  private readonly color = new Color();

  update({ frame }: OverlayView): void {
    this.lines.begin();
    const tree = frame.overlays.tree;
    if (tree) {
      const { corners: c, depths } = tree;
      const deepest = depths.reduce((most, depth) => Math.max(most, depth), 1);
      depths.forEach((depth, i) => {
        heatColor(1 - depth / deepest, this.color);
        this.lines.box(c[6 * i]!, c[6 * i + 1]!, c[6 * i + 2]!, c[6 * i + 3]!, c[6 * i + 4]!, c[6 * i + 5]!, this.color);
      });
    }
    this.lines.end();
  }

  clear(): void {
    this.lines.begin();
    this.lines.end();
  }
}
