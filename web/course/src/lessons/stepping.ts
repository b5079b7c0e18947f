// How time is cut into steps, and how contacts and joints are solved in one.
import { choice, ground, type Lesson, palette, slider } from '../lesson';

const schemes = ['semi_implicit_euler', 'explicit_euler', 'rk4', 'verlet'];
const RADIUS = 2; // m, of the orbit

export const integrators: Lesson = {
  title: 'integrators',
  sliders: [
    choice('scheme', 'Integrator', schemes, 1),
    slider('step', 'Time step', 0.01, 0.2, 0.01, 0.05, 's'),
    slider('speed', 'Speed at the start, as a share of that of a circle', 0.6, 1.2, 0.05, 1),
  ],
  scene: (v) => ({
    gyre_scene: 1,
    name: 'a planet and its star',
    world: { gravity: [0, 0, 0], integrator: schemes[v.scheme!], time_step: v.step, substeps: 1, sleeping: false },
    view: { eye: [0, 8, 5], target: [0, 0, 0], field_of_view: 0.65 },
    bodies: [
      { name: 'star', type: 'static', color: palette.yellow, shapes: [{ type: 'sphere', radius: 0.25 }] },
      {
        name: 'planet',
        color: palette.blue,
        position: [RADIUS, 0, 0],
        linear_velocity: [0, 0, v.speed! * Math.sqrt(4 * RADIUS)],
        shapes: [{ type: 'sphere', radius: 0.12 }],
      },
    ],
    force_fields: [{ type: 'radial', center: [0, 0, 0], strength: 4, radius: RADIUS, falloff: 2 }],
  }),
  readings: [
    { label: 'distance', unit: 'm', color: palette.blue, value: ({ position }) => Math.hypot(...position('planet')) },
    {
      // Of a kilogram: v^2/2 - g r^2 / distance.
      label: 'energy of a kilogram',
      unit: 'J',
      color: palette.red,
      value: ({ position, velocity }) => Math.hypot(...velocity('planet')) ** 2 / 2 - (4 * RADIUS * RADIUS) / Math.hypot(...position('planet')),
    },
  ],
};

export const springs: Lesson = {
  title: 'stiff springs',
  sliders: [
    choice('kind', 'Springs', ['implicit (rows of the solver)', 'explicit (forces)'], 1),
    choice('scheme', 'Integrator', schemes),
    slider('stiffness', 'Stiffness, 10 to the power of', 1, 6, 0.25, 3, 'N/m'),
    slider('substeps', 'Sub-steps of 1/60 s', 1, 16, 1, 4),
  ],
  scene: (v) => ({
    gyre_scene: 1,
    name: 'a weight on a spring',
    world: { springs: v.kind === 1 ? 'explicit' : 'implicit', integrator: schemes[v.scheme!], substeps: v.substeps, sleeping: false },
    view: { eye: [0, 1.6, 4.4], target: [0, 1.2, 0], field_of_view: 0.65 },
    bodies: [
      { name: 'beam', type: 'static', color: palette.grey, position: [0, 2.35, 0], shapes: [{ type: 'box', half_extents: [0.6, 0.05, 0.2] }] },
      { name: 'weight', color: palette.sand, position: [0, 1.2, 0], mass: 1, shapes: [{ type: 'box', half_extents: [0.15, 0.15, 0.15] }] },
    ],
    joints: [{ type: 'distance', a: 'world', b: 'weight', anchor: [0, 2.3, 0], anchor_b: [0, 1.2, 0], length: 1, stiffness: 10 ** v.stiffness! }],
  }),
  readings: [
    { label: 'length of the spring', unit: 'm', color: palette.blue, value: ({ position }) => 2.3 - position('weight')[1] },
    { label: 'at rest by the equation', unit: 'm', color: palette.grey, value: (_, v) => 1 + 9.81 / 10 ** v.stiffness! },
  ],
  words: (_, v) => {
    const w = Math.sqrt(10 ** v.stiffness!);
    return `The spring oscillates at ${(w / (2 * Math.PI)).toFixed(1)} Hz. Semi-implicit Euler follows it up to steps of 2/w = ${(2 / w).toFixed(4)} s; bodies move in steps of ${(1 / 120 / v.substeps!).toFixed(4)} s here.`;
  },
};

const solverKinds = ['soft_step', 'sequential_impulses', 'lcp'];

export const solvers: Lesson = {
  title: 'sequential impulses and LCP',
  sliders: [
    choice('solver', 'Solver', solverKinds, 1),
    slider('ratio', 'Mass of the load / mass of a box', 1, 1000, 1, 200),
    slider('iterations', 'Iterations of sequential impulses', 1, 60, 1, 10),
  ],
  overlays: ['contacts'],
  scene: (v) => ({
    gyre_scene: 1,
    name: 'a heavy load on light boxes',
    world: { solver: solverKinds[v.solver!], iterations: v.iterations },
    view: { eye: [2.6, 2, 4.6], target: [0, 1, 0], field_of_view: 0.65 },
    bodies: [
      ground,
      ...[0, 1, 2].map((i) => ({
        name: `box ${i}`,
        color: palette.sand,
        position: [0, 0.2 + 0.4 * i, 0],
        mass: 10,
        shapes: [{ type: 'box', half_extents: [0.2, 0.2, 0.2] }],
      })),
      { name: 'load', color: palette.grey, position: [0, 1.6, 0], mass: 10 * v.ratio!, shapes: [{ type: 'box', half_extents: [0.4, 0.4, 0.4] }] },
    ],
  }),
  readings: [
    { label: 'height of the load', unit: 'm', color: palette.blue, value: ({ position }) => position('load')[1] },
    { label: 'where it should be', unit: 'm', color: palette.grey, value: () => 1.6 },
  ],
  words: ({ frame }) => `Deepest overlap: ${(1000 * Math.max(0, frame.stats.maxPenetration)).toFixed(1)} mm.`,
};
