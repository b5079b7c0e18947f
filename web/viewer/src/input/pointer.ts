// The hand. On a body that can move, and on ropes, cloths and solids, it pulls; a flat gas it stirs, with Alt any gas; a click without moving
// selects; everywhere else it is the camera's.
import { Vector3 } from 'three';
import { BodyFlag, type Command } from '../protocol';
import * as store from '../state/store';
import type { Surroundings } from './surroundings';

const PAUSE = 80; // ms without motion while time runs, after which nothing is stirred
const CLICK = 5; // pixels that a click may move

interface Press {
  id: number;
  x: number;
  y: number;
  key: number | null; // of a body
  soft: number | null;
  grabbed: Vector3 | null; // where in the scene something was taken hold of
  stirred: { key: number; at: Vector3; since: number; moving: boolean } | null; // a gas: where and when (ms) the hand was last
}

export class Pointer {
  private press: Press | null = null;
  private at = { x: 0, y: 0, fresh: false };
  private readonly touches = new Set<number>();

  constructor(private readonly viewer: Surroundings) {
    const element = viewer.stage.renderer.domElement;
    element.addEventListener('pointerdown', (event) => this.down(event));
    element.addEventListener('pointermove', (event) => this.move(event));
    for (const name of ['pointerup', 'pointercancel'] as const) element.addEventListener(name, (event) => this.up(event));
    element.addEventListener('pointerleave', () => (element.style.cursor = ''));
    element.addEventListener('dblclick', (event) => this.doubleClick(event));
  }

  // Where the pointer was last, for what is thrown.
  get place(): { x: number; y: number } {
    const box = this.viewer.stage.renderer.domElement.getBoundingClientRect();
    return this.at.x === 0 && this.at.y === 0 ? { x: box.left + box.width / 2, y: box.top + box.height / 2 } : this.at;
  }

  private down(event: PointerEvent): void {
    this.touches.add(event.pointerId);
    this.at = { x: event.clientX, y: event.clientY, fresh: false };
    const { viewer } = this;
    const frame = viewer.playback.frame;
    viewer.stage.renderer.domElement.focus({ preventScroll: true });
    // A second finger means the camera.
    if (this.touches.size > 1) return this.letGo();
    if (event.button !== 0 || !frame) return;
    const { key, soft, hold } = this.under(event.clientX, event.clientY);
    this.press = { id: event.pointerId, x: event.clientX, y: event.clientY, key, soft, grabbed: null, stirred: null };
    if (!hold && !event.shiftKey && !event.ctrlKey && !event.metaKey && this.beginStirring(event)) return;
    if (!hold || event.ctrlKey || event.metaKey || event.shiftKey) return;
    this.press.grabbed = new Vector3(...hold.at);
    viewer.rig.controls.enabled = false;
    viewer.stage.renderer.domElement.setPointerCapture(event.pointerId);
    viewer.stage.renderer.domElement.style.cursor = 'grabbing';
    viewer.playback.command(hold);
  }

  // True if there is a gas to be stirred.
  private beginStirring(event: PointerEvent): boolean {
    const { viewer } = this;
    if (store.scene.peek()?.live !== true || viewer.fluids.known.length === 0) return false;
    const body = viewer.picker.pick(viewer.bodies, event.clientX, event.clientY);
    const gas = viewer.picker.pickGas(viewer.fluids, event.clientX, event.clientY, body?.distance);
    if (!gas || !(gas.flat || event.altKey)) return false;
    this.press!.stirred = { key: gas.key, at: gas.point, since: performance.now(), moving: false };
    viewer.rig.controls.enabled = false;
    viewer.stage.renderer.domElement.setPointerCapture(event.pointerId);
    return true;
  }

  // The gas moves as the hand does.
  private stir(stirred: NonNullable<Press['stirred']>): void {
    const now = performance.now();
    const to = this.viewer.picker.onPlaneThrough(stirred.at, this.at.x, this.at.y);
    const seconds = (now - stirred.since) / 1000;
    if (!to || !(seconds > 0)) return;
    const velocity = to.clone().sub(stirred.at).divideScalar(Math.max(seconds, 1 / 60));
    this.viewer.playback.command({ do: 'stir', key: stirred.key, at: to.toArray(), velocity: velocity.toArray() });
    Object.assign(stirred, { at: to, since: now, moving: true });
  }

  private stopStirring(): void {
    const stirred = this.press?.stirred;
    if (!stirred?.moving) return;
    stirred.moving = false;
    this.viewer.playback.command({ do: 'still', key: stirred.key });
  }

  // The body or soft matter under the pointer, and how to take hold of it.
  private under(x: number, y: number): { key: number | null; soft: number | null; hold: Extract<Command, { at: unknown; do: 'grab' | 'grab_soft' }> | null } {
    const { picker, bodies, softs, playback } = this.viewer;
    const live = store.scene.peek()?.live === true;
    const body = picker.pick(bodies, x, y);
    const soft = picker.pickSoft(softs, x, y, body?.distance);
    if (soft) return { key: null, soft: soft.key, hold: live ? { do: 'grab_soft', key: soft.key, at: soft.point.toArray() } : null };
    if (!body) return { key: null, soft: null, hold: null };
    const movable = live && (playback.frame!.flags[body.row]! & BodyFlag.dynamic) !== 0;
    return { key: body.key, soft: null, hold: movable ? { do: 'grab', key: body.key, at: body.point.toArray() } : null };
  }

  private move(event: PointerEvent): void {
    this.at = { x: event.clientX, y: event.clientY, fresh: true };
  }

  private up(event: PointerEvent): void {
    this.touches.delete(event.pointerId);
    const { press } = this;
    if (!press || press.id !== event.pointerId) return;
    const still = Math.hypot(event.clientX - press.x, event.clientY - press.y) < CLICK;
    this.letGo();
    if (still && event.type === 'pointerup') {
      store.select(press.key, press.soft);
      if ((press.key ?? press.soft) !== null && innerWidth > 900) store.panel.value = 'inspect';
    }
  }

  private doubleClick(event: MouseEvent): void {
    const picked = this.viewer.picker.pick(this.viewer.bodies, event.clientX, event.clientY);
    if (!picked || this.viewer.bodies.known.get(picked.key)?.type === 'fixed') return;
    store.select(picked.key);
    store.following.value = true;
  }

  private letGo(): void {
    if (this.press?.grabbed) this.viewer.playback.command({ do: 'release' });
    this.stopStirring();
    this.press = null;
    this.viewer.rig.controls.enabled = true;
    this.viewer.stage.renderer.domElement.style.cursor = '';
  }

  // Once a picture: the body follows the pointer in the plane in which it was taken, whatever the camera does meanwhile.
  update(): void {
    const stirred = this.press?.stirred;
    if (stirred && !this.at.fresh && store.playing.peek() && performance.now() - stirred.since > PAUSE) this.stopStirring();
    if (!this.at.fresh) return;
    this.at.fresh = false;
    const { viewer } = this;
    if (this.press?.grabbed) {
      const to = viewer.picker.onPlaneThrough(this.press.grabbed, this.at.x, this.at.y);
      if (to) viewer.playback.command({ do: 'pull', to: to.toArray() });
    } else if (stirred) {
      this.stir(stirred);
    } else if (this.touches.size === 0) {
      this.hover();
    }
  }

  private hover(): void {
    const { viewer } = this;
    const frame = viewer.playback.frame;
    if (!frame || frame.flags.length > 4000) return;
    viewer.stage.renderer.domElement.style.cursor = this.under(this.at.x, this.at.y).hold ? 'grab' : '';
  }
}
