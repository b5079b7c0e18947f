// Ropes, cloths and solids by the package: what is given comes through, and the bits are those of the other builds.
import assert from 'node:assert/strict';
import test from 'node:test';

import { engine, gyre, made } from './kit.mjs';

const { BodyType, ClothLinks, RopeLinks, SoftKind, SolidModel, plane, sphere } = gyre;
const api = await engine(process.env.GYRE_WEB_BUILD ?? 'simd');
const second = 1 / 60;

function clothOverBall(on) {
  const world = on.createWorld();
  const ball = world.addBody({ type: BodyType.fixed }, { geometry: sphere({ radius: 0.5 }) });
  const cloth = world.addCloth({ grid: { size: [1.6, 1.6], cells: [20, 20] }, pose: { position: [0.01, 0.7, 0] }, thickness: 0.02 });
  return { world, ball, cloth };
}

test('a cloth falls on a ball and hangs over it', () => {
  const { world, cloth } = clothOverBall(api);
  assert.deepEqual([...world.softs()], [cloth]);
  const info = world.softInfo(cloth);
  assert.equal(info.kind, SoftKind.cloth);
  assert.equal(info.vertices, 441);
  assert.ok(Math.abs(info.mass - 0.2 * 1.6 * 1.6) < 1e-5, `${info.mass} kg`);
  assert.equal(world.softTriangles(cloth).length, 3 * 2 * 400);
  assert.equal(world.stats().softVertices, 441);
  for (let i = 0; i < 60; ++i) world.step(second);
  const { x, y, z, vy } = world.vertices(cloth);
  assert.ok(x instanceof Float64Array && vy instanceof Float32Array && x.length === 441);
  const away = Array.from(x, (_, i) => Math.hypot(x[i], y[i], z[i]));
  assert.ok(Math.min(...away) > 0.5, `a vertex is ${Math.min(...away)} m from the middle of the ball`);
  assert.ok(Math.abs(y[220] - 0.51) < 0.01, `the middle lies at ${y[220]} m`);
  assert.ok(y[0] < 0.25, `a corner hangs at ${y[0]} m`);
  assert.ok(world.softInfo(cloth).contacts > 10);
  assert.ok(world.energy().softElastic > 0);
});

test('every build moves a cloth to the same bits', { skip: made('plain') && made('simd') ? false : 'one build alone was made' }, async () => {
  const [first, ...others] = await Promise.all(['simd', 'plain', 'threads'].filter(made).map(async (build) => {
    const { world } = clothOverBall(await engine(build));
    for (let i = 0; i < 30; ++i) world.step(second);
    return world.hash();
  }));
  for (const other of others) assert.equal(other, first);
});

test('rays, moving shapes and overlaps find soft matter', () => {
  const { world, ball, cloth } = clothOverBall(api);
  for (let i = 0; i < 30; ++i) world.step(second);
  const hit = world.castRay([0.03, 2, 0.02], [0, -3, 0]);
  assert.equal(hit.soft, cloth);
  assert.ok(Math.abs(hit.weights[0] + hit.weights[1] + hit.weights[2] - 1) < 1e-6);
  assert.ok(hit.triangle >= 0 && hit.triangle < 800);
  assert.equal(world.castRay([0.03, 2, 0.02], [0, -3, 0], { soft: false }).body, ball);
  const stopped = world.castShape({ shape: sphere({ radius: 0.1 }), pose: { position: [0, 2, 0] }, translation: [0, -3, 0] });
  assert.equal(stopped.soft, cloth);
  assert.ok(world.overlapAny({ shape: sphere({ radius: 0.1 }), pose: { position: [0, 0.5, 0] } }));
});

test('events tell which shapes soft matter touches', () => {
  const { world, ball, cloth } = clothOverBall(api);
  let begins = { count: 0 };
  for (let i = 0; i < 60 && begins.count === 0; ++i) {
    world.step(second);
    begins = world.events().softBegins;
  }
  assert.equal(begins.count, 1);
  assert.equal(begins.soft[0], cloth);
  assert.equal(begins.body[0], ball);
  assert.equal(world.events().inverted.count, 0);
  world.removeBody(ball);
  world.step(second);
  assert.equal(world.events().softEnds.count, 1);
});

