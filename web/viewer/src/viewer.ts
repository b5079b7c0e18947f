// Puts the parts together: frames come from playback, bodies and overlays show them, the camera looks, input acts. One animation
// loop drives all.
import { effect } from '@preact/signals';
import { Box3, Vector3 } from 'three';
import { Bodies } from './draw/bodies';
import { BodyPainter } from './draw/body_painter';
import { CameraRig } from './draw/camera_rig';
import { Fluids } from './draw/fluids';
import { Links } from './draw/links';
import { Picker } from './draw/picker';
import { Selection } from './draw/selection';
import { Softs } from './draw/softs';
import { Stage } from './draw/stage';
import { Inspection } from './input/inspection';
import { Pointer } from './input/pointer';
import { Thrower } from './input/thrower';
import { overlayKinds } from './overlays/all';
import type { Overlay, OverlayView } from './overlays/overlay';
import { Playback } from './playback/playback';
import type { Frame, OverlayName, Structure } from './protocol';
import { History } from './state/history';
import * as preferences from './state/preferences';
import * as store from './state/store';

export class Viewer {
  readonly playback = new Playback();
  readonly history = new History();
  readonly stage: Stage;
  readonly bodies: Bodies;
  readonly softs = new Softs(preferences.quality.peek());
  readonly fluids: Fluids;
  readonly picker: Picker;
  readonly rig: CameraRig;
  readonly thrower: Thrower;
  readonly inspection: Inspection;
  readonly pointer: Pointer;
  private readonly painter: BodyPainter;
  private readonly selection: Selection;
  private readonly links = new Links();
  private readonly overlays = new Map<OverlayName, Overlay>(); // those that are switched on, in the scene
  private readonly overlaysMade = new Map<OverlayName, Overlay>();
  private bounds = new Box3();
  private readonly center = new Vector3();
  radius = 10; // m, of a ball around the scene
  private painted = false;
  private dirty = true;
  private lastPicture = performance.now();
  private pictures = 0;
  private countedSince = performance.now();

  constructor(holder: HTMLElement) {
    this.stage = new Stage(holder);
    this.painter = new BodyPainter(this.stage.colors);
    this.bodies = new Bodies(this.stage.ground, this.painter, preferences.quality.peek());
    this.fluids = new Fluids(preferences.quality.peek(), this.stage.colors);
    this.stage.scene.add(this.bodies.group, this.softs.group, this.fluids.group, this.links.object);
    this.picker = new Picker(this.stage.camera, this.stage.renderer.domElement);
    this.selection = new Selection(this.bodies);
    this.stage.scene.add(this.selection.object);
    this.thrower = new Thrower(this);
    this.inspection = new Inspection(this.playback);
    // Listens before the camera does, so that a hand on a body does not turn the view.
    this.pointer = new Pointer(this);
    this.rig = new CameraRig(this.stage.camera, this.stage.renderer.domElement);
    this.playback.onOpen(() => this.welcome());
    this.playback.onFrame((frame, structure, jumped) => this.receive(frame, structure, jumped));
    this.obeyPreferences();
    requestAnimationFrame(() => this.draw());
  }

  private obeyPreferences(): void {
    effect(() => {
      const theme = preferences.theme.value;
      document.documentElement.dataset.theme = theme;
      this.stage.setTheme(theme);
      this.painter.theme = this.stage.colors;
      this.selection.setColor(this.stage.colors.selection);
      this.links.setColor(this.stage.colors.link);
      this.fluids.setTheme(this.stage.colors);
      this.repaint();
    });
    effect(() => {
      const quality = preferences.quality.value;
      this.stage.setQuality(quality);
      this.bodies.setQuality(quality);
      this.softs.setQuality(quality);
      this.fluids.setQuality(quality);
      this.repaint();
    });
    effect(() => {
      this.painter.colorBy = preferences.colorBy.value;
      this.repaint();
    });
    effect(() => this.switchOverlays(preferences.overlays.value));
    effect(() => this.selection.show(store.selected.value));
    effect(() => this.stage.setLift(store.panel.value !== null && innerWidth <= 900 && innerHeight > 500 ? 0.22 : 0));
  }

