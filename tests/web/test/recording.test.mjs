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
const recordAgain = (options) => {
  const again = gyre.openScene(readFileSync(join(root, 'scenes/machines.gyre.json'), 'utf8'));
  const other = again.record(options);
  for (let i = 0; i < STEPS; i++) again.step();
  return Buffer.from(other.finish());
};
const poses = recordAgain({ commands: false });
const commands = recordAgain({ poses: false });
const energies = (({ kinetic, potential, elastic }) => ({ kinetic, potential, elastic }))(scene.energy());
gyre.close();

const viewer = viewerTests({ files: { 'whole.gyrec': whole, 'cut.gyrec': whole.subarray(0, Math.floor(0.7 * whole.length)), 'poses.gyrec': poses, 'commands.gyrec': commands } });

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

const NEEDS_WORLD = ['contacts', 'friction', 'bounds', 'tree', 'islands', 'joints'];

test('a recording with commands has everything inside that the live scene has', async (t) => {
  const page = await viewer.open(t, 'file=/files/whole.gyrec&play=0&quality=low', { width: 640, height: 400 });
  await page.evaluate((names) => names.forEach((name) => window.gyre.overlay(name, true)), NEEDS_WORLD);
  await page.evaluate((last) => window.gyre.seek(last), STEPS);
  const inside = () => page.evaluate(() => {
    const { overlays, stats, links } = window.gyre.viewer.playback.frame;
    return { contacts: overlays.contacts.scales.length, boxes: overlays.bounds.length, nodes: overlays.tree.depths.length, joints: overlays.joints.rigid.length, islands: overlays.islands.length, links: links.length, stats };
  });
  const end = await inside();
  const { kinetic, potential, elastic } = end.stats;
  assert.deepEqual({ kinetic, potential, elastic }, energies);
  assert.equal(end.joints, 4);
  assert.equal(end.links, 6);
  assert.ok(end.contacts > 0 && end.boxes > 0 && end.nodes > 0 && end.islands > 0);
  // Back, and again the same: the world goes the way that the poses go.
  await page.evaluate(() => window.gyre.seek(17));
  assert.notEqual((await inside()).stats.kinetic, kinetic);
  await page.evaluate((last) => window.gyre.seek(last), STEPS);
  assert.deepEqual({ ...(await inside()).stats, stepMs: 0, stageMs: [] }, { ...end.stats, stepMs: 0, stageMs: [] });
  // The inspector knows what only a world knows.
  const report = await page.evaluate((key) => window.gyre.viewer.playback.client.request('inspect', { key }), await page.evaluate(() => window.gyre.key('wheel')));
  assert.ok(report.mass > 0 && report.words.includes('wheel'), report.words);
  viewer.noErrors(page);
});

test('a recording of commands alone is simulated and then played', async (t) => {
  const page = await viewer.open(t, 'file=/files/commands.gyrec&play=0&quality=low', { width: 640, height: 400 });
  assert.equal(await page.evaluate(() => window.gyre.scene.lastStep), STEPS);
  for (const step of [90, 31, 0]) {
    await page.evaluate((wanted) => window.gyre.seek(wanted), step);
    assert.ok((await farthest(page, step)) < 1.2 * ACCURACY, `step ${step} is ${await farthest(page, step)} m off`);
  }
  assert.equal(await page.evaluate(() => window.gyre.scene.posesOnly), '');
  viewer.noErrors(page);
});

test('a recording of poses says what it lacks', async (t) => {
  const page = await viewer.open(t, 'file=/files/poses.gyrec&play=0&quality=low', { width: 1000, height: 700 });
  assert.match(await page.evaluate(() => window.gyre.scene.posesOnly), /looked at only/);
  await page.keyboard.press('o');
  assert.match(await page.locator('.panel-body').innerText(), /Only poses are known/);
  assert.ok(await page.getByRole('switch', { name: /^Contacts/ }).isDisabled());
  await page.keyboard.press('c');
  assert.match(await page.locator('.panel-body').innerText(), /no times, energies or contacts/);
  await page.evaluate(() => window.gyre.seek(40));
  assert.ok((await farthest(page, 40)) < 1.2 * ACCURACY);
  viewer.noErrors(page);
});
