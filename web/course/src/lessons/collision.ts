// How the engine finds what touches.
import { choice, ground, type Lesson, palette, randoms, slider } from '../lesson';

const colors = Object.values(palette);

// Sticks in a box without a lid: thrown in at random places and angles.
function sticks(count: number, halfLength: number, radius: number, spread: number): object[] {
  const random = randoms(7);
  const side = Math.ceil(Math.cbrt(count));
  return Array.from({ length: count }, (_, i) => ({
    name: `stick ${i}`,
    color: colors[i % colors.length],
    position: [
      (((i % side) + 0.5) / side - 0.5) * spread,
      0.6 + (Math.floor(i / (side * side)) * spread) / side,
      (((Math.floor(i / side) % side) + 0.5) / side - 0.5) * spread,
    ],
    orientation: { euler_xyz: [3 * random(), 3 * random(), 3 * random()] },
    shapes: [{ type: 'capsule', radius, half_height: halfLength, density: 500 }],
  }));
}

export const boundingVolumes: Lesson = {
  title: 'bounding volumes',
  sliders: [slider('count', 'Sticks', 2, 60, 1, 20), slider('length', 'Length of a stick', 0.1, 1.2, 0.1, 0.8, 'm')],
  overlays: ['bounds'],
  scene: (v) => ({
    gyre_scene: 1,
    name: 'boxes around sticks',
    view: { eye: [3, 2.6, 5], target: [0, 0.7, 0], field_of_view: 0.65 },
    bodies: [ground, ...sticks(v.count!, v.length! / 2, 0.06, 2)],
  }),
  readings: [
    { label: 'pairs of boxes that overlap', unit: '', color: palette.blue, value: ({ frame }) => frame.stats.pairs },
    { label: 'pairs that touch', unit: '', color: palette.red, value: ({ frame }) => frame.stats.touching },
  ],
};

const broadPhases = ['bvh', 'grid', 'octree', 'quadtree', 'kd_tree', 'bsp_tree', 'sweep_and_prune', 'brute_force'];

export const trees: Lesson = {
  title: 'hierarchies, grids and trees',
  sliders: [choice('kind', 'Structure', broadPhases), slider('count', 'Balls', 20, 1500, 20, 300), slider('spread', 'Largest ball / smallest ball', 1, 10, 1, 2)],
  overlays: ['tree'],
  scene: (v) => {
    const random = randoms(11);
    const half = 2 * Math.cbrt(v.count! / 300);
    return {
      gyre_scene: 1,
      name: 'balls in zero gravity',
      world: { gravity: [0, 0, 0], broad_phase: broadPhases[v.kind!], sleeping: false, substeps: 1 },
      view: { eye: [1.8 * half, 1.6 * half, 3 * half], target: [0, 0, 0], field_of_view: 0.75 },
      bodies: Array.from({ length: v.count! }, (_, i) => ({
        name: `ball ${i}`,
        color: colors[i % colors.length],
        position: [half * (2 * random() - 1), half * (2 * random() - 1), half * (2 * random() - 1)],
        linear_velocity: [random() - 0.5, random() - 0.5, random() - 0.5],
        shapes: [{ type: 'sphere', radius: 0.05 * (1 + (v.spread! - 1) * random() ** 3), restitution: 1, static_friction: 0, dynamic_friction: 0 }],
      })),
      force_fields: [{ type: 'radial', center: [0, 0, 0], strength: 0.3, radius: half, falloff: -1 }],
    };
  },
  readings: [
    { label: 'pairs of boxes that overlap', unit: '', color: palette.blue, value: ({ frame }) => frame.stats.pairs },
    { label: 'time of a step', unit: 'ms', color: palette.red, value: ({ frame }) => frame.stats.stepMs },
  ],
  words: ({ frame }) => {
    const n = frame.stats.bodies;
    return `${n} balls make ${(n * (n - 1)) / 2} pairs; ${frame.stats.pairs} pairs of boxes overlap. The tree is drawn for bvh alone.`;
  },
};

export const separatingAxes: Lesson = {
  title: 'separating axes',
  sliders: [
    slider('yaw', 'Upper box, turned about the vertical', 0, 90, 5, 45, '°'),
    slider('tilt', 'Upper box, tilted', 0, 90, 5, 45, '°'),
    slider('offset', 'Upper box, beside the middle', 0, 1, 0.05, 0.3, 'm'),
  ],
  overlays: ['contacts'],
  scene: (v) => ({
    gyre_scene: 1,
    name: 'two boxes meet',
    view: { eye: [2, 2.2, 3.4], target: [0, 0.7, 0], field_of_view: 0.65 },
    bodies: [
      { name: 'lower', type: 'static', color: palette.grey, position: [0, 0.3, 0], shapes: [{ type: 'box', half_extents: [0.6, 0.3, 0.6] }] },
      {
        name: 'upper',
        color: palette.sand,
        position: [v.offset, 1.6, 0],
        orientation: { euler_xyz: [(v.tilt! * Math.PI) / 180, (v.yaw! * Math.PI) / 180, 0] },
        shapes: [{ type: 'box', half_extents: [0.3, 0.3, 0.3], static_friction: 0.8, dynamic_friction: 0.8 }],
      },
      ground,
    ],
  }),
  readings: [
    { label: 'contact points', unit: '', color: palette.blue, value: ({ frame }) => frame.stats.contactPoints },
    { label: 'deepest overlap', unit: 'mm', color: palette.red, value: ({ frame }) => 1000 * Math.max(0, frame.stats.maxPenetration) },
  ],
};

export const continuousCollision: Lesson = {
  title: 'continuous collision',
  sliders: [
    slider('speed', 'Speed of the ball', 5, 300, 5, 200, 'm/s'),
    choice('continuous', 'Continuous collision of the ball', ['off', 'on'], 0),
    slider('thickness', 'Thickness of the plate', 0.01, 0.3, 0.01, 0.02, 'm'),
  ],
  scene: (v) => ({
    gyre_scene: 1,
    name: 'a fast ball and a thin plate',
    world: { gravity: [0, 0, 0] },
    view: { eye: [0, 2.5, 9], target: [0, 0.5, 0], field_of_view: 0.65 },
    bodies: [
      {
        name: 'plate',
        color: palette.sand,
        position: [0.9, 0.5, 0],
        shapes: [{ type: 'box', half_extents: [v.thickness! / 2, 1, 1], density: 2000 / v.thickness! }],
      },
      {
        name: 'ball',
        color: palette.red,
        position: [-4.2, 0.5, 0],
        linear_velocity: [v.speed, 0, 0],
        continuous: v.continuous === 1,
        shapes: [{ type: 'sphere', radius: 0.1, density: 1000 }],
      },
    ],
  }),
  readings: [
    { label: 'ball', unit: 'm', color: palette.red, value: ({ position }) => Math.min(position('ball')[0], 6) },
    { label: 'plate', unit: 'm', color: palette.blue, value: ({ position }) => Math.min(position('plate')[0], 6) },
  ],
  words: ({ position }) => `The ball is ${position('ball')[0] > position('plate')[0] ? 'behind the plate: it went through' : 'before the plate'}.`,
};
