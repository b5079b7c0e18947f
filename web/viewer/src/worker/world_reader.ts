// From a world to what the page is told about it: poses, numbers, overlays, a body in words. Everything is copied: the engine's
// arrays are good only until its next change.
import { BodyType, BoxKind, ContactState, type Gyre, JointKind, kNoIsland, type BodyId, type World } from 'gyre-physics';
import { BodyFlag, type BodyReport, type DoubleVec3, type OverlayData, type OverlayName, type Quat, type Stats, type Vec3 } from '../protocol';
import { typeName } from './describe';
import { readFlow, readParticles } from './fluids';
import { slotOf } from './keys';
import { readSoftReadings } from './softs';

export interface Rows {
  ids: Float64Array;
  poses: Float32Array; // 7 a row
  velocities: Float32Array; // 6 a row
}

export function readRows(world: World, origin: Vec3): Rows {
  const { ids, positions, orientations, linearVelocities, angularVelocities } = world.bodies();
  const count = ids.length;
  const poses = new Float32Array(7 * count);
  const velocities = new Float32Array(6 * count);
  for (let row = 0; row < count; row++) {
    for (let i = 0; i < 3; i++) {
      poses[7 * row + i] = positions[3 * row + i]! - origin[i]!;
      velocities[6 * row + i] = linearVelocities[3 * row + i]!;
      velocities[6 * row + 3 + i] = angularVelocities[3 * row + i]!;
    }
    for (let i = 0; i < 4; i++) poses[7 * row + 3 + i] = orientations[4 * row + i]!;
  }
  return { ids: ids.slice(), poses, velocities };
}

// Both lists are in the order of the slots, so one walk finds who is awake.
export function readFlags(world: World, ids: Float64Array, types: Uint8Array): Uint8Array {
  const flags = new Uint8Array(ids.length);
  const awake = world.awakeBodies().ids;
  let next = 0;
  for (let row = 0; row < ids.length; row++) {
    flags[row] = types[row] === BodyType.dynamic ? BodyFlag.dynamic : types[row] === BodyType.kinematic ? BodyFlag.kinematic : 0;
    if (awake[next] !== ids[row]) continue;
    flags[row]! |= BodyFlag.awake;
    next++;
  }
  return flags;
}

export function readStats(world: World, stepMs: number): Stats {
  const counts = world.stats();
  const energy = world.energy();
  const momentum = world.momentum();
  return {
    stepMs,
    stageMs: world.timing() ? Array.from(world.readTimes().stages.seconds, (seconds) => 1000 * seconds) : [],
    bodies: counts.bodies,
    awake: counts.awakeBodies,
    pairs: counts.pairs,
    touching: counts.touching,
    contactPoints: counts.contactPoints,
    kinetic: energy.kinetic,
    potential: energy.potential,
    elastic: energy.elastic + energy.softElastic,
    linear: momentum.linear,
    angular: momentum.angular,
    maxPenetration: world.maxPenetration(),
    softs: counts.softs,
    softVertices: counts.softVertices,
    fluids: world.fluids().length,
  };
}

// The anchors of distance joints, and of the hand on soft matter.
export function readLinks(world: World, origin: Vec3): Float32Array {
  if (world.stats().joints === 0) return new Float32Array(0);
  const { kinds, anchors } = world.readJoints(origin);
  const links: number[] = [];
  kinds.forEach((kind, i) => {
    if (kind === JointKind.distance || kind === JointKind.mouse) links.push(...anchors.subarray(6 * i, 6 * i + 6));
  });
  return Float32Array.from(links);
}

// Whether the main axis of a kind of joint is shown as a turn about x of its frame (1), as a way along it (2), or not.
function wayOf(kind: JointKind): number {
  if (kind === JointKind.hinge || kind === JointKind.cone || kind === JointKind.universal) return 1;
  return kind === JointKind.slider || kind === JointKind.wheel ? 2 : 0;
}

const bit = (kind: number): number => 1 << kind;

