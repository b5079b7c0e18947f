// The package as npm would deliver it: what is in it, how large it is, and that a stranger's project can use it by its README.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test, { after, before } from 'node:test';
import { gzipSync } from 'node:zlib';

import { made, root } from './kit.mjs';

const source = join(root, 'web/gyre-physics');
const readme = readFileSync(join(source, 'README.md'), 'utf8');
let folder, tarball;

before(() => {
  folder = mkdtempSync(join(tmpdir(), 'gyre-package-'));
  const npm = (...words) => execFileSync('npm', [...words, '--loglevel=error'], { cwd: folder, encoding: 'utf8' });
  const [{ filename }] = JSON.parse(npm('pack', source, '--json'));
  tarball = join(folder, filename);
  writeFileSync(join(folder, 'package.json'), '{"name": "stranger", "private": true, "type": "module"}');
  npm('install', '--offline', '--no-audit', '--no-fund', tarball);
});
after(() => rmSync(folder, { recursive: true, force: true }));

test('what a page fetches is below a megabyte and a quarter', () => {
  const dist = join(folder, 'node_modules/gyre-physics/dist');
  const packed = (path) => gzipSync(readFileSync(path)).length;
  const modules = readdirSync(dist).filter((name) => name.endsWith('.js')).reduce((sum, name) => sum + packed(join(dist, name)), 0);
  for (const name of readdirSync(join(dist, 'engine'))) {
    const size = modules + packed(join(dist, 'engine', name));
    assert.ok(size < 1.25e6, `${name} with the rest: ${size} bytes`);
  }
  // The reader of glTF comes on top, for a page that opens such a file.
  const gltf = packed(join(dist, 'engine/gltf.js'));
  assert.ok(gltf > 1000 && gltf < 0.3e6, `gltf.js: ${gltf} bytes`);
  // Three builds of the engine in one file, of which a page fetches one: 1 MB each.
  assert.ok(statSync(tarball).size < 3.4e6, `${statSync(tarball).size} bytes`);
});

test('no sources, tests or tools are delivered', () => {
  assert.deepEqual(readdirSync(join(folder, 'node_modules/gyre-physics')).sort(), ['LICENSE', 'README.md', 'dist', 'package.json']);
});

test("the README's first example prints what it says", () => {
  const code = readme.match(/```js\n([\s\S]*?)```/)[1];
  assert.ok(code.trim().split('\n').length <= 10, 'ten lines to a falling box');
  writeFileSync(join(folder, 'example.js'), code);
  const printed = Number(execFileSync(process.execPath, ['example.js'], { cwd: folder, encoding: 'utf8', timeout: 60000 }));
  assert.ok(Math.abs(printed - 0.5) < 1e-3, `printed ${printed}`);
});

test("the README's other examples run", async () => {
  const [, , soft, rest, gltf] = readme.split('```js\n').map((part) => part.split('```')[0]);
  writeFileSync(join(folder, 'soft.js'), soft);
  const height = Number(execFileSync(process.execPath, ['soft.js'], { cwd: folder, encoding: 'utf8', timeout: 60000 }));
  assert.ok(Math.abs(height - 0.5) < 0.02, `the middle of the cloth is at ${height} m`);
  const scene = JSON.stringify({ gyre_scene: 1, bodies: [{ name: 'ball', shapes: [{ type: 'sphere', radius: 0.5 }] }] });
  const code = `import { load } from 'gyre-physics';
globalThis.fetch = async () => ({ text: async () => ${JSON.stringify(scene)} });
const gyre = await load(), world = gyre.createWorld();
${rest}
console.log('ran');
`;
  writeFileSync(join(folder, 'more.js'), code);
  assert.match(execFileSync(process.execPath, ['more.js'], { cwd: folder, encoding: 'utf8', timeout: 60000 }), /ran/);
  const robot = JSON.stringify(readFileSync(join(root, 'scenes/formats/playground.gltf'), 'utf8'));
  const fetched = `globalThis.fetch = async () => ({ arrayBuffer: async () => new TextEncoder().encode(${robot}).buffer });`;
  writeFileSync(join(folder, 'gltf.js'), `${fetched}\n${gltf}\nconsole.log(robot.bodyNames.length > 0 && 'ran');`);
  assert.match(execFileSync(process.execPath, ['gltf.js'], { cwd: folder, encoding: 'utf8', timeout: 60000 }), /ran/);
});

test('a program with threads ends by itself', { skip: !made('threads') && 'the build with threads is not made' }, () => {
  writeFileSync(join(folder, 'threads.js'), `import { load } from 'gyre-physics';
const gyre = await load({ build: 'threads', workers: 2 });
const world = gyre.createWorld({ threads: 3 });
world.addBody({}, { geometry: { kind: 0 } });
for (let i = 0; i < 10; ++i) world.step(1 / 60);
console.log(gyre.maxThreads);
`);
  assert.equal(execFileSync(process.execPath, ['threads.js'], { cwd: folder, encoding: 'utf8', timeout: 60000 }).trim(), '3');
});

test('the types are those that a strict TypeScript project takes', () => {
  writeFileSync(join(folder, 'user.ts'), `import load, { BodyType, JointKind, box, type BodyId, type Vec3, World } from 'gyre-physics';
const gyre = await load({ build: 'simd' });
const world: World = gyre.createWorld({ gravity: [0, -9.81, 0], stepping: { substeps: 8 } });
const body: BodyId = world.addBody({ type: BodyType.dynamic, pose: { position: { x: 0, y: 1, z: 0 } } }, { geometry: box({ rounding: 0.1 }) });
const velocity: Vec3 = world.linearVelocity(body);
const into: Float32Array = world.linearVelocity(body, new Float32Array(3));
world.addJoint({ kind: JointKind.hinge, b: body, limits: { low: -1, high: 1 } });
const hash: bigint = world.hash();
const places: Float64Array = world.bodies().positions;
// @ts-expect-error a field that is not there
world.addBody({ colour: 1 });
// @ts-expect-error a field of another kind of joint
world.addJoint({ kind: JointKind.ball, b: body, limits: { low: -1, high: 1 } });
// @ts-expect-error not one of the kinds
world.setType(body, 9);
console.log(velocity, into, hash, places);
`);
  const options = ['--noEmit', '--strict', '--target', 'es2022', '--module', 'nodenext', '--moduleResolution', 'nodenext', '--lib', 'es2022,dom', '--types', ''];
  const compiler = join(source, 'node_modules/.bin/tsc');
  try {
    execFileSync(compiler, [...options, 'user.ts'], { cwd: folder, encoding: 'utf8', timeout: 120000 });
  } catch (error) {
    assert.fail(error.stdout);
  }
});
