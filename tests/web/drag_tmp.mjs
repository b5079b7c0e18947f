import { launch, newPage, ready } from './browser.mjs';
import { serve } from './server.mjs';
import { settled, dist } from './setup.mjs';
const server = await serve(dist, {}, { isolated: true });
const browser = await launch();
const page = await newPage(browser, { width: 800, height: 512 });
await page.goto(`${server.address}?scene=softdev&play=0&quality=low`);
await ready(page);
await page.evaluate(() => window.gyre.advance(5));
await settled(page);
const soft = (i) => page.evaluate((i) => { const s=[...window.gyre.viewer.softs.items.values()][i]; const n=s.vertices.length/3, k=3*(n>>1); return [...s.vertices.slice(k,k+3)]; }, i);
for (const [i, name] of [[0,'flag'],[3,'jelly'],[2,'rope']]) {
  const at = await soft(i);
  const p = await page.evaluate((a) => window.gyre.onPage(...a), at);
  await page.mouse.move(p.x, p.y); await page.mouse.down();
  for (let k=1;k<=4;k++) { await page.mouse.move(p.x + 20*k, p.y - 25*k); await page.evaluate(() => new Promise(r => requestAnimationFrame(() => requestAnimationFrame(r)))); await page.evaluate(() => window.gyre.advance(8)); }
  await settled(page);
  const q = await soft(i);
  console.log(name, at, q, await page.evaluate(() => [window.gyre.step, window.gyre.names().includes('hand')]));
  await page.screenshot({ path: `/tmp/web_d_${name}.png` });
  await page.mouse.up();
  await settled(page);
  await page.evaluate(() => window.gyre.advance(6));
  console.log('released', await page.evaluate(() => [window.gyre.step, window.gyre.names().join()]));
}
const h = await page.evaluate(() => window.gyre.hash());
const s = await page.evaluate(() => window.gyre.step);
await page.evaluate(() => window.gyre.seek(3));
await page.evaluate((s) => window.gyre.seek(s), s);
console.log(h, await page.evaluate(() => window.gyre.hash()), page.errors);
await browser.close(); await server.close();
