// Ropes, cloths and solids on the page: drawn where they are, of recordings forward and back; in live scenes the mouse drags them.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { BodyType, load, sphere } from '../../../web/gyre-physics/dist/index.js';
import { changed } from '../pictures.mjs';
import { root, settled, viewerTests } from '../setup.mjs';

const STEPS = 40;
const ACCURACY = 1e-4; // m, what a recorder keeps by default; and some rounding to 32 bits

// A cloth over a ball, a rope and a box of jelly; half way the rope is taken away.
const gyre = await load({ build: 'simd' });
const world = gyre.createWorld();
world.addBody({ type: BodyType.fixed }, { geometry: sphere({ radius: 0.5 }) });
const softs = {
  sheet: world.addCloth({ grid: { size: [1.6, 1.6], cells: [12, 12] }, pose: { position: [0, 0.6, 0] } }),
  line: world.addRope({ points: [[-2, 1, 0], [-1, 1, 0]], segments: 12 }),
  jelly: world.addSolid({ box: { halfExtents: [0.3, 0.3, 0.3], cells: [2, 2, 2] }, pose: { position: [1.5, 0.5, 0] } }),
};
world.pin(softs.line, 0);
const recorder = world.record({ commands: false });
for (const [name, id] of Object.entries(softs)) recorder.labelSoft(id, name, name === 'sheet' ? { red: 255, green: 40, blue: 40 } : []);
const places = [];
for (let i = 0; i <= STEPS; i++) {
  if (i === STEPS / 2) world.removeSoft(softs.line);
  if (i > 0) world.step(1 / 60);
  places.push(Object.fromEntries(Object.entries(softs).filter(([, id]) => world.softExists(id)).map(([name, id]) => {
    const { x, y, z } = world.vertices(id);
    return [name, Array.from(x, (_, k) => [x[k], y[k], z[k]]).flat()];
  })));
}
const whole = Buffer.from(recorder.finish());
gyre.close();

const scene = Buffer.from(JSON.stringify({
  gyre_scene: 1,
  name: 'soft',
  bodies: [
    { name: 'ground', type: 'static', shapes: [{ type: 'plane' }] },
    { name: 'weight', position: [-2, 1, 0], mass: 1, shapes: [{ type: 'sphere', radius: 0.2 }] },
  ],
  ropes: [{ name: 'line', points: [[-2, 2, 0], [-2, 1.2, 0]], segments: 8, attach: [{ end: 0, body: 'world' }, { end: 1, body: 'weight' }] }],
  cloths: [{ name: 'flag', grid: { size: [1.2, 0.8], cells: [12, 8] }, position: [0, 2, 0], pinned: [0, 12] }],
  soft_bodies: [{ name: 'jelly', box: { half_extents: [0.4, 0.4, 0.4], cells: [3, 3, 3] }, position: [2, 0.4, 0] }],
}));

// A sheet whose left half begins twice as long, beside a rope that is not drawn out, and a jelly, which alone has stress.
const drawn = Buffer.from(JSON.stringify({
  gyre_scene: 1,
  name: 'drawn',
  world: { gravity: [0, 0, 0] },
  view: { eye: [0, 0, 6], target: [0, 0, 0] },
  cloths: [{
    name: 'sheet', grid: { size: [2, 1], cells: [2, 1] }, color: '#808080', orientation: [0.70710678, 0, 0, 0.70710678],
    state: { positions: [[-2, 0.5, 0], [0, 0.5, 0], [1, 0.5, 0], [-2, -0.5, 0], [0, -0.5, 0], [1, -0.5, 0]] },
  }],
  ropes: [{ name: 'line', points: [[-1, 1.2, 0], [1, 1.2, 0]], segments: 4, radius: 0.1, color: '#808080' }],
  soft_bodies: [{ name: 'jelly', box: { half_extents: [0.3, 0.3, 0.3], cells: [2, 2, 2] }, position: [0, -1.2, 0], color: '#808080' }],
}));

const banner = readFileSync(join(root, 'scenes/soft/tearing_banner.gyre.json'));
const viewer = viewerTests({ files: { 'soft.gyrec': whole, 'soft.gyre.json': scene, 'banner.gyre.json': banner, 'drawn.gyre.json': drawn } });

