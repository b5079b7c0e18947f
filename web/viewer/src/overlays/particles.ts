// The particles of liquids as points. Their surfaces are hidden meanwhile.
import { BufferAttribute, BufferGeometry, Points, PointsMaterial } from 'three';
import type { Overlay, OverlayView } from './overlay';

export class Particles implements Overlay {
  readonly object = new Points(new BufferGeometry(), new PointsMaterial({ color: '#57b4e8', size: 2, sizeAttenuation: false }));

  constructor() {
    this.object.frustumCulled = false;
    this.object.raycast = () => {};
    this.object.visible = false;
  }

  update({ frame }: OverlayView): void {
    const places = frame.overlays.particles;
    this.object.visible = places !== undefined && places.length > 0;
    if (!places) return;
    this.object.geometry.dispose();
    this.object.geometry = new BufferGeometry();
    this.object.geometry.setAttribute('position', new BufferAttribute(places, 3));
  }

  clear(): void {
    this.object.visible = false;
  }
}
