// How it looks: the page in dark, light and on a phone, its panels, and every overlay, against stored pictures.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { changed, comparePicture } from '../pictures.mjs';
import { settled, viewerTests } from '../setup.mjs';

const viewer = viewerTests();

// Of the page, or of a part of it. Times and pictures a second are other numbers each time.
async function picture(page, part) {
  await page.evaluate(() => document.querySelectorAll('.facts').forEach((facts) => (facts.style.visibility = 'hidden')));
  await page.mouse.move(2, 300);
  await settled(page);
  return part ? page.locator(part).screenshot() : page.screenshot();
}

for (const theme of ['dark', 'light']) {
  test(`the page, ${theme}`, async (t) => {
    const page = await viewer.open(t, `scene=showcase&play=0&theme=${theme}`, { width: 800, height: 520, theme });
    await page.evaluate(() => window.gyre.advance(45));
    comparePicture(`page-${theme}`, await picture(page));
    viewer.noErrors(page);
  });
}

test('the page on a phone', async (t) => {
  const page = await viewer.open(t, 'scene=dominoes&play=0&theme=dark', { width: 360, height: 640, touch: true });
  await page.evaluate(() => window.gyre.advance(60));
  comparePicture('phone', await picture(page));
  await page.getByRole('button', { name: 'Overlays', exact: true }).click();
  comparePicture('phone-overlays', await picture(page));
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= 360, `the page is ${wide} pixels wide`);
  viewer.noErrors(page);
});

test('help, drawer and panels', async (t) => {
  const page = await viewer.open(t, 'scene=machines&play=0&theme=light&quality=low', { width: 1000, height: 700, theme: 'light' });
  await page.evaluate(() => window.gyre.advance(30));
  await page.evaluate(() => document.querySelector('#stage').remove()); // the panels let what is behind them through
  await page.keyboard.press('?');
  comparePicture('help', await picture(page, '.help'));
  await page.keyboard.press('Escape');
  await page.keyboard.press('w');
  comparePicture('panel-world', await picture(page, '.side-panel'));
  await page.keyboard.press('s');
  await page.locator('.scene-card img').first().evaluate((image) => image.decode());
  comparePicture('drawer', await picture(page, '.drawer'), 0.03);
  viewer.noErrors(page);
});

const OVERLAYS = {
  contacts: ['stack', 40],
  friction: ['incline_materials', 30],
  bounds: ['rolling', 60],
  tree: ['stack', 40], // few lines: each is drawn a little differently by other browsers
  islands: ['half_wood_half_lead', 40],
  mass: ['machines', 30],
  joints: ['bridge', 40],
  velocities: ['billiards', 70],
  hulls: ['height_field', 60],
};

for (const [name, [scene, steps]] of Object.entries(OVERLAYS)) {
  test(`overlay: ${name}`, async (t) => {
    const page = await viewer.open(t, `scene=${scene}&play=0&theme=dark&quality=low`, { width: 360, height: 240 });
    await page.evaluate((count) => window.gyre.advance(count), steps);
    await page.keyboard.press('h'); // the picture alone
    const before = await picture(page);
    await page.evaluate((overlay) => window.gyre.overlay(overlay, true), name);
    const shown = await picture(page);
    assert.ok(changed(before, shown) > 0.001, `the overlay changes ${changed(before, shown)} of the picture`);
    comparePicture(`overlay-${name}`, shown);
    await page.evaluate((overlay) => window.gyre.overlay(overlay, false), name);
    assert.ok(changed(before, await picture(page)) < 0.0002, 'the overlay does not go away');
    viewer.noErrors(page);
  });
}

// What an overlay shows may come long after its switch: the engine is busy and answers later, or nothing touches yet. The pictures
// drawn meanwhile have none of it, and must not be the last word.
test('overlays that were switched on before there was anything to show', async (t) => {
  for (const [name, [scene, steps]] of Object.entries(OVERLAYS)) {
    const page = await viewer.open(t, `scene=${scene}&play=0&theme=dark&quality=low`, { width: 360, height: 240 });
    await page.keyboard.press('h');
    await page.evaluate(
      async ([overlay, count]) => {
        const frames = async (more) => {
          for (let i = 0; i < more; i++) await new Promise((done) => requestAnimationFrame(done));
        };
        const { client } = window.gyre.viewer.playback;
        const ask = client.request.bind(client);
        // Every answer comes three pictures late.
        client.request = async (...asked) => {
          const answer = await ask(...asked);
          await frames(3);
          return answer;
        };
        window.gyre.overlay(overlay, true);
        await frames(3);
        await window.gyre.advance(count);
      },
      [name, steps],
    );
    const late = await picture(page);
    comparePicture(`overlay-${name}`, late);
    await page.evaluate((overlay) => window.gyre.overlay(overlay, false), name);
    assert.ok(changed(late, await picture(page)) > 0.001, `${name} shows nothing`);
    viewer.noErrors(page);
  }
});
