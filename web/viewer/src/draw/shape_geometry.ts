// Shapes to meshes. Boxes, balls, cylinders, cones and capsules are one unit mesh each, stretched per body, so that all of a kind
// are one draw call; what cannot be stretched (rounded boxes, surfaces) has a mesh of its own, shared by equal shapes.
import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  ConeGeometry,
  CylinderGeometry,
  Matrix4,
  PlaneGeometry,
  Quaternion,
  SphereGeometry,
  Vector3,
} from 'three';
import { RoundedBoxGeometry } from 'three/addons/geometries/RoundedBoxGeometry.js';
import { mergeVertices, toCreasedNormals } from 'three/addons/utils/BufferGeometryUtils.js';
import type { ShapeDescription, ShapeGeometry, Surface } from '../protocol';

// How the surface of a mesh is drawn; see body_material.ts.
export type Finish = 'edges' | 'band' | 'spokes' | 'plain' | 'ground';

export interface Part {
  mesh: string; // which mesh
  local: Matrix4; // body from mesh
  finish: Finish;
}

const PLANE_REACH = 1000; // m, half the side of the square that stands for an endless plane

export function shapeMatrix(shape: ShapeDescription): Matrix4 {
  return new Matrix4().compose(new Vector3(...shape.position), new Quaternion(...shape.rotation), new Vector3(1, 1, 1));
}

const scaled = (x: number, y: number, z: number): Matrix4 => new Matrix4().makeScale(x, y, z);

// The parts that a shape is drawn with, in the shape's frame.
function partsInShape(geometry: ShapeGeometry): Part[] {
  switch (geometry.kind) {
    case 'sphere':
      return [{ mesh: 'sphere', local: scaled(geometry.radius, geometry.radius, geometry.radius), finish: 'band' }];
    case 'box': {
      const [x, y, z] = geometry.halfExtents;
      if (geometry.rounding <= 0) return [{ mesh: 'box', local: scaled(x, y, z), finish: 'edges' }];
      return [{ mesh: `box ${x} ${y} ${z} ${geometry.rounding}`, local: new Matrix4(), finish: 'plain' }];
    }
    case 'capsule': {
      const { radius: r, halfHeight: h } = geometry;
      return [
        { mesh: 'tube', local: scaled(r, h, r), finish: 'spokes' },
        { mesh: 'cap', local: scaled(r, r, r).setPosition(0, h, 0), finish: 'spokes' },
        { mesh: 'cap', local: scaled(r, -r, -r).setPosition(0, -h, 0), finish: 'spokes' },
      ];
    }
    case 'cylinder':
      return [{ mesh: 'cylinder', local: scaled(geometry.radius, geometry.halfHeight, geometry.radius), finish: 'spokes' }];
    case 'cone':
      return [{ mesh: 'cone', local: scaled(geometry.radius, geometry.halfHeight, geometry.radius), finish: 'spokes' }];
    case 'plane': {
      const normal = new Vector3(...geometry.normal).normalize();
      const turn = new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), normal);
      const place = normal.multiplyScalar(geometry.offset / new Vector3(...geometry.normal).length());
      return [{ mesh: 'plane', local: new Matrix4().compose(place, turn, new Vector3(1, 1, 1)), finish: 'ground' }];
    }
    case 'surface':
      return [{ mesh: geometry.surface, local: new Matrix4(), finish: 'plain' }];
  }
}

export function partsOf(shape: ShapeDescription): Part[] {
  const place = shapeMatrix(shape);
  return partsInShape(shape.geometry).map((part) => ({ ...part, local: place.clone().multiply(part.local) }));
}

function surfaceGeometry(surface: Surface): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(surface.vertices, 3));
  geometry.setIndex(new BufferAttribute(surface.indices, 1));
  // Hulls are faceted; of terrains only the sharp edges are.
  if (surface.kind === 'hull') {
    const faceted = geometry.toNonIndexed();
    faceted.computeVertexNormals();
    return faceted;
  }
  return toCreasedNormals(mergeVertices(geometry), 0.6);
}

function roundedBox(name: string): BufferGeometry {
  const [x, y, z, rounding] = name.split(' ').slice(1).map(Number) as [number, number, number, number];
  return new RoundedBoxGeometry(2 * x, 2 * y, 2 * z, 4, rounding);
}

export function meshGeometry(name: string, surfaces: ReadonlyMap<string, Surface>): BufferGeometry {
  switch (name) {
    case 'sphere':
      return new SphereGeometry(1, 32, 20);
    case 'box':
      return new BoxGeometry(2, 2, 2);
    case 'tube':
      return new CylinderGeometry(1, 1, 2, 28, 1, true);
    case 'cap':
      return new SphereGeometry(1, 28, 10, 0, 2 * Math.PI, 0, Math.PI / 2);
    case 'cylinder':
      return new CylinderGeometry(1, 1, 2, 36);
    case 'cone':
      return new ConeGeometry(1, 2, 36);
    case 'plane':
      return new PlaneGeometry(2 * PLANE_REACH, 2 * PLANE_REACH).rotateX(-Math.PI / 2);
    default: {
      const surface = surfaces.get(name);
      return surface ? surfaceGeometry(surface) : roundedBox(name);
    }
  }
}
