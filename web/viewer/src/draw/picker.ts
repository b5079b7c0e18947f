// What lies under the pointer: a ray from the camera against what is drawn.
import { type PerspectiveCamera, Plane, Raycaster, Vector2, Vector3 } from 'three';
import type { Bodies } from './bodies';

export interface Picked {
  key: number;
  row: number;
  point: Vector3;
  distance: number;
}

export class Picker {
  private readonly caster = new Raycaster();
  private readonly pointer = new Vector2();

  constructor(
    private readonly camera: PerspectiveCamera,
    private readonly element: HTMLElement,
  ) {}

  private aim(x: number, y: number): void {
    const box = this.element.getBoundingClientRect();
    this.pointer.set(((x - box.left) / box.width) * 2 - 1, 1 - ((y - box.top) / box.height) * 2);
    this.camera.updateMatrixWorld();
    this.caster.setFromCamera(this.pointer, this.camera);
  }

  // x and y as in a pointer event.
  pick(bodies: Bodies, x: number, y: number): Picked | null {
    this.aim(x, y);
    let best: Picked | null = null;
    for (const batch of bodies.meshesToPick) {
      for (const hit of this.caster.intersectObject(batch.readyToPick(), false)) {
        if (hit.instanceId === undefined || (best && hit.distance >= best.distance)) continue;
        const row = batch.rows[hit.instanceId]!;
        best = { key: bodies.keys[row]!, row, point: hit.point.clone(), distance: hit.distance };
      }
    }
    return best;
  }

  ray(x: number, y: number): { origin: Vector3; direction: Vector3 } {
    this.aim(x, y);
    return { origin: this.caster.ray.origin.clone(), direction: this.caster.ray.direction.clone() };
  }

  // Where the pointer is on the plane through `place` that faces the camera.
  onPlaneThrough(place: Vector3, x: number, y: number): Vector3 | null {
    this.aim(x, y);
    const normal = this.camera.getWorldDirection(new Vector3());
    return this.caster.ray.intersectPlane(new Plane().setFromNormalAndCoplanarPoint(normal, place), new Vector3());
  }

  // Where a place of the scene is on the page.
  onPage(place: Vector3): { x: number; y: number } {
    const at = place.clone().project(this.camera);
    const box = this.element.getBoundingClientRect();
    return { x: box.left + ((at.x + 1) / 2) * box.width, y: box.top + ((1 - at.y) / 2) * box.height };
  }
}
