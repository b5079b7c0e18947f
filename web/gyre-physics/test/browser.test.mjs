// The package in a real browser, from a bare <script type=module>: the same hashes, and the best build that the page allows. Needs Chromium
// (Debian's, or CHROMIUM) and playwright-core.
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import test, { after, before } from 'node:test';

import { made, nativeHash, nativeProgram, root, sceneNames, sceneText } from './kit.mjs';

const chromium = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser'].find((path) => path && existsSync(path));
const playwright = await import('playwright-core').catch(() => null);
const skip = !chromium ? 'no Chromium: install Debian\'s, or set CHROMIUM' : !playwright ? 'playwright-core is not installed' : !nativeProgram ? 'no native gyre to compare with' : false;

const types = { '.js': 'text/javascript', '.json': 'application/json', '.obj': 'text/plain' };
const page = '<!doctype html><title>Gyre</title><script type=module>import * as gyre from "/web/gyre-physics/dist/index.js"; window.gyre = gyre;</script>';
let server, browser, address;

/** The repository over HTTP; below /isolated/ with the headers that threads need. */
function answer(request, response) {
  const isolated = request.url.startsWith('/isolated/');
  const path = normalize(decodeURIComponent(request.url.replace('/isolated', '').split('?')[0]));
  // Modules that an isolated page loads must allow it.
  const headers = { 'Cross-Origin-Resource-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp' };
  if (isolated) headers['Cross-Origin-Opener-Policy'] = 'same-origin';
  if (path === '/' || path === '/page') {
    response.writeHead(200, { ...(isolated ? headers : {}), 'Content-Type': 'text/html' }).end(page);
  } else if (existsSync(join(root, path))) {
    response.writeHead(200, { ...headers, 'Content-Type': types[extname(path)] ?? 'application/octet-stream' }).end(readFileSync(join(root, path)));
  } else {
    response.writeHead(404).end();
  }
}

before(async () => {
  if (skip) return;
  server = createServer(answer).listen(0, '127.0.0.1');
  await new Promise((resolve) => server.on('listening', resolve));
  address = `http://127.0.0.1:${server.address().port}`;
  browser = await playwright.chromium.launch({ executablePath: chromium, args: ['--no-sandbox', '--disable-gpu'] });
});
after(async () => {
  await browser?.close();
  server?.close();
});

async function open(path) {
  const tab = await browser.newPage();
  const errors = [];
  tab.on('pageerror', (error) => errors.push(String(error)));
  tab.on('console', (message) => ['error', 'warning'].includes(message.type()) && !/favicon/.test(message.location().url) && errors.push(message.text()));
  await tab.goto(address + path);
  await tab.waitForFunction('window.gyre !== undefined');
  return { tab, errors };
}

/** Runs in the page. */
async function hashOf({ text, build, steps }) {
  window.engines ??= {};
  const engine = (window.engines[build ?? 'best'] ??= await window.gyre.load({ build }));
  const files = {};
  for (const [, name] of text.matchAll(/"file": *"([^"]+)"/g)) files[name] = await (await fetch(`/scenes/${name}`)).text();
  const scene = engine.openScene(text, { files, threads: engine.maxThreads });
  for (let i = 0; i < steps; ++i) scene.step();
  const hash = scene.hash().toString(16).padStart(16, '0');
  scene.dispose();
  return { build: engine.build, hash };
}

for (const [path, build, chosen] of [['/page', undefined, 'simd'], ['/page', 'plain', 'plain'], ['/isolated/page', undefined, 'threads']]) {
  test(`${path}, ${build ?? 'the best build'}`, { skip: skip || (made(chosen) ? false : `the build '${chosen}' is not made`) }, async (t) => {
    const { tab, errors } = await open(path);
    // Every scene once; in the slower builds those that mix the most.
    const names = chosen === 'simd' ? sceneNames : sceneNames.filter((name) => /^(machines|bowling|height_field|card_house)/.test(name));
    for (const name of names) {
      await t.test(name, async () => {
        const steps = 600;
        const found = await tab.evaluate(hashOf, { text: sceneText(name), build, steps });
        assert.deepEqual(found, { build: chosen, hash: nativeHash(name, steps) });
      });
    }
    assert.deepEqual(errors, []);
    await tab.close();
  });
}

test('a page that is not isolated is told what threads need', { skip }, async () => {
  const { tab } = await open('/page');
  const message = await tab.evaluate(() => window.gyre.load({ build: 'threads' }).catch((error) => error.message));
  assert.match(message, /cross-origin isolated.*Cross-Origin-Opener-Policy/);
  await tab.close();
});
