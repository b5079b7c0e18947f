// Rods, ropes and springs as thin lines between their anchors: what hangs on them would else hang on nothing. The hand that pulls a
// body is one of them.
import { Color } from 'three';
import { LineLayer } from '../overlays/line_layer';
import type { Frame } from '../protocol';

export class Links {
  private readonly lines = new LineLayer(1.8);
  readonly object = this.lines.object;
  private readonly color = new Color();

  setColor(color: Color): void {
    this.color.copy(color);
  }

  update({ links }: Frame): void {
    if (links.length === 0 && this.lines.lines === 0) return;
    this.lines.begin();
    for (let i = 0; i < links.length; i += 6) {
      this.lines.line(links[i]!, links[i + 1]!, links[i + 2]!, links[i + 3]!, links[i + 4]!, links[i + 5]!, this.color);
    }
    this.lines.end();
  }
}
