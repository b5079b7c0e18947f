import * as C from 'cannon-es';

export async function create({ fixed, boxes }, { gravity, friction }) {
  const world = new C.World({ gravity: new C.Vec3(0, gravity, 0), allowSleep: false });
  world.broadphase = new C.SAPBroadphase(world);
  Object.assign(world.defaultContactMaterial, { friction, restitution: 0 });
  const add = (part, mass) => {
    const body = new C.Body({ mass, shape: new C.Box(new C.Vec3(...part.half)), position: new C.Vec3(...part.place),
      quaternion: new C.Quaternion(...part.turn), linearDamping: 0, angularDamping: 0 });
    world.addBody(body);
    return body;
  };
  for (const part of fixed) add(part, 0);
  const bodies = boxes.map((part) => add(part, 1));
  return {
    version: `${world.solver.iterations} iterations`,
    step: (seconds) => world.step(seconds),
    places: () => bodies.flatMap(({ position }) => [position.x, position.y, position.z]),
  };
}
