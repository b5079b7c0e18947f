// Fluids: vector fields on a grid, and particles that carry them.
import { ground, type Lesson, palette, slider } from '../lesson';

export const gas: Lesson = {
  title: 'a gas as a vector field',
  sliders: [
    slider('speed', 'Speed of the wind', 0.2, 2, 0.1, 1, 'm/s'),
    slider('viscosity', 'Viscosity, 10 to the power of', -4, -1, 0.25, -2.5, 'Pa s'),
    slider('radius', 'Radius of the cylinder', 0.05, 0.3, 0.05, 0.15, 'm'),
  ],
  overlays: ['flow'],
  scene: (v) => ({
    gyre_scene: 1,
    name: 'wind around a cylinder',
    world: { gravity: [0, 0, 0], substeps: 2 },
    view: { eye: [1.5, 0.75, 3.9], target: [1.5, 0.75, 0], field_of_view: 0.5 },
    bodies: [
      {
        name: 'cylinder',
        type: 'static',
        position: [0.8, 0.765, 0.025],
        color: palette.grey,
        shapes: [{ type: 'cylinder', radius: v.radius, half_height: 0.1, orientation: { axis: [1, 0, 0], angle: Math.PI / 2 } }],
      },
    ],
    gases: [
      {
        name: 'air',
        bounds: [
          [0, 0, 0],
          [3, 1.5, 0.05],
        ],
        cells: [96, 48, 1],
        viscosity: 10 ** v.viscosity!,
        boundary: { y: 'closed', z: 'closed' },
        initial_velocity: [v.speed, 0, 0],
        color: '#e8e4dc',
        emitters: Array.from({ length: 15 }, (_, i) => ({
          position: [0.05, 0.05 + 0.1 * i, 0.025],
          radius: 0.09,
          density: i % 2,
          temperature: 293.15,
          velocity: [v.speed, 0, 0],
        })),
      },
    ],
  }),
  words: (_, v) => {
    const reynolds = (1.2 * v.speed! * 2 * v.radius!) / 10 ** v.viscosity!;
    return `Reynolds number: density · speed · diameter / viscosity = ${reynolds.toPrecision(3)}.`;
  },
};

const WIDE = 2.4; // m, of the tank

export const liquid: Lesson = {
  title: 'a liquid that carries its vector field along',
  sliders: [
    slider('height', 'Height of the water', 0.3, 1, 0.05, 0.8, 'm'),
    slider('viscosity', 'Viscosity, 10 to the power of', -3, 2, 0.5, -3, 'Pa s'),
    slider('density', 'Density of the crate', 100, 2000, 50, 400, 'kg/m³'),
  ],
  scene: (v) => {
    const wall = (name: string, position: number[], half: number[]): object => ({
      name,
      type: 'static',
      position,
      color: '#bfbbb3',
      shapes: [{ type: 'box', half_extents: half }],
    });
    return {
      gyre_scene: 1,
      name: 'a dam breaks',
      world: { substeps: 2 },
      view: { eye: [2.2, 2, 4], target: [1.2, 0.35, 0.2], field_of_view: 0.6 },
      bodies: [
        ground,
        wall('left', [-0.05, 0.3, 0.2], [0.05, 0.3, 0.3]),
        wall('right', [WIDE + 0.05, 0.3, 0.2], [0.05, 0.3, 0.3]),
        {
          name: 'crate',
          color: palette.sand,
          position: [1.6, 0.125, 0.2],
          shapes: [{ type: 'box', half_extents: [0.12, 0.12, 0.12], density: v.density, static_friction: 0.3, dynamic_friction: 0.3 }],
        },
      ],
      liquids: [
        {
          name: 'water',
          bounds: [
            [0, 0, 0],
            [WIDE, 1.4, 0.4],
          ],
          cell_size: 0.08,
          viscosity: 10 ** v.viscosity!,
          fill: [
            {
              box: [
                [0, 0, 0],
                [0.7, v.height, 0.4],
              ],
            },
          ],
        },
      ],
    };
  },
  readings: [
    { label: 'height of the crate', unit: 'm', color: palette.blue, value: ({ position }) => position('crate')[1] },
    { label: 'speed of the crate', unit: 'm/s', color: palette.red, value: ({ velocity }) => Math.hypot(...velocity('crate')) },
  ],
};
