// Bodies on the screen: their descriptions, the poses as they are drawn now (between two frames), and the batches they are drawn with.
import { type BufferGeometry, Color, Group, type Material } from 'three';
import type { BodyDescription, Frame, Structure, Surface } from '../protocol';
import { Batch } from './batch';
import type { BodyPainter } from './body_painter';
import { bodyMaterial, type GroundColors } from './body_material';
import { meshGeometry, type Part, partsOf } from './shape_geometry';
import type { Quality } from '../state/preferences';

interface PartInRow {
  row: number;
  part: Part;
  material: string;
  color: number | null;
}

export class Bodies {
  readonly group = new Group();
  readonly known = new Map<number, BodyDescription>();
  readonly surfaces = new Map<string, Surface>();
  keys: Uint32Array = new Uint32Array(0);
  rowOf = new Map<number, number>();
  poses = new Float32Array(0); // 7 a row, as drawn now
  private moved = new Uint8Array(0);
  private batches: { batch: Batch; parts: PartInRow[]; sensor: boolean }[] = [];
  private readonly meshes = new Map<string, BufferGeometry>();
  private readonly materials = new Map<string, Material>();
  private readonly parts = new Map<number, { part: Part; material: string; color: number | null; sensor: boolean }[]>();
  private readonly scratch = new Color();

  constructor(
    private readonly ground: GroundColors,
    private readonly painter: BodyPainter,
    private quality: Quality,
  ) {}

  // Forgets everything: another scene comes.
  clear(): void {
    this.dropBatches();
    for (const mesh of this.meshes.values()) mesh.dispose();
    this.meshes.clear();
    this.known.clear();
    this.surfaces.clear();
    this.parts.clear();
    this.keys = new Uint32Array(0);
    this.rowOf.clear();
  }

  restructure(structure: Structure): void {
    for (const surface of structure.surfaces) this.surfaces.set(surface.key, surface);
    for (const body of structure.added) {
      this.known.set(body.key, body);
      this.parts.set(
        body.key,
        body.shapes.flatMap((shape) => partsOf(shape).map((part) => ({ part, material: shape.material, color: shape.color, sensor: shape.sensor }))),
      );
    }
    this.keys = structure.keys;
    this.rowOf = new Map();
    structure.keys.forEach((key, row) => this.rowOf.set(key, row));
    this.poses = new Float32Array(7 * structure.keys.length);
    this.moved = new Uint8Array(structure.keys.length);
    this.rebuild();
  }

  setQuality(quality: Quality): void {
    if (quality === this.quality) return;
    this.quality = quality;
    for (const material of this.materials.values()) material.dispose();
    this.materials.clear();
    this.rebuild();
  }

  private dropBatches(): void {
    for (const { batch } of this.batches) batch.dispose();
    this.batches = [];
  }

  private rebuild(): void {
    this.dropBatches();
    const groups = new Map<string, PartInRow[]>();
    this.keys.forEach((key, row) => {
      for (const { part, material, color, sensor } of this.parts.get(key) ?? []) {
        const name = `${sensor ? 'sensor' : part.finish}|${part.mesh}`;
        const group = groups.get(name);
        if (group) group.push({ row, part, material, color });
        else groups.set(name, [{ row, part, material, color }]);
      }
    });
    for (const [name, parts] of groups) {
      const { mesh, finish } = parts[0]!.part;
      const sensor = name.startsWith('sensor|');
      const open = this.surfaces.get(mesh)?.kind === 'mesh' || this.surfaces.get(mesh)?.kind === 'height_field';
      const batch = new Batch(this.mesh(mesh), this.material(finish, sensor, open), parts);
      batch.mesh.castShadow = finish !== 'ground' && !sensor;
      batch.mesh.receiveShadow = !sensor;
      this.group.add(batch.mesh);
      this.batches.push({ batch, parts, sensor });
    }
    this.poses.fill(NaN);
  }

  private mesh(name: string): BufferGeometry {
    let mesh = this.meshes.get(name);
    if (!mesh) this.meshes.set(name, (mesh = meshGeometry(name, this.surfaces)));
    return mesh;
  }

  private material(finish: Part['finish'], sensor: boolean, open: boolean): Material {
    const name = `${finish} ${sensor} ${open}`;
    let material = this.materials.get(name);
    if (!material) this.materials.set(name, (material = bodyMaterial(finish, this.quality, this.ground, sensor, open)));
    return material;
  }

  // Moves everything to `part` of the way between two frames with the same structure.
  place(from: Frame, to: Frame, part: number): void {
    const a = from.poses;
    const b = to.poses;
    const out = this.poses;
    const rows = Math.min(this.keys.length, b.length / 7);
    for (let row = 0; row < rows; row++) {
      const p = 7 * row;
      let changed = false;
      // The two quaternions of a step lie close together; the shorter way is the one with a positive product.
      const product = a[p + 3]! * b[p + 3]! + a[p + 4]! * b[p + 4]! + a[p + 5]! * b[p + 5]! + a[p + 6]! * b[p + 6]!;
      const sign = product < 0 ? -1 : 1;
      for (let i = 0; i < 7; i++) {
        const start = i < 3 ? a[p + i]! : sign * a[p + i]!;
        const value = Math.fround(part === 1 ? b[p + i]! : start + part * (b[p + i]! - start));
        if (out[p + i] !== value) {
          out[p + i] = value;
          changed = true;
        }
      }
      if (changed && part !== 1) {
        const size = Math.hypot(out[p + 3]!, out[p + 4]!, out[p + 5]!, out[p + 6]!);
        for (let i = 3; i < 7; i++) out[p + i]! /= size;
      }
      this.moved[row] = changed ? 1 : 0;
    }
    for (const { batch } of this.batches) batch.place(out, this.moved);
  }

  paint(frame: Frame): void {
    for (const { batch, parts } of this.batches) {
      batch.color((row, i) => {
        const body = this.known.get(this.keys[row]!);
        return this.painter.color(frame, row, body, parts[i]!.material, parts[i]!.color, this.scratch);
      });
    }
  }

  // What can be picked, and which body an instance belongs to.
  get meshesToPick(): Batch[] {
    return this.batches.filter(({ sensor }) => !sensor).map(({ batch }) => batch);
  }
}
