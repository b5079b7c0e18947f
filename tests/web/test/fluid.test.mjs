// Gases and liquids on the page: smoke that moves, arrows of the flow, flat gases as pictures, surfaces of liquids.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { load } from '../../../web/gyre-physics/dist/index.js';
import { changed } from '../pictures.mjs';
import { settled, viewerTests } from '../setup.mjs';

const view = { eye: [0, 1, 5], target: [0, 1, 0], field_of_view: 0.5 };
const scenes = {
  smoke: { gases: [{ name: 'room', bounds: [[-1, 0, -1], [1, 2, 1]], cells: [24, 24, 24], emitters: [{ position: [0, 0.3, 0], radius: 0.25, temperature: 420 }] }] },
  flat: {
    gases: [{ name: 'sheet', bounds: [[-1, 0, 0], [1, 2, 0.1]], cells: [24, 24, 1], boundary: { z: 'closed' }, emitters: [{ position: [0, 0.3, 0], radius: 0.25, temperature: 420 }] }],
  },
  cavity: { gases: [{ name: 'cavity', bounds: [[-1, 0, 0], [1, 2, 0.1]], cells: [24, 24, 1], viscosity: 0.01, boundary: 'no_slip', walls: { '+y': { velocity: [1, 0, 0] } } }] },
  still: { gases: [{ name: 'sheet', bounds: [[-1, 0, 0], [1, 2, 0.1]], cells: [24, 24, 1], boundary: 'closed' }] },
  dam: { liquids: [{ name: 'dam', bounds: [[-1, 0, -0.5], [1, 1.5, 0.5]], cell_size: 0.1, fill: [{ box: [[-1, 0, -0.5], [-0.2, 1, 0.5]] }] }] },
};
const files = Object.fromEntries(Object.entries(scenes).map(([name, scene]) => [`${name}.gyre.json`, Buffer.from(JSON.stringify({ gyre_scene: 1, name, view, ...scene }))]));

// Played by its poses; the gas is simulated beside them.
const gyre = await load({ build: 'simd' });
const world = gyre.createWorld();
world.addGas({ lower: [-1, 0, -1], upper: [1, 2, 1], cells: [16, 16, 16], emitters: { position: [0, 0.3, 0], radius: 0.3, temperature: 420 } });
const recorder = world.record();
for (let i = 0; i < 40; i++) world.step(1 / 60);
files['smoke.gyrec'] = Buffer.from(recorder.finish());
gyre.close();

const viewer = viewerTests({ files });
const open = (t, file, options = '') => viewer.open(t, `file=/files/${file}&play=0&quality=low&theme=dark${options}`, { width: 480, height: 360 });

async function after(page, steps) {
  await page.evaluate((count) => window.gyre.advance(count), steps);
  await settled(page);
  return page.screenshot();
}

// Mean brightness, 0 to 255, of the picture around a place of the scene.
async function brightness(page, place) {
  return page.evaluate((at) => {
    const { stage } = window.gyre.viewer;
    const { x, y } = window.gyre.onPage(...at);
    const gl = stage.renderer.getContext();
    const canvas = stage.renderer.domElement;
    const box = canvas.getBoundingClientRect();
    stage.render();
    const size = 8;
    const out = new Uint8Array(4 * size * size);
    const left = Math.round(((x - box.left) / box.width) * canvas.width - size / 2);
    const low = Math.round((1 - (y - box.top) / box.height) * canvas.height - size / 2);
    gl.readPixels(left, low, size, size, gl.RGBA, gl.UNSIGNED_BYTE, out);
    return out.reduce((sum, value, i) => sum + (i % 4 < 3 ? value : 0), 0) / (3 * size * size);
  }, place);
}

test('smoke rises, and the picture shows it where it is', async (t) => {
  const page = await open(t, 'smoke.gyre.json');
  await after(page, 2);
  const clear = await brightness(page, [0, 1.3, 0]);
  const low = await brightness(page, [0, 0.3, 0]);
  assert.ok(low > clear + 30, `the emitter is ${low} bright, clear air ${clear}`);
  const before = await page.screenshot();
  assert.ok(changed(before, await after(page, 60)) > 0.02, 'the picture stayed as it was');
  const risen = await brightness(page, [0, 1.3, 0]);
  assert.ok(risen > clear + 20, `where the smoke rose to, it is ${risen} bright, before ${clear}`);
  assert.equal(await page.evaluate(() => window.gyre.stats.fluids), 1);
  await page.evaluate(() => window.gyre.seek(2));
  await settled(page);
  assert.ok(Math.abs((await brightness(page, [0, 1.3, 0])) - clear) < 2, 'going back takes the smoke back');
  viewer.noErrors(page);
});

