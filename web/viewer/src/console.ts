// `gyre` in the browser's console: the scene by script. Tests use the same.
import { Vector3 } from 'three';
import type { Command, NewWorldSettings, OverlayName, SceneDescription, Stats } from './protocol';
import * as preferences from './state/preferences';
import * as store from './state/store';
import type { Viewer } from './viewer';

declare global {
  interface Window {
    gyre: Console;
  }
}

export class Console {
  constructor(readonly viewer: Viewer) {}

  // Whether a scene is open and nothing is under way.
  get ready(): boolean {
    return store.scene.peek() !== null && store.opening.peek() === null && this.viewer.playback.frame !== null;
  }

  get scene(): SceneDescription | null {
    return store.scene.peek();
  }

  get file(): string {
    return store.scene.peek()?.file ?? '';
  }

  get selected(): number | null {
    return store.selected.peek();
  }

  get speed(): number {
    return store.speed.peek();
  }

  set speed(times: number) {
    store.speed.value = times;
  }

  get step(): number {
    return this.viewer.playback.frame?.step ?? 0;
  }

  get stats(): Stats | null {
    return this.viewer.playback.frame?.stats ?? null;
  }

  play(): void {
    this.viewer.playback.play();
  }

  pause(): void {
    this.viewer.playback.pause();
  }

  // So many steps on, then pauses.
  advance(steps = 1): Promise<void> {
    return this.viewer.playback.advance(steps);
  }

  seek(step: number): Promise<void> {
    return this.viewer.playback.seekAndWait(step);
  }

  // The state hash of the world as it stands, 16 hexadecimal digits.
  async hash(): Promise<string> {
    await this.viewer.playback.idle();
    return this.viewer.playback.client.request('hash', {});
  }

  // By name: the place of the body's origin in the frame that is shown, m.
  position(name: string): [number, number, number] | null {
    const key = this.key(name);
    const row = key === null ? undefined : this.viewer.bodies.rowOf.get(key);
    const frame = this.viewer.playback.frame;
    return row === undefined || !frame ? null : [frame.poses[7 * row]!, frame.poses[7 * row + 1]!, frame.poses[7 * row + 2]!];
  }

  // Of all bodies, 7 numbers each: place and quaternion.
  poses(): number[] {
    return [...(this.viewer.playback.frame?.poses ?? [])];
  }

  // Of all ropes, cloths and solids: their vertices in the frame that is shown, 3 numbers each, m.
  allVertices(): number[] {
    return [...(this.viewer.playback.frame?.softVertices ?? [])];
  }

  // Of a rope, cloth or solid by name: its vertices in the frame that is shown, 3 numbers each, m.
  vertices(name: string): number[] | null {
    const drawn = this.viewer.softs.named(name);
    const frame = this.viewer.playback.frame;
    return drawn && frame ? [...frame.softVertices.slice(3 * drawn.first, 3 * (drawn.first + drawn.soft.vertices))] : null;
  }

  names(): string[] {
    return [...this.viewer.bodies.keys].map((key) => this.viewer.bodies.known.get(key)?.name ?? '');
  }

  key(name: string): number | null {
    for (const [key, body] of this.viewer.bodies.known) {
      if (body.name === name && this.viewer.bodies.rowOf.has(key)) return key;
    }
    return null;
  }

  // Where a place of the scene is on the page, in pixels.
  onPage(x: number, y: number, z: number): { x: number; y: number } {
    this.viewer.stage.camera.updateMatrixWorld();
    return this.viewer.picker.onPage(new Vector3(x, y, z));
  }

  overlay(name: OverlayName, on: boolean): void {
    if (preferences.overlays.peek().has(name) !== on) preferences.toggleOverlay(name);
  }

  configure(settings: NewWorldSettings): Promise<void> {
    return this.viewer.playback.configure(settings);
  }

  command(command: Command): void {
    this.viewer.playback.command(command);
  }
}
