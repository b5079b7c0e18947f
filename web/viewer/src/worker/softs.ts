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

// One array after the other.
function joined(parts: Float32Array[]): Float32Array<ArrayBuffer> {
  if (parts.length === 1) return parts[0] as Float32Array<ArrayBuffer>;
  const all = new Float32Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
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
  return joined(parts);
}

// Stress or strain at the vertices of one, the mean of the elements around; empty where there is none to read.
function atVertices(world: World, id: SoftId, what: 'stress' | 'strain'): Float32Array {
  const values = what === 'stress' ? world.solidStress(id) : world.softStrain(id);
  const { kind, vertices } = world.softInfo(id);
  if (values.length === 0) return new Float32Array(0);
  const sum = new Float32Array(vertices);
  const count = new Uint32Array(vertices);
  const corners = kind === SoftKind.rope ? null : kind === SoftKind.cloth ? world.softTriangles(id) : world.solidTetrahedra(id);
  const each = kind === SoftKind.rope ? 2 : kind === SoftKind.cloth ? 3 : 4;
  for (let i = 0; i < each * values.length; i++) {
    const vertex = corners ? corners[i]! : (i >> 1) + (i & 1);
    sum[vertex]! += values[Math.floor(i / each)]!;
    count[vertex]!++;
  }
  return sum.map((value, i) => (count[i]! > 0 ? value / count[i]! : NaN));
}

// Of each point of the surface that a solid carries the nearest of its vertices, found when it is first asked for.
const nearest = new WeakMap<World, Map<SoftId, Uint32Array>>();
function nearestVertices(world: World, id: SoftId): Uint32Array {
  const known = nearest.get(world) ?? new Map<SoftId, Uint32Array>();
  nearest.set(world, known);
  const found = known.get(id);
  if (found) return found;
  const points = world.softSurface(id);
  const { x, y, z } = world.vertices(id);
  const made = new Uint32Array(points.length / 3);
  for (let i = 0; i < made.length; i++) {
    let least = Infinity;
    for (let k = 0; k < x.length; k++) {
      const apart = (points[3 * i]! - x[k]!) ** 2 + (points[3 * i + 1]! - y[k]!) ** 2 + (points[3 * i + 2]! - z[k]!) ** 2;
      if (apart >= least) continue;
      least = apart;
      made[i] = k;
    }
  }
  known.set(id, made);
  return made;
}

// 1 a drawn vertex, of all in the order of the world; NaN where there is none. `carried`: solids are drawn as the surface that they carry.
export function readSoftReadings(world: World, what: 'stress' | 'strain', carried: boolean): Float32Array {
  const parts = Array.from(world.softs().slice(), (id): Float32Array => {
    const values = atVertices(world, id, what);
    const surface = carried ? world.softSurface(id).length / 3 : 0;
    if (values.length === 0) return new Float32Array(surface || world.softInfo(id).vertices).fill(NaN);
    return surface > 0 ? Float32Array.from(nearestVertices(world, id), (vertex) => values[vertex]!) : values;
  });
  return joined(parts);
}

export function reportOnSoft(world: World, id: SoftId, key: number, name: string): SoftReport {
  const { kind, vertices, mass, kineticEnergy, elasticEnergy, contacts } = world.softInfo(id);
  const state = { mass, kinetic: kineticEnergy, elastic: elasticEnergy, contacts };
  return { key, name, kind: softKindName(kind), vertices, triangles: world.softTriangles(id).length / 3, state };
}
