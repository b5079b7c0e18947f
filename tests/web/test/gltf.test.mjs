// glTF files with physics: dropped onto the page, and from an address with its buffers beside it.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { root, viewerTests } from '../setup.mjs';

const playground = readFileSync(join(root, 'scenes/formats/playground.gltf'), 'utf8');
const corners = Buffer.from(new Float32Array([0, 0, 0, 1, 0, 0, 0, 1, 0]).buffer);
const triangle = JSON.stringify({
  asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0, extensions: { OMI_physics_body: {} } }],
  meshes: [{ primitives: [{ attributes: { POSITION: 0 } }] }],
  accessors: [{ bufferView: 0, componentType: 5126, type: 'VEC3', count: 3 }],
  bufferViews: [{ buffer: 0, byteLength: 36 }], buffers: [{ uri: 'a%20b.bin', byteLength: 36 }],
});
const viewer = viewerTests({ files: { 'triangle.gltf': triangle, 'a b.bin': corners } });

test('a glTF file that is dropped onto the page runs', async (t) => {
  const page = await viewer.open(t, 'scene=stack&quality=low&play=0', { width: 640, height: 400 });
  const data = await page.evaluateHandle((text) => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([text], 'playground.gltf'));
    return transfer;
  }, playground);
  await page.dispatchEvent('body', 'drop', { dataTransfer: data });
  await page.waitForFunction(() => window.gyre.ready && window.gyre.file === 'playground.gltf', null, { timeout: 60000 });
  const before = await page.evaluate(() => {
    window.gyre.pause();
    return [...window.gyre.poses()];
  });
  await page.evaluate(() => window.gyre.advance(30));
  const after = await page.evaluate(() => [...window.gyre.poses()]);
  assert.ok(before.some((value, i) => Math.abs(value - after[i]) > 1e-3), 'nothing moved');
  viewer.noErrors(page);
});

test('buffers are fetched beside the file, and what is not simulated is said', async (t) => {
  const page = await viewer.open(t, 'file=/files/triangle.gltf&quality=low&play=0', { width: 640, height: 400 });
  const dialog = page.locator('[role=alertdialog]');
  await dialog.waitFor();
  assert.match(await dialog.innerText(), /Not all of it is simulated[\s\S]*OMI_physics_body/);
  await dialog.locator('button.primary').click();
  assert.equal(await dialog.count(), 0);
  viewer.noErrors(page);
});
