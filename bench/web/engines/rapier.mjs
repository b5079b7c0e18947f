import R from '@dimforge/rapier3d-simd-compat';

export async function create({ fixed, boxes }, { gravity, friction }) {
  await R.init();
  const world = new R.World({ x: 0, y: gravity, z: 0 });
  const collider = (part) => R.ColliderDesc.cuboid(...part.half).setFriction(friction).setRestitution(0).setDensity(1);
  for (const part of fixed) world.createCollider(collider(part).setTranslation(...part.place));
  const bodies = boxes.map((part) => {
    const [x, y, z, w] = part.turn;
    const body = world.createRigidBody(R.RigidBodyDesc.dynamic().setTranslation(...part.place).setRotation({ x, y, z, w }).setCanSleep(false));
    world.createCollider(collider(part), body);
    return body;
  });
  return {
    version: `${R.version()}, ${world.integrationParameters.numSolverIterations} solver iterations`,
    step: (seconds) => {
      world.timestep = seconds;
      world.step();
    },
    places: () => bodies.flatMap((body) => Object.values(body.translation())),
  };
}