  private switchOverlays(names: ReadonlySet<OverlayName>): void {
    for (const { name, make } of overlayKinds) {
      const overlay = this.overlays.get(name);
      if (names.has(name) && !overlay) this.addOverlay(name, make);
      if (names.has(name) || !overlay) continue;
      this.overlays.delete(name);
      overlay.object.removeFromParent();
      overlay.clear();
    }
    this.painter.islands = names.has('islands');
    this.fluids.setLook(names.has('speed'), !names.has('particles'));
    this.playback.overlays([...names]);
    this.repaint();
  }

  private addOverlay(name: OverlayName, make: () => Overlay): void {
    const overlay = this.overlaysMade.get(name) ?? make();
    this.overlaysMade.set(name, overlay);
    this.overlays.set(name, overlay);
    this.stage.scene.add(overlay.object);
  }

  // Another scene: nothing of the old one stays, and the camera goes to it.
  private welcome(): void {
    const scene = store.scene.peek()!;
    this.bodies.clear();
    this.softs.clear();
    this.fluids.clear();
    this.history.clear();
    this.bounds = new Box3(new Vector3(...scene.bounds.low), new Vector3(...scene.bounds.high));
    this.bounds.getCenter(this.center);
    this.radius = Math.max(this.bounds.getSize(new Vector3()).length() / 2, 0.05);
    this.stage.setScale(this.radius);
    const { view } = scene;
    this.rig.frameAtOnce(this.bounds);
    if (view) this.rig.lookAtOnce(new Vector3(...view.eye), new Vector3(...view.target), view.fieldOfView);
    this.repaint();
  }

  private receive(frame: Frame, structure: Structure | null, jumped: boolean): void {
    if (structure) {
      this.bodies.restructure(structure);
      this.softs.restructure(structure);
      this.fluids.restructure(structure);
      this.selection.show(store.selected.peek());
      this.painted = false;
    }
    if (frame.measured) this.history.add(frame, jumped);
    this.dirty = true;
    this.inspection.follow(frame);
    if (this.painter.changes) this.painted = false;
  }

  private repaint(): void {
    this.painted = false;
    this.dirty = true;
  }

  private draw(): void {
    requestAnimationFrame(() => this.draw());
    const now = performance.now();
    const seconds = Math.min((now - this.lastPicture) / 1000, 0.5);
    this.lastPicture = now;
    this.count(now);
    this.playback.tick(seconds);
    const between = this.playback.between();
    const scene = store.scene.peek();
    if (between && scene) {
      this.bodies.place(between.from, between.to, between.part);
      this.softs.place(between.from, between.to, between.part);
      this.fluids.show(between.to);
      if (!this.painted) {
        this.painted = true;
        this.bodies.paint(between.to);
      }
      this.rig.follow(this.followedPlace());
      this.updateOverlays(between.to);
      this.stage.lightAround(store.following.peek() ? this.rig.controls.target : this.center);
    }
    this.softs.highlight(store.selectedSoft.peek(), this.stage.colors.selection);
    this.pointer.update();
    this.rig.update(seconds);
    this.fluids.face(this.stage.camera);
    this.stage.render();
  }

  private updateOverlays(frame: Frame): void {
    const view: OverlayView = { frame, bodies: this.bodies, softs: this.softs, scale: this.radius };
    const moving = store.playing.peek() || this.dirty;
    this.dirty = false;
    this.selection.update();
    if (!moving) return;
    this.links.update(frame);
    for (const overlay of this.overlays.values()) overlay.update(view);
  }

  // Where the body that is looked at is drawn.
  placeOf(key: number): Vector3 | null {
    const row = this.bodies.rowOf.get(key);
    return row === undefined ? null : new Vector3().fromArray(this.bodies.poses, 7 * row);
  }

  private followedPlace(): Vector3 | null {
    const key = store.selected.peek();
    return store.following.peek() && key !== null ? this.placeOf(key) : null;
  }

  frameScene(): void {
    store.following.value = false;
    const key = store.selected.peek();
    const place = key === null ? null : this.placeOf(key);
    const half = 0.12 * this.radius;
    this.rig.frame(place ? new Box3(place.clone().subScalar(half), place.clone().addScalar(half)) : this.bounds);
  }

  private count(now: number): void {
    this.pictures++;
    if (now - this.countedSince < 500) return;
    store.framesPerSecond.value = Math.round((1000 * this.pictures) / (now - this.countedSince));
    this.pictures = 0;
    this.countedSince = now;
  }
}
