// Gases and liquids of a world: the page is told of their boxes once, and of their smoke, heat, light and surfaces in each frame.
import { type FluidEmitter, type FluidEmitterInput, type FluidId, FluidField, type FluidInfo, FluidKind, type World } from 'gyre-physics';
import type { Box, FlowData, FluidDescription, FluidState, Vec3 } from '../protocol';
import { placeOf } from './keys';

const SUN: Vec3 = normalized([0.45, 1, 0.62]); // as on the page
const THICKNESS = 14; // optical thickness of the thickest smoke along the shortest side of its box
const STIRRED = 0.8; // radius of what a pointer stirs, in parts of the shortest side times THICKNESS
const ARROWS = 26; // along the longer side of a slice
const NONE = { bytes: new Uint8Array(0), floats: new Float32Array(0), indices: new Uint32Array(0) };

function normalized([x, y, z]: Vec3): Vec3 {
  const length = Math.hypot(x, y, z);
  return [x / length, y / length, z / length];
}

// What 255 stands for.
interface Scales {
  smoke: number; // kg/m^3
  ambient: number; // K
  heat: number; // K above it
  fastest: number; // m/s, of all frames so far
  emitters: readonly FluidEmitter[]; // those that it began with
}

const cellsOf = ({ cells }: FluidInfo): Vec3 => [cells[0]!, cells[1]!, cells[2]!];

function boxOf({ lower, cell, cells }: FluidInfo, origin: Vec3): Box {
  const low: Vec3 = [lower[0] - origin[0], lower[1] - origin[1], lower[2] - origin[2]];
  return { low, high: [low[0] + cell[0] * cells[0]!, low[1] + cell[1] * cells[1]!, low[2] + cell[2] * cells[2]!] };
}

function flatAxis({ cells }: FluidInfo): 0 | 1 | 2 | null {
  const axis = cells.indexOf(1);
  return axis < 0 ? null : (axis as 0 | 1 | 2);
}

// 3 numbers a corner.
export function corners(boxes: readonly Box[]): number[] {
  return boxes.flatMap(({ low, high }) => [...low, ...high]);
}

export class FluidReader {
  private readonly scales = new Map<number, Scales>(); // by the place of the id

  constructor(private readonly origin: Vec3) {}

  describe(world: World, id: FluidId, look: Pick<FluidDescription, 'key' | 'name' | 'color'>): FluidDescription {
    const info = world.fluidInfo(id);
    const { smoke, heat } = this.scalesOf(world, id, info);
    return {
      ...look,
      kind: info.kind === FluidKind.gas ? 'gas' : 'liquid',
      cells: cellsOf(info),
      box: boxOf(info, this.origin),
      flat: flatAxis(info),
      smoky: smoke > 0 || heat > 0,
      extinction: extinctionOf(info),
    };
  }

  // `speeds`: wanted beside the smoke.
  read(world: World, id: FluidId, speeds: boolean): FluidState {
    const info = world.fluidInfo(id);
    if (info.kind === FluidKind.liquid) return this.readLiquid(world, id);
    const scales = this.scalesOf(world, id, info);
    const voxels = new Uint8Array(4 * info.cells[0]! * info.cells[1]! * info.cells[2]!);
    if (scales.smoke > 0) put(voxels, 0, world.fluidField(id, FluidField.smoke), 0, scales.smoke);
    if (scales.heat > 0) put(voxels, 1, world.fluidField(id, FluidField.temperature), scales.ambient, scales.heat);
    if (speeds || (flatAxis(info) !== null && !(scales.smoke > 0 || scales.heat > 0))) {
      const field = world.fluidField(id, FluidField.speed);
      for (let i = 0; i < field.length; i++) scales.fastest = Math.max(scales.fastest, field[i]!);
      put(voxels, 3, field, 0, scales.fastest || 1);
    }
    if (scales.smoke > 0) light(voxels, info);
    return { voxels, fastest: scales.fastest, vertices: NONE.floats.slice(), normals: NONE.floats.slice(), indices: NONE.indices.slice() };
  }

