// Broken and hostile files: the page says in words what is wrong and where, and goes on living.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { ready, root, viewerTests } from '../setup.mjs';

const stack = readFileSync(join(root, 'scenes/stack.gyre.json'), 'utf8');
const files = {
  'not_json.gyre.json': '{"gyre_scene": 1, "bodies": [',
  'bad_radius.gyre.json': '{"gyre_scene": 1, "bodies": [{"name": "a", "shapes": [{"type": "sphere", "radius": -1}]}]}',
  'unknown_field.gyre.json': '{"gyre_scene": 1, "bodys": []}',
  'no_mesh.gyre.json': '{"gyre_scene": 1, "meshes": {"m": {"file": "missing.obj"}}, "bodies": []}',
  'outside.gyre.json': '{"gyre_scene": 1, "meshes": {"m": {"file": "../secret.obj"}}, "bodies": []}',
  'noise.gyre.json': Buffer.from(Array.from({ length: 400 }, (_, i) => (i * 197 + 91) % 256)),
  'noise.gyrec': Buffer.from(Array.from({ length: 400 }, (_, i) => (i * 197 + 91) % 256)),
  'header_only.gyrec': Buffer.from('GYREPLAY'),
  'empty.gyre.json': '',
  'nothing.gyre.json': 'null',
  'list.gyre.json': '[1, 2]',
  'later.gyre.json': '{"gyre_scene": 9, "bodies": []}',
  'later.gyrec': Buffer.concat([Buffer.from('GYREPLAY'), Buffer.from([9, 0, 0, 0]), Buffer.alloc(64)]),
  'world.gyresnap': Buffer.concat([Buffer.from('GYRESNAP'), Buffer.alloc(64)]),
  'good.gyre.json': stack,
  'bad.glb': Buffer.concat([Buffer.from('glTF'), Buffer.alloc(40)]),
  'no_buffer.gltf': '{"asset": {"version": "2.0"}, "buffers": [{"uri": "missing.bin", "byteLength": 4}]}',
};
const viewer = viewerTests({ files });

const cases = [
  ['not_json.gyre.json', /not_json\.gyre\.json/],
  ['bad_radius.gyre.json', /\/bodies\/0\/shapes\/0\/radius/],
  ['unknown_field.gyre.json', /bodys/],
  ['no_mesh.gyre.json', /missing\.obj/],
  ['outside.gyre.json', /secret\.obj/],
  ['noise.gyre.json', /noise\.gyre\.json/],
  ['noise.gyrec', /recording/i],
  ['header_only.gyrec', /recording/i],
  ['empty.gyre.json', /empty\.gyre\.json/],
  ['nothing.gyre.json', /expected a scene/],
  ['list.gyre.json', /expected a scene/],
  ['later.gyre.json', /found 9, expected 1/],
  ['later.gyrec', /format 9; this version reads format 1/],
  ['world.gyresnap', /is a snapshot/],
  ['bad.glb', /version 0 of glTF/],
  ['no_buffer.gltf', /missing\.bin/],
  ['nowhere.gyre.json', /There is no nowhere\.gyre\.json/],
];

test('a broken file gives its message', async (t) => {
  const page = await viewer.open(t, 'play=0&quality=low&file=/files/good.gyre.json', { width: 800, height: 600 });
  for (const [name, pattern] of cases) {
    await t.test(name, async () => {
      const address = new URL(page.url());
      address.search = `?quality=low&file=/files/${name}`;
      await page.goto(address.href);
      await page.locator('[role=alertdialog]').waitFor();
      const text = await page.locator('[role=alertdialog]').innerText();
      assert.match(text, pattern);
      assert.doesNotMatch(text, /undefined|\[object|TypeError|Cannot read|load\(\)/);
    });
  }
});

test('a broken file leaves what was open', async (t) => {
  const page = await viewer.open(t, 'play=0&quality=low&file=/files/good.gyre.json', { width: 800, height: 600 });
  await page.keyboard.press('s');
  await page.locator('.drawer input[type=file]').setInputFiles({ name: 'mine.gyre.json', mimeType: 'application/json', buffer: Buffer.from(files['bad_radius.gyre.json']) });
  await page.locator('[role=alertdialog]').waitFor();
  await page.getByRole('button', { name: 'Close', exact: true }).last().click();
  await page.evaluate(() => window.gyre.advance(3));
  assert.equal(await page.evaluate(() => window.gyre.step), 3);
  assert.equal(await page.evaluate(() => window.gyre.file), 'good.gyre.json');
  viewer.noErrors(page);
});

test("a file of one's own opens", async (t) => {
  const page = await viewer.open(t, 'play=0&quality=low&scene=billiards', { width: 800, height: 600 });
  await page.keyboard.press('s');
  await page.locator('.drawer input[type=file]').setInputFiles({ name: 'mine.gyre.json', mimeType: 'application/json', buffer: Buffer.from(stack) });
  await page.waitForFunction(() => window.gyre.file === 'mine.gyre.json');
  await ready(page);
  viewer.noErrors(page);
});

test('an address on another server is refused', async (t) => {
  const page = await viewer.open(t, 'file=https://example.org/scene.gyre.json', { width: 800, height: 600, wait: false });
  await page.locator('[role=alertdialog]').waitFor();
  assert.match(await page.locator('[role=alertdialog]').innerText(), /another server/);
});
