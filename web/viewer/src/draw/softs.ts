// Ropes, cloths and solids on the screen: one mesh each, whose vertices move with every picture.
import { Color, DoubleSide, Group, type Material, Mesh, MeshLambertMaterial, MeshStandardMaterial } from 'three';
import type { Frame, SoftDescription, SoftKind, Structure } from '../protocol';
import type { Quality } from '../state/preferences';
import { bodyColor, readingColor } from './palette';
import { type SoftMesh, softMesh } from './soft_geometry';

export interface DrawnSoft {
  soft: SoftDescription;
  first: number; // its first vertex in the frame
  vertices: Float32Array; // 3 each, as drawn now
  mesh: Mesh;
}

interface Item extends DrawnSoft {
  shape: SoftMesh;
  sphereIsOld: boolean;
}

// The back of a cloth is paler, as in the pictures of `gyre render`; a rope has a stripe around it. Without textures, either lets the eye see a turn.
// Where readings are shown, the colour is that of the key alone.
const FRAGMENT: Record<SoftKind, string> = {
  cloth: 'if (!gl_FrontFacing) diffuseColor.rgb = mix(diffuseColor.rgb, vec3(0.73), 0.45);',
  rope: /* glsl */ `
    float turn = fract(vUv.x + vUv.y);
    float blur = max(fwidth(vUv.y), 1e-4);
    float stripe = smoothstep(0.25 - blur, 0.25 + blur, abs(turn - 0.5));
    diffuseColor.rgb *= mix(0.62, 1.0, mix(stripe, 0.5, smoothstep(0.3, 0.8, blur)));`,
  solid: '',
};

// Only the vertices of a cloth keep away from bodies: its flat triangles cut a little off what is round below them. So that the round does not
// show through, a cloth is this part of its mean edge nearer to the eye than it is, in depth alone.
const NEARER = 0.06;
const DEPTH = /* glsl */ `
  #include <project_vertex>
  vec4 gyreNearer = projectionMatrix * (mvPosition + vec4(0.0, 0.0, gyreNear, 0.0));
  gl_Position.z = gyreNearer.z / gyreNearer.w * gl_Position.w;
`;

function material(kind: SoftKind, quality: Quality, edge: number): MeshStandardMaterial | MeshLambertMaterial {
  const made = quality === 'high' ? new MeshStandardMaterial({ roughness: kind === 'solid' ? 0.45 : 0.85, metalness: 0 }) : new MeshLambertMaterial();
  if (kind === 'cloth') made.side = DoubleSide;
  if (kind === 'rope') made.defines = { ...made.defines, USE_UV: '' };
  made.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace('#include <color_fragment>', `#include <color_fragment>\n#ifndef USE_COLOR\n${FRAGMENT[kind]}\n#endif`);
    if (kind !== 'cloth') return;
    shader.uniforms.gyreNear = { value: NEARER * edge };
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', '#include <common>\nuniform float gyreNear;')
      .replace('#include <project_vertex>', DEPTH);
  };
  made.customProgramCacheKey = () => `gyre ${kind} ${quality}`;
  return made;
}

export class Softs {
  readonly group = new Group();
  private readonly items = new Map<number, Item>();
  private fresh: readonly SoftDescription[] = []; // whose places in the frame are not known until it comes
  private shown: { from: Frame; to: Frame; part: number } | null = null;

  constructor(private quality: Quality) {}

  // Forgets everything: another scene comes.
  clear(): void {
    for (const key of [...this.items.keys()]) this.drop(key);
    this.fresh = [];
    this.shown = null;
  }

  private drop(key: number): void {
    const item = this.items.get(key);
    if (!item) return;
    item.mesh.removeFromParent();
    item.mesh.geometry.dispose();
    (item.mesh.material as Material).dispose();
    this.items.delete(key);
  }

  restructure({ softs }: Structure): void {
    const sizes = new Map(softs.map(({ key, vertices }) => [key, vertices]));
    for (const [key, { soft }] of [...this.items]) {
      if (sizes.get(key) !== soft.vertices) this.drop(key);  // gone, or torn
    }
    this.fresh = softs;
    this.shown = null;
  }

