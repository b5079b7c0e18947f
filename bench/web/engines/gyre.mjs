import { BodyType, box, load } from 'gyre-physics';

export async function create({ fixed, boxes }, { gravity, friction }) {
  const gyre = await load({ build: process.env.GYRE_WEB_BUILD || 'simd' });
  const world = gyre.createWorld({ gravity: [0, gravity, 0], sleeping: false, threads: gyre.maxThreads });
  const material = { staticFriction: friction, dynamicFriction: friction };
  const add = (type, { half, place, turn }) =>
    world.addBody({ type, pose: { position: place, orientation: turn } }, { geometry: box({ halfExtents: half }), density: 1, material });
  for (const part of fixed) add(BodyType.fixed, part);
  for (const part of boxes) add(BodyType.dynamic, part);
  return {
    version: `build ${gyre.build}, ${world.substeps()} sub-steps`,
    step: (seconds) => world.step(seconds),
    places: () => world.bodies().positions.slice(3 * fixed.length),
  };
}
