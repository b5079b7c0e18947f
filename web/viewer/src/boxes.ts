// Boxes around shapes, shared by worker and page. `vertices` gives those of a surface by its key.
import type { Box, Quat, ShapeDescription, ShapeGeometry, Vec3 } from './protocol';

type Vertices = (surface: string) => Float32Array | undefined;

export const emptyBox = (): Box => ({ low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity] });

export function include(box: Box, other: Box): void {
  for (let i = 0; i < 3; i++) {
    box.low[i] = Math.min(box.low[i]!, other.low[i]!);
    box.high[i] = Math.max(box.high[i]!, other.high[i]!);
  }
}

export const sizeOf = (box: Box): number => Math.hypot(box.high[0] - box.low[0], box.high[1] - box.low[1], box.high[2] - box.low[2]);

function around(half: Vec3): Box {
  return { low: [-half[0], -half[1], -half[2]], high: half };
}

// In the shape's own frame; null for what has no end.
function ownBox(geometry: ShapeGeometry, vertices: Vertices): Box | null {
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
      const box = emptyBox();
      const points = vertices(geometry.surface) ?? new Float32Array(0);
      for (let i = 0; i < points.length; i += 3) {
        const point: Vec3 = [points[i]!, points[i + 1]!, points[i + 2]!];
        include(box, { low: point, high: point });
      }
      return Number.isFinite(sizeOf(box)) ? box : null;
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
export function moved(box: Box, place: Vec3, turn: Quat): Box {
  const out: Box = { low: [0, 0, 0], high: [0, 0, 0] };
  matrix(turn).forEach((row, i) => {
    const center = row.reduce((sum, value, k) => sum + (value * (box.low[k]! + box.high[k]!)) / 2, place[i]!);
    const half = row.reduce((sum, value, k) => sum + (Math.abs(value) * (box.high[k]! - box.low[k]!)) / 2, 0);
    out.low[i] = center - half;
    out.high[i] = center + half;
  });
  return out;
}

export function shapeBox(shape: ShapeDescription, vertices: Vertices): Box | null {
  const own = ownBox(shape.geometry, vertices);
  return own && moved(own, shape.position, shape.rotation);
}