// `carried`: solids are drawn as the surface that they carry.
export function readOverlays(world: World, names: ReadonlySet<OverlayName>, origin: Vec3, carried: boolean): OverlayData {
  const data: OverlayData = {};
  if (names.has('contacts') || names.has('friction')) {
    const table = world.readContacts(origin);
    data.contacts = {
      positions: table.positions.slice(),
      normals: table.normals.slice(),
      tangents: table.tangents.slice(),
      forces: table.forces.slice(),
      frictionForces: table.frictionForces.slice(),
      scales: table.scales.slice(),
      sliding: Uint8Array.from(table.states, (state) => (state === ContactState.sliding ? 1 : 0)),
    };
  }
  if (names.has('bounds')) data.bounds = world.readBoxes(bit(BoxKind.tight), origin).corners.slice();
  if (names.has('tree')) {
    const boxes = world.readBoxes(bit(BoxKind.fixedTree) | bit(BoxKind.movingTree), origin);
    data.tree = { corners: boxes.corners.slice(), depths: boxes.depths.slice() };
  }
  if (names.has('islands')) {
    data.islands = Int32Array.from(world.readBodies(origin).islands, (island) => (island === kNoIsland ? -1 : island));
  }
  if (names.has('joints')) {
    const table = world.readJoints(origin);
    data.joints = {
      anchors: table.anchors.slice(),
      frames: table.frames.slice(),
      rigid: Uint8Array.from(table.kinds, (kind) => (kind === JointKind.distance ? 0 : 1)),
      ways: Uint8Array.from(table.kinds, (kind) => wayOf(kind as JointKind)),
      limits: Float32Array.from(table.limits, (limit, i) => (table.hasLimits[i >> 1] ? limit : NaN)),
      positions: table.positions.slice(),
      // A wheel's motor spins it; what is shown of a wheel is its suspension.
      motors: Float32Array.from(table.kinds, (kind, i) =>
        table.motors[2 * i + 1]! > 0 && kind !== JointKind.wheel ? table.motors[2 * i]! : 0,
      ),
    };
  }
  if (names.has('flow')) data.flow = readFlow(world, origin);
  if (names.has('stress') || names.has('strain')) data.readings = readSoftReadings(world, names.has('stress') ? 'stress' : 'strain', carried);
  if (names.has('particles')) data.particles = readParticles(world, origin);
  return data;
}

// The engine calls bodies by their slots ("body 12"); a visitor knows them by name.
export function withNames(words: string, ids: ArrayLike<number>, nameOf: (id: number) => string): string {
  return words.replace(/\bbody (\d+)\b/g, (text, slot: string) => {
    const id = Array.prototype.find.call(ids, (candidate: number) => slotOf(candidate) === Number(slot)) as number | undefined;
    return id === undefined ? text : `“${nameOf(id)}”`;
  });
}

export function reportOn(gyre: Gyre, world: World, id: BodyId, key: number, name: string, words: string): BodyReport {
  const pose = world.pose(id);
  const mass = world.massProperties(id);
  const linear = Array.from(world.linearVelocity(id)) as Vec3;
  const angular = Array.from(world.angularVelocity(id)) as Vec3;
  const principal = mass.mass > 0 ? gyre.principalAxes(mass.inertia) : null;
  return {
    key,
    name,
    type: typeName(world.type(id)),
    awake: world.isAwake(id),
    mass: mass.mass,
    principalMoments: principal ? principal.moments : [0, 0, 0],
    position: pose.position as DoubleVec3,
    centerOfMass: Array.from(world.centerOfMass(id)) as DoubleVec3,
    rotation: pose.orientation as Quat,
    linear,
    angular,
    kinetic: kineticEnergy(mass.mass, linear, angular, principal, pose.orientation),
    words,
  };
}

// m v^2 / 2 + sum of I_i w_i^2 / 2 along the principal axes.
function kineticEnergy(
  mass: number,
  v: Vec3,
  w: Vec3,
  principal: { moments: Vec3; orientation: Quat } | null,
  orientation: Quat,
): number {
  if (!principal) return 0;
  const local = turnBack(principal.orientation, turnBack(orientation, w));
  const turning = principal.moments.reduce((sum, moment, i) => sum + moment * local[i]! ** 2, 0);
  return 0.5 * (mass * (v[0] ** 2 + v[1] ** 2 + v[2] ** 2) + turning);
}

// The vector in the frame that q turns into the present one: v + 2 u x (u x v - w v), with q = (u, w) reversed.
function turnBack([x, y, z, w]: Quat, v: Vec3): Vec3 {
  const cross = (a: Vec3, b: Vec3): Vec3 => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const u: Vec3 = [-x, -y, -z];
  const inner = cross(u, v).map((value, i) => value + w * v[i]!) as Vec3;
  return cross(u, inner).map((value, i) => v[i]! + 2 * value) as Vec3;
}
