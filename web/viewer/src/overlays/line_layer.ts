// Many coloured lines of a few pixels' width, refilled each frame without new memory unless there are more than ever before.
import { type Color, InstancedInterleavedBuffer, InterleavedBufferAttribute, DynamicDrawUsage } from 'three';
import { LineMaterial } from 'three/addons/lines/LineMaterial.js';
import { LineSegments2 } from 'three/addons/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/addons/lines/LineSegmentsGeometry.js';

export class LineLayer {
  readonly object: LineSegments2;
  private places = new Float32Array(0);
  private colors = new Float32Array(0);
  private placeBuffer: InstancedInterleavedBuffer | null = null;
  private colorBuffer: InstancedInterleavedBuffer | null = null;
  private count = 0;
  private geometry = new LineSegmentsGeometry();

  constructor(width: number, options: { onTop?: boolean; opacity?: number } = {}) {
    const { onTop = false, opacity = 1 } = options;
    const material = new LineMaterial({ linewidth: width, vertexColors: true, transparent: true, opacity, depthTest: !onTop, fog: false });
    material.depthWrite = false;
    this.object = new LineSegments2(this.geometry, material);
    this.object.frustumCulled = false;
    this.object.renderOrder = onTop ? 10 : 5;
    this.object.raycast = () => {};
    this.grow(64);
  }

  begin(): void {
    this.count = 0;
  }

  line(ax: number, ay: number, az: number, bx: number, by: number, bz: number, color: Color): void {
    if (6 * (this.count + 1) > this.places.length) this.grow(2 * this.count);
    const p = 6 * this.count++;
    const { places, colors } = this;
    places[p] = ax;
    places[p + 1] = ay;
    places[p + 2] = az;
    places[p + 3] = bx;
    places[p + 4] = by;
    places[p + 5] = bz;
    colors[p] = colors[p + 3] = color.r;
    colors[p + 1] = colors[p + 4] = color.g;
    colors[p + 2] = colors[p + 5] = color.b;
  }

  // A line with a small head of two strokes, so that its direction is seen.
  arrow(ax: number, ay: number, az: number, dx: number, dy: number, dz: number, color: Color): void {
    const length = Math.hypot(dx, dy, dz);
    if (!(length > 0)) return;
    const bx = ax + dx;
    const by = ay + dy;
    const bz = az + dz;
    this.line(ax, ay, az, bx, by, bz, color);
    // Any direction across the arrow.
    let sx = dz;
    let sy = 0;
    let sz = -dx;
    if (Math.abs(dy) > 0.9 * length) [sx, sy, sz] = [0, -dz, dy];
    const across = (0.14 * length) / Math.max(Math.hypot(sx, sy, sz), 1e-12);
    const back = 0.78;
    for (const side of [across, -across]) {
      this.line(bx, by, bz, ax + back * dx + side * sx, ay + back * dy + side * sy, az + back * dz + side * sz, color);
    }
  }

  box(lx: number, ly: number, lz: number, ux: number, uy: number, uz: number, color: Color): void {
    for (const y of [ly, uy]) {
      this.line(lx, y, lz, ux, y, lz, color);
      this.line(ux, y, lz, ux, y, uz, color);
      this.line(ux, y, uz, lx, y, uz, color);
      this.line(lx, y, uz, lx, y, lz, color);
    }
    this.line(lx, ly, lz, lx, uy, lz, color);
    this.line(ux, ly, lz, ux, uy, lz, color);
    this.line(ux, ly, uz, ux, uy, uz, color);
    this.line(lx, ly, uz, lx, uy, uz, color);
  }

  end(): void {
    this.geometry.instanceCount = this.count;
    this.object.visible = this.count > 0;
    for (const buffer of [this.placeBuffer!, this.colorBuffer!]) {
      buffer.clearUpdateRanges();
      buffer.addUpdateRange(0, 6 * this.count);
      buffer.needsUpdate = true;
    }
  }

  get lines(): number {
    return this.count;
  }

  private grow(lines: number): void {
    const places = new Float32Array(6 * Math.max(lines, 64));
    const colors = new Float32Array(places.length);
    places.set(this.places);
    colors.set(this.colors);
    this.places = places;
    this.colors = colors;
    this.geometry.dispose();
    this.geometry = new LineSegmentsGeometry();
    this.placeBuffer = new InstancedInterleavedBuffer(places, 6, 1).setUsage(DynamicDrawUsage);
    this.colorBuffer = new InstancedInterleavedBuffer(colors, 6, 1).setUsage(DynamicDrawUsage);
    this.geometry.setAttribute('instanceStart', new InterleavedBufferAttribute(this.placeBuffer, 3, 0));
    this.geometry.setAttribute('instanceEnd', new InterleavedBufferAttribute(this.placeBuffer, 3, 3));
    this.geometry.setAttribute('instanceColorStart', new InterleavedBufferAttribute(this.colorBuffer, 3, 0));
    this.geometry.setAttribute('instanceColorEnd', new InterleavedBufferAttribute(this.colorBuffer, 3, 3));
    this.object.geometry = this.geometry;
  }
}