test('a recording shows the vertices forward and back', async (t) => {
  const page = await viewer.open(t, 'file=/files/soft.gyrec&play=0&quality=low', { width: 640, height: 400 });
  for (const step of [0, STEPS, 19, 18, 21, 7]) {
    await page.evaluate((wanted) => window.gyre.seek(wanted), step);
    await settled(page);
    for (const name of Object.keys(softs)) {
      const shown = await page.evaluate((wanted) => window.gyre.vertices(wanted), name);
      const expected = places[step][name];
      if (!expected) {
        assert.equal(shown, null, `${name} is still there at step ${step}`);
        continue;
      }
      assert.equal(shown.length, expected.length);
      const off = Math.max(...expected.map((value, i) => Math.abs(value - shown[i])));
      assert.ok(off < 1.2 * ACCURACY, `${name} at step ${step} is ${off} m off`);
    }
  }
  assert.equal(await page.evaluate(() => window.gyre.stats.softs), 3);
  viewer.noErrors(page);
});

test('a cloth has its colour, and the picture follows its motion', async (t) => {
  const page = await viewer.open(t, 'file=/files/soft.gyrec&play=0&quality=low&theme=light', { width: 640, height: 400 });
  const corner = () => page.evaluate(() => window.gyre.onPage(...window.gyre.vertices('sheet').slice(0, 3)));
  const middle = () => page.evaluate(() => window.gyre.onPage(...window.gyre.vertices('sheet').slice(3 * 84, 3 * 84 + 3)));
  await page.evaluate(() => window.gyre.seek(0));
  await settled(page);
  const before = await page.screenshot();
  const { x, y } = await middle();
  const [red, green, blue] = await color(page, x, y);
  assert.ok(red > 1.5 * green && red > 1.5 * blue, `the cloth has colour ${red}, ${green}, ${blue}`);
  const high = await corner();
  await page.evaluate((last) => window.gyre.seek(last), STEPS);
  await settled(page);
  assert.ok((await corner()).y > high.y + 20, 'the corner hangs lower');
  assert.ok(changed(before, await page.screenshot()) > 0.02, 'the picture stayed as it was');
  viewer.noErrors(page);
});

const middleOf = (page, name) =>
  page.evaluate((wanted) => {
    const vertices = window.gyre.vertices(wanted);
    const at = 3 * Math.floor(vertices.length / 6);
    return vertices.slice(at, at + 3);
  }, name);

test('the mouse drags ropes, cloths and solids, and lets them go', async (t) => {
  const page = await viewer.open(t, 'file=/files/soft.gyre.json&play=0&quality=low', { width: 800, height: 500 });
  await page.evaluate(() => window.gyre.advance(20));
  const pinned = await page.evaluate(() => window.gyre.vertices('flag').slice(0, 3));
  for (const name of ['jelly', 'flag', 'line']) {
    await settled(page);
    const before = await middleOf(page, name);
    const { x, y } = await page.evaluate((place) => window.gyre.onPage(...place), before);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 30, y - 60, { steps: 3 });
    await settled(page);
    await page.evaluate(() => window.gyre.advance(20));
    const after = await middleOf(page, name);
    assert.ok(after[1] > before[1] + 0.05, `${name} was pulled up from ${before[1]} m to ${after[1]} m`);
    assert.ok((await page.evaluate(() => window.gyre.names())).includes('hand'));
    await page.mouse.up();
    await settled(page);
    await page.evaluate(() => window.gyre.advance(1));
    assert.deepEqual(await page.evaluate(() => window.gyre.names()), ['ground', 'weight']);
  }
  // The hand never takes hold of vertices that the scene pins, so they are still there.
  assert.deepEqual(await page.evaluate(() => window.gyre.vertices('flag').slice(0, 3)), pinned);
  const last = await page.evaluate(() => window.gyre.step);
  const hash = await page.evaluate(() => window.gyre.hash());
  await page.evaluate(() => window.gyre.seek(30));
  await page.evaluate((step) => window.gyre.seek(step), last);
  assert.equal(await page.evaluate(() => window.gyre.hash()), hash);
  viewer.noErrors(page);
});

