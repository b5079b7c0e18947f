// Centres of mass, and for each body the ellipsoid of even density that has its mass and inertia: with semi-axes a, b, c the
// moment about a is m (b^2 + c^2) / 5, so a^2 = 5 (Ib + Ic - Ia) / (2 m).
import { DynamicDrawUsage, Group, InstancedMesh, Matrix4, MeshLambertMaterial, Quaternion, SphereGeometry, Vector3 } from 'three';
import { overlayColors } from '../draw/palette';
import type { BodyDescription } from '../protocol';
import { Marks } from './marks';
import type { Overlay, OverlayView } from './overlay';
import { principalAxes } from './principal_axes';

export class Mass implements Overlay {
  readonly object = new Group();
  private readonly marks = new Marks();
  private readonly geometry = new SphereGeometry(1, 24, 16);
  private readonly material = new MeshLambertMaterial({
    color: overlayColors.ellipsoid,
    transparent: true,
    opacity: 0.5,
    depthTest: false,
    depthWrite: false,
    fog: false,
  });
  private ellipsoids: InstancedMesh | null = null;
  private readonly locals = new WeakMap<BodyDescription, Matrix4>();
  private readonly body = new Matrix4();

  constructor() {
    this.object.add(this.marks.object);
  }

  update({ frame, bodies, scale }: OverlayView): void {
    const rows = frame.flags.length;
    const mesh = this.room(rows);
    let count = 0;
    const place = new Vector3();
    const turn = new Quaternion();
    const one = new Vector3(1, 1, 1);
    const center = new Vector3();
    this.marks.begin();
    for (let row = 0; row < rows; row++) {
      const body = bodies.known.get(bodies.keys[row]!);
      if (!body || body.mass <= 0) continue;
      place.fromArray(bodies.poses, 7 * row);
      turn.fromArray(bodies.poses, 7 * row + 3);
      this.body.compose(place, turn, one);
      center.set(...body.centerOfMass).applyMatrix4(this.body);
      this.marks.add(center.x, center.y, center.z, 0.007 * scale, overlayColors.center);
      mesh.setMatrixAt(count++, this.body.multiply(this.localOf(body)));
    }
    this.marks.end();
    mesh.count = count;
    mesh.instanceMatrix.needsUpdate = true;
  }

  private localOf(body: BodyDescription): Matrix4 {
    let local = this.locals.get(body);
    if (!local) {
      const { moments, axes } = principalAxes(body.inertia);
      const [a, b, c] = moments;
      const half = (twice: number): number => Math.sqrt(Math.max((2.5 * twice) / body.mass, 1e-12));
      local = axes.scale(new Vector3(half(b + c - a), half(a + c - b), half(a + b - c))).setPosition(...body.centerOfMass);
      this.locals.set(body, local);
    }
    return local;
  }

  private room(rows: number): InstancedMesh {
    if (this.ellipsoids && this.ellipsoids.instanceMatrix.count >= rows) return this.ellipsoids;
    this.ellipsoids?.removeFromParent();
    this.ellipsoids?.dispose();
    const mesh = new InstancedMesh(this.geometry, this.material, Math.max(2 * rows, 16));
    mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    mesh.frustumCulled = false;
    mesh.renderOrder = 8;
    mesh.raycast = () => {};
    this.object.add(mesh);
    this.ellipsoids = mesh;
    return mesh;
  }

  clear(): void {
    this.marks.begin();
    this.marks.end();
    if (this.ellipsoids) this.ellipsoids.count = 0;
  }
}
