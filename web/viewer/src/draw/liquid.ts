// The surface of a liquid. Seen at a slant it shows less of what is below and more of the sky (C. Schlick, "An inexpensive BRDF model for
// physically-based rendering", 1994).
import { BufferAttribute, BufferGeometry, type Color, Mesh, MeshStandardMaterial } from 'three';
import type { FluidState } from '../protocol';

const FRAGMENT = /* glsl */ `
  #include <opaque_fragment>
  float gyreSlant = pow(1.0 - clamp(dot(normalize(vViewPosition), normal), 0.0, 1.0), 4.0);
  gl_FragColor.rgb = mix(gl_FragColor.rgb, gyreSky, 0.55 * gyreSlant);
  gl_FragColor.a = mix(gl_FragColor.a, 1.0, 0.7 * gyreSlant);
`;

export class Liquid {
  readonly mesh: Mesh<BufferGeometry, MeshStandardMaterial>;
  private readonly sky: { value: Color };

  constructor(color: Color, sky: Color) {
    const material = new MeshStandardMaterial({ color, roughness: 0.12, metalness: 0, transparent: true, opacity: 0.72 });
    this.sky = { value: sky };
    material.onBeforeCompile = (shader) => {
      shader.uniforms.gyreSky = this.sky;
      shader.fragmentShader = shader.fragmentShader
        .replace('#include <common>', '#include <common>\nuniform vec3 gyreSky;')
        .replace('#include <opaque_fragment>', FRAGMENT);
    };
    material.customProgramCacheKey = () => 'gyre liquid';
    this.mesh = new Mesh(new BufferGeometry(), material);
    this.mesh.frustumCulled = false;
    this.mesh.receiveShadow = true;
    this.mesh.renderOrder = 2;
    this.mesh.raycast = () => {};
  }

  show({ vertices, normals, indices }: FluidState): void {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(vertices, 3));
    geometry.setAttribute('normal', new BufferAttribute(normals, 3));
    geometry.setIndex(new BufferAttribute(indices, 1));
    this.mesh.geometry.dispose();
    this.mesh.geometry = geometry;
  }

  setSky(color: Color): void {
    this.sky.value = color;
  }

  dispose(): void {
    this.mesh.removeFromParent();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
