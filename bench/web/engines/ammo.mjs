import { createRequire } from 'node:module';

export async function create({ fixed, boxes }, { gravity, friction }) {
  const loaded = createRequire(import.meta.url)('ammo.js');
  const A = typeof loaded === 'function' ? ((await loaded()) ?? loaded) : loaded;
  const configuration = new A.btDefaultCollisionConfiguration();
  const world = new A.btDiscreteDynamicsWorld(new A.btCollisionDispatcher(configuration), new A.btDbvtBroadphase(),
    new A.btSequentialImpulseConstraintSolver(), configuration);
  world.setGravity(new A.btVector3(0, gravity, 0));
  const alwaysActive = 4;
  const add = (part, mass) => {
    const pose = new A.btTransform();
    pose.setIdentity();
    pose.setOrigin(new A.btVector3(...part.place));
    pose.setRotation(new A.btQuaternion(...part.turn));
    const shape = new A.btBoxShape(new A.btVector3(...part.half));
    const inertia = new A.btVector3(0, 0, 0);
    if (mass > 0) shape.calculateLocalInertia(mass, inertia);
    const body = new A.btRigidBody(new A.btRigidBodyConstructionInfo(mass, new A.btDefaultMotionState(pose), shape, inertia));
    // Two bodies' frictions are multiplied.
    body.setFriction(Math.sqrt(friction));
    body.setRestitution(0);
    body.setActivationState(alwaysActive);
    world.addRigidBody(body);
    return body;
  };
  for (const part of fixed) add(part, 0);
  const bodies = boxes.map((part) => add(part, 1));
  return {
    version: 'Bullet 2, 10 iterations',
    step: (seconds) => world.stepSimulation(seconds, 0, seconds),
    places: () => bodies.flatMap((body) => {
      const place = body.getWorldTransform().getOrigin();
      return [place.x(), place.y(), place.z()];
    }),
  };
}
