// glTF files: the scene that the module reads is byte for byte that of `gyre convert`, and moves like the file natively.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test, { after, before } from 'node:test';

import { engine, gyre, hashText, made, nativeProgram, sceneFolder } from './kit.mjs';

const build = process.env.GYRE_WEB_BUILD ?? 'simd';
const skip = !made(build) ? `the build '${build}' is not made` : !made('gltf') ? 'the reader of glTF is not made' : false;
const playground = skip ? null : readFileSync(join(sceneFolder, 'formats/playground.gltf'));
let folder;
before(() => (folder = mkdtempSync(join(tmpdir(), 'gyre-gltf-'))));
after(() => rmSync(folder, { recursive: true, force: true }));

const native = (...words) => execFileSync(nativeProgram, words, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] });

for (const scene of ['formats/playground.gltf', 'half_wood_half_lead.gyre.json', 'machines.gyre.json']) {
  test(`${scene} as gyre convert reads it`, { skip: skip || (nativeProgram ? false : 'no native gyre to compare with') }, async () => {
    const path = join(sceneFolder, scene);
    const glb = scene.endsWith('.gltf') ? path : join(folder, 'scene.glb');
    if (glb !== path) native('convert', path, glb);
    const converted = join(folder, 'scene.gyre.json');
    native('convert', glb, converted);
    const { text } = await gyre.importGltf(readFileSync(glb), { file: glb });
    assert.equal(text, readFileSync(converted, 'utf8'));
    const world = (await engine(build)).openScene(text);
    for (let i = 0; i < 60; ++i) world.step();
    assert.equal(hashText(world), native('simulate', glb, '--steps', '60', '--hash', '--quiet').match(/^[0-9a-f]{16}$/m)[0]);
    world.dispose();
  });
}

test('buffers are those that are given', { skip }, async () => {
  const mesh = {
    asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
    accessors: [{ bufferView: 0, componentType: 5126, type: 'VEC3', count: 3 }],
    bufferViews: [{ buffer: 0, byteLength: 36 }], buffers: [{ uri: 'a%20b.bin', byteLength: 36 }],
  };
  const bytes = new TextEncoder().encode(JSON.stringify(mesh));
  const corners = new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]);
  const { text, notes } = await gyre.importGltf(bytes, { files: { 'a b.bin': corners } });
  assert.deepEqual(notes, []);
  assert.deepEqual(Object.values(JSON.parse(text).meshes)[0].vertices, [[0, 0, 0], [1, 0, 0], [0, 1, 0]]);
  await assert.rejects(gyre.importGltf(bytes), /a b\.bin.*no files can be opened/);
});

test('what is refused or left out is said', { skip }, async () => {
  const bytes = new TextEncoder().encode(JSON.stringify({ asset: { version: '2.0' }, nodes: [{ extensions: { OMI_physics_body: {} } }] }));
  const { notes } = await gyre.importGltf(bytes, { file: 'omi.gltf' });
  assert.match(notes.join(), /omi\.gltf: not simulated: .*OMI_physics_body/);
  await assert.rejects(gyre.importGltf(bytes, { file: 'omi.gltf', strict: true }), gyre.GyreError);
  await assert.rejects(gyre.importGltf(new Uint8Array(0), { file: 'empty.glb' }), /empty\.glb/);
  await assert.rejects(gyre.importGltf(bytes, { stric: true }), /no option is named "stric"/);
});
