// Ropes, cloths and solids of a world: what the page is told about them once, and their vertices in each frame.
import { type SoftId, SoftKind, type World } from 'gyre-physics';
import type { SoftDescription, SoftKind as SoftKindName, SoftReport, Vec3 } from '../protocol';

export function softKindName(kind: number): SoftKindName {
  return kind === SoftKind.rope ? 'rope' : kind === SoftKind.cloth ? 'cloth' : 'solid';
}

export function describeSoft(world: World, id: SoftId, look: Pick<SoftDescription, 'key' | 'name' | 'color'>): SoftDescription {
  const { kind, vertices, radius } = world.softInfo(id);
  return { ...look, kind: softKindName(kind), vertices, radius, triangles: world.softTriangles(id).slice() };
}

// 3 a vertex, of all of them in this order.
export function readSoftVertices(world: World, ids: ArrayLike<SoftId>, origin: Vec3): Float32Array<ArrayBuffer> {
  if (ids.length === 0) return new Float32Array(0);
  const out = new Float32Array(3 * world.stats().softVertices);
  let to = 0;
  for (let i = 0; i < ids.length; i++) {
    const { x, y, z } = world.vertices(ids[i]!);
    for (let k = 0; k < x.length; k++) {
      out[to++] = x[k]! - origin[0];
      out[to++] = y[k]! - origin[1];
      out[to++] = z[k]! - origin[2];
    }
  }
  return out;
}

export function reportOnSoft(world: World, id: SoftId, key: number, name: string): SoftReport {
  const { kind, vertices, awake, mass, kineticEnergy, elasticEnergy, contacts } = world.softInfo(id);
  const state = { awake, mass, kinetic: kineticEnergy, elastic: elasticEnergy, contacts };
  return { key, name, kind: softKindName(kind), vertices, triangles: world.softTriangles(id).length / 3, state };
}
