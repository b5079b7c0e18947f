// The package's loader refuses Node, so while it loads it is shown what it asks a page for.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join } from 'node:path';
import { pathToFileURL } from 'node:url';

async function load() {
  const folder = dirname(createRequire(import.meta.url).resolve('physx-js-webidl/package.json'));
  const wasmBinary = readFileSync(join(folder, 'physx-js-webidl.wasm'));
  const node = globalThis.process;
  Object.assign(globalThis, { window: globalThis, document: { currentScript: { src: pathToFileURL(`${folder}/`).href } }, process: undefined });
  try {
    const { default: make } = await import(pathToFileURL(join(folder, 'physx-js-webidl.mjs')).href);
    return await make({ wasmBinary });
  } finally {
    globalThis.process = node;
  }
}

export async function create({ fixed, boxes }, { gravity, friction }) {
  const P = await load();
  const top = P.PxTopLevelFunctions.prototype ?? P.PxTopLevelFunctions;
  const version = P.PHYSICS_VERSION ?? top.PHYSICS_VERSION ?? P.PxTopLevelFunctions.PHYSICS_VERSION;
  const scale = new P.PxTolerancesScale();
  const physics = top.CreatePhysics(version, top.CreateFoundation(version, new P.PxDefaultAllocator(), new P.PxDefaultErrorCallback()), scale);
  const how = new P.PxSceneDesc(scale);
  how.gravity = new P.PxVec3(0, gravity, 0);
  how.cpuDispatcher = top.DefaultCpuDispatcherCreate(0);
  how.filterShader = top.DefaultFilterShader();
  const world = physics.createScene(how);
  const material = physics.createMaterial(friction, friction, 0);
  const flags = new P.PxShapeFlags(P.PxShapeFlagEnum.eSCENE_QUERY_SHAPE | P.PxShapeFlagEnum.eSIMULATION_SHAPE);
  const everything = new P.PxFilterData(1, 1, 0, 0);
  const add = (part, moving) => {
    const pose = new P.PxTransform(P.PxIDENTITYEnum.PxIdentity);
    pose.set_p(new P.PxVec3(...part.place));
    pose.set_q(new P.PxQuat(...part.turn));
    const body = moving ? physics.createRigidDynamic(pose) : physics.createRigidStatic(pose);
    const shape = physics.createShape(new P.PxBoxGeometry(...part.half), material, true, flags);
    shape.setSimulationFilterData(everything);
    body.attachShape(shape);
    if (moving) {
      P.PxRigidBodyExt.prototype.setMassAndUpdateInertia(body, 1);
      body.setSleepThreshold(0);
      body.setStabilizationThreshold(0);
      body.setLinearDamping(0);
      body.setAngularDamping(0);
    }
    world.addActor(body);
    return body;
  };
  for (const part of fixed) add(part, false);
  const bodies = boxes.map((part) => add(part, true));
  return {
    version: `PhysX ${version >> 24}.${(version >> 16) & 255}.${(version >> 8) & 255}`,
    step: (seconds) => {
      world.simulate(seconds);
      world.fetchResults(true);
    },
    places: () => bodies.flatMap((body) => {
      const { x, y, z } = body.getGlobalPose().get_p();
      return [x, y, z];
    }),
  };
}
