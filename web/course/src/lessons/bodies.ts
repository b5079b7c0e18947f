// One body: how it turns, how hard it is to turn, how it rubs.
import { choice, type Lesson, palette, type Seen, slider, type Values } from '../lesson';

const length = ([x, y, z]: [number, number, number]): number => Math.hypot(x, y, z);

export const orientation: Lesson = {
  title: 'orientation and torque',
  sliders: [
    choice('axis', 'Spin about the axis of the', ['smallest moment', 'middle moment', 'largest moment'], 1),
    slider('spin', 'Spin', 2, 20, 1, 10, 'rad/s'),
    slider('nudge', 'Nudge about another axis', 0, 0.5, 0.01, 0.1, 'rad/s'),
    slider('torque', 'Torque about the vertical, first second', -0.4, 0.4, 0.05, 0, 'N m'),
  ],
  scene: (v) => {
    // Moments of the plate's box: smallest about x (long), middle about z, largest about y (across the plate).
    const spins = [
      [v.spin, v.nudge, 0],
      [v.nudge, 0, v.spin],
      [v.nudge, v.spin, 0],
    ];
    return {
      gyre_scene: 1,
      name: 'a free body turns',
      world: { gravity: [0, 0, 0], time_step: 0.008333333 },
      view: { eye: [0.9, 0.9, 1.6], target: [0, 0, 0], field_of_view: 0.6 },
      bodies: [
        {
          name: 'plate',
          can_sleep: false,
          angular_velocity: spins[v.axis!],
          shapes: [
            { type: 'box', half_extents: [0.4, 0.03, 0.2], density: 1000, color: palette.sand },
            { type: 'box', half_extents: [0.05, 0.031, 0.2], position: [0.35, 0, 0], density: 1000, color: palette.red },
            { type: 'box', half_extents: [0.05, 0.031, 0.2], position: [-0.35, 0, 0], density: 1000, color: palette.blue },
          ],
          forces: [{ torque: [0, v.torque, 0], start: 0, end: 1 }],
        },
      ],
    };
  },
  readings: [
    { label: 'angular momentum', unit: 'kg m²/s', color: palette.blue, value: ({ frame }) => length(frame.stats.angular) },
    { label: 'kinetic energy / 10', unit: 'J', color: palette.red, value: ({ frame }) => frame.stats.kinetic / 10 },
    { label: 'spin about x / 10', unit: 'rad/s', color: palette.green, value: ({ spin }) => spin('plate')[0] / 10 },
  ],
};

const SLOPE_LENGTH = 8; // m
const RADIUS = 0.25; // m

// A slope whose upper face runs through the origin of the scene, down along x.
function slope(angle: number, material: object): object {
  return {
    name: 'slope',
    type: 'static',
    color: '#d6d8dc',
    orientation: { axis: [0, 0, 1], angle: -angle },
    shapes: [{ type: 'box', half_extents: [SLOPE_LENGTH / 2, 0.1, 2], position: [0, -0.1, 0], ...material }],
  };
}

function onSlope(angle: number, along: number, above: number, z: number): number[] {
  return [along * Math.cos(angle) + above * Math.sin(angle), -along * Math.sin(angle) + above * Math.cos(angle), z];
}

const rolled = (seen: Seen, name: string, v: Values): number => {
  const [x, y] = seen.position(name);
  const angle = radians(v.angle!);
  return x * Math.cos(angle) - y * Math.sin(angle) + SLOPE_LENGTH / 2 - 0.5;
};
const radians = (degrees: number): number => (degrees * Math.PI) / 180;

const FRICTION = { static_friction: 1.5, dynamic_friction: 1.5 };

// A ball of 1 kg whose inertia is the share c of m r^2.
function ball(name: string, share: number, angle: number, z: number, color: string): object {
  const moment = Math.max(share, 1e-3) * RADIUS * RADIUS;
  return {
    name,
    color,
    position: onSlope(angle, 0.5 - SLOPE_LENGTH / 2, RADIUS, z),
    mass: 1,
    inertia: [moment, moment, moment, 0, 0, 0],
    can_sleep: false,
    shapes: [{ type: 'sphere', radius: RADIUS, ...FRICTION }],
  };
}

export const inertia: Lesson = {
  title: 'inertia',
  sliders: [slider('share', 'Inertia of the blue ball, as a share c of m r²', 0, 1, 0.05, 0.65), slider('angle', 'Slope', 2, 25, 1, 10, '°')],
  scene: (v) => {
    const angle = radians(v.angle!);
    return {
      gyre_scene: 1,
      name: 'a race down a slope',
      view: { eye: [3.5, 3, 8], target: [0, -0.3, 0], field_of_view: 0.65 },
      bodies: [
        slope(angle, FRICTION),
        ball('solid', 0.4, angle, -1.2, palette.red),
        ball('yours', v.share!, angle, 0, palette.blue),
        ball('all at the rim', 1, angle, 1.2, palette.green),
      ],
    };
  },
  readings: [
    { label: 'solid ball (c = 0.4)', unit: 'm', color: palette.red, value: (seen, v) => rolled(seen, 'solid', v) },
    { label: 'yours', unit: 'm', color: palette.blue, value: (seen, v) => rolled(seen, 'yours', v) },
    {
      label: 'yours by the equation',
      unit: 'm',
      color: palette.grey,
      value: ({ time }, v) => Math.min((0.5 * 9.81 * Math.sin(radians(v.angle!)) * time * time) / (1 + v.share!), SLOPE_LENGTH),
    },
  ],
};

export const friction: Lesson = {
  title: 'friction',
  sliders: [
    slider('angle', 'Slope', 0, 45, 1, 31, '°'),
    slider('rest', 'Static friction', 0, 1.2, 0.05, 0.6),
    slider('sliding', 'Dynamic friction', 0, 1.2, 0.05, 0.4),
  ],
  overlays: ['contacts', 'friction'],
  scene: (v) => {
    const angle = radians(v.angle!);
    const material = { static_friction: v.rest, dynamic_friction: Math.min(v.sliding!, v.rest!) };
    return {
      gyre_scene: 1,
      name: 'a box on a slope',
      view: { eye: [2.5, 2.5, 9], target: [0, -0.4, 0], field_of_view: 0.65 },
      bodies: [
        slope(angle, material),
        {
          name: 'box',
          color: palette.sand,
          position: onSlope(angle, 0.6 - SLOPE_LENGTH / 2, 0.25, 0),
          orientation: { axis: [0, 0, 1], angle: -angle },
          shapes: [{ type: 'box', half_extents: [0.4, 0.25, 0.4], density: 500, ...material }],
        },
      ],
    };
  },
  readings: [
    { label: 'speed', unit: 'm/s', color: palette.blue, value: ({ velocity }) => length(velocity('box')) },
    {
      label: 'speed by the equation',
      unit: 'm/s',
      color: palette.grey,
      value: ({ time }, v) => {
        const angle = radians(v.angle!);
        const sliding = Math.min(v.sliding!, v.rest!);
        if (Math.tan(angle) <= v.rest!) return 0;
        return 9.81 * (Math.sin(angle) - sliding * Math.cos(angle)) * time;
      },
    },
  ],
  words: (_, v) => {
    const tangent = Math.tan(radians(v.angle!));
    return `tan ${v.angle}° = ${tangent.toFixed(3)} is ${tangent > v.rest! ? 'above' : 'at most'} the static friction ${v.rest}: the box ${tangent > v.rest! ? 'slides' : 'stays'}.`;
  },
};