test('overlays of a gas: arrows and speed, on and off', async (t) => {
  const page = await open(t, 'smoke.gyre.json');
  const plain = await after(page, 40);
  for (const name of ['flow', 'speed']) {
    await page.evaluate((overlay) => window.gyre.overlay(overlay, true), name);
    await settled(page);
    assert.ok(changed(plain, await page.screenshot()) > 0.005, `${name} shows nothing`);
    await page.evaluate((overlay) => window.gyre.overlay(overlay, false), name);
    await settled(page);
    assert.ok(changed(plain, await page.screenshot()) < 0.001, `${name} stays when it is switched off`);
  }
  viewer.noErrors(page);
});

test('flat gases are pictures: of smoke, of speed where there is none', async (t) => {
  const page = await open(t, 'flat.gyre.json');
  await after(page, 2);
  assert.ok((await brightness(page, [0, 0.3, 0.05])) > (await brightness(page, [0, 1.5, 0.05])) + 40);
  const cavity = await open(t, 'cavity.gyre.json');
  await after(cavity, 60);
  assert.ok((await brightness(cavity, [0, 1.95, 0.05])) > (await brightness(cavity, [0, 0.5, 0.05])) + 20, 'the lid drags what is next to it');
  viewer.noErrors(page);
  viewer.noErrors(cavity);
});

test('a dam breaks: its surface flows, particles show instead', async (t) => {
  const page = await open(t, 'dam.gyre.json');
  const before = await after(page, 1);
  const dry = await brightness(page, [0.5, 0.15, 0.5]);
  const flown = await after(page, 40);
  assert.ok(changed(before, flown) > 0.02, 'the picture stayed as it was');
  assert.ok(Math.abs((await brightness(page, [0.5, 0.15, 0.5])) - dry) > 8, 'no water where it flowed to');
  const surface = await page.evaluate(() => window.gyre.viewer.playback.frame.fluids[0].indices.length);
  assert.ok(surface > 300);
  await page.evaluate(() => window.gyre.overlay('particles', true));
  await settled(page);
  assert.ok(changed(flown, await page.screenshot()) > 0.01, 'particles look like the surface');
  viewer.noErrors(page);
});

test('the mouse stirs a flat gas, and going back takes it back', async (t) => {
  const page = await open(t, 'still.gyre.json', '&overlays=speed');
  await page.evaluate(() => window.gyre.advance(2));
  const fastest = () => page.evaluate(() => window.gyre.viewer.playback.frame.fluids[0].voxels.reduce((most, value, i) => (i % 4 === 3 ? Math.max(most, value) : most), 0));
  const before = { speed: await fastest(), hash: await page.evaluate(() => window.gyre.hash()) };
  const from = await page.evaluate(() => window.gyre.onPage(-0.4, 1, 0.05));
  const to = await page.evaluate(() => window.gyre.onPage(0.3, 1, 0.05));
  const camera = () => page.evaluate(() => window.gyre.viewer.stage.camera.position.toArray());
  const eye = await camera();
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move(to.x, to.y, { steps: 4 });
  await settled(page);
  await page.evaluate(() => window.gyre.advance(2));
  assert.ok((await fastest()) > before.speed + 100, `stirred, the fastest is ${await fastest()} of 255, before ${before.speed}`);
  assert.deepEqual(await camera(), eye, 'the view turned');
  await page.mouse.up();
  await settled(page);
  await page.evaluate(() => window.gyre.seek(2));
  await page.evaluate(() => window.gyre.seek(1));
  await page.evaluate(() => window.gyre.advance(1));
  assert.equal(await page.evaluate(() => window.gyre.hash()), before.hash);
  viewer.noErrors(page);
});

test('a recording with commands shows its smoke', async (t) => {
  const page = await open(t, 'smoke.gyrec');
  const mean = () => page.evaluate(() => window.gyre.viewer.playback.frame.fluids[0]?.voxels.filter((_, i) => i % 4 === 0).reduce((sum, value) => sum + value, 0) ?? 0);
  await page.evaluate(() => window.gyre.seek(5));
  await settled(page);
  const early = await mean();
  await page.evaluate(() => window.gyre.seek(40));
  await settled(page);
  assert.ok(early > 0 && (await mean()) > 1.2 * early);
  viewer.noErrors(page);
});