test('a click on a cloth tells of it, and it can be removed', async (t) => {
  const page = await viewer.open(t, 'file=/files/soft.gyre.json&play=0&quality=low', { width: 1280, height: 720 });
  await settled(page);
  const { x, y } = await page.evaluate((place) => window.gyre.onPage(...place), await middleOf(page, 'flag'));
  await page.mouse.click(x, y);
  await page.locator('.body-head h2').waitFor();
  assert.equal(await page.locator('.body-head h2').innerText(), 'flag');
  const text = await page.locator('.panel-body').innerText();
  assert.match(text, /Vertices\s+117/);
  assert.match(text, /Mass\s+[\d.]+ kg/);
  await page.keyboard.press('Delete');
  await page.waitForFunction(() => window.gyre.vertices('flag') === null);
  assert.equal(await page.evaluate(() => window.gyre.stats.softs), 2);
  viewer.noErrors(page);
});

test('a cloth that tears is drawn anew, and is whole again where the scene goes back', async (t) => {
  const page = await viewer.open(t, 'file=/files/banner.gyre.json&play=0&quality=low', { width: 480, height: 300 });
  const drawn = () => page.evaluate(() => window.gyre.vertices('banner').length / 3);
  await settled(page);
  const whole = await drawn();
  await page.evaluate(() => window.gyre.advance(30));
  await settled(page);
  const torn = await drawn();
  assert.ok(torn > whole, `${torn} vertices, ${whole} at the start`);
  await page.evaluate(() => window.gyre.seek(2));
  await settled(page);
  assert.equal(await drawn(), whole);
  await page.evaluate(() => window.gyre.seek(30));
  await settled(page);
  assert.equal(await drawn(), torn);
  viewer.noErrors(page);
});

test('strain and stress are colours on a key, on and off', async (t) => {
  const page = await viewer.open(t, 'file=/files/drawn.gyre.json&play=0&quality=low&theme=light', { width: 640, height: 400 });
  await settled(page);
  const at = async (place) => {
    const { x, y } = await page.evaluate((where) => window.gyre.onPage(...where), place);
    return color(page, x, y);
  };
  const isGrey = ([red, green, blue]) => Math.max(red, green, blue) - Math.min(red, green, blue) < 40;
  const key = () => page.evaluate(() => document.querySelector('.reading-key')?.getAttribute('aria-label') ?? null);
  const places = { left: [-1.6, 0.2, 0], right: [0.9, 0.2, 0], line: [0.1, 1.2, 0.1] };
  assert.ok(isGrey(await at(places.left)));
  assert.equal(await key(), null);
  await page.evaluate(() => window.gyre.overlay('strain', true));
  await settled(page);
  const [left, right, line] = [await at(places.left), await at(places.right), await at(places.line)];
  assert.ok(left[0] > left[2] + 60, `drawn out: ${left}`);
  assert.ok(right[2] > right[0] + 40, `at rest: ${right}`);
  assert.ok(line[2] > line[0] + 40, `the rope at rest: ${line}`);
  assert.equal(await key(), 'strain from 0 % to 100 %');
  await page.evaluate(() => window.gyre.overlay('stress', true));
  await settled(page);
  assert.ok(isGrey(await at(places.left)), 'a sheet has no stress to show');
  assert.match(await key(), /^stress from 0 Pa to/);
  await page.evaluate(() => window.gyre.overlay('stress', false));
  await settled(page);
  assert.equal(await key(), null);
  viewer.noErrors(page);
});

// Of the picture, 0 to 255 each.
async function color(page, x, y) {
  return page.evaluate(([px, py]) => {
    const { stage } = window.gyre.viewer;
    const gl = stage.renderer.getContext();
    const canvas = stage.renderer.domElement;
    const box = canvas.getBoundingClientRect();
    stage.render();
    const out = new Uint8Array(4);
    gl.readPixels(Math.round(((px - box.left) / box.width) * canvas.width), Math.round((1 - (py - box.top) / box.height) * canvas.height), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, out);
    return [...out];
  }, [x, y]);
}
