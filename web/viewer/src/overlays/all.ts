// Every overlay there is, in the order of the panel.
import { Bounds } from './bounds';
import { Contacts } from './contacts';
import { Flow } from './flow';
import { Friction } from './friction';
import { Hulls } from './hulls';
import { Islands } from './islands';
import { Joints } from './joints';
import { Mass } from './mass';
import type { OverlayKind } from './overlay';
import { Particles } from './particles';
import { Reading } from './reading';
import { Speed } from './speed';
import { Tree } from './tree';
import { Velocities } from './velocities';

export const overlayKinds: readonly OverlayKind[] = [
  { name: 'contacts', label: 'Contacts', hint: 'points and normals, longer with more load', key: '1', make: () => new Contacts() },
  { name: 'friction', label: 'Friction', hint: 'tangents of the contact basis, and the impulse', key: '2', make: () => new Friction() },
  { name: 'bounds', label: 'Bounding boxes', hint: 'of every shape', key: '3', make: () => new Bounds() },
  { name: 'tree', label: 'Broad-phase tree', hint: 'nodes, from the root (warm) to the leaves (cold)', key: '4', make: () => new Tree() },
  { name: 'islands', label: 'Islands and sleep', hint: 'what is solved together; grey sleeps', key: '5', make: () => new Islands() },
  { name: 'mass', label: 'Mass and inertia', hint: 'centres of mass, ellipsoids of inertia', key: '6', make: () => new Mass() },
  { name: 'joints', label: 'Joint frames', hint: 'anchors, axes, and gaps in pink', key: '7', make: () => new Joints() },
  { name: 'velocities', label: 'Velocities', hint: 'linear (blue), angular (pink)', key: '8', make: () => new Velocities() },
  { name: 'hulls', label: 'Collision shapes', hint: 'what really collides, as wire', key: '9', make: () => new Hulls() },
  { name: 'flow', label: 'Flow', hint: 'velocity of fluids on a slice', key: 'v', fluid: true, make: () => new Flow() },
  { name: 'speed', label: 'Speed of gases', hint: 'on a slice, from still (blue) to fast (red)', key: 'x', fluid: true, make: () => new Speed() },
  { name: 'strain', label: 'Strain', hint: 'of ropes, cloths and solids, on a key', key: 'n', soft: true, make: () => new Reading('strain') },
  { name: 'stress', label: 'Stress', hint: 'of von Mises in solids, on a key', key: 'm', soft: true, make: () => new Reading('stress') },
  { name: 'particles', label: 'Particles of liquids', hint: 'instead of the surface', key: 'l', fluid: true, make: () => new Particles() },
];
