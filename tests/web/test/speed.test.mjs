// Ten thousand boxes: the page shows them, in a handful of draw calls, and stays alive while they are computed.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { manyBoxes } from '../many_boxes.mjs';
import { settled, viewerTests } from '../setup.mjs';

const viewer = viewerTests({ files: { 'many.gyre.json': manyBoxes(25, 16) } });

test('ten thousand boxes', async (t) => {
  const page = await viewer.open(t, 'file=/files/many.gyre.json&play=0&quality=low', { width: 480, height: 300 });
  assert.equal(await page.evaluate(() => window.gyre.names().length), 10001);
  await page.evaluate(() => window.gyre.advance(3));
  await settled(page);
  const { calls, triangles } = await page.evaluate(() => window.gyre.viewer.stage.renderer.info.render);
  assert.ok(calls < 12, `${calls} draw calls`);
  assert.ok(triangles > 10000 * 12, `${triangles} triangles`);
  viewer.noErrors(page);
});
