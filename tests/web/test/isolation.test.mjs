// A server that does not isolate the page (a plain folder on the web): the engine runs on one thread, with the same bits, and says so.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { viewerTests } from '../setup.mjs';

const plain = viewerTests({ isolated: false });
const isolated = viewerTests();
const run = async (page) => {
  await page.evaluate(() => window.gyre.advance(60));
  return page.evaluate(async () => ({ isolated: crossOriginIsolated, threads: window.gyre.scene.choices.maxThreads, hash: await window.gyre.hash(), engine: window.gyre.scene.engine }));
};

test('a page that is not isolated has the same bits', async (t) => {
  const query = 'scene=half_wood_half_lead&play=0&quality=low';
  const page = await plain.open(t, query, { width: 640, height: 400 });
  const here = await run(page);
  assert.equal(here.isolated, false);
  assert.equal(here.threads, 1);
  assert.match(here.engine, /threads need a page that is cross-origin isolated/);
  plain.noErrors(page);
  const there = await run(await isolated.open(t, query, { width: 640, height: 400 }));
  assert.equal(there.isolated, true);
  assert.equal(there.hash, here.hash);
});
