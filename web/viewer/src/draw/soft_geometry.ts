// Meshes of ropes, cloths and solids, filled anew from their vertices: a tube along a rope, the triangles of a cloth or of a solid's
// surface, with normals that are the means of the faces around.
import { BufferAttribute, BufferGeometry, DynamicDrawUsage } from 'three';
import type { SoftDescription } from '../protocol';

const SIDES = 10; // of a tube
const COSINES = Array.from({ length: SIDES + 1 }, (_, side) => Math.cos((2 * Math.PI * side) / SIDES));
const SINES = Array.from({ length: SIDES + 1 }, (_, side) => Math.sin((2 * Math.PI * side) / SIDES));
const CREASE = Math.cos(0.7); // a solid's faces that meet at a larger angle when it is first seen have an edge between them
const STRIPE = 12; // radii of a rope from one stripe to the next

export interface SoftMesh {
  readonly geometry: BufferGeometry;
  readonly edge: number; // m, the mean length of its edges when it was first seen
  // `vertices`: 3 each, of this rope, cloth or solid alone.
  fill(vertices: Float32Array): void;
  // 3 a vertex of this one: red, green, blue.
  paint(colors: Float32Array): void;
}

// `source(i)`: the vertex of the soft matter that the i-th drawn one has its colour of.
function paintVertices(geometry: BufferGeometry, colors: Float32Array, source: (drawn: number) => number): void {
  const count = geometry.getAttribute('position').count;
  if (!geometry.hasAttribute('color')) geometry.setAttribute('color', dynamic(count, 3));
  const color = geometry.getAttribute('color') as BufferAttribute;
  for (let i = 0; i < count; i++) color.array.set(colors.subarray(3 * source(i), 3 * source(i) + 3), 3 * i);
  color.needsUpdate = true;
}

export function softMesh(soft: SoftDescription, vertices: Float32Array): SoftMesh {
  return soft.kind === 'rope' ? new Tube(soft, vertices) : new Skin(soft, vertices);
}

function dynamic(count: number, width: number): BufferAttribute {
  const attribute = new BufferAttribute(new Float32Array(width * count), width);
  attribute.setUsage(DynamicDrawUsage);
  return attribute;
}

// ---------------------------------------------------------------------------------------------------------- cloths and solids

class Skin implements SoftMesh {
  readonly geometry = new BufferGeometry();
  readonly edge: number;
  private readonly sources: Uint32Array; // which vertex each drawn vertex is at
  private readonly corners: Uint32Array; // three drawn vertices a triangle

  constructor({ kind, triangles }: SoftDescription, vertices: Float32Array) {
    const parted = part(triangles, kind === 'solid' ? faceNormals(triangles, vertices) : null);
    this.sources = parted.sources;
    this.corners = parted.corners;
    this.geometry.setIndex(new BufferAttribute(this.corners, 1));
    this.geometry.setAttribute('position', dynamic(this.sources.length, 3));
    this.geometry.setAttribute('normal', dynamic(this.sources.length, 3));
    this.fill(vertices);
    this.edge = meanEdge(triangles, vertices);
  }

  fill(vertices: Float32Array): void {
    const { sources, corners } = this;
    const position = this.geometry.getAttribute('position') as BufferAttribute;
    const normal = this.geometry.getAttribute('normal') as BufferAttribute;
    const p = position.array as Float32Array;
    const n = normal.array as Float32Array;
    for (let i = 0; i < sources.length; i++) {
      const from = 3 * sources[i]!;
      p[3 * i] = vertices[from]!;
      p[3 * i + 1] = vertices[from + 1]!;
      p[3 * i + 2] = vertices[from + 2]!;
    }
    n.fill(0);
    // Of a triangle, the cross product of two edges: its area weighs it.
    for (let i = 0; i < corners.length; i += 3) {
      const a = 3 * corners[i]!;
      const b = 3 * corners[i + 1]!;
      const c = 3 * corners[i + 2]!;
      const ux = p[b]! - p[a]!;
      const uy = p[b + 1]! - p[a + 1]!;
      const uz = p[b + 2]! - p[a + 2]!;
      const vx = p[c]! - p[a]!;
      const vy = p[c + 1]! - p[a + 1]!;
      const vz = p[c + 2]! - p[a + 2]!;
      const x = uy * vz - uz * vy;
      const y = uz * vx - ux * vz;
      const z = ux * vy - uy * vx;
      for (const corner of [a, b, c]) {
        n[corner]! += x;
        n[corner + 1]! += y;
        n[corner + 2]! += z;
      }
    }
    for (let i = 0; i < n.length; i += 3) {
      const size = Math.hypot(n[i]!, n[i + 1]!, n[i + 2]!);
      if (size === 0) continue;
      n[i]! /= size;
      n[i + 1]! /= size;
      n[i + 2]! /= size;
    }
    position.needsUpdate = true;
    normal.needsUpdate = true;
  }

