// The package's interface: that nothing of the engine's is missing, that values come through, and what mistakes are answered.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import test from 'node:test';

import { engine, gyre, hashText, meshFiles, root, sceneText } from './kit.mjs';

const { BodyType, JointKind, ShapeKind, box, capsule, cone, cylinder, plane, sphere, nameOf } = gyre;
const api = await engine(process.env.GYRE_WEB_BUILD ?? 'simd');
const second = 1 / 60;

function boxOnGround() {
  const world = api.createWorld();
  const ground = world.addBody({ type: BodyType.fixed }, { geometry: plane() });
  const body = world.addBody({ pose: { position: [0, 0.5, 0] } }, { geometry: box() });
  return { world, ground, body };
}
function close(found, expected, tolerance = 1e-6) {
  assert.equal(found.length, expected.length);
  for (let i = 0; i < expected.length; ++i) assert.ok(Math.abs(found[i] - expected[i]) <= tolerance, `[${i}]: ${found[i]}, expected ${expected[i]}`);
}

test('every public function of World is there', () => {
  // Read from the header in another, simpler way than the generator's.
  const header = readFileSync(join(root, 'include/gyre/world.h'), 'utf8');
  const text = header.slice(header.indexOf('class World {'), header.indexOf(' private:')).replace(/\/\/.*$/gm, '');
  const names = new Set([...text.matchAll(/^ {2}[\w:<>&*, ]+?[ &*](\w+)\(/gm)].map((match) => match[1]));
  assert.ok(names.size > 50, `${names.size} functions found in world.h`);
  // With a reason each.
  const leftOut = new Set([...readFileSync(join(root, 'web/bindings/model.py'), 'utf8').matchAll(/"World::(\w+)": "/g)].map((match) => match[1]));
  const elsewhere = { World: gyre.World, create: gyre.Gyre.prototype.createWorld, state: () => {}, exists: gyre.World.prototype.bodyExists };
  for (const name of names) {
    if (leftOut.has(name)) continue;
    const camel = name.replace(/_(\w)/g, (_, letter) => letter.toUpperCase());
    assert.equal(typeof (elsewhere[name] ?? gyre.World.prototype[camel]), 'function', name);
  }
});

test('enumerators are those of the headers', () => {
  for (const file of ['defs', 'geometry', 'result']) {
    const header = readFileSync(join(root, `include/gyre/${file}.h`), 'utf8').replace(/\/\/.*$/gm, '');
    for (const [, name, body] of header.matchAll(/enum class (\w+)[^{]*\{([^}]*)\}/g)) {
      const names = body.split(',').map((part) => part.trim()).filter(Boolean);
      const camel = names.map((part) => part.replace(/_(\w)/g, (_, letter) => letter.toUpperCase()));
      assert.deepEqual(Object.keys(gyre[name]), camel);
      assert.deepEqual(Object.values(gyre[name]), camel.map((_, i) => i));
    }
  }
  assert.equal(nameOf(ShapeKind, 8), 'heightField');
});

test('a falling box follows the parabola and comes to rest', () => {
  const world = api.createWorld();
  world.addBody({ type: BodyType.fixed }, { geometry: plane() });
  const body = world.addBody({ pose: { position: [0, 5, 0] } }, { geometry: box() });
  const steps = 30;
  for (let i = 0; i < steps; ++i) world.step(second);
  // Bodies move twice a sub-step, by h: y = y0 - g t (t + h) / 2 for semi-implicit Euler.
  const t = steps * second, h = second / (2 * world.substeps());
  close([world.pose(body).position[1]], [5 - (9.81 * t * (t + h)) / 2], 1e-5);
  for (let i = 0; i < 150; ++i) world.step(second);
  close(world.pose(body).position, [0, 0.5, 0], 1e-4);
  assert.equal(world.isAwake(body), false);
  assert.equal(world.stepCount(), 180);
});

test('bulk arrays agree with the single readers', () => {
  const world = api.createWorld({ gravity: [0, 0, 0] });
  for (let i = 0; i < 20; ++i) {
    world.addBody({ pose: { position: [3 * i, i, -i], orientation: [0, Math.sin(i), 0, Math.cos(i)] }, linearVelocity: [i, 0, 1], angularVelocity: [0, i, 0] },
      { geometry: sphere({ radius: 0.25 }) });
  }
  world.step(second);
  const all = world.bodies();
  assert.equal(all.ids.length, 20);
  all.ids.forEach((id, i) => {
    const pose = world.pose(id);
    assert.deepEqual([...all.positions.slice(3 * i, 3 * i + 3)], pose.position);
    assert.deepEqual([...all.orientations.slice(4 * i, 4 * i + 4)], pose.orientation);
    assert.deepEqual([...all.linearVelocities.slice(3 * i, 3 * i + 3)], world.linearVelocity(id));
    assert.deepEqual([...all.angularVelocities.slice(3 * i, 3 * i + 3)], world.angularVelocity(id));
  });
  const out = new Float32Array(3);
  assert.equal(world.linearVelocity(all.ids[7], out), out);
  assert.deepEqual([...out], [7, 0, 1]);
});

test('views survive the growth of memory when asked for again', () => {
  const world = api.createWorld({ gravity: [0, 0, 0], sleeping: false });
  const first = world.addBody({ pose: { position: [1, 2, 3] } }, { geometry: sphere() });
  assert.deepEqual([...world.bodies().positions], [1, 2, 3]);
  for (let i = 0; i < 30000; ++i) world.addBody({ pose: { position: [5 * i, 100, 0] } }, { geometry: box() });
  world.step(second);
  const all = world.bodies();
  assert.equal(all.ids.length, 30001);
  assert.equal(all.ids[0], first);
  assert.deepEqual([...all.positions.slice(0, 3)], [1, 2, 3]);
  world.dispose();
});

test('shapes come back as they were given', () => {
  const world = api.createWorld();
  const points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
  const hull = api.cookHull(points);
  const shapes = [sphere({ radius: 0.25 }), box({ halfExtents: [1, 2, 3], rounding: 0.125 }), capsule({ radius: 0.5, halfHeight: 2 }),
    cylinder({ radius: 1, halfHeight: 2 }), cone({ radius: 1, halfHeight: 3 })];
  for (const geometry of shapes) {
    const body = world.addBody({}, { geometry });
    assert.deepEqual(world.geometry(world.shapes(body)[0]), geometry);
  }
  const body = world.addBody({}, [{ geometry: hull, local: { position: [0, 1, 0] } }, { geometry: sphere() }]);
  const [first, other] = world.shapes(body);
  const read = world.geometry(first);
  assert.equal(read.kind, ShapeKind.hull);
  assert.equal(read.geometry.contentHash(), hull.contentHash());
  assert.deepEqual(world.localTransform(first).position, [0, 1, 0]);
  assert.equal(world.bodyOf(other), body);
  const view = api.viewHull(hull);
  assert.equal(view.vertices.length, 12);
  assert.equal(view.faceOffsets.length, 5);
  const mass = api.massProperties(hull, 6);
  close([mass.mass], [1], 1e-6);  // a sixth of a cubic metre
  close(mass.center, [0.25, 0.25, 0.25], 1e-6);
  const ground = api.cookMesh({ vertices: new Float32Array([-5, 0, -5, -5, 0, 5, 5, 0, 5, 5, 0, -5]), indices: [0, 1, 2, 0, 2, 3] });
  assert.deepEqual([...api.viewMesh(ground).indices].length, 6);
  const field = api.cookHeightField({ heights: new Float32Array(9), columns: 3, rows: 3, spacing: 2 });
  assert.equal(api.viewHeightField(field).columns, 3);
  world.addBody({ type: BodyType.fixed }, { geometry: field });
});

test('contacts, events, counts, energy', () => {
  const { world, ground, body } = boxOnGround();
  const begins = [];
  for (let i = 0; i < 10; ++i) {
    world.step(second);
    const events = world.events();
    for (let k = 0; k < events.begins.count; ++k) begins.push([events.begins.bodyA[k], events.begins.bodyB[k]].sort());
  }
  assert.deepEqual(begins, [[ground, body].sort()]);
  const contacts = world.contacts();
  assert.equal(contacts.count, 4);
  const force = contacts.normalImpulse.reduce((sum, impulse) => sum + impulse) / second;
  close([force], [9.81 * 1000], 1);
  assert.equal(world.stats().contactPoints, 4);
  close([world.energy().potential], [1000 * 9.81 * 0.5], 0.5);
  close(world.momentum().linear, [0, 0, 0], 1e-2);
});

test('joints of every kind that hold a point hold it', () => {
  // A universal joint and one of six axes want more than an anchor; the others hold no point, or not here.
  for (const name of ['ball', 'hinge', 'slider', 'fixed', 'distance', 'cone']) {
    const kind = JointKind[name];
    const world = api.createWorld();
    const body = world.addBody({ pose: { position: [1, 5, 0] } }, { geometry: sphere() });
    const axis = ['hinge', 'slider', 'cone'].includes(name) ? { axis: [0, 0, 1] } : {};
    const limits = name === 'slider' ? { limits: { low: -1, high: 1 } } : {};
    const joint = world.addJoint({ kind, b: body, anchor: [0, 5, 0], ...axis, ...limits });
    for (let i = 0; i < 60; ++i) world.step(second);
    assert.ok(world.jointExists(joint), name);
    const [x, y] = world.pose(body).position;
    if (kind !== JointKind.slider) close([Math.hypot(x, y - 5)], [1], 0.01);
    world.removeJoint(joint);
    assert.equal(world.jointExists(joint), false);
  }
});

test('a joint has the fields of its kind alone', () => {
  const world = api.createWorld();
  const body = world.addBody({}, { geometry: sphere() });
  assert.throws(() => world.addJoint({ kind: JointKind.ball, b: body, axis: [0, 0, 1] }), /BallDef.*axis/s);
  assert.throws(() => world.addJoint({ b: body }), /JointDef\.kind/);
  assert.throws(() => world.addJoint({ kind: JointKind.hinge, b: body, limitFrequency: -1 }), /joint\.limit_frequency is -1/);
  const path = world.addJoint({ kind: JointKind.path, b: body, points: [-1, 0, 0, 0, 0, 0, 1, 0.2, 0] });
  assert.ok(world.jointExists(path));
});

test('every setter changes what its reader tells', () => {
  const { world, body, ground } = boxOnGround();
  const [shape] = world.shapes(body);
  world.setGravity([0, -1, 0]);
  assert.deepEqual(world.gravity(), [0, -1, 0]);
  world.setSubsteps(7);
  assert.equal(world.substeps(), 7);
  world.setVelocity(body, [1, 2, 3], { x: 4, y: 5, z: 6 });
  assert.deepEqual([world.linearVelocity(body), world.angularVelocity(body)], [[1, 2, 3], [4, 5, 6]]);
  world.setPose(body, { position: [7, 8, 9] });
  assert.deepEqual(world.pose(body), { position: [7, 8, 9], orientation: [0, 0, 0, 1] });
  world.setMaterial(shape, { staticFriction: 0.25, dynamicFriction: 0.125, id: 3 });
  assert.equal(world.material(shape).staticFriction, 0.25);
  assert.equal(world.material(shape).id, 3);
  world.setMaterialPair({ a: 3, b: 4, staticFriction: 1 });
  world.setFilter(shape, { layer: 2, collidesWith: 0xffffffff, group: -1 });
  world.setType(body, BodyType.kinematic);
  assert.equal(world.type(body), BodyType.kinematic);
  world.moveKinematic(body, { position: [7, 9, 9] }, second);
  world.step(second);
  close(world.pose(body).position, [7, 9, 9], 1e-6);
  world.setType(body, BodyType.dynamic);
  world.setGravityScale(body, 0);
  world.setDamping(body, 0.5, 0.25);
  world.setVelocity(body, [0, 0, 0], [0, 0, 0]);
  world.addImpulse(body, [1000, 0, 0]);
  close(world.linearVelocity(body), [1, 0, 0], 1e-6);
  world.addForce(body, [0, 0, 1000]);
  world.addForceAt(body, [0, 0, 0], [0, 0, 0]);
  world.addTorque(body, [0, 1, 0]);
  world.addImpulseAt(body, [0, 1, 0], [7, 9, 9]);
  world.addAngularImpulse(body, [0, 0, 1]);
  world.step(second);
  world.setAwake(body, true);
  world.setSleeping(false);
  world.removeBody(ground);
  assert.equal(world.bodyExists(ground), false);
});

test('user data keep all 64 bits', () => {
  const world = api.createWorld();
  const value = 0xfedcba9876543210n;
  assert.equal(world.userData(world.addBody({ userData: value })), value);
  assert.equal(world.userData(world.addBody({ userData: 5 })), 5n);
});

test('mistakes are named', () => {
  const { world, body } = boxOnGround();
  const other = boxOnGround();
  const refused = (what, message, kind = gyre.GyreError) =>
    assert.throws(what, (error) => error instanceof kind && message.test(error.message) || assert.fail(`${error.name}: ${error.message}`));
  refused(() => world.addBody({ mass: -1 }, { geometry: sphere() }), /mass is -1/);
  refused(() => world.addBody({}, { geometry: sphere({ radius: -1 }) }), /radius/);
  refused(() => world.addBody({ maas: 1 }), /BodyDef has no field "maas"; it has type, pose/, TypeError);
  refused(() => world.addBody({ pose: { position: [1, 2] } }), /Pose\.position: found an array of 2, expected 3 numbers/, TypeError);
  refused(() => world.addBody({ mass: '5' }), /BodyDef\.mass: found "5", expected a number/, TypeError);
  refused(() => world.addBody({ type: 7 }), /BodyDef\.type: found 7, expected one of fixed \(0\)/, TypeError);
  refused(() => world.addBody({}, { geometry: { kind: 99 } }), /shape\.kind: found 99/, TypeError);
  refused(() => world.setSubsteps(2.5), /setSubsteps: substeps: found 2.5, expected a whole number/, TypeError);
  refused(() => world.setSubsteps(1000), /substeps/);
  refused(() => world.step(0), /seconds/);
  refused(() => api.createWorld({ threads: -1 }), /threads/);
  refused(() => api.cookHull([[0, 0, 0], [1, 0, 0], [0, 1, 0]]), /4|points/);
  refused(() => api.loadSnapshot(new Uint8Array(10)), /snapshot|bytes/i);
  refused(() => api.openReplay(new TextEncoder().encode('not a recording')), /record/i);
  refused(() => api.openScene('{"gyre_scene": 1, "bodies": [{"shapes": []'), /scene:1:/);
  refused(() => api.openScene('{"gyre_scene": 1, "bodys": []}', { file: 'mine.json' }), /mine\.json.*bodys/);
  world.removeBody(body);
  refused(() => world.setVelocity(body, [0, 0, 0], [0, 0, 0]), /exist/);
  // An id of another world is refused, although a body of that number is there.
  refused(() => other.world.setVelocity(world.addBody({}, { geometry: box() }), [1, 0, 0], [0, 0, 0]), /world|exist/);
  const before = other.world.hash();
  assert.throws(() => other.world.addForce(other.body, [NaN, 0, 0]));
  assert.equal(other.world.hash(), before);
});

test('an object that was disposed of says so', () => {
  const { world } = boxOnGround();
  world.dispose();
  world.dispose();
  assert.equal(world.disposed, true);
  assert.throws(() => world.step(second), /disposed/);
});

test('snapshots: back, and again forward, bit for bit', () => {
  const scene = api.openScene(sceneText('card_house.gyre.json'));
  for (let i = 0; i < 50; ++i) scene.step();
  const snapshot = scene.saveSnapshot(), before = scene.hash();
  for (let i = 0; i < 50; ++i) scene.step(scene.timeStep);
  const after = scene.hash();
  scene.restoreSnapshot(snapshot);
  assert.equal(scene.hash(), before);
  const copy = api.loadSnapshot(snapshot, { broadPhase: undefined, threads: 1 } && { threads: 1 });
  for (let i = 0; i < 50; ++i) {
    scene.step(scene.timeStep);
    copy.step(scene.timeStep);
  }
  assert.equal(scene.hash(), after);
  assert.equal(copy.hash(), after);
  const rollback = api.createRollback(4);
  rollback.save(copy);
  copy.step(second);
  assert.equal(rollback.restore(copy, copy.stepCount() - 1), true);
  assert.equal(copy.hash(), after);
  assert.equal(api.createRollback(2).oldest(), Infinity);
});

test('recordings: taken in pieces, played, sought back', () => {
  const { world, body } = boxOnGround();
  world.addBody({ pose: { position: [0.25, 3, 0] } }, { geometry: sphere() });
  const recorder = world.record();
  assert.throws(() => world.record(), /recorded/);
  const pieces = [], hashes = [world.hash()];
  for (let i = 0; i < 60; ++i) {
    if (i === 20) world.addImpulse(body, [2000, 0, 0]);
    world.step(second);
    hashes.push(world.hash());
    if (i % 10 === 0) pieces.push(recorder.take());
  }
  pieces.push(recorder.finish());
  const bytes = Buffer.concat(pieces);
  const replay = api.openReplay(bytes);
  assert.equal(replay.stepCount(), 60);
  assert.equal(replay.truncated(), false);
  for (let i = 1; i <= 60; ++i) {
    assert.equal(replay.step(), true);
    assert.equal(replay.matches, true);
    assert.equal(replay.world().hash(), hashes[i]);
  }
  assert.equal(replay.step(), false);
  for (const step of [10, 55, 0, 31]) {
    replay.seek(step);
    assert.equal(replay.position(), step);
    assert.equal(replay.world().hash(), hashes[step]);
  }
  assert.throws(() => replay.seek(61), /61/);
  assert.equal(api.openReplay(bytes.subarray(0, bytes.length - 40)).truncated(), true);
  const inner = replay.world();
  replay.dispose();
  assert.throws(() => inner.step(second), /disposed/);
});

test('pose tracks: frames, names and colours without simulating', () => {
  const scene = api.openScene(JSON.stringify({
    gyre_scene: 1, name: 'two', view: { eye: [5, 5, 5], target: [0, 0, 0] },
    bodies: [{ name: 'ground', type: 'static', shapes: [{ type: 'plane' }] }, { name: 'ball', color: '#ff8000', position: [0, 4, 0], shapes: [{ type: 'sphere', radius: 0.5 }] }],
  }));
  const recorder = scene.record({ frameInterval: 2 });
  assert.throws(() => scene.record(), /already/);
  const places = [scene.pose(scene.sceneBodies[1]).position];
  for (let i = 1; i <= 40; ++i) {
    scene.step();
    if (i % 2 === 0) places.push(scene.pose(scene.sceneBodies[1]).position);
  }
  const bytes = recorder.finish();
  assert.throws(() => recorder.take(), /finished/);
  assert.throws(() => scene.record({ commands: false, poses: false }), /must be recorded/);
  const track = api.openPoseTrack(bytes);
  assert.equal(track.frameCount(), places.length);
  for (const frame of [20, 3, 0, 11]) {
    track.seek(frame);
    const { ids, positions, awake } = track.frame();
    assert.equal(ids.length, 2);
    assert.equal(awake.length, 2);
    close(positions.slice(3), places[frame], 2 * track.accuracy().position);
  }
  const ball = track.frame().ids[1];
  const label = track.label(ball);
  assert.equal(label.name, 'ball');
  assert.deepEqual([label.colors.red[0], label.colors.green[0], label.colors.blue[0]], [255, 128, 0]);
  assert.equal(JSON.parse(track.note('scene')).name, 'two');
  const models = track.models();
  assert.deepEqual(models[track.frame().models[1]].shapes[0].geometry, sphere({ radius: 0.5 }));
  assert.throws(() => track.seek(1000), /frame/);
  assert.throws(() => api.openPoseTrack(new Uint8Array(3)), gyre.GyreError);
  // What is not kept ends by itself.
  scene.record().dispose();
  scene.record();
  scene.dispose();
});

test('scenes: names, meshes, forces, and what they are told to change', () => {
  assert.throws(() => api.openScene(sceneText('mesh_terrain.gyre.json')), /\.obj.*no files/);
  assert.throws(() => api.openScene(sceneText('mesh_terrain.gyre.json'), { files: { 'hills.obj': '' } }), /given were: "hills\.obj"/);
  const terrain = api.openScene(sceneText('mesh_terrain.gyre.json'), { files: meshFiles() });
  assert.ok(terrain.stats().shapes > 1);
  const scene = api.openScene(sceneText('bridge.gyre.json'), { settings: { stepping: { substeps: 9 }, gravity: [0, -1, 0], timeStep: 0.02 } });
  assert.equal(scene.substeps(), 9);
  assert.equal(scene.timeStep, 0.02);
  assert.deepEqual(scene.gravity(), [0, -1, 0]);
  assert.equal(scene.bodyNames.length, scene.stats().bodies);
  assert.equal(scene.bodyName(scene.sceneBodies[3]), scene.bodyNames[3]);
  assert.equal(new Set(scene.bodyNames).size, scene.bodyNames.length);
  assert.equal(scene.sceneJoints.length, scene.stats().joints);
  scene.step();
  assert.equal(scene.steps, 1);
  const again = api.openScene(scene.toJson());
  assert.deepEqual(again.bodies().positions, scene.bodies().positions);
  assert.throws(() => api.openScene(sceneText('stack.gyre.json'), { settings: { substeps: 3 } }), /no setting is named "substeps"/);
});

test('colours and view of a scene', () => {
  const ball = { type: 'sphere', radius: 0.5 };
  const scene = api.openScene(JSON.stringify({
    gyre_scene: 1, view: { eye: [1, 2, 3], target: [0, 0.5, 0] }, materials: { tin: { density: 7300, color: '#0a0b0c' } },
    bodies: [{ name: 'a', color: '#ff8000', shapes: [ball] }, { name: 'b', shapes: [{ ...ball, material: 'tin' }, { ...ball, color: '#010203' }] }, { name: 'c', shapes: [ball] }],
  }));
  assert.deepEqual(scene.colors.slice(0, 2), [[0xff8000], [0x0a0b0c, 0x010203]]);
  assert.ok(scene.colors[2][0] > 0);
  assert.deepEqual(scene.materialNames, [[''], ['tin', ''], ['']]);
  assert.deepEqual([scene.view.eye, scene.view.target], [[1, 2, 3], [0, 0.5, 0]]);
  assert.ok(scene.view.fieldOfView > 0);
  assert.equal(api.openScene('{"gyre_scene": 1}').view, undefined);
});

test('a force of a scene acts when it is due', () => {
  const text = JSON.stringify({
    gyre_scene: 1, world: { gravity: [0, 0, 0], time_step: 0.01 },
    bodies: [{ name: 'ball', mass: 2, shapes: [{ type: 'sphere', radius: 0.5 }], forces: [{ force: [4, 0, 0], start: 0.05, end: 0.1 }] }],
  });
  const scene = api.openScene(text);
  for (let i = 0; i < 5; ++i) scene.step();
  assert.deepEqual(scene.linearVelocity(scene.sceneBodies[0]), [0, 0, 0]);
  for (let i = 0; i < 10; ++i) scene.step();
  close(scene.linearVelocity(scene.sceneBodies[0]), [0.1, 0, 0], 1e-6);
});

test('bodies and shapes change at run time', () => {
  const { world, ground, body } = boxOnGround();
  const [shape] = world.shapes(body);
  assert.equal(Math.round(world.massProperties(body).mass), 1000);
  world.setDensity(shape, 500);
  assert.equal(Math.round(world.massProperties(body).mass), 500);
  world.setMass(body, { mass: 10, inertia: [1, 2, 3, 0, 0, 0] });
  assert.equal(world.massProperties(body).mass, 10);
  close(world.massProperties(body).inertia, [1, 2, 3, 0, 0, 0]);
  world.setLockedAxes(body, { linear: [true, false, false] });
  assert.deepEqual(world.lockedAxes(body).linear, [true, false, false]);
  world.addImpulse(body, [50, 0, 0]);
  world.step(second);
  assert.equal(world.pose(body).position[0], 0);
  world.setUserData(body, 2n ** 60n);
  world.setShapeUserData(shape, 7);
  assert.equal(world.userData(body), 2n ** 60n);
  assert.equal(world.shapeUserData(shape), 7n);
  world.setPairIgnored(body, ground, true);
  assert.equal(world.pairIgnored(ground, body), true);
  for (let i = 0; i < 30; ++i) world.step(second);
  assert.ok(world.pose(body).position[1] < 0, 'it falls through the ground');
  const kept = world.saveSnapshotWith(new Uint8Array([1, 2, 3]));
  assert.deepEqual([...api.snapshotUserBytes(kept)], [1, 2, 3]);
  world.setPose(body, { position: [0, 3, 0] });
  world.setEnabled(body, false);
  assert.equal(world.enabled(body), false);
  assert.equal(world.castRay([0, 3, 5], [0, 0, -10]), undefined);
  for (let i = 0; i < 10; ++i) world.step(second);
  close(world.pose(body).position, [0, 3, 0]);
  world.setEnabled(body, true);
  assert.ok(world.castRay([0, 3, 5], [0, 0, -10]));
});

test('couplings, articulations and named laws', () => {
  const world = api.createWorld({ gravity: [0, 0, 0] });
  const mass = { mass: 1, inertia: [1, 1, 1, 0, 0, 0] };
  const [left, right] = [-1, 1].map((x) => world.addBody({ pose: { position: [x, 0, 0] }, canSleep: false, ...mass }));
  const slider = (b, x) => world.addJoint({ kind: JointKind.slider, b, anchor: [x, 0, 0], axis: [1, 0, 0] });
  const [a, b] = [slider(left, -1), slider(right, 1)];
  const axis = gyre.JointAxis.linearX;
  const coupling = world.addCoupling({ terms: [{ joint: a, axis, coefficient: 1 }, { joint: b, axis, coefficient: 2 }] });
  assert.deepEqual([...world.couplings()], [coupling]);
  for (let i = 0; i < 30; ++i) {
    world.addJointLoad(a, axis, 5);
    world.step(second);
  }
  close([world.linearVelocity(right)[0] * 2], [-world.linearVelocity(left)[0]], 1e-4);
  assert.ok(world.couplingState(coupling).force < 0);
  world.setMotor(a, { targetVelocity: 0, maxForce: 3 });
  world.step(second);
  close([Math.abs(world.jointAxisState(a, axis).motor)], [3], 1e-4);
  assert.throws(() => world.addCoupling({ terms: [{ joint: a, axis }] }), /2 to 8/);
  const table = world.readArticulation(left);
  assert.deepEqual([...table.massMatrix], [1]);
  close([...world.inverseDynamics(left, [4])], [4]);
  assert.equal(world.pointJacobian(left, [0, 0, 0]).length, 6);
  const charge = world.addBody({ linearVelocity: [1, 0, 0], canSleep: false });
  world.addField({ kind: gyre.FieldKind.magnetic, strength: 2, axis: [0, 0, 1] });
  for (let i = 0; i < 60; ++i) world.step(second);
  close(world.linearVelocity(charge), [Math.cos(2), -Math.sin(2), 0], 1e-3);
});

test('seeing inside: tables, drawing, times, reasons', () => {
  const { world, body } = boxOnGround();
  world.setTiming(true);
  for (let i = 0; i < 5; ++i) world.step(second);
  const origin = [0, 0, 0];
  const bodies = world.readBodies(origin);
  assert.deepEqual([...bodies.ids], [...world.bodies().ids]);
  close([...bodies.centers.slice(3)], world.pose(body).position, 1e-6);
  assert.equal(world.readContacts(origin).separations.length, 4);
  assert.ok(world.readBoxes(gyre.kAllBoxes, origin).corners.length >= 6);
  const drawn = world.drawDebug({ layers: 1 << gyre.DrawLayer.contactPoints, origin });
  assert.equal(drawn.pointPositions.length, 12);
  assert.equal(drawn.layers[gyre.DrawLayer.contactPoints].points, 4);
  const times = world.readTimes();
  assert.equal(times.steps, 5);
  assert.ok(times.stages.count > 5 && times.stages.name.includes('solve') && times.stages.seconds.length === times.stages.count);
  const why = world.explain(body);
  assert.equal(nameOf(gyre.AwakeReason, why.reason), 'settling');
  assert.equal(why.touching.count, 1);
  assert.match(why.words, /\w+ .*\./);
  world.validate();
  assert.equal(api.addWireframe(box()).length, 12 * 6);
});

test('values of the mathematics', () => {
  const half = Math.SQRT1_2;
  close(api.fromAxisAngle([0, 1, 0], Math.PI / 2), [0, half, 0, half], 1e-6);
  const { sin, cos } = api.sinCos(1);
  close([sin, cos], [Math.sin(1), Math.cos(1)], 1e-7);
  close(api.slerp([0, 0, 0, 1], [0, half, 0, half], 0.5), [0, Math.sin(Math.PI / 8), 0, Math.cos(Math.PI / 8)], 1e-6);
  assert.equal(api.modelMatrix({ position: [1, 2, 3] })[13], 2);
});

test('warmUp leaves nothing behind', () => {
  const world = api.createWorld();
  const before = world.hash();
  api.warmUp();
  assert.equal(world.hash(), before);
});

test('two engines do not mix', async () => {
  const other = await gyre.load({ build: 'simd' });
  const rollback = other.createRollback(1);
  assert.throws(() => rollback.save(api.createWorld()), /another load/);
  other.close();
  assert.throws(() => other.createWorld(), /closed/);
  assert.equal(hashText(api.createWorld()).length, 16);
});

test('load says what it does not know', async () => {
  await assert.rejects(gyre.load({ build: 'fast' }), /expected 'simd', 'threads' or 'plain'/);
  await assert.rejects(gyre.load({ build: 'threads', workers: 1.5 }), /workers/);
});
