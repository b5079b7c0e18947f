// Bodies in the engine to descriptions for drawing.
import { type AnyShape, BodyType, type BodyId, type Geometry, type Gyre, ShapeKind, type Transform, type World } from 'gyre-physics';
import type { BodyDescription, BodyType as BodyTypeName, ShapeDescription, ShapeGeometry, Surface } from '../protocol';
import { fans, grid } from './triangles';

export function typeName(type: number): BodyTypeName {
  return type === BodyType.dynamic ? 'dynamic' : type === BodyType.kinematic ? 'kinematic' : 'fixed';
}

export class Describer {
  // Surfaces that the page has not been sent yet.
  private fresh: Surface[] = [];
  private readonly known = new Map<string, Surface>();

  constructor(private readonly gyre: Gyre) {}

  takeSurfaces(): Surface[] {
    const surfaces = this.fresh;
    this.fresh = [];
    return surfaces;
  }

  vertices(surface: string): Float32Array | undefined {
    return this.known.get(surface)?.vertices;
  }

  body(world: World, id: BodyId, key: number, name: string): BodyDescription {
    const mass = world.massProperties(id);
    const shapes = Array.from(world.shapes(id)).map((shape): ShapeDescription | null => {
      const geometry = world.geometry(shape);
      return geometry && this.shape(geometry, world.localTransform(shape));
    });
    return {
      key,
      name,
      type: typeName(world.type(id)),
      mass: mass.mass,
      centerOfMass: mass.center,
      inertia: mass.inertia,
      shapes: shapes.filter((shape) => shape !== null),
    };
  }

  // As it is; how it looks is filled in by who knows.
  shape(geometry: AnyShape, local: Transform): ShapeDescription {
    return { geometry: this.geometry(geometry), position: local.position, rotation: local.orientation, material: '', color: null, sensor: false };
  }

  private geometry(shape: AnyShape): ShapeGeometry {
    switch (shape.kind) {
      case ShapeKind.sphere:
        return { kind: 'sphere', radius: shape.radius };
      case ShapeKind.box:
        return { kind: 'box', halfExtents: shape.halfExtents, rounding: shape.rounding };
      case ShapeKind.capsule:
        return { kind: 'capsule', radius: shape.radius, halfHeight: shape.halfHeight };
      case ShapeKind.cylinder:
        return { kind: 'cylinder', radius: shape.radius, halfHeight: shape.halfHeight };
      case ShapeKind.cone:
        return { kind: 'cone', radius: shape.radius, halfHeight: shape.halfHeight };
      case ShapeKind.plane:
        return { kind: 'plane', normal: shape.normal, offset: shape.offset };
      default:
        return { kind: 'surface', surface: this.surface(shape.geometry) };
    }
  }

  private surface(geometry: Geometry): string {
    const key = geometry.contentHash().toString(16);
    if (this.known.has(key)) return key;
    const surface = { key, ...this.triangles(geometry) };
    this.known.set(key, surface);
    this.fresh.push(surface);
    return key;
  }

  private triangles(geometry: Geometry): Omit<Surface, 'key'> {
    switch (geometry.kind()) {
      case ShapeKind.hull: {
        const { vertices, faceOffsets, faceIndices } = this.gyre.viewHull(geometry);
        return { kind: 'hull', vertices: vertices.slice(), indices: fans(faceOffsets, faceIndices) };
      }
      case ShapeKind.mesh: {
        const { vertices, indices } = this.gyre.viewMesh(geometry);
        return { kind: 'mesh', vertices: vertices.slice(), indices: indices.slice() };
      }
      default: {
        const { heights, columns, rows, spacing } = this.gyre.viewHeightField(geometry);
        return { kind: 'height_field', ...grid(heights, columns, rows, spacing) };
      }
    }
  }
}
