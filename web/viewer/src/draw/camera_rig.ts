// The camera: orbits, pans and zooms by hand, frames the scene or a body smoothly, follows a body that moves.
import { type Box3, MathUtils, type PerspectiveCamera, Vector3 } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

const FIRST_VIEW = new Vector3(0.62, 0.42, 1).normalize();
const GLIDE = 6; // 1/s, how quickly the camera comes to where it was sent

interface Flight {
  target: Vector3;
  distance: number;
}

export class CameraRig {
  readonly controls: OrbitControls;
  private flight: Flight | null = null;
  private readonly followed = new Vector3();
  private following = false;

  constructor(
    private readonly camera: PerspectiveCamera,
    element: HTMLElement,
  ) {
    this.controls = new OrbitControls(camera, element);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.rotateSpeed = 0.8;
    this.controls.zoomToCursor = true;
    this.controls.maxPolarAngle = 0.995 * Math.PI;
    this.controls.addEventListener('start', () => (this.flight = null));
  }

  // Looks at a box from the usual side, as near as it fits into the picture; at once.
  frameAtOnce(box: Box3): void {
    this.flight = null;
    this.following = false;
    const size = box.getSize(new Vector3()).length();
    const center = box.getCenter(new Vector3());
    this.controls.minDistance = size / 400;
    this.controls.maxDistance = size * 15 + 20;
    this.controls.target.copy(center);
    this.camera.position.copy(center).addScaledVector(FIRST_VIEW, this.distanceFor(box, FIRST_VIEW));
    this.controls.update();
  }

  // Stands where the scene says that a good picture is taken; farther back on a narrow screen, so that as much is in it.
  lookAtOnce(eye: Vector3, target: Vector3, fieldOfView: number): void {
    const wanted = Math.tan(fieldOfView / 2);
    const here = Math.tan(MathUtils.degToRad(this.camera.fov) / 2);
    // Pictures are meant for a screen of about 3 to 2; and here bars cover the upper and lower edge.
    const narrow = 1.1 * Math.max(1, 1.5 / this.camera.aspect);
    this.controls.target.copy(target);
    this.camera.position.copy(eye).sub(target).multiplyScalar((narrow * wanted) / here).add(target);
    this.controls.update();
  }

  // The box from the side on which the camera is, gliding there.
  frame(box: Box3): void {
    const side = this.camera.position.clone().sub(this.controls.target).normalize();
    this.flight = { target: box.getCenter(new Vector3()), distance: this.distanceFor(box, side) };
  }

  // How far from its centre, on this side, every corner of a box is in the picture, with some air around.
  private distanceFor(box: Box3, side: Vector3): number {
    const air = 1.12;
    const up = Math.tan(MathUtils.degToRad(this.camera.fov) / 2) / air;
    const across = up * this.camera.aspect;
    const right = new Vector3(0, 1, 0).cross(side).normalize();
    const top = side.clone().cross(right);
    const half = box.getSize(new Vector3()).multiplyScalar(0.5);
    let distance = 0;
    for (let corner = 0; corner < 8; corner++) {
      const at = new Vector3(corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y, corner & 4 ? half.z : -half.z);
      const wide = Math.max(Math.abs(at.dot(right)) / across, Math.abs(at.dot(top)) / up);
      distance = Math.max(distance, at.dot(side) + wide);
    }
    return Math.max(distance, 0.01);
  }

  follow(place: Vector3 | null): void {
    if (!place) {
      this.following = false;
      return;
    }
    if (this.following) {
      // The camera goes along; the hand may turn and zoom meanwhile.
      this.camera.position.add(place).sub(this.followed);
      this.controls.target.add(place).sub(this.followed);
    } else {
      this.following = true;
      this.flight = { target: place.clone(), distance: this.camera.position.distanceTo(this.controls.target) };
    }
    if (this.flight) this.flight.target.copy(place);
    this.followed.copy(place);
  }

  // The ground stands still: a camera below it would see nothing.
  update(seconds: number): void {
    if (this.flight) {
      const part = 1 - Math.exp(-GLIDE * seconds);
      const { target } = this.controls;
      const away = this.camera.position.clone().sub(target);
      const distance = MathUtils.lerp(away.length(), this.flight.distance, part);
      target.lerp(this.flight.target, part);
      this.camera.position.copy(target).add(away.setLength(distance));
      const close = target.distanceTo(this.flight.target) < 1e-3 * distance && Math.abs(distance - this.flight.distance) < 1e-3 * distance;
      if (close) this.flight = null;
    }
    this.controls.update(seconds);
  }
}
