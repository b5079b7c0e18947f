// All parts that share a mesh and a finish: one instanced draw call. A part belongs to a row of the frame and has a place on it.
import { type BufferGeometry, type Color, DynamicDrawUsage, InstancedMesh, type Material } from 'three';
import type { Part } from './shape_geometry';

export class Batch {
  readonly mesh: InstancedMesh;
  readonly rows: Int32Array;
  private sphereIsOld = false;
  private readonly locals: Float32Array; // 12 a part: three columns and the place

  constructor(geometry: BufferGeometry, material: Material, parts: readonly { row: number; part: Part }[]) {
    const count = parts.length;
    this.mesh = new InstancedMesh(geometry, material, count);
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    this.mesh.frustumCulled = false;
    this.rows = new Int32Array(count);
    this.locals = new Float32Array(12 * count);
    parts.forEach(({ row, part }, i) => {
      this.rows[i] = row;
      const e = part.local.elements;
      this.locals.set([e[0], e[1], e[2], e[4], e[5], e[6], e[8], e[9], e[10], e[12], e[13], e[14]], 12 * i);
    });
  }

  // Places the parts of the rows that moved.
  place(poses: Float32Array, moved: Uint8Array): void {
    const out = this.mesh.instanceMatrix.array as Float32Array;
    const { rows, locals } = this;
    let any = false;
    for (let i = 0; i < rows.length; i++) {
      const row = rows[i]!;
      if (!moved[row]) continue;
      any = true;
      const p = 7 * row;
      const x = poses[p + 3]!;
      const y = poses[p + 4]!;
      const z = poses[p + 5]!;
      const w = poses[p + 6]!;
      const xx = 1 - 2 * (y * y + z * z);
      const xy = 2 * (x * y - w * z);
      const xz = 2 * (x * z + w * y);
      const yx = 2 * (x * y + w * z);
      const yy = 1 - 2 * (x * x + z * z);
      const yz = 2 * (y * z - w * x);
      const zx = 2 * (x * z - w * y);
      const zy = 2 * (y * z + w * x);
      const zz = 1 - 2 * (x * x + y * y);
      for (let column = 0; column < 4; column++) {
        const l = 12 * i + 3 * column;
        const o = 16 * i + 4 * column;
        const a = locals[l]!;
        const b = locals[l + 1]!;
        const c = locals[l + 2]!;
        out[o] = xx * a + xy * b + xz * c;
        out[o + 1] = yx * a + yy * b + yz * c;
        out[o + 2] = zx * a + zy * b + zz * c;
        out[o + 3] = 0;
      }
      out[16 * i + 12]! += poses[p]!;
      out[16 * i + 13]! += poses[p + 1]!;
      out[16 * i + 14]! += poses[p + 2]!;
      out[16 * i + 15] = 1;
    }
    if (any) {
      this.mesh.instanceMatrix.needsUpdate = true;
      this.sphereIsOld = true;
    }
  }

  // Before rays are sent at it. The sphere around ten thousand parts costs more than placing them, and nothing else needs it fresh.
  readyToPick(): InstancedMesh {
    if (this.sphereIsOld) this.mesh.computeBoundingSphere();
    this.sphereIsOld = false;
    return this.mesh;
  }

  color(colorOf: (row: number, part: number) => Color): void {
    for (let i = 0; i < this.rows.length; i++) this.mesh.setColorAt(i, colorOf(this.rows[i]!, i));
    if (this.mesh.instanceColor) this.mesh.instanceColor.needsUpdate = true;
  }

  dispose(): void {
    this.mesh.removeFromParent();
    this.mesh.dispose();
  }
}
