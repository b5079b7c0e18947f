// The mouse: a dragged body follows it, a click selects, the space bar throws.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { settled, viewerTests } from '../setup.mjs';

const viewer = viewerTests();

async function onPage(page, name) {
  return page.evaluate((body) => window.gyre.onPage(...window.gyre.position(body)), name);
}

async function topBox(page) {
  return page.evaluate(() => {
    const names = window.gyre.names().filter((name) => name !== 'ground' && window.gyre.position(name));
    return names.reduce((a, b) => (window.gyre.position(b)[1] > window.gyre.position(a)[1] ? b : a));
  });
}

test('a dragged body follows the mouse', async (t) => {
  const page = await viewer.open(t, 'scene=stack&play=0&quality=low', { width: 800, height: 600 });
  await page.evaluate(() => window.gyre.advance(2));
  await settled(page);
  const name = await topBox(page);
  const start = await onPage(page, name);
  await page.mouse.move(start.x, start.y);
  await page.mouse.down();
  await page.evaluate(() => window.gyre.play());
  const goal = { x: start.x + 150, y: start.y - 20 };
  await page.mouse.move(start.x + 75, start.y - 10, { steps: 4 });
  await page.mouse.move(goal.x, goal.y, { steps: 4 });
  const from = await page.evaluate(() => window.gyre.step);
  await page.waitForFunction((step) => window.gyre.step > step + 150, from, { timeout: 60000 });
  const held = await onPage(page, name);
  assert.ok(Math.hypot(held.x - goal.x, held.y - goal.y) < 45, `the body is at ${held.x}, ${held.y} instead of ${goal.x}, ${goal.y}`);
  await page.mouse.up();
  const released = await page.evaluate(() => window.gyre.step);
  await page.waitForFunction((step) => window.gyre.step > step + 100, released, { timeout: 60000 });
  const fallen = await onPage(page, name);
  assert.ok(fallen.y > held.y + 30, 'the body that was let go does not fall');
  assert.ok(!(await page.evaluate(() => window.gyre.names())).includes('hand'), 'the hand is still there');
  viewer.noErrors(page);
});

test('a click selects and the inspector tells about the body', async (t) => {
  const page = await viewer.open(t, 'scene=stack&play=0&quality=low', { width: 1280, height: 720 });
  await settled(page);
  const name = await topBox(page);
  const { x, y } = await onPage(page, name);
  await page.mouse.click(x, y);
  await page.locator('.body-head h2').waitFor();
  assert.equal(await page.locator('.body-head h2').innerText(), name);
  const text = await page.locator('.panel-body').innerText();
  assert.match(text, /Mass\s+[\d.]+ kg/);
  assert.ok((await page.locator('.words').innerText()).length > 20, 'no words on why it is awake');
  await page.keyboard.press('Escape');
  await page.keyboard.press('Escape');
  assert.equal(await page.evaluate(() => window.gyre.selected), null);
  viewer.noErrors(page);
});

test('the space bar throws what the panel says', async (t) => {
  const page = await viewer.open(t, 'scene=stack&play=0&quality=low', { width: 800, height: 600 });
  const before = await page.evaluate(() => window.gyre.names().length);
  const { x, y } = await onPage(page, await topBox(page));
  await page.mouse.move(x, y);
  await page.keyboard.press('Space');
  await page.waitForFunction((count) => window.gyre.names().length === count + 1, before);
  assert.ok((await page.evaluate(() => window.gyre.names())).includes('ball 1'));
  viewer.noErrors(page);
});

test('what is thrown has a name of its own', async (t) => {
  const page = await viewer.open(t, 'scene=machines&play=0&quality=low', { width: 640, height: 400 });
  for (let i = 0; i < 2; i++) {
    await page.evaluate(async () => {
      window.gyre.command({ do: 'throw', what: 'ball', size: 0.2, density: 1000, from: [0, 9 + 2 * window.gyre.step, 0], velocity: [0, 0, 0] });
      await window.gyre.advance(1);
    });
  }
  const names = await page.evaluate(() => window.gyre.names());
  assert.equal(new Set(names).size, names.length, `two of one name: ${names}`);
  viewer.noErrors(page);
});

test('B puts a body down under the pointer', async (t) => {
  const page = await viewer.open(t, 'scene=stack&play=0&quality=low', { width: 800, height: 600 });
  await settled(page);
  const name = await topBox(page);
  const [, top] = await page.evaluate((body) => window.gyre.position(body), name);
  const { x, y } = await onPage(page, name);
  await page.mouse.move(x, y);
  await page.keyboard.press('b');
  await page.waitForFunction(() => window.gyre.names().includes('ball 1'));
  const [, height] = await page.evaluate(() => window.gyre.position('ball 1'));
  assert.ok(height > top - 0.6 && height < top + 1.5, `put down at ${height} m, the box is at ${top} m`);
  viewer.noErrors(page);
});
