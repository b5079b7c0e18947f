// The package finds its module by itself only in a page.
import make from '@babylonjs/havok';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';

export async function create({ fixed, boxes }, { gravity, friction, step }) {
  const main = createRequire(import.meta.url).resolve('@babylonjs/havok');
  const H = await make({ wasmBinary: readFileSync(main.replace(/lib\/(umd|esm)\/.*$/, 'lib/esm/HavokPhysics.wasm')) });
  const world = H.HP_World_Create()[1];
  H.HP_World_SetGravity(world, [0, gravity, 0]);
  H.HP_World_SetIdealStepTime(world, step);
  const add = (part, moving) => {
    const shape = H.HP_Shape_CreateBox([0, 0, 0], [0, 0, 0, 1], part.half.map((half) => 2 * half))[1];
    H.HP_Shape_SetMaterial(shape, [friction, friction, 0, H.MaterialCombine.GEOMETRIC_MEAN ?? H.MaterialCombine.MINIMUM, H.MaterialCombine.MAXIMUM]);
    const body = H.HP_Body_Create()[1];
    H.HP_Body_SetShape(body, shape);
    H.HP_Body_SetMotionType(body, moving ? H.MotionType.DYNAMIC : H.MotionType.STATIC);
    if (moving) {
      const mass = H.HP_Shape_BuildMassProperties(shape)[1];
      mass[1] = 1;
      H.HP_Body_SetMassProperties(body, mass);
      H.HP_Body_SetLinearDamping(body, 0);
      H.HP_Body_SetAngularDamping(body, 0);
      H.HP_Body_SetActivationControl(body, H.ActivationControl.ALWAYS_ACTIVE);
    }
    H.HP_Body_SetQTransform(body, [part.place, part.turn]);
    H.HP_World_AddBody(world, body, false);
    return body;
  };
  for (const part of fixed) add(part, false);
  const bodies = boxes.map((part) => add(part, true));
  return {
    version: 'its defaults',
    step: (seconds) => H.HP_World_Step(world, seconds),
    places: () => bodies.flatMap((body) => H.HP_Body_GetPosition(body)[1]),
  };
}
