import make from 'jolt-physics/wasm-compat';

const layers = { fixed: 0, moving: 1 };

export async function create({ fixed, boxes }, { gravity, friction }) {
  const J = await make();
  const settings = new J.JoltSettings();
  const pairs = new J.ObjectLayerPairFilterTable(2);
  pairs.EnableCollision(layers.fixed, layers.moving);
  pairs.EnableCollision(layers.moving, layers.moving);
  const broad = new J.BroadPhaseLayerInterfaceTable(2, 2);
  for (const layer of Object.values(layers)) broad.MapObjectToBroadPhaseLayer(layer, new J.BroadPhaseLayer(layer));
  settings.mObjectLayerPairFilter = pairs;
  settings.mBroadPhaseLayerInterface = broad;
  settings.mObjectVsBroadPhaseLayerFilter = new J.ObjectVsBroadPhaseLayerFilterTable(broad, 2, pairs, 2);
  const jolt = new J.JoltInterface(settings);
  const system = jolt.GetPhysicsSystem();
  system.SetGravity(new J.Vec3(0, gravity, 0));
  const bodies = system.GetBodyInterface();
  const add = (part, moving) => {
    const how = new J.BodyCreationSettings(new J.BoxShape(new J.Vec3(...part.half)), new J.RVec3(...part.place), new J.Quat(...part.turn),
      moving ? J.EMotionType_Dynamic : J.EMotionType_Static, moving ? layers.moving : layers.fixed);
    Object.assign(how, { mFriction: friction, mRestitution: 0, mAllowSleeping: false, mLinearDamping: 0, mAngularDamping: 0 });
    if (moving) {
      how.mOverrideMassProperties = J.EOverrideMassProperties_CalculateInertia;
      how.mMassPropertiesOverride.mMass = 1;
    }
    const body = bodies.CreateBody(how);
    bodies.AddBody(body.GetID(), moving ? J.EActivation_Activate : J.EActivation_DontActivate);
    return body;
  };
  for (const part of fixed) add(part, false);
  const made = boxes.map((part) => add(part, true));
  system.OptimizeBroadPhase();
  return {
    version: `${system.GetPhysicsSettings().mNumVelocitySteps} velocity and ${system.GetPhysicsSettings().mNumPositionSteps} position steps`,
    step: (seconds) => jolt.Step(seconds, 1),
    places: () => made.flatMap((body) => {
      const place = body.GetPosition();
      return [place.GetX(), place.GetY(), place.GetZ()];
    }),
  };
}
