// Brings new bodies into a live scene: thrown from the camera to where the pointer is, or put down there.
import { Vector3 } from 'three';
import { throwable, throwSpeed } from '../state/preferences';
import * as store from '../state/store';
import type { Surroundings } from './surroundings';

const DENSITY = 1500; // kg/m^3
const NOTHING: [number, number, number] = [0, 0, 0];

export class Thrower {
  constructor(private readonly viewer: Surroundings) {}

  // As large as suits the scene.
  private get size(): number {
    return Math.min(Math.max(0.035 * this.viewer.radius, 0.02), 0.6);
  }

  throw(): void {
    const { viewer, size } = this;
    if (!store.scene.peek()?.live) return;
    const { x, y } = viewer.pointer.place;
    const { origin, direction } = viewer.picker.ray(x, y);
    // As fast as suits the scene's size: a second or so to cross it.
    const pace = throwSpeed.peek() * Math.min(Math.max(viewer.radius / 8, 0.15), 4);
    const hand = new Vector3(0, -1, 0).applyQuaternion(viewer.stage.camera.quaternion);
    const from = origin.addScaledVector(direction, 3 * size).addScaledVector(hand, size);
    this.add(from, direction.multiplyScalar(pace).toArray());
    if (!store.playing.peek()) viewer.playback.play();
  }

  // Upon whatever lies under the pointer.
  putDown(): void {
    const { viewer } = this;
    if (!store.scene.peek()?.live) return;
    const { x, y } = viewer.pointer.place;
    const body = viewer.picker.pick(viewer.bodies, x, y);
    const picked = viewer.picker.pickSoft(viewer.softs, x, y, body?.distance) ?? body;
    if (picked) this.add(picked.point.add(new Vector3(0, 1.5 * this.size, 0)), NOTHING);
  }

  private add(from: Vector3, velocity: [number, number, number]): void {
    this.viewer.playback.command({ do: 'throw', what: throwable.peek(), size: this.size, density: DENSITY, from: from.toArray(), velocity });
  }
}
