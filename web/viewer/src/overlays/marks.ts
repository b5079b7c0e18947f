// Many small coloured balls, refilled each frame: contact points, centres of mass.
import { type Color, DynamicDrawUsage, Group, InstancedMesh, MeshBasicMaterial, SphereGeometry } from 'three';

export class Marks {
  readonly object = new Group();
  private readonly geometry = new SphereGeometry(1, 12, 8);
  private readonly material = new MeshBasicMaterial({ depthTest: false, transparent: true, fog: false });
  private mesh = this.make(256);
  private count = 0;

  private make(capacity: number): InstancedMesh {
    const mesh = new InstancedMesh(this.geometry, this.material, capacity);
    mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    mesh.frustumCulled = false;
    mesh.renderOrder = 9;
    mesh.raycast = () => {};
    mesh.count = 0;
    this.object.add(mesh);
    return mesh;
  }

  begin(): void {
    this.count = 0;
  }

  add(x: number, y: number, z: number, radius: number, color: Color): void {
    if (16 * (this.count + 1) > this.mesh.instanceMatrix.array.length) this.grow();
    const m = this.mesh.instanceMatrix.array as Float32Array;
    const i = 16 * this.count;
    m.fill(0, i, i + 16);
    m[i] = m[i + 5] = m[i + 10] = radius;
    m[i + 12] = x;
    m[i + 13] = y;
    m[i + 14] = z;
    m[i + 15] = 1;
    this.mesh.setColorAt(this.count++, color);
  }

  end(): void {
    this.mesh.count = this.count;
    this.mesh.instanceMatrix.needsUpdate = true;
    if (this.mesh.instanceColor) this.mesh.instanceColor.needsUpdate = true;
  }

  private grow(): void {
    const old = this.mesh;
    this.mesh = this.make(4 * this.count);
    this.mesh.instanceMatrix.array.set(old.instanceMatrix.array);
    if (old.instanceColor) {
      this.mesh.setColorAt(0, this.material.color); // makes the buffer
      this.mesh.instanceColor!.array.set(old.instanceColor.array);
    }
    old.removeFromParent();
    old.dispose();
  }
}
