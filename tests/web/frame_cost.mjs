// What a picture of ten thousand moving boxes costs the page's own thread, without the graphics card's part; and how long the worker
// takes to answer with a frame when it has no step to do. Prints medians, for docs/decisions/viewer.md.
//   node frame_cost.mjs
import { launch, newPage, ready } from './browser.mjs';
import { manyBoxes } from './many_boxes.mjs';
import { serve } from './server.mjs';
import { dist } from './setup.mjs';

const server = await serve(dist, { 'many.gyre.json': manyBoxes(25, 16) });
const browser = await launch();
const page = await newPage(browser, { width: 64, height: 48 });
await page.goto(`${server.address}?file=/files/many.gyre.json&play=0&quality=low`);
await ready(page);
const costs = await page.evaluate(async () => {
  const { viewer } = window.gyre;
  const { playback, bodies, stage } = viewer;
  const costs = {};
  const timed = async (name, work) => {
    const begin = performance.now();
    await work();
    (costs[name] ??= []).push(performance.now() - begin);
  };
  await window.gyre.configure({ threads: 1 });
  await window.gyre.advance(3);
  const from = playback.frame;
  await window.gyre.advance(1);
  const to = playback.frame;
  for (let i = 0; i < 80; i++) await timed('the answer of the worker', () => playback.client.request('advance', { steps: 0, commands: [] }));
  window.requestAnimationFrame = () => 0; // from here on only what is called here is drawn
  await new Promise((done) => setTimeout(done, 300));
  const gl = stage.renderer.getContext();
  const pixel = new Uint8Array(4);
  for (let i = 0; i < 200; i++) {
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); // waits until the picture before is drawn
    await timed('taking a frame over', () => viewer.receive(to, null, false));
    await timed('placing the boxes', () => bodies.place(from, to, ((i % 50) + 0.5) / 50));
    await timed('drawing calls', () => stage.render());
    await timed('painting anew (by speed or sleep)', () => bodies.paint(to));
    if (i === 49) for (const name of Object.keys(costs).slice(1)) costs[name].length = 0; // compiled by now
  }
  return costs;
});
for (const [name, times] of Object.entries(costs)) {
  times.sort((a, b) => a - b);
  console.log(`${name}: median ${times[times.length >> 1].toFixed(2)} ms, 95 % below ${times[Math.floor(0.95 * times.length)].toFixed(2)} ms`);
}
await browser.close();
await server.close();
