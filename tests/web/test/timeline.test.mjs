// The time line: going back and forward again gives the same positions to the bit, also through what a visitor did.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { viewerTests } from '../setup.mjs';

const viewer = viewerTests();
const state = () => window.gyre.hash().then((hash) => ({ step: window.gyre.step, hash, poses: window.gyre.poses() }));

test('scrubbing returns the same positions', async (t) => {
  const page = await viewer.open(t, 'scene=dominoes&play=0&quality=low', { width: 640, height: 400 });
  const seen = new Map();
  for (let i = 0; i < 8; i++) {
    await page.evaluate(() => window.gyre.advance(30));
    const now = await page.evaluate(state);
    seen.set(now.step, now);
  }
  assert.deepEqual([...seen.keys()], [30, 60, 90, 120, 150, 180, 210, 240]);
  assert.notDeepEqual(seen.get(240).poses, seen.get(30).poses);
  for (const step of [30, 210, 60, 60, 240, 90, 120]) {
    await page.evaluate((wanted) => window.gyre.seek(wanted), step);
    assert.deepEqual(await page.evaluate(state), seen.get(step), `after scrubbing to ${step}`);
  }
  // Playing on from the past goes through the same states.
  await page.evaluate(() => window.gyre.advance(90));
  assert.deepEqual(await page.evaluate(state), seen.get(210));
  viewer.noErrors(page);
});

test('the slider and the keys scrub', async (t) => {
  const page = await viewer.open(t, 'scene=stack&play=0&quality=low', { width: 640, height: 400 });
  await page.evaluate(() => window.gyre.advance(50));
  await page.locator('.timeline').fill('20');
  await page.waitForFunction(() => window.gyre.step === 20);
  await page.keyboard.press('ArrowLeft');
  await page.waitForFunction(() => window.gyre.step === 19);
  await page.keyboard.press('ArrowRight');
  await page.waitForFunction(() => window.gyre.step === 20);
  await page.keyboard.press('Home');
  await page.waitForFunction(() => window.gyre.step === 0);
  await page.keyboard.press('End');
  await page.waitForFunction(() => window.gyre.step === 50);
  viewer.noErrors(page);
});

test('what a visitor did is done again, and a new deed cuts the future off', async (t) => {
  const page = await viewer.open(t, 'scene=stack&play=0&quality=low', { width: 640, height: 400 });
  await page.evaluate(async () => {
    await window.gyre.advance(20);
    window.gyre.command({ do: 'throw', what: 'ball', size: 0.3, density: 2000, from: [-6, 2, 0], velocity: [14, 2, 0] });
    await window.gyre.advance(70);
  });
  const bodies = await page.evaluate(() => window.gyre.names().length);
  const first = await page.evaluate(state);
  await page.evaluate(() => window.gyre.seek(10));
  assert.equal(await page.evaluate(() => window.gyre.names().length), bodies - 1);
  await page.evaluate(() => window.gyre.seek(90));
  assert.deepEqual(await page.evaluate(state), first);
  assert.equal(await page.evaluate(() => window.gyre.names().length), bodies);

  await page.evaluate(async () => {
    await window.gyre.seek(30);
    window.gyre.command({ do: 'gravity', value: [0, 3, 0] });
    await window.gyre.advance(10);
  });
  assert.equal(await page.evaluate(() => window.gyre.viewer.playback.frame.lastStep), 40);
  viewer.noErrors(page);
});
