// A gas on a plane through the middle of its box, as a picture: its smoke and heat, or its speed from still (blue) to fast (red).
import { BufferAttribute, BufferGeometry, type Color, type Data3DTexture, DoubleSide, Mesh, ShaderMaterial, Vector3 } from 'three';
import type { Box } from '../protocol';

const VERTEX = /* glsl */ `
  uniform vec3 low;
  uniform vec3 size;
  varying vec3 cell;
  void main() {
    cell = (position - low) / size;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;

const FRAGMENT = /* glsl */ `
  precision highp sampler3D;
  uniform sampler3D voxels;
  uniform vec3 color;
  uniform bool speed;
  varying vec3 cell;
  vec3 scale(float part) {
    vec3 cold = mix(vec3(0.02, 0.05, 0.22), vec3(0.05, 0.42, 0.62), smoothstep(0.0, 0.35, part));
    vec3 warm = mix(vec3(0.85, 0.78, 0.2), vec3(0.75, 0.06, 0.03), smoothstep(0.65, 1.0, part));
    return mix(cold, warm, smoothstep(0.3, 0.7, part));
  }
  void main() {
    vec4 here = texture(voxels, cell);
    vec3 smoke = mix(vec3(0.012, 0.02, 0.035), color, here.r) + here.g * vec3(0.8, 0.22, 0.03);
    gl_FragColor = vec4(speed ? scale(here.a) : smoke, 0.94);
    #include <colorspace_fragment>
  }`;

export class FluidSlice {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;

  // `across`: the axis that the plane stands on.
  constructor(box: Box, across: 0 | 1 | 2, voxels: Data3DTexture, color: Color) {
    const low = new Vector3(...box.low);
    const size = new Vector3(...box.high).sub(low);
    const [a, b] = [0, 1, 2].filter((axis) => axis !== across) as [number, number];
    const places = [0, 1, 2, 3].flatMap((corner) => {
      const place = low.clone().addScaledVector(size, 0.5);
      place.setComponent(a, corner & 1 ? box.high[a]! : box.low[a]!);
      place.setComponent(b, corner & 2 ? box.high[b]! : box.low[b]!);
      return place.toArray();
    });
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(places), 3));
    geometry.setIndex([0, 1, 3, 0, 3, 2]);
    const material = new ShaderMaterial({
      uniforms: { voxels: { value: voxels }, low: { value: low }, size: { value: size }, color: { value: color }, speed: { value: false } },
      vertexShader: VERTEX, fragmentShader: FRAGMENT, transparent: true, depthWrite: false, side: DoubleSide,
    });
    this.mesh = new Mesh(geometry, material);
    this.mesh.renderOrder = 3;
    this.mesh.raycast = () => {};
  }

  showSpeed(on: boolean): void {
    this.mesh.material.uniforms.speed!.value = on;
  }

  dispose(): void {
    this.mesh.removeFromParent();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
