// The speed of gases as a picture on a slice. It is drawn with the gases (draw/fluids.ts), which have the numbers on the graphics card; here is
// only the switch.
import { Group } from 'three';
import type { Overlay } from './overlay';

export class Speed implements Overlay {
  readonly object = new Group();

  update(): void {}

  clear(): void {}
}
