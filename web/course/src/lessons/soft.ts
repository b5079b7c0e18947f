// Matter that bends: ropes, cloth, solids.
import { choice, ground, type Lesson, palette, slider } from '../lesson';

const lowest = (list: number[]): number => {
  let low = Infinity;
  for (let i = 1; i < list.length; i += 3) low = Math.min(low, list[i]!);
  return low;
};

const ropeIntegrators = ['implicit', 'semi_implicit_euler', 'rk4', 'verlet'];

export const ropes: Lesson = {
  title: 'springs and rods',
  sliders: [
    slider('stiffness', 'Stretch stiffness EA of the springs, 10 to the power of', 1.5, 5, 0.25, 2, 'N'),
    choice('scheme', 'Integrator of the springs', ropeIntegrators),
    slider('load', 'Load on each rope', 0.1, 20, 0.1, 2, 'kg'),
  ],
  scene: (v) => {
    const rope = (name: string, x: number, color: string, rest: object): object => ({
      name,
      points: [
        [x, 3, 0],
        [x, 2, 0],
      ],
      segments: 10,
      linear_density: 0.2,
      color,
      attach: [
        { end: 0, body: 'world' },
        { end: 1, body: `load ${name}` },
      ],
      ...rest,
    });
    const load = (name: string, x: number, color: string): object => ({
      name: `load ${name}`,
      color,
      position: [x, 1.9, 0],
      mass: v.load,
      shapes: [{ type: 'sphere', radius: 0.1 }],
    });
    return {
      gyre_scene: 1,
      name: 'a rope of springs and a rope of rods',
      world: { sleeping: false },
      view: { eye: [0, 1.8, 5.4], target: [0, 1.8, 0], field_of_view: 0.65 },
      bodies: [ground, load('springs', -0.6, palette.red), load('rods', 0.6, palette.blue)],
      ropes: [
        rope('springs', -0.6, palette.red, { links: 'springs', stretch_stiffness: 10 ** v.stiffness!, integrator: ropeIntegrators[v.scheme!] }),
        rope('rods', 0.6, palette.blue, { links: 'rods' }),
      ],
    };
  },
  readings: [
    { label: 'length of the springs', unit: 'm', color: palette.red, value: ({ vertices }) => 3 - lowest(vertices('springs')) },
    { label: 'length of the rods', unit: 'm', color: palette.blue, value: ({ vertices }) => 3 - lowest(vertices('rods')) },
    {
      label: 'springs at rest by the equation',
      unit: 'm',
      color: palette.grey,
      value: (_, v) => 1 + ((v.load! + 0.1) * 9.81) / 10 ** v.stiffness!,
    },
  ],
};

const links = ['springs', 'membrane', 'rods'];

export const cloth: Lesson = {
  title: 'cloth',
  sliders: [
    choice('links', 'Links', links),
    slider('stretch', 'Stretch stiffness, 10 to the power of', 1, 4, 0.25, 3, 'N/m'),
    slider('bend', 'Bend stiffness, 10 to the power of', -6, -1, 0.5, -4, 'N m'),
    slider('cells', 'Cells along a side', 8, 40, 4, 24),
  ],
  scene: (v) => ({
    gyre_scene: 1,
    name: 'a cloth on two pins and a ball',
    view: { eye: [2.4, 2.6, 4.4], target: [0, 1, 0], field_of_view: 0.65 },
    bodies: [ground, { name: 'ball', type: 'static', color: palette.grey, position: [0, 0.7, 0], shapes: [{ type: 'sphere', radius: 0.5 }] }],
    cloths: [
      {
        name: 'cloth',
        color: palette.red,
        grid: { size: [2, 2], cells: [v.cells, v.cells] },
        position: [0, 1.4, 0],
        links: links[v.links!],
        stretch_stiffness: 10 ** v.stretch!,
        shear_stiffness: 0.06 * 10 ** v.stretch!,
        bend_stiffness: 10 ** v.bend!,
        damping: 0.01,
        pinned: [0, v.cells],
      },
    ],
  }),
  readings: [
    { label: 'lowest point', unit: 'm', color: palette.blue, value: ({ vertices }) => lowest(vertices('cloth')) },
    { label: 'kinetic energy', unit: 'J', color: palette.red, value: ({ frame }) => frame.stats.kinetic },
  ],
};

const models = ['linear', 'corotated', 'neo_hookean'];
const LENGTH = 1.5; // m, of the free part of the beam
const HALF = 0.1; // m
const DENSITY = 1000;

export const finiteElements: Lesson = {
  title: 'finite elements',
  sliders: [
    choice('model', 'Model', models, 1),
    slider('young', "Young's modulus, 10 to the power of", 6.5, 8, 0.25, 7, 'Pa'),
    slider('poisson', "Poisson's ratio", 0, 0.45, 0.05, 0.3),
    slider('cells', 'Cells along the beam', 6, 30, 3, 15),
  ],
  scene: (v) => ({
    gyre_scene: 1,
    name: 'a beam that is held at one end',
    world: { sleeping: false },
    view: { eye: [0.6, 1.6, 3.6], target: [0.2, 0.9, 0], field_of_view: 0.65 },
    bodies: [ground],
    soft_bodies: [
      {
        name: 'beam',
        color: palette.green,
        box: { half_extents: [LENGTH / 2, HALF, HALF], cells: [v.cells, 3, 3] },
        position: [0, 1.4, 0],
        density: DENSITY,
        young_modulus: 10 ** v.young!,
        poisson_ratio: v.poisson,
        model: models[v.model!],
        damping: 0.05,
        pinned_region: {
          box: [
            [-LENGTH / 2 - 0.001, 0, -1],
            [-LENGTH / 2 + 0.001, 3, 1],
          ],
        },
      },
    ],
  }),
  readings: [
    { label: 'the end hangs down by', unit: 'm', color: palette.blue, value: ({ vertices }) => 1.4 - HALF - lowest(vertices('beam')) },
    {
      // Under its own weight: rho g A L^4 / (8 E I), with I / A = (2 HALF)^2 / 12.
      label: 'by beam theory, for small bending',
      unit: 'm',
      color: palette.grey,
      value: (_, v) => Math.min((DENSITY * 9.81 * LENGTH ** 4 * 12) / (8 * 10 ** v.young! * (2 * HALF) ** 2), LENGTH),
    },
  ],
};