  paint(colors: Float32Array): void {
    paintVertices(this.geometry, colors, (drawn) => this.sources[drawn]!);
  }
}

function meanEdge(triangles: Uint32Array, vertices: Float32Array): number {
  let sum = 0;
  for (let i = 0; i < triangles.length; i++) sum += distance(vertices, triangles[i]!, triangles[i % 3 === 2 ? i - 2 : i + 1]!);
  return sum / Math.max(triangles.length, 1);
}

function faceNormals(triangles: Uint32Array, p: Float32Array): Float32Array {
  const out = new Float32Array(triangles.length);
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = [3 * triangles[i]!, 3 * triangles[i + 1]!, 3 * triangles[i + 2]!];
    const u = [p[b]! - p[a]!, p[b + 1]! - p[a + 1]!, p[b + 2]! - p[a + 2]!] as const;
    const v = [p[c]! - p[a]!, p[c + 1]! - p[a + 1]!, p[c + 2]! - p[a + 2]!] as const;
    const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]] as const;
    const size = Math.hypot(...normal) || 1;
    out.set(normal.map((value) => value / size), i);
  }
  return out;
}

// The vertices that triangles use, each as often as there are creases through it. Without normals there are no creases.
function part(triangles: Uint32Array, normals: Float32Array | null): { sources: Uint32Array; corners: Uint32Array } {
  const sources: number[] = [];
  const first: number[] = []; // of each drawn vertex, its first corner's triangle
  const drawn = new Map<number, number[]>(); // by vertex
  const corners = triangles.map((vertex, corner) => {
    const triangle = corner - (corner % 3);
    const known = drawn.get(vertex) ?? [];
    const same = known.find((one) => normals === null || product(normals, first[one]!, triangle) > CREASE);
    if (same !== undefined) return same;
    drawn.set(vertex, [...known, sources.length]);
    first.push(triangle);
    return sources.push(vertex) - 1;
  });
  return { sources: Uint32Array.from(sources), corners };
}

const product = (v: Float32Array, a: number, b: number): number => v[a]! * v[b]! + v[a + 1]! * v[b + 1]! + v[a + 2]! * v[b + 2]!;

// ----------------------------------------------------------------------------------------------------------------------- ropes

// A ring around each vertex, across the mean of the two directions there, and one of no width at each end. From ring to ring it turns as
// little as it can, so that the tube does not twist.
class Tube implements SoftMesh {
  readonly geometry = new BufferGeometry();
  readonly edge: number;
  private readonly rings: number;

  constructor(
    private readonly soft: SoftDescription,
    vertices: Float32Array,
  ) {
    this.rings = soft.vertices + 4; // at each end two more: the edge of the end, and its middle
    const index: number[] = [];
    for (let ring = 0; ring + 1 < this.rings; ring++) {
      // The edge of an end has two rings in one place, with the normals of the end and of the side.
      if (ring === 1 || ring === this.rings - 3) continue;
      for (let side = 0; side < SIDES; side++) {
        const a = ring * (SIDES + 1) + side;
        index.push(a, a + 1, a + SIDES + 1, a + 1, a + SIDES + 2, a + SIDES + 1);
      }
    }
    const count = this.rings * (SIDES + 1);
    this.geometry.setIndex(index);
    this.geometry.setAttribute('position', dynamic(count, 3));
    this.geometry.setAttribute('normal', dynamic(count, 3));
    this.geometry.setAttribute('uv', new BufferAttribute(stripes(soft, vertices), 2));
    this.fill(vertices);
    this.edge = distance(vertices, 0, 1);
  }

