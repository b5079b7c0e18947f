// The promise: after 600 steps (40 with soft matter, 20 with fluids) every scene has the same state, bit for bit, natively and in each build of the package.
import assert from 'node:assert/strict';
import test from 'node:test';

import { engine, gyre, hashText, made, meshFiles, nativeHash, nativeProgram, sceneNames, sceneText, softSceneNames, fluidSceneNames } from './kit.mjs';

// A step of soft matter or of a fluid costs as much as many steps of bodies.
const runs = [
  ...sceneNames.map((name) => [name, 600]), ...softSceneNames.map((name) => [name, 40]), ...fluidSceneNames.map((name) => [name, 20]),
];
const builds = process.env.GYRE_WEB_BUILD ? [process.env.GYRE_WEB_BUILD] : ['simd', 'threads', 'plain'].filter(made);
const skip = nativeProgram === null ? 'no native gyre to compare with: build it, or set GYRE_CLI' : false;

test('there are scenes to compare', () => {
  assert.ok(sceneNames.length >= 15, `${sceneNames.length} scenes`);
  assert.ok(softSceneNames.length >= 3, `${softSceneNames.length} scenes of soft matter`);
  assert.ok(fluidSceneNames.length >= 5, `${fluidSceneNames.length} scenes of fluids`);
});

for (const build of builds) {
  test(`build ${build}`, { skip }, async (t) => {
    const engineOfBuild = await engine(build);
    assert.equal(engineOfBuild.build, build);
    for (const [name, steps] of runs) {
      await t.test(name, () => {
        const threads = build === 'threads' ? engineOfBuild.maxThreads : 1;
        const scene = engineOfBuild.openScene(sceneText(name), { file: name, files: meshFiles(), threads });
        for (let i = 0; i < steps; ++i) scene.step();
        assert.equal(hashText(scene), nativeHash(name, steps));
        scene.dispose();
      });
      // Workers go back to the pool when the page's own thread is free.
      await new Promise((resolve) => setTimeout(resolve, 5));
    }
  });
}

test('the hash sees a difference of one bit', async () => {
  const world = (await engine(builds[0])).createWorld();
  const body = world.addBody({ pose: { position: [0, 1, 0] } }, { geometry: gyre.sphere() });
  const before = world.hash();
  world.setPose(body, { position: [0, 1 + 2 ** -52, 0] });
  assert.notEqual(world.hash(), before);
});
