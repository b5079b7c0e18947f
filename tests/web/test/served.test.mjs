// A recording in the page without the engine: gyre view decodes it, and the bodies move as they were recorded. No WebAssembly.
import assert from 'node:assert/strict';
import { execFileSync, spawn } from 'node:child_process';
import { mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { launch, newPage, ready } from '../browser.mjs';
import { root, settled } from '../setup.mjs';

const gyre = process.env.GYRE_CLI ?? join(root, 'build/release/bin/gyre');
const page_folder = join(root, 'web/viewer/dist-recordings');
const STEPS = 200; // three groups of frames: two are fetched as the page opens
const ROUNDING = 1e-5; // m: the page draws 32-bit places

const folder = mkdtempSync(join(tmpdir(), 'gyre-served-'));
const recording = join(folder, 'run.gyrec');
let browser;
before(async () => {
  browser = await launch();
});
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true });
});

// Hulls, meshes, height fields, joints and colours: everything that a page must be told. What it should show is read by the decoder
// that was written from docs/recording.md alone.
execFileSync(gyre, ['simulate', join(root, 'scenes/showcase.gyre.json'), '--steps', `${STEPS}`, '--record', recording, '--quiet']);
const table = execFileSync('python3', [join(root, 'tools/recording_to_csv.py'), recording], { encoding: 'utf8', maxBuffer: 1e9 });
const [titles, ...rows] = table.trim().split('\n').map((line) => line.split(','));
const columns = ['step', 'body', 'px', 'py', 'pz'].map((title) => titles.indexOf(title));
const places = new Map(); // step to name to place
for (const row of rows) {
  const [step, name, ...place] = columns.map((column) => row[column]);
  if (!places.has(Number(step))) places.set(Number(step), new Map());
  places.get(Number(step)).set(name, place.map(Number));
}

// gyre view with a file; resolves to its address.
async function view(t, file) {
  const server = spawn(gyre, ['view', file, '--port', '0', '--no-open', '--viewer', page_folder], { stdio: ['ignore', 'pipe', 'ignore'] });
  t.after(() => server.kill('SIGINT'));
  return new Promise((resolve, reject) => {
    server.stdout.once('data', (text) => resolve(String(text).trim()));
    server.once('exit', (code) => reject(new Error(`gyre view ended with ${code}`)));
  });
}

async function open(t, address) {
  const page = await newPage(browser, { width: 900, height: 600 });
  t.after(() => page.context().close());
  await page.goto(address);
  return page;
}

// The largest difference of any coordinate to what was recorded.
async function farthest(page, step) {
  const shown = await page.evaluate(() => ({ poses: window.gyre.poses(), names: window.gyre.names() }));
  assert.equal(shown.names.length, places.get(step).size);
  return Math.max(...shown.names.map((name, row) => {
    const place = places.get(step).get(name);
    assert.ok(place, `no body ${name}`);
    return Math.max(...place.map((value, i) => Math.abs(value - shown.poses[7 * row + i])));
  }));
}

test('the page has no WebAssembly', () => {
  for (const file of readdirSync(page_folder, { recursive: true })) {
    assert.ok(!file.endsWith('.wasm'), file);
    if (file.endsWith('.js')) assert.ok(!readFileSync(join(page_folder, file), 'utf8').includes('WebAssembly'), file);
  }
});

test('a recording that the server decodes plays forward and back', async (t) => {
  const page = await open(t, `${await view(t, recording)}&play=0&quality=low`);
  await ready(page);
  assert.equal(await page.evaluate(() => window.gyre.scene.live), false);
  assert.equal(await page.evaluate(() => window.gyre.scene.lastStep), STEPS);
  await settled(page);
  const first = await page.screenshot();
  for (const step of [0, STEPS, 94, 93, 92, 7]) {
    await page.evaluate((wanted) => window.gyre.seek(wanted), step);
    const off = await farthest(page, step);
    assert.ok(off < ROUNDING, `step ${step} is ${off} m off`);
  }
  await page.evaluate(() => window.gyre.play());
  await page.waitForFunction((last) => window.gyre.step === last, STEPS, { timeout: 60000 });
  assert.ok((await farthest(page, STEPS)) < ROUNDING);
  const moved = [...places.get(STEPS)].filter(([name, place]) => Math.hypot(...place.map((value, i) => value - places.get(0).get(name)[i])) > 0.1);
  assert.ok(moved.length > 20, `${moved.length} bodies moved`);
  await settled(page);
  const last = await page.screenshot();
  assert.ok(!first.equals(last));
  assert.match(await page.evaluate(() => window.gyre.scene.posesOnly), /without the engine.*\.\/run --live/s);
  assert.deepEqual(page.errors, []);
});

test('a scene in the page without the engine is refused in words', async (t) => {
  const page = await open(t, await view(t, join(root, 'scenes/stack.gyre.json')));
  const notice = page.getByRole('alertdialog');
  await notice.waitFor();
  assert.match(await notice.innerText(), /built without the engine.*\.\/run --live/s);
});

test('when the server has ended, the page says so', async (t) => {
  const server = spawn(gyre, ['view', recording, '--port', '0', '--no-open', '--viewer', page_folder], { stdio: ['ignore', 'pipe', 'ignore'] });
  const address = await new Promise((resolve) => server.stdout.once('data', (text) => resolve(String(text).trim())));
  const page = await open(t, `${address}&play=0&quality=low`);
  await ready(page);
  await page.evaluate(() => window.gyre.viewer.playback.idle());
  const ended = new Promise((resolve) => server.once('exit', resolve));
  server.kill('SIGINT');
  await ended;
  await page.evaluate((last) => window.gyre.viewer.playback.seek(last), STEPS);
  const notice = page.getByRole('alertdialog');
  await notice.waitFor();
  assert.match(await notice.innerText(), /server does not answer/);
});
