// How large a scene is, for the camera and the lights: a box around what there is to see. Planes have no end; fixed bodies that are
// far larger than everything that moves (floors, terrains) count only where they lie near that.
import type { BodyDescription, Box, Quat, ShapeDescription, ShapeGeometry, Vec3 } from '../protocol';

const empty = (): Box => ({ low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] });

function include(box: Box, other: Box): void {
  for (let i = 0; i < 3; i++) {
    box.low[i] = Math.min(box.low[i]!, other.low[i]!);
    box.high[i] = Math.max(box.high[i]!, other.high[i]!);
  }
}

const size = (box: Box): number => Math.hypot(box.high[0] - box.low[0], box.high[1] - box.low[1], box.high[2] - box.low[2]);

function around(half: Vec3): Box {
  return { low: [-half[0], -half[1], -half[2]], high: half };
}

// In the shape's own frame; null for what has no end.
function ownBox(geometry: ShapeGeometry, vertices: (surface: string) => Float32Array | undefined): Box | null {
  switch (geometry.kind) {
    case 'sphere':
      return around([geometry.radius, geometry.radius, geometry.radius]);
    case 'box':
      return around([...geometry.halfExtents]);
    case 'capsule':
      return around([geometry.radius, geometry.radius + geometry.halfHeight, geometry.radius]);
    case 'cylinder':
    case 'cone':
      return around([geometry.radius, geometry.halfHeight, geometry.radius]);
    case 'plane':
      return null;
    case 'surface': {
      const box = empty();
      const points = vertices(geometry.surface) ?? new Float32Array(0);
      for (let i = 0; i < points.length; i += 3) {
        const point: Vec3 = [points[i]!, points[i + 1]!, points[i + 2]!];
        include(box, { low: point, high: point });
      }
      return Number.isFinite(size(box)) ? box : null;
    }
  }
}

function matrix([x, y, z, w]: Quat): number[][] {
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
  ];
}

// The box around a turned and moved box.
function moved(box: Box, place: Vec3, turn: Quat): Box {
  const out: Box = { low: [0, 0, 0], high: [0, 0, 0] };
  matrix(turn).forEach((row, i) => {
    const center = row.reduce((sum, value, k) => sum + (value * (box.low[k]! + box.high[k]!)) / 2, place[i]!);
    const half = row.reduce((sum, value, k) => sum + (Math.abs(value) * (box.high[k]! - box.low[k]!)) / 2, 0);
    out.low[i] = center - half;
    out.high[i] = center + half;
  });
  return out;
}

function shapeBox(shape: ShapeDescription, vertices: (surface: string) => Float32Array | undefined): Box | null {
  const own = ownBox(shape.geometry, vertices);
  return own && moved(own, shape.position, shape.rotation);
}

// `poses`: 7 a body, as in frames.
export function extent(bodies: readonly BodyDescription[], poses: Float32Array, vertices: (surface: string) => Float32Array | undefined): Box {
  const moving = empty();
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
  const all = empty();
  const nothingMoves = !Number.isFinite(size(moving));
  if (!nothingMoves) include(all, moving);
  const reach = size(moving);
  for (const box of fixed) {
    if (nothingMoves || size(box) < 1.5 * reach) include(all, box);
    else include(all, near(box, moving, 0.15 * reach));
  }
  return Number.isFinite(size(all)) ? all : { low: [-2, 0, -2], high: [2, 2, 2] };
}

// The part of a large box that lies around a small one; the small one if they lie apart.
function near(large: Box, small: Box, more: number): Box {
  const part = empty();
  for (let i = 0; i < 3; i++) {
    part.low[i] = Math.max(large.low[i]!, small.low[i]! - more);
    part.high[i] = Math.min(large.high[i]!, small.high[i]! + more);
    if (part.low[i]! > part.high[i]!) return small;
  }
  return part;
}
