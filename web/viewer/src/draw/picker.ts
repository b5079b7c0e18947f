// What lies under the pointer: a ray from the camera against what is drawn.
import { Box3, type PerspectiveCamera, Plane, Raycaster, Vector2, Vector3 } from 'three';
import type { Bodies } from './bodies';
import type { Fluids } from './fluids';
import type { DrawnSoft, Softs } from './softs';

const NEAR_A_ROPE = 0.012; // rad: a rope may be this far from the ray, for it is thin

export interface Picked {
  key: number;
  row: number;
  point: Vector3;
  distance: number;
}

export interface PickedSoft {
  key: number;
  point: Vector3;
  distance: number;
}

export interface PickedGas extends PickedSoft {
  flat: boolean;
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

  // Soft matter that is nearer than `limit`.
  pickSoft(softs: Softs, x: number, y: number, limit = Infinity): PickedSoft | null {
    this.aim(x, y);
    let best: PickedSoft | null = null;
    for (const drawn of softs.toPick) {
      const hit = drawn.soft.kind === 'rope' ? this.onRope(drawn) : this.caster.intersectObject(drawn.mesh, false)[0];
      if (hit && hit.distance < (best?.distance ?? limit)) best = { key: drawn.soft.key, point: hit.point.clone(), distance: hit.distance };
    }
    return best;
  }

  // A gas whose box begins nearer than `limit`: in the middle of what the ray goes through of it, on the plane of a flat one.
  pickGas(fluids: Fluids, x: number, y: number, limit = Infinity): PickedGas | null {
    this.aim(x, y);
    const { ray } = this.caster;
    const [entry, exit] = [new Vector3(), new Vector3()];
    let best: PickedGas | null = null;
    for (const { kind, key, box, flat } of fluids.known) {
      const solid = new Box3(new Vector3(...box.low), new Vector3(...box.high));
      if (kind !== 'gas' || !ray.intersectBox(solid, entry)) continue;
      const inside = solid.containsPoint(ray.origin);
      const distance = inside ? 0 : entry.distanceTo(ray.origin);
      if (distance >= (best?.distance ?? limit)) continue;
      // The far side: from beyond it back.
      const back = ray.clone();
      back.origin.copy(ray.at(distance + 4 * solid.getSize(new Vector3()).length(), new Vector3()));
      back.direction.negate();
      if (!back.intersectBox(solid, exit)) continue;
      best = { key, flat: flat !== null, point: (inside ? ray.origin : entry).clone().lerp(exit, 0.5), distance };
    }
    return best;
  }

  private onRope({ soft, vertices }: DrawnSoft): { point: Vector3; distance: number } | null {
    const { ray } = this.caster;
    const [a, b, onRay, onRope] = [new Vector3(), new Vector3(), new Vector3(), new Vector3()];
    let best: { point: Vector3; distance: number } | null = null;
    for (let i = 0; i + 1 < soft.vertices; i++) {
      const away = Math.sqrt(ray.distanceSqToSegment(a.fromArray(vertices, 3 * i), b.fromArray(vertices, 3 * i + 3), onRay, onRope));
      const distance = onRay.distanceTo(ray.origin);
      if (away > soft.radius + NEAR_A_ROPE * distance || (best && distance >= best.distance)) continue;
      best = { point: onRope.clone(), distance: distance - soft.radius };
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
