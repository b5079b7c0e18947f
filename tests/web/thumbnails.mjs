// Makes the pictures of the list of scenes, web/viewer/thumbnails/*.webp, by the built viewer itself:
//   node thumbnails.mjs [scene...]
import { mkdirSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { launch, newPage, ready } from './browser.mjs';
import { serve } from './server.mjs';
import { dist, root } from './setup.mjs';

const [WIDTH, HEIGHT] = [320, 200];
const SHARPNESS = 2; // drawn larger, then made smaller
// Steps after which something is to be seen; the others at once settled or best at the usual moment.
const MOMENT = { billiards: 70, bowling: 95, chain: 75, dominoes: 150, newtons_cradle: 40, pile: 130, showcase: 75, height_field: 60, mesh_terrain: 120, bouncing: 45, t_handle: 30, card_house: 5, stack: 5,
  'fluid/candle': 110, 'fluid/smoke_fan': 90, 'fluid/vortex_street': 300, 'fluid/lid_driven_cavity': 240, 'fluid/dam_break': 45, 'fluid/flag_in_fan_wind': 80 };
const USUAL = 60;

const asked = process.argv.slice(2);
const scenesIn = (folder) =>
  readdirSync(join(root, 'scenes', folder)).filter((name) => name.endsWith('.gyre.json')).map((name) => join(folder, name.replace('.gyre.json', '')));
const folders = readdirSync(join(root, 'scenes'), { withFileTypes: true }).filter((entry) => entry.isDirectory());
const all = ['', ...folders.map((entry) => entry.name)].flatMap(scenesIn);
const out = join(root, 'web/viewer/thumbnails');
mkdirSync(out, { recursive: true });
for (const folder of folders) mkdirSync(join(out, folder.name), { recursive: true });

const server = await serve(dist);
const browser = await launch();
for (const name of asked.length > 0 ? asked : all) {
  const page = await newPage(browser, { width: WIDTH * SHARPNESS, height: HEIGHT * SHARPNESS });
  await page.goto(`${server.address}?scene=${name}&play=0&theme=dark`);
  await ready(page);
  const picture = await page.evaluate(
    async ({ steps, width, height }) => {
      const { viewer } = window.gyre;
      await window.gyre.advance(steps);
      await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
      viewer.stage.render();
      const small = new OffscreenCanvas(width, height);
      const context = small.getContext('2d');
      context.imageSmoothingQuality = 'high';
      context.drawImage(viewer.stage.renderer.domElement, 0, 0, width, height);
      const blob = await small.convertToBlob({ type: 'image/webp', quality: 0.82 });
      return [...new Uint8Array(await blob.arrayBuffer())];
    },
    { steps: MOMENT[name] ?? USUAL, width: WIDTH, height: HEIGHT },
  );
  writeFileSync(join(out, `${name}.webp`), Buffer.from(picture));
  console.log(`${name}: ${picture.length} bytes`);
  await page.context().close();
}
await browser.close();
await server.close();
