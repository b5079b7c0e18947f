// Smoke as a volume: slices across the view, from far to near, each as thick as the next is away (B. Cabral, N. Cam, J. Foran, "Accelerated
// volume rendering and tomographic reconstruction using texture mapping hardware", 1994). The depth test hides what is behind bodies.
import {
  BufferAttribute, BufferGeometry, type Camera, Color, CustomBlending, type Data3DTexture, DoubleSide, DynamicDrawUsage, Mesh, OneFactor,
  OneMinusSrcAlphaFactor, ShaderMaterial, Vector3,
} from 'three';
import type { Box } from '../protocol';
import type { Quality } from '../state/preferences';

const SLICES: Record<Quality, number> = { high: 96, low: 40 };
const MOST_CORNERS = 6; // of the cut of a plane and a box
const EDGES = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((corner) => [1, 2, 4].filter((bit) => (corner & bit) === 0).map((bit) => [corner, corner | bit] as const));

const VERTEX = /* glsl */ `
  uniform vec3 low;
  uniform vec3 size;
  varying vec3 cell;
  varying vec3 seen;
  void main() {
    cell = (position - low) / size;
    vec4 place = modelViewMatrix * vec4(position, 1.0);
    seen = place.xyz;
    gl_Position = projectionMatrix * place;
  }`;

// Smoke takes light on the way to the eye and gives back what of the sun and the sky reaches it. Warm gas glows.
const FRAGMENT = /* glsl */ `
  precision highp sampler3D;
  uniform sampler3D voxels;
  uniform vec3 color;
  uniform float sun;
  uniform float sky;
  uniform float extinction;
  uniform float thickness;
  varying vec3 cell;
  varying vec3 seen;
  void main() {
    vec4 here = texture(voxels, cell);
    float way = thickness * length(seen) / max(-seen.z, 1e-6);
    float covers = 1.0 - exp(-extinction * way * (here.r + 0.1 * here.g));
    if (covers < 0.002) discard;
    vec3 smoke = mix(color, vec3(1.0, 0.42, 0.12), 0.8 * here.g);
    vec3 light = smoke * (sky + sun * here.b) + here.g * here.g * vec3(0.55, 0.2, 0.03);
    gl_FragColor = vec4(light, 1.0);
    #include <colorspace_fragment>
    gl_FragColor *= covers;
  }`;

export class Smoke {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  private readonly places: BufferAttribute;
  private readonly corners: Vector3[];
  private slices: number;

  constructor(box: Box, voxels: Data3DTexture, color: Color, extinction: number, quality: Quality) {
    const low = new Vector3(...box.low);
    const high = new Vector3(...box.high);
    this.corners = Array.from({ length: 8 }, (_, i) => new Vector3(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z));
    this.slices = SLICES[quality];
    const geometry = new BufferGeometry();
    this.places = new BufferAttribute(new Float32Array(3 * 3 * (MOST_CORNERS - 2) * SLICES.high), 3).setUsage(DynamicDrawUsage);
    geometry.setAttribute('position', this.places);
    const material = new ShaderMaterial({
      uniforms: {
        voxels: { value: voxels }, low: { value: low }, size: { value: high.clone().sub(low) }, color: { value: color }, sun: { value: 1 },
        sky: { value: 1 }, extinction: { value: extinction }, thickness: { value: 0 },
      },
      vertexShader: VERTEX, fragmentShader: FRAGMENT, transparent: true, depthWrite: false, side: DoubleSide,
      blending: CustomBlending, blendSrc: OneFactor, blendDst: OneMinusSrcAlphaFactor,
    });
    this.mesh = new Mesh(geometry, material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 4; // over the surfaces of liquids
    this.mesh.raycast = () => {};
  }

  setQuality(quality: Quality): void {
    this.slices = SLICES[quality];
  }

  setLight(sun: number, sky: number): void {
    const { uniforms } = this.mesh.material;
    uniforms.sun!.value = sun;
    uniforms.sky!.value = sky;
  }

  // Puts the slices across the view of this camera. Before each picture: the renderer takes the places before it draws anything.
  face(camera: Camera): void {
    camera.updateMatrixWorld();
    const eye = new Vector3().setFromMatrixPosition(camera.matrixWorld);
    const back = new Vector3().setFromMatrixColumn(camera.matrixWorld, 2);
    const right = new Vector3().setFromMatrixColumn(camera.matrixWorld, 0);
    const up = new Vector3().setFromMatrixColumn(camera.matrixWorld, 1);
    const away = this.corners.map((corner) => -back.dot(corner.clone().sub(eye)));
    const near = Math.max(Math.min(...away), 0);
    const far = Math.max(...away);
    const thickness = (far - near) / this.slices;
    let count = 0;
    for (let slice = this.slices - 1; slice >= 0 && thickness > 0; slice--) {
      const at = near + (slice + 0.5) * thickness;
      const cuts = this.cutsAt(at, away);
      const middle = cuts.reduce((sum, cut) => sum.add(cut), new Vector3()).divideScalar(Math.max(cuts.length, 1));
      const around = cuts.map((cut) => ({ cut, angle: Math.atan2(up.dot(cut.clone().sub(middle)), right.dot(cut.clone().sub(middle))) }));
      around.sort((a, b) => a.angle - b.angle);
      for (let i = 2; i < around.length; i++) {
        for (const { cut } of [around[0]!, around[i - 1]!, around[i]!]) this.places.setXYZ(count++, cut.x, cut.y, cut.z);
      }
    }
    this.places.clearUpdateRanges();
    this.places.addUpdateRange(0, 3 * count);
    this.places.needsUpdate = true;
    this.mesh.geometry.setDrawRange(0, count);
    this.mesh.material.uniforms.thickness!.value = thickness;
    this.mesh.material.uniformsNeedUpdate = true;
  }

  // Where the edges of the box are so far from the eye, along the view.
  private cutsAt(at: number, away: readonly number[]): Vector3[] {
    const cuts: Vector3[] = [];
    for (const [a, b] of EDGES) {
      const from = away[a]! - at;
      const to = away[b]! - at;
      if (from > 0 !== to > 0 && cuts.length < MOST_CORNERS) cuts.push(this.corners[a]!.clone().lerp(this.corners[b]!, from / (from - to)));
    }
    return cuts;
  }

  dispose(): void {
    this.mesh.removeFromParent();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
