// The world panel: settings take effect, and those that need a new world change no bit of what comes.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { viewerTests } from '../setup.mjs';

const viewer = viewerTests();

test('broad phase, SIMD width and threads change no bit', async (t) => {
  const page = await viewer.open(t, 'scene=machines&play=0&quality=low', { width: 640, height: 400 });
  await page.evaluate(() => window.gyre.advance(90));
  const wanted = await page.evaluate(() => window.gyre.hash());
  await page.evaluate(() => window.gyre.seek(30));
  const { choices } = await page.evaluate(() => window.gyre.scene);
  const settings = [
    ...choices.broadPhase.map((broadPhase) => ({ broadPhase })),
    ...choices.simdWidth.map((simdWidth) => ({ simdWidth })),
    { threads: choices.maxThreads },
  ];
  assert.ok(settings.length >= 4);
  for (const change of settings) {
    await page.evaluate((asked) => window.gyre.configure(asked), change);
    await page.evaluate(() => window.gyre.advance(60));
    assert.equal(await page.evaluate(() => window.gyre.hash()), wanted, JSON.stringify(change));
    await page.evaluate(() => window.gyre.seek(30));
  }
  viewer.noErrors(page);
});

test('settings are those of the moment that is shown', async (t) => {
  const page = await viewer.open(t, 'scene=stack&play=0&quality=low', { width: 640, height: 400 });
  const settings = () => page.evaluate(() => ({ sleeping: window.gyre.scene.settings.sleeping, substeps: window.gyre.scene.settings.substeps, up: window.gyre.scene.settings.gravity[1] }));
  await page.evaluate(() => window.gyre.advance(10));
  const before = await settings();
  await page.evaluate(async () => {
    window.gyre.command({ do: 'gravity', value: [0, 1.5, 0] });
    window.gyre.command({ do: 'substeps', value: 7 });
    window.gyre.command({ do: 'sleeping', value: false });
    await window.gyre.advance(10);
  });
  const after = { sleeping: false, substeps: 7, up: 1.5 };
  assert.deepEqual(await settings(), after);
  await page.evaluate(() => window.gyre.seek(5));
  assert.deepEqual(await settings(), before);
  await page.evaluate(() => window.gyre.advance(10));
  assert.deepEqual(await settings(), after);
  viewer.noErrors(page);
});

test('gravity, sub-steps and sleeping act at once', async (t) => {
  const page = await viewer.open(t, 'scene=stack&play=0&quality=low', { width: 1100, height: 800 });
  await page.evaluate(() => window.gyre.advance(200));
  const rest = await page.evaluate(() => window.gyre.poses());
  await page.keyboard.press('w');
  await page.getByRole('radio', { name: 'None' }).click();
  await page.getByRole('slider', { name: 'Sub-steps' }).fill('8');
  await page.evaluate(async () => {
    window.gyre.command({ do: 'gravity', value: [0, 4, 0] });
    await window.gyre.advance(60);
  });
  const risen = await page.evaluate(() => window.gyre.poses());
  assert.ok(Math.max(...risen.map((value, i) => value - rest[i])) > 1, 'nothing rises');
  viewer.noErrors(page);
});