  setQuality(quality: Quality): void {
    if (quality === this.quality) return;
    this.quality = quality;
    for (const { soft, mesh, shape } of this.items.values()) {
      const before = mesh.material as MeshStandardMaterial | MeshLambertMaterial;
      const next = material(soft.kind, quality, shape.edge);
      next.color.copy(before.color);
      next.vertexColors = before.vertexColors;
      mesh.material = next;
      before.dispose();
    }
  }

  // Colours vertices by readings, 1 a vertex of the frame, from `low` (blue) to `high` (red); null: everything has its own colour.
  read(readings: Float32Array | null, low: number, high: number): void {
    const color = new Color();
    for (const item of this.items.values()) {
      const material = item.mesh.material as MeshStandardMaterial | MeshLambertMaterial;
      const count = item.soft.vertices;
      const values = readings?.subarray(item.first, item.first + count);
      const colored = values !== undefined && values.length === count && Number.isFinite(values[0]!);
      if (material.vertexColors !== colored) {
        material.vertexColors = colored;
        material.needsUpdate = true;
        if (colored) material.color.set(0xffffff);
        else this.color(item);
      }
      if (!colored) continue;
      const colors = new Float32Array(3 * count);
      for (let i = 0; i < count; i++) readingColor(high > low ? (values[i]! - low) / (high - low) : 0, color).toArray(colors, 3 * i);
      item.shape.paint(colors);
    }
  }

  // Moves everything to `part` of the way between two frames with the same structure.
  place(from: Frame, to: Frame, part: number): void {
    const { shown } = this;
    if (shown && shown.from === from && shown.to === to && shown.part === part) return;
    this.shown = { from, to, part };
    let first = 0;
    for (const soft of this.fresh) {
      const range = [3 * first, 3 * (first + soft.vertices)] as const;
      const item = this.items.get(soft.key);
      if (item) item.first = first;
      else this.add(soft, first, to.softVertices.slice(...range));
      first += soft.vertices;
    }
    this.fresh = [];
    for (const item of this.items.values()) {
      mix(from.softVertices, to.softVertices, part, 3 * item.first, item.vertices);
      item.shape.fill(item.vertices);
      item.sphereIsOld = true;
    }
  }

  private add(soft: SoftDescription, first: number, vertices: Float32Array): void {
    const shape = softMesh(soft, vertices);
    const mesh = new Mesh(shape.geometry, material(soft.kind, this.quality, shape.edge));
    mesh.castShadow = mesh.receiveShadow = true;
    mesh.frustumCulled = false;
    this.items.set(soft.key, { soft, first, vertices, mesh, shape, sphereIsOld: true });
    this.group.add(mesh);
    this.color(this.items.get(soft.key)!);
  }

  private color({ soft, mesh }: Item): void {
    const { color } = mesh.material as MeshStandardMaterial | MeshLambertMaterial;
    if (soft.color === null) bodyColor(soft.key, color);
    else color.set(soft.color);
  }

  // Lets it glow a little; null: none.
  highlight(key: number | null, color: Color): void {
    for (const { soft, mesh } of this.items.values()) {
      const { emissive } = mesh.material as MeshStandardMaterial | MeshLambertMaterial;
      if (soft.key === key) emissive.copy(color).multiplyScalar(0.3);
      else emissive.set(0);
    }
  }

  named(name: string): DrawnSoft | undefined {
    return [...this.items.values()].find(({ soft }) => soft.name === name);
  }

  // Everything that can be picked.
  get toPick(): DrawnSoft[] {
    for (const item of this.items.values()) {
      if (item.sphereIsOld) item.mesh.geometry.computeBoundingSphere();
      item.sphereIsOld = false;
    }
    return [...this.items.values()];
  }
}

function mix(from: Float32Array, to: Float32Array, part: number, first: number, out: Float32Array): void {
  for (let i = 0; i < out.length; i++) {
    const start = from[first + i]!;
    out[i] = start + part * (to[first + i]! - start);
  }
}