test('ropes: vectors in every form, attached, pinned, released', () => {
  const points = [[0, 2, 0], [0.5, 2, 0], [1, 2, 0]];
  const forms = [points, points.flat(), new Float64Array(points.flat()), points.map(([x, y, z]) => ({ x, y, z }))];
  const hashes = forms.map((given) => {
    const world = api.createWorld();
    world.addRope({ points: given, segments: 10, links: RopeLinks.springs, radius: 0.03, settings: { damping: 0.01, userData: 7n } });
    return world.hash();
  });
  assert.equal(new Set(hashes).size, 1);
  const world = api.createWorld();
  const rope = world.addRope({ points, segments: 10 });
  const post = world.addBody({ type: BodyType.kinematic, pose: { position: [1, 2, 0] } });
  world.pin(rope, 0);
  world.attach(rope, 10, post);
  for (let i = 0; i < 60; ++i) {
    world.moveKinematic(post, { position: [1 - i / 150, 2 - i / 150, 0] }, second);
    world.step(second);
  }
  const { x, y } = world.vertices(rope);
  assert.ok(Math.abs(x[0]) < 1e-6 && Math.abs(y[0] - 2) < 1e-6);
  assert.ok(Math.abs(x[10] - world.pose(post).position[0]) < 1e-3 && Math.abs(y[10] - world.pose(post).position[1]) < 1e-3, `${x[10]}, ${y[10]}`);
  world.release(rope, 10);
  for (let i = 0; i < 30; ++i) world.step(second);
  const end = world.vertices(rope).y[10];
  assert.ok(end < 1.3, `the free end is at ${end} m`);
  const snapshot = world.saveSnapshot();
  const before = world.hash();
  world.removeSoft(rope);
  assert.equal(world.softExists(rope), false);
  assert.throws(() => world.softInfo(rope).kind === undefined || world.pin(rope, 0), gyre.GyreError);
  world.restoreSnapshot(snapshot);
  assert.equal(world.hash(), before);
  assert.equal(world.softs().length, 1);
});

test('solids: boxes and tetrahedra, vertices that are set', () => {
  const world = api.createWorld({ gravity: [0, 0, 0] });
  const jelly = world.addSolid({ box: { halfExtents: [0.5, 0.5, 0.5], cells: [2, 2, 2] }, model: SolidModel.corotated, pose: { position: [0, 3, 0] } });
  assert.equal(world.softInfo(jelly).vertices, 27);
  assert.equal(world.softTriangles(jelly).length, 3 * 2 * 4 * 6);
  const tetrahedron = world.addSolid({ vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], tetrahedra: [0, 1, 2, 3], density: 600 });
  assert.ok(Math.abs(world.softInfo(tetrahedron).mass - 100) < 1e-3);
  const { x, y, z } = world.vertices(jelly);
  const places = Float64Array.from({ length: 81 }, (_, i) => [x, y, z][i % 3][Math.floor(i / 3)] + (i % 3 === 0 ? 10 : 0));
  world.setVertices(jelly, places, new Float32Array(81).fill(1));
  assert.deepEqual(Array.from(world.vertices(jelly).x), Array.from({ length: 27 }, (_, i) => places[3 * i]));
  assert.equal(world.vertices(jelly).vz[26], 1);
});

test('mistakes in definitions are named', () => {
  const world = api.createWorld();
  world.addBody({ type: BodyType.fixed }, { geometry: plane() });
  const refused = (what, message, kind = gyre.GyreError) =>
    assert.throws(what, (error) => error instanceof kind && message.test(error.message) || assert.fail(`${error.name}: ${error.message}`));
  refused(() => world.addCloth({ grid: { sizes: [1, 1] } }), /ClothGrid has no field "sizes"/, TypeError);
  refused(() => world.addCloth({ grid: { size: [1, 1, 1] } }), /ClothGrid\.size: found an array of 3, expected an array of 2/, TypeError);
  refused(() => world.addCloth({ links: ClothLinks.springs }), /grid|vertices/);
  refused(() => world.addRope({ points: [0, 1] }), /RopeDef\.points: .* multiple of 3/, TypeError);
  refused(() => world.addRope({ points: [0, 1, 0] }), /points/);
  refused(() => world.addSolid({ box: {}, poissonRatio: 0.5 }), /poisson_ratio/);
  const rope = world.addRope({ points: [0, 1, 0, 1, 1, 0] });
  refused(() => world.pin(rope, 2), /vertex is 2/);
});
