// What collides, as wire: every convex shape's edges and every mesh's triangles, one instanced draw call a mesh, so that ten
// thousand bodies have theirs too.
import { BufferAttribute, BufferGeometry, EdgesGeometry, Group, InstancedMesh, LineBasicMaterial, WireframeGeometry } from 'three';
import { Batch } from '../draw/batch';
import { meshGeometry, type Part, partsOf } from '../draw/shape_geometry';
import type { Overlay, OverlayView } from './overlay';

// The edges of a round shape are the seams that a person would draw.
const SHARP = 25; // degrees between two faces that make an edge

export class Hulls implements Overlay {
  readonly object = new Group();
  private readonly material = new LineBasicMaterial({ color: '#ffffff', transparent: true, opacity: 0.85, fog: false });
  private readonly edges = new Map<string, BufferGeometry>();
  private batches: Batch[] = [];
  private structure = -1;
  private moved = new Uint8Array(0);

  update({ frame, bodies }: OverlayView): void {
    if (frame.structure !== this.structure) this.rebuild(frame.structure, bodies);
    this.moved.fill(1);
    for (const batch of this.batches) batch.place(bodies.poses, this.moved);
  }

  private rebuild(structure: number, bodies: OverlayView['bodies']): void {
    this.clear();
    this.structure = structure;
    this.moved = new Uint8Array(bodies.keys.length);
    const groups = new Map<string, { row: number; part: Part }[]>();
    bodies.keys.forEach((key, row) => {
      for (const shape of bodies.known.get(key)?.shapes ?? []) {
        if (shape.geometry.kind === 'plane') continue;
        for (const part of partsOf(shape)) {
          const group = groups.get(part.mesh);
          if (group) group.push({ row, part });
          else groups.set(part.mesh, [{ row, part }]);
        }
      }
    });
    for (const [mesh, parts] of groups) {
      const batch = new Batch(this.edgesOf(mesh, bodies), this.material, parts);
      asLines(batch.mesh);
      this.object.add(batch.mesh);
      this.batches.push(batch);
    }
  }

  private edgesOf(name: string, bodies: OverlayView['bodies']): BufferGeometry {
    let edges = this.edges.get(name);
    if (!edges) {
      const kind = bodies.surfaces.get(name)?.kind;
      const solid = name === 'sphere' || name === 'cap' ? ringsOf(name) : meshGeometry(name, bodies.surfaces);
      edges = solid.getAttribute('normal')
        ? kind === 'mesh' || kind === 'height_field'
          ? new WireframeGeometry(solid)
          : new EdgesGeometry(solid, SHARP)
        : solid;
      this.edges.set(name, edges);
    }
    return edges;
  }

  clear(): void {
    for (const batch of this.batches) batch.dispose();
    this.batches = [];
    for (const edges of this.edges.values()) edges.dispose();
    this.edges.clear();
    this.structure = -1;
  }
}

// An instanced mesh drawn as lines: the renderer asks these marks which primitive to draw.
function asLines(mesh: InstancedMesh): void {
  Object.assign(mesh, { isMesh: false, isLine: true, isLineSegments: true, raycast: () => {} });
  mesh.renderOrder = 6;
  mesh.castShadow = false;
}

// Three great circles for a ball; the rim and two half circles for the cap of a capsule.
function ringsOf(name: 'sphere' | 'cap'): BufferGeometry {
  const points: number[] = [];
  const arcs: ((a: number) => [number, number, number])[] = [
    (a) => [Math.cos(a), 0, Math.sin(a)],
    (a) => [Math.cos(a), Math.sin(a), 0],
    (a) => [0, Math.sin(a), Math.cos(a)],
  ];
  const pieces = 48;
  arcs.forEach((arc, index) => {
    const reach = name === 'cap' && index > 0 ? Math.PI : 2 * Math.PI;
    for (let i = 0; i < pieces; i++) points.push(...arc((reach * i) / pieces), ...arc((reach * (i + 1)) / pieces));
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(points), 3));
  return geometry;
}
