// An overlay: something drawn over the bodies that says what the engine knows about them. One file each; the list is in all.ts.
import type { Object3D } from 'three';
import type { Bodies } from '../draw/bodies';
import type { Softs } from '../draw/softs';
import type { Frame, OverlayName } from '../protocol';

export interface OverlayView {
  frame: Frame;
  bodies: Bodies;
  softs: Softs;
  scale: number; // m, the radius of the scene: how long an arrow of usual size may be
}

export interface Overlay {
  // In the scene while the overlay is switched on. Whether it is visible is the overlay's own affair: it may have nothing to show
  // yet, because the engine has not answered or nothing touches, and something with the next frame.
  readonly object: Object3D;
  // Called for every new frame, and for every picture while bodies glide between two frames.
  update(view: OverlayView): void;
  clear(): void;
}

export interface OverlayKind {
  name: OverlayName;
  label: string;
  hint: string;
  key: string; // on the keyboard
  fluid?: boolean; // only of use where there are gases or liquids
  soft?: boolean; // only of use where there are ropes, cloths or solids
  make: () => Overlay;
}
