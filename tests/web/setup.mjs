// What every test file begins with: one browser, one server, and pages that are closed behind each test.
import assert from 'node:assert/strict';
import { join, resolve } from 'node:path';
import { after, before } from 'node:test';
import { launch, newPage, ready } from './browser.mjs';
export { ready };
import { serve } from './server.mjs';

export const root = resolve(import.meta.dirname, '../..');
export const dist = join(root, 'web/viewer/dist');

export function viewerTests({ files = {}, isolated = true } = {}) {
  const state = {};
  before(async () => {
    state.server = await serve(dist, files, { isolated });
    state.browser = await launch();
  });
  after(async () => {
    await state.browser?.close();
    await state.server?.close();
  });
  return {
    // A page at /?query. With `wait`, until its scene is open; the motion is off, so that pictures are the same every time.
    async open(t, query = '', { wait = true, ...options } = {}) {
      const page = await newPage(state.browser, options);
      t.after(() => page.context().close());
      await page.goto(`${state.server.address}?${query}`);
      if (wait) await ready(page);
      return page;
    },
    // A page without an error, whatever it did.
    noErrors(page) {
      assert.deepEqual(page.errors, []);
    },
  };
}

// Everything that a frame changes is on the page, and the picture is drawn: reading a pixel waits for the renderer, and the frames
// after it bring the picture to the screen.
export async function settled(page) {
  await page.evaluate(async () => {
    const frames = async (count) => {
      for (let i = 0; i < count; i++) await new Promise((done) => requestAnimationFrame(done));
    };
    const { playback, stage } = window.gyre.viewer;
    await playback.idle();
    await document.fonts.ready;
    await frames(3);
    const gl = stage.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    await frames(2);
  });
}
