// Which colour a body has: the scene's, or by material, by body, by sleep or by speed; and by island while that overlay is on.
import { Color } from 'three';
import { type BodyDescription, BodyFlag, type Frame } from '../protocol';
import type { ColorBy } from '../state/preferences';
import { asleepColor, awakeColor, bodyColor, heatColor, materialColor, numberColor, type ThemeColors } from './palette';

const FAST = 8; // m/s drawn as red

export class BodyPainter {
  colorBy: ColorBy = 'scene';
  islands = false;
  private readonly gray = new Color('#7d8794');

  constructor(public theme: ThemeColors) {}

  // Whether the colours follow the state and so have to be looked at with each frame.
  get changes(): boolean {
    return this.islands || this.colorBy === 'sleep' || this.colorBy === 'speed';
  }

  color(frame: Frame, row: number, body: BodyDescription | undefined, material: string, given: number | null, out: Color): Color {
    const flags = frame.flags[row] ?? 0;
    const awake = (flags & BodyFlag.awake) !== 0;
    const dynamic = (flags & BodyFlag.dynamic) !== 0;
    const { islands } = frame.overlays;
    if (this.islands && islands) {
      const island = islands[row] ?? -1;
      if (!dynamic) return out.copy(this.theme.fixed);
      (island >= 0 ? numberColor(island, out) : out.copy(this.gray));
      return awake ? out : out.lerp(this.gray, 0.65);
    }
    if (this.colorBy === 'sleep' && dynamic) return out.copy(awake ? awakeColor : asleepColor);
    if (this.colorBy === 'speed' && dynamic) {
      const v = frame.velocities;
      return heatColor(Math.hypot(v[6 * row]!, v[6 * row + 1]!, v[6 * row + 2]!) / FAST, out);
    }
    if (this.colorBy === 'scene' && given !== null) return shade(out.set(given), body);
    if (this.colorBy === 'material' && material !== '') return shade(materialColor(material, out), body);
    if (!dynamic && body?.type !== 'kinematic') return out.copy(this.theme.fixed);
    return bodyColor(body?.key ?? row, out);
  }
}

// A shade of its own for each body, or a wall would be one blot.
function shade(color: Color, body: BodyDescription | undefined): Color {
  return color.offsetHSL(0, 0, ((((body?.key ?? 0) * 7) % 11) - 5) * 0.008);
}
