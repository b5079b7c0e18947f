// The live scenes of the course: each opens as a file, without a server, runs, and moves. Every slider at both of its ends makes a scene
// that the engine opens and steps.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { launch, newPage, ready } from '../browser.mjs';

const root = resolve(import.meta.dirname, '../../..');
const script = join(root, 'web/course/dist/live.js');
const pages = readdirSync(join(root, 'docs/course')).filter((name) => name.endsWith('.md'));
const named = pages.flatMap((name) => [...readFileSync(join(root, 'docs/course', name), 'utf8').matchAll(/data-lesson="(\w+)"/g)].map((match) => match[1]));
const work = mkdtempSync(join(tmpdir(), 'gyre-course-'));
after(() => rmSync(work, { recursive: true }));

test('every page of the course has a live scene', () => {
  for (const page of pages.filter((name) => name !== 'index.md')) {
    assert.match(readFileSync(join(root, 'docs/course', page), 'utf8'), /<div data-lesson="\w+">/, page);
  }
});

test('every slider at its ends makes a scene that opens', async () => {
  const bundle = join(work, 'lessons.mjs');
  const esbuild = join(root, 'web/gyre-physics/node_modules/.bin/esbuild');
  execFileSync(esbuild, [join(root, 'web/course/src/lessons/all.ts'), '--bundle', '--format=esm', `--outfile=${bundle}`, '--log-level=warning']);
  const { lessons } = await import(pathToFileURL(bundle).href);
  assert.deepEqual(Object.keys(lessons).sort(), [...named].sort(), 'each lesson has one page');
  const { load } = await import(pathToFileURL(join(root, 'web/gyre-physics/dist/index.js')).href);
  const gyre = await load();
  for (const [name, lesson] of Object.entries(lessons)) {
    const first = Object.fromEntries(lesson.sliders.map((slider) => [slider.name, slider.value]));
    const states = [first, ...lesson.sliders.flatMap(({ name: which, low, high }) => [{ ...first, [which]: low }, { ...first, [which]: high }])];
    for (const state of states) {
      const scene = gyre.openScene(JSON.stringify(lesson.scene(state)), { file: `${name} ${JSON.stringify(state)}` });
      try {
        for (let i = 0; i < 3; ++i) scene.step();
      } catch (error) {
        // An explicit scheme may explode, which the engine says in words; a page then shows them.
        assert.match(String(error), /no longer finite|cannot follow/, name);
      }
      scene.dispose();
    }
  }
});

// One page for all: what it compiled for one scene it need not compile again.
let browser, page;
before(async () => {
  browser = await launch();
  page = await newPage(browser, { width: 240, height: 240, theme: 'light' });
});
after(() => browser?.close());

for (const name of named) {
  test(`${name} runs`, { skip: existsSync(script) ? false : 'web/course/dist/live.js is not built' }, async () => {
    page.errors.length = 0;
    const file = join(work, `${name}.html`);
    writeFileSync(
      file,
      `<!doctype html><meta charset="utf-8"><style>.gyre-stage { height: 90px }</style><body><div data-lesson="${name}"></div><script defer src="${pathToFileURL(script)}"></script>`,
    );
    await page.goto(`${pathToFileURL(file)}?quality=low`);
    await ready(page);
    // The velocity tells of motion in fluids alone, where no body moves.
    const state = () => [...window.gyre.poses(), ...window.gyre.allVertices(), ...window.gyre.viewer.playback.frame.fluids.flatMap(({ voxels }) => [...voxels])];
    await page.evaluate(() => window.gyre.pause());
    const before = await page.evaluate(state);
    await page.evaluate(() => window.gyre.advance(20));
    const after = await page.evaluate(state);
    assert.ok(after.some((value, i) => value !== before[i]), 'nothing moved');
    assert.ok(after.every(Number.isFinite), 'a number is not finite');
    assert.equal(await page.locator('.gyre-message').textContent(), '');
    assert.deepEqual(page.errors, []);
    // A slider starts the scene anew.
    const step = await page.evaluate(() => window.gyre.step);
    assert.ok(step >= 20);
    await page.evaluate(async () => {
      const one = document.querySelector('.gyre-slider input');
      one.value = one.max;
      one.dispatchEvent(new Event('change'));
      await window.gyreLesson.live.restart();
      window.gyre.pause();
    });
    assert.ok((await page.evaluate(() => window.gyre.step)) < step, 'the scene did not start anew');
    assert.ok(JSON.parse(await page.locator('.gyre-scene').textContent()).gyre_scene === 1);
    assert.deepEqual(page.errors, []);
  });
}