  fill(vertices: Float32Array): void {
    const last = this.soft.vertices - 1;
    let across: Triple = [0, 0, 0];
    let along: Triple = [0, 1, 0];
    for (let i = 0; i <= last; i++) {
      const before = direction(vertices, Math.max(i - 1, 0), Math.max(i, 1), along);
      const after = direction(vertices, Math.min(i, last - 1), Math.min(i + 1, last), before);
      along = unit([before[0] + after[0], before[1] + after[1], before[2] + after[2]], after);
      across = unit(without(across, along), anyAcross(along));
      // Where the rope bends, the ring is an ellipse across both directions.
      const bend = Math.min(1 / Math.max(dot(along, before), 0.5), 1.5);
      const bent = unit([after[0] - before[0], after[1] - before[1], after[2] - before[2]], along);
      if (i === 0) this.end(0, vertices, 0, along, across, -1);
      this.ring(i + 2, vertices, i, along, across, { bend, bent });
      if (i === last) this.end(this.rings - 1, vertices, i, along, across, 1);
    }
    (this.geometry.getAttribute('position') as BufferAttribute).needsUpdate = true;
    (this.geometry.getAttribute('normal') as BufferAttribute).needsUpdate = true;
  }

  paint(colors: Float32Array): void {
    const last = this.soft.vertices - 1;
    paintVertices(this.geometry, colors, (drawn) => Math.min(Math.max(Math.floor(drawn / (SIDES + 1)) - 2, 0), last));
  }

  private ring(ring: number, vertices: Float32Array, at: number, along: Triple, across: Triple, { bend, bent }: { bend: number; bent: Triple }): void {
    const p = this.geometry.getAttribute('position').array as Float32Array;
    const n = this.geometry.getAttribute('normal').array as Float32Array;
    const other = cross(along, across);
    const { radius } = this.soft;
    const bentAcross = (bend - 1) * dot(across, bent);
    const bentOther = (bend - 1) * dot(other, bent);
    for (let side = 0; side <= SIDES; side++) {
      const c = COSINES[side]!;
      const s = SINES[side]!;
      const to = 3 * (ring * (SIDES + 1) + side);
      const more = c * bentAcross + s * bentOther;
      for (let k = 0; k < 3; k++) {
        const out = c * across[k]! + s * other[k]!;
        p[to + k] = vertices[3 * at + k]! + radius * (out + more * bent[k]!);
        n[to + k] = out;
      }
    }
  }

  // The flat end: its middle and its edge, both looking out.
  private end(middle: number, vertices: Float32Array, at: number, along: Triple, across: Triple, way: number): void {
    this.ring(middle - way, vertices, at, along, across, { bend: 1, bent: along });
    const p = this.geometry.getAttribute('position').array as Float32Array;
    const n = this.geometry.getAttribute('normal').array as Float32Array;
    for (let side = 0; side <= SIDES; side++) {
      for (let k = 0; k < 3; k++) {
        p[3 * (middle * (SIDES + 1) + side) + k] = vertices[3 * at + k]!;
        for (const ring of [middle, middle - way]) n[3 * (ring * (SIDES + 1) + side) + k] = way * along[k]!;
      }
    }
  }
}

// Around the rope from 0 to 1; along it, so many stripes.
function stripes({ vertices: count, radius }: SoftDescription, vertices: Float32Array): Float32Array {
  const out = new Float32Array(2 * (count + 4) * (SIDES + 1));
  let length = 0;
  for (let ring = 0; ring < count + 4; ring++) {
    const at = Math.min(Math.max(ring - 2, 0), count - 1);
    if (ring > 2 && ring < count + 2) length += distance(vertices, at - 1, at);
    for (let side = 0; side <= SIDES; side++) out.set([side / SIDES, length / (STRIPE * radius)], 2 * (ring * (SIDES + 1) + side));
  }
  return out;
}

type Triple = [number, number, number];
const dot = (a: Triple, b: Triple): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a: Triple, b: Triple): Triple => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

function without(v: Triple, axis: Triple): Triple {
  const part = dot(v, axis);
  return [v[0] - part * axis[0], v[1] - part * axis[1], v[2] - part * axis[2]];
}

function unit(v: Triple, otherwise: Triple): Triple {
  const size = Math.hypot(...v);
  return size > 1e-6 ? [v[0] / size, v[1] / size, v[2] / size] : otherwise;
}

function anyAcross(axis: Triple): Triple {
  return unit(Math.abs(axis[1]) < 0.9 ? cross(axis, [0, 1, 0]) : cross(axis, [1, 0, 0]), [1, 0, 0]);
}

function direction(p: Float32Array, a: number, b: number, otherwise: Triple): Triple {
  return unit([p[3 * b]! - p[3 * a]!, p[3 * b + 1]! - p[3 * a + 1]!, p[3 * b + 2]! - p[3 * a + 2]!], otherwise);
}

function distance(p: Float32Array, a: number, b: number): number {
  return Math.hypot(p[3 * b]! - p[3 * a]!, p[3 * b + 1]! - p[3 * a + 1]!, p[3 * b + 2]! - p[3 * a + 2]!);
}
