// The outline of the body that was clicked: the edges of its shapes, drawn over everything.
import { type BufferGeometry, type Color, EdgesGeometry, Group, LineBasicMaterial, LineSegments } from 'three';
import type { Bodies } from './bodies';
import { meshGeometry, partsOf } from './shape_geometry';

export class Selection {
  readonly object = new Group();
  private readonly material = new LineBasicMaterial({ transparent: true, depthTest: false, fog: false });
  private key: number | null = null;

  constructor(private readonly bodies: Bodies) {
    this.object.renderOrder = 12;
    this.object.visible = false;
  }

  setColor(color: Color): void {
    this.material.color = color;
  }

  show(key: number | null): void {
    this.key = key;
    for (const child of [...this.object.children]) {
      child.removeFromParent();
      ((child as LineSegments).geometry as BufferGeometry).dispose();
    }
    const body = key === null ? undefined : this.bodies.known.get(key);
    for (const shape of body?.shapes ?? []) {
      if (shape.geometry.kind === 'plane') continue;
      for (const part of partsOf(shape)) {
        const edges = new EdgesGeometry(meshGeometry(part.mesh, this.bodies.surfaces), part.mesh === 'sphere' ? 8 : 20);
        const lines = new LineSegments(edges, this.material);
        lines.applyMatrix4(part.local);
        lines.renderOrder = 12;
        lines.raycast = () => {};
        this.object.add(lines);
      }
    }
    this.update();
  }

  update(): void {
    const row = this.key === null ? undefined : this.bodies.rowOf.get(this.key);
    this.object.visible = row !== undefined && !Number.isNaN(this.bodies.poses[7 * row]);
    if (row === undefined) return;
    this.object.position.fromArray(this.bodies.poses, 7 * row);
    this.object.quaternion.fromArray(this.bodies.poses, 7 * row + 3);
  }
}
