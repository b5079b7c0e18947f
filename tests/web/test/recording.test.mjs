// A recording plays in the page: the same poses as the world that was recorded, forward and back; what is cut off plays to its end.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { load } from '../../../web/gyre-physics/dist/index.js';
import { root, viewerTests } from '../setup.mjs';

const STEPS = 90;
const ACCURACY = 1e-4; // m, what a recorder keeps by default; and some rounding to 32 bits

const gyre = await load({ build: 'simd' });
const scene = gyre.openScene(readFileSync(join(root, 'scenes/machines.gyre.json'), 'utf8'));
const recorder = scene.record();
const places = [Array.from(scene.bodies().positions)];
for (let i = 0; i < STEPS; i++) {
  scene.step();
  places.push(Array.from(scene.bodies().positions));
}
const whole = Buffer.from(recorder.finish());
gyre.close();

const viewer = viewerTests({ files: { 'whole.gyrec': whole, 'cut.gyrec': whole.subarray(0, Math.floor(0.7 * whole.length)) } });

// The largest difference of any coordinate to the world that was recorded.
async function farthest(page, step) {
  const poses = await page.evaluate(() => window.gyre.poses());
  assert.equal(poses.length / 7, places[step].length / 3);
  return Math.max(...places[step].map((value, i) => Math.abs(value - poses[7 * Math.floor(i / 3) + (i % 3)])));
}

test('a recording plays forward and back', async (t) => {
  const page = await viewer.open(t, 'file=/files/whole.gyrec&play=0&quality=low', { width: 640, height: 400 });
  assert.equal(await page.evaluate(() => window.gyre.scene.live), false);
  assert.equal(await page.evaluate(() => window.gyre.scene.lastStep), STEPS);
  for (const step of [0, 90, 31, 30, 29, 64]) {
    await page.evaluate((wanted) => window.gyre.seek(wanted), step);
    assert.ok((await farthest(page, step)) < 1.2 * ACCURACY, `step ${step} is ${await farthest(page, step)} m off`);
  }
  await page.evaluate(() => window.gyre.play());
  await page.waitForFunction((last) => window.gyre.step === last, STEPS, { timeout: 60000 });
  assert.ok((await farthest(page, STEPS)) < 1.2 * ACCURACY);
  viewer.noErrors(page);
});

test('a recording that was cut off plays up to its last whole frame', async (t) => {
  const page = await viewer.open(t, 'file=/files/cut.gyrec&play=0&quality=low', { width: 640, height: 400 });
  const { lastStep, truncated } = await page.evaluate(() => window.gyre.scene);
  assert.equal(truncated, true);
  assert.ok(lastStep > 0 && lastStep < STEPS, `${lastStep} frames`);
  await page.evaluate((last) => window.gyre.seek(last), lastStep);
  assert.ok((await farthest(page, lastStep)) < 1.2 * ACCURACY);
  viewer.noErrors(page);
});