  // A ball of gas around `at` moves with `velocity`: one more emitter, with the smoke and the temperature of this place.
  stir(world: World, id: FluidId, at: Vec3, velocity: Vec3): void {
    const info = world.fluidInfo(id);
    if (info.kind !== FluidKind.gas) return;
    const { density, temperature } = world.probe(id, at);
    const cell = Math.max(...[0, 1, 2].filter((axis) => info.cells[axis]! > 1).map((axis) => info.cell[axis]!));
    const radius = Math.max(STIRRED / extinctionOf(info), 1.5 * cell);
    this.setEmitters(world, id, info, [{ position: at, radius, density, temperature, velocity }]);
  }

  still(world: World, id: FluidId): void {
    this.setEmitters(world, id, world.fluidInfo(id), []);
  }

  private setEmitters(world: World, id: FluidId, info: FluidInfo, more: FluidEmitterInput[]): void {
    world.setEmitters(id, [...this.scalesOf(world, id, info).emitters, ...more]);
  }

  private readLiquid(world: World, id: FluidId): FluidState {
    const surface = world.liquidSurface(id);
    const vertices = Float32Array.from(surface.vertices, (value, i) => value - this.origin[i % 3]!);
    const indices = surface.indices.slice();
    return { voxels: NONE.bytes.slice(), fastest: 0, vertices, normals: normalsOf(vertices, indices), indices };
  }

  private scalesOf(world: World, id: FluidId, info: FluidInfo): Scales {
    const place = placeOf(id);
    let scales = this.scales.get(place);
    if (!scales) {
      scales = info.kind === FluidKind.gas ? scalesOf(world, id) : { smoke: 0, ambient: 0, heat: 0, fastest: 0, emitters: [] };
      this.scales.set(place, scales);
    }
    return scales;
  }
}

// Nothing in a gas is thicker or hotter than what it began with and what its emitters give, but for what burns.
function scalesOf(world: World, id: FluidId): Scales {
  const { ambientTemperature: ambient, density: gas, emitters, fields, combustion } = world.gasDef(id);
  let smoke = 0;
  let hottest = ambient;
  for (const { density, temperature, fuel } of emitters) {
    smoke = Math.max(smoke, density + (combustion ? combustion.smokeYield * fuel : 0));
    hottest = Math.max(hottest, temperature + (combustion ? (combustion.heatRelease * fuel) / (gas * combustion.heatCapacity) : 0));
  }
  for (const density of fields?.density ?? []) smoke = Math.max(smoke, density);
  for (const temperature of fields?.temperature ?? []) hottest = Math.max(hottest, temperature);
  // A thousandth of a kelvin is rounding.
  return { smoke, ambient, heat: hottest - ambient > 1e-3 ? hottest - ambient : 0, fastest: 0, emitters };
}

function extinctionOf({ cell, cells }: FluidInfo): number {
  const sides = [0, 1, 2].filter((axis) => cells[axis]! > 1).map((axis) => cells[axis]! * cell[axis]!);
  return THICKNESS / Math.min(...sides, Infinity);
}

function put(voxels: Uint8Array, part: number, field: Float32Array, zero: number, full: number): void {
  const scale = 255 / full;
  for (let i = 0; i < field.length; i++) {
    const value = scale * (field[i]! - zero);
    voxels[4 * i + part] = value <= 0 ? 0 : value >= 255 ? 255 : value + 0.5;
  }
}

