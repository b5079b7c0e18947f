import { launch, newPage, ready } from './browser.mjs';
import { serve } from './server.mjs';
import { settled, dist } from './setup.mjs';
const [scene, steps, out] = process.argv.slice(2);
const server = await serve(dist, {}, { isolated: true });
const browser = await launch();
const page = await newPage(browser, { width: 1000, height: 640 });
await page.goto(`${server.address}?scene=${scene}&play=0`);
await ready(page);
for (const [i, n] of steps.split(',').map(Number).entries()) {
  const t = Date.now();
  await page.evaluate((n) => window.gyre.advance(n), n);
  await settled(page);
  console.log('step', await page.evaluate(() => [window.gyre.step, window.gyre.stats.stepMs]), Date.now() - t);
  await page.screenshot({ path: `${out}${i}.png` });
}
console.log(page.errors);
await browser.close(); await server.close();
