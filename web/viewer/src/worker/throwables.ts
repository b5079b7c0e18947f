// What can be thrown, by its size: about the volume of a ball of that radius.
import { box, capsule, cone, cylinder, sphere, type AnyShapeInput } from 'gyre-physics';
import type { Throwable } from '../protocol';

export function throwableShape(what: Throwable, size: number): AnyShapeInput {
  switch (what) {
    case 'ball':
      return sphere({ radius: size });
    case 'box':
      return box({ halfExtents: [0.8 * size, 0.8 * size, 0.8 * size] });
    case 'capsule':
      return capsule({ radius: 0.65 * size, halfHeight: 0.75 * size });
    case 'cylinder':
      return cylinder({ radius: 0.8 * size, halfHeight: 0.8 * size });
    case 'cone':
      return cone({ radius: size, halfHeight: size });
  }
}
