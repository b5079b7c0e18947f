// Materials of bodies: one three.js material with a few lines of shader each, which draw what lets the eye see a body turn - edges
// on boxes, a band around balls, sectors on what is round about an axis - without any texture, at any stretch of the unit meshes.
import { type Color, DoubleSide, type Material, MeshLambertMaterial, MeshStandardMaterial } from 'three';
import type { Quality } from '../state/preferences';
import type { Finish } from './shape_geometry';

const VERTEX = /* glsl */ `
  #include <begin_vertex>
  gyreLocal = position;
  #ifdef USE_INSTANCING
    gyreHalf = vec3(length(instanceMatrix[0].xyz), length(instanceMatrix[1].xyz), length(instanceMatrix[2].xyz));
  #else
    gyreHalf = vec3(1.0);
  #endif
`;

const FRAGMENT: Record<Exclude<Finish, 'ground'>, string> = {
  plain: '',
  // A lighter line along the edges: the second smallest distance to a face is the distance to an edge.
  edges: /* glsl */ `
    vec3 toFace = gyreHalf - abs(gyreLocal) * gyreHalf;
    float nearest = min(toFace.x, min(toFace.y, toFace.z));
    float farthest = max(toFace.x, max(toFace.y, toFace.z));
    float toEdge = toFace.x + toFace.y + toFace.z - nearest - farthest;
    float width = 0.05 * min(gyreHalf.x, min(gyreHalf.y, gyreHalf.z)) + 0.002 * max(gyreHalf.x, max(gyreHalf.y, gyreHalf.z));
    float pixel = max(fwidth(toEdge), 1e-6);
    float edge = (1.0 - smoothstep(width, width + pixel, toEdge)) * min(1.0, 1.5 * width / pixel);
    diffuseColor.rgb = mix(diffuseColor.rgb, diffuseColor.rgb * 1.22 + 0.07, edge);
  `,
  band: /* glsl */ `
    float height = abs(gyreLocal.y);
    float band = 1.0 - smoothstep(0.3, 0.3 + max(fwidth(height), 1e-6), height);
    diffuseColor.rgb *= mix(1.0, 0.72, band);
  `,
  // Six sectors: sin(3 a) = 3 s - 4 s^3.
  spokes: /* glsl */ `
    float sine = gyreLocal.z / max(length(gyreLocal.xz), 1e-5);
    float sector = 3.0 * sine - 4.0 * sine * sine * sine;
    float blur = max(fwidth(sector), 1e-4);
    float inner = smoothstep(0.0, 0.06, length(gyreLocal.xz));
    diffuseColor.rgb *= mix(1.0, mix(0.8, 1.0, smoothstep(-blur, blur, sector)), inner);
  `,
};

const GROUND = /* glsl */ `
  float gyreGrid(vec2 place, float cell) {
    vec2 at = place / cell;
    vec2 pixel = fwidth(at);
    vec2 away = abs(fract(at - 0.5) - 0.5);
    vec2 line = 1.0 - smoothstep(pixel * 0.6, pixel * 1.6, away);
    return max(line.x, line.y) * (1.0 - smoothstep(0.15, 0.5, max(pixel.x, pixel.y)));
  }
`;

export interface GroundColors {
  ground: { value: Color };
  minor: { value: Color };
  major: { value: Color };
  cell: { value: number }; // m between two thin lines
}

function plainMaterial(quality: Quality, see_through: boolean): Material {
  const common = see_through ? { transparent: true, opacity: 0.3, depthWrite: false } : {};
  return quality === 'high' ? new MeshStandardMaterial({ roughness: 0.62, metalness: 0.05, ...common }) : new MeshLambertMaterial(common);
}

export function bodyMaterial(finish: Finish, quality: Quality, ground: GroundColors, seeThrough = false, doubleSided = false): Material {
  const material = plainMaterial(quality, seeThrough);
  if (doubleSided) material.side = DoubleSide;
  if (finish === 'plain') return material;
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', '#include <common>\nvarying vec3 gyreLocal;\nvarying vec3 gyreHalf;')
      .replace('#include <begin_vertex>', VERTEX);
    const head = 'varying vec3 gyreLocal;\nvarying vec3 gyreHalf;\n';
    if (finish === 'ground') {
      Object.assign(shader.uniforms, { gyreGround: ground.ground, gyreMinor: ground.minor, gyreMajor: ground.major, gyreCell: ground.cell });
      shader.fragmentShader = shader.fragmentShader
        .replace('#include <common>', `#include <common>\n${head}uniform vec3 gyreGround, gyreMinor, gyreMajor;\nuniform float gyreCell;\n${GROUND}`)
        .replace(
          '#include <color_fragment>',
          `diffuseColor.rgb = gyreGround;
           diffuseColor.rgb = mix(diffuseColor.rgb, gyreMinor, gyreGrid(gyreLocal.xz, gyreCell));
           diffuseColor.rgb = mix(diffuseColor.rgb, gyreMajor, gyreGrid(gyreLocal.xz, gyreCell * 10.0));`,
        );
    } else {
      shader.fragmentShader = shader.fragmentShader
        .replace('#include <common>', `#include <common>\n${head}`)
        .replace('#include <color_fragment>', `#include <color_fragment>\n${FRAGMENT[finish]}`);
    }
  };
  material.customProgramCacheKey = () => `gyre ${finish} ${quality}`;
  return material;
}