// How much light of the sun reaches each cell. One sweep away from the sun: a cell has the light of the neighbours towards it, each by how
// often a ray comes from there, less what their smoke takes.
function light(voxels: Uint8Array, info: FluidInfo): void {
  const { cell, cells } = info;
  const [nx, ny, nz] = [cells[0]!, cells[1]!, cells[2]!];
  const crossings = SUN.map((part, axis) => (cells[axis]! > 1 ? Math.abs(part) / cell[axis]! : 0));
  const rate = crossings[0]! + crossings[1]! + crossings[2]!; // 1/m
  if (!(rate > 0)) return;
  const [wx, wy, wz] = [crossings[0]! / rate, crossings[1]! / rate, crossings[2]! / rate];
  const passes = Float32Array.from({ length: 256 }, (_, smoke) => Math.exp((-extinctionOf(info) * smoke) / 255 / rate));
  // Light that leaves a cell; all of it comes in at the sides of the box.
  const left = new Float32Array(nx * ny * nz);
  for (let z = nz - 1; z >= 0; z--) {
    for (let y = ny - 1; y >= 0; y--) {
      for (let x = nx - 1; x >= 0; x--) {
        const i = x + nx * (y + ny * z);
        const arrives =
          wx * (x + 1 < nx ? left[i + 1]! : 1) + wy * (y + 1 < ny ? left[i + nx]! : 1) + wz * (z + 1 < nz ? left[i + nx * ny]! : 1);
        left[i] = arrives * passes[voxels[4 * i]!]!;
        voxels[4 * i + 2] = 255 * arrives;
      }
    }
  }
}

function normalsOf(vertices: Float32Array, indices: Uint32Array): Float32Array {
  const normals = new Float32Array(vertices.length);
  for (let t = 0; t < indices.length; t += 3) {
    const [a, b, c] = [3 * indices[t]!, 3 * indices[t + 1]!, 3 * indices[t + 2]!];
    const [ux, uy, uz] = [vertices[b]! - vertices[a]!, vertices[b + 1]! - vertices[a + 1]!, vertices[b + 2]! - vertices[a + 2]!];
    const [vx, vy, vz] = [vertices[c]! - vertices[a]!, vertices[c + 1]! - vertices[a + 1]!, vertices[c + 2]! - vertices[a + 2]!];
    const [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    for (const i of [a, b, c]) {
      normals[i]! += x;
      normals[i + 1]! += y;
      normals[i + 2]! += z;
    }
  }
  for (let i = 0; i < normals.length; i += 3) {
    const scale = 1 / Math.max(Math.hypot(normals[i]!, normals[i + 1]!, normals[i + 2]!), 1e-30);
    for (let k = i; k < i + 3; k++) normals[k]! *= scale;
  }
  return normals;
}

// Velocities on a slice through the middle of each fluid: along its plane if it is flat, else upright along its longer side.
export function readFlow(world: World, origin: Vec3): FlowData[] {
  return Array.from(world.fluids().slice(), (id) => {
    const info = world.fluidInfo(id);
    const { low, high } = boxOf(info, [0, 0, 0]);
    const size = low.map((value, axis) => high[axis]! - value);
    const across: 0 | 1 | 2 = flatAxis(info) ?? (size[0]! >= size[2]! ? 2 : 0);
    const [a, b] = [0, 1, 2].filter((axis) => axis !== across) as [number, number];
    const spacing = Math.max(size[a]!, size[b]!) / ARROWS;
    const [columns, rows] = [Math.max(1, Math.round(size[a]! / spacing)), Math.max(1, Math.round(size[b]! / spacing))];
    const points = new Float64Array(3 * columns * rows);
    for (let row = 0; row < rows; row++) {
      for (let column = 0; column < columns; column++) {
        const at = 3 * (column + columns * row);
        points[at + across] = 0.5 * (low[across]! + high[across]!);
        points[at + a] = low[a]! + ((column + 0.5) / columns) * size[a]!;
        points[at + b] = low[b]! + ((row + 0.5) / rows) * size[b]!;
      }
    }
    const velocities = world.sampleVelocity(id, points).slice();
    return { points: Float32Array.from(points, (value, i) => value - origin[i % 3]!), velocities, spacing, across };
  });
}

// 3 numbers a particle, of all liquids.
export function readParticles(world: World, origin: Vec3): Float32Array {
  const all: number[] = [];
  for (const id of world.fluids().slice()) {
    if (world.fluidInfo(id).kind !== FluidKind.liquid) continue;
    const { positions } = world.liquidParticles(id);
    for (let i = 0; i < positions.length; i++) all.push(positions[i]! - origin[i % 3]!);
  }
  return Float32Array.from(all);
}
