// How large a scene is, for the camera and the lights: a box around what there is to see. Planes have no end; fixed bodies that are
// far larger than everything that moves (floors, terrains) count only where they lie near that.
import { emptyBox, include, moved, shapeBox, sizeOf } from '../boxes';
import type { BodyDescription, Box, Quat, Vec3 } from '../protocol';

// `poses`: 7 a body, `soft`: 3 a vertex, as in frames.
export function extent(
  bodies: readonly BodyDescription[],
  poses: Float32Array,
  vertices: (surface: string) => Float32Array | undefined,
  soft: Float32Array,
): Box {
  const moving = emptyBox();
  for (let i = 0; i < soft.length; i += 3) {
    const place = Array.from(soft.subarray(i, i + 3)) as Vec3;
    include(moving, { low: place, high: place });
  }
  const fixed: Box[] = [];
  bodies.forEach((body, row) => {
    const place = Array.from(poses.subarray(7 * row, 7 * row + 3)) as Vec3;
    const turn = Array.from(poses.subarray(7 * row + 3, 7 * row + 7)) as Quat;
    for (const shape of body.shapes) {
      const own = shapeBox(shape, vertices);
      if (!own) continue;
      const box = moved(own, place, turn);
      if (body.type === 'fixed') fixed.push(box);
      else include(moving, box);
    }
  });
  const all = emptyBox();
  const nothingMoves = !Number.isFinite(sizeOf(moving));
  if (!nothingMoves) include(all, moving);
  const reach = sizeOf(moving);
  for (const box of fixed) {
    if (nothingMoves || sizeOf(box) < 1.5 * reach) include(all, box);
    else include(all, near(box, moving, 0.15 * reach));
  }
  return Number.isFinite(sizeOf(all)) ? all : { low: [-2, 0, -2], high: [2, 2, 2] };
}

// The part of a large box that lies around a small one; the small one if they lie apart.
function near(large: Box, small: Box, more: number): Box {
  const part = emptyBox();
  for (let i = 0; i < 3; i++) {
    part.low[i] = Math.max(large.low[i]!, small.low[i]! - more);
    part.high[i] = Math.min(large.high[i]!, small.high[i]! + more);
    if (part.low[i]! > part.high[i]!) return small;
  }
  return part;
}
