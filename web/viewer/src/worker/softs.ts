// Ropes, cloths and solids of a world: what the page is told about them once, and their vertices in each frame.
import { type SoftId, SoftKind, type World } from 'gyre-physics';
import type { SoftDescription, SoftKind as SoftKindName, SoftReport, Vec3 } from '../protocol';

export function softKindName(kind: number): SoftKindName {
  return kind === SoftKind.rope ? 'rope' : kind === SoftKind.cloth ? 'cloth' : 'solid';
}

// The drawn points of one: three numbers a vertex, or its coordinates one by one. Of a solid that was made of a surface that surface, which its
// tetrahedra carry along.
function drawn(world: World, id: SoftId): { rows: Float64Array } | { columns: [Float64Array, Float64Array, Float64Array] } {
  const rows = world.softSurface(id);
  if (rows.length > 0) return { rows };
  const { x, y, z } = world.vertices(id);
  return { columns: [x, y, z] };
}

export function describeSoft(world: World, id: SoftId, look: Pick<SoftDescription, 'key' | 'name' | 'color'>): SoftDescription {
  const { kind, vertices, radius } = world.softInfo(id);
  const carried = world.softSurface(id).length / 3;
  const triangles = (carried > 0 ? world.softSurfaceTriangles(id) : world.softTriangles(id)).slice();
  return { ...look, kind: softKindName(kind), vertices: carried || vertices, radius, triangles };
}

// 3 a vertex, of all of them in this order.
export function readSoftVertices(world: World, ids: ArrayLike<SoftId>, origin: Vec3): Float32Array<ArrayBuffer> {
  const parts = Array.from(ids, (id): Float32Array => {
    const what = drawn(world, id);
    if ('rows' in what) return Float32Array.from(what.rows, (value, i) => value - origin[i % 3]!);
    const [x, y, z] = what.columns;
    const out = new Float32Array(3 * x.length);
    for (let i = 0; i < x.length; i++) {
      out[3 * i] = x[i]! - origin[0];
      out[3 * i + 1] = y[i]! - origin[1];
      out[3 * i + 2] = z[i]! - origin[2];
    }
    return out;
  });
  if (parts.length === 1) return parts[0] as Float32Array<ArrayBuffer>;
  const all = new Float32Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

export function reportOnSoft(world: World, id: SoftId, key: number, name: string): SoftReport {
  const { kind, vertices, mass, kineticEnergy, elasticEnergy, contacts } = world.softInfo(id);
  const state = { mass, kinetic: kineticEnergy, elastic: elasticEnergy, contacts };
  return { key, name, kind: softKindName(kind), vertices, triangles: world.softTriangles(id).length / 3, state };
}
