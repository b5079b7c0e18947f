// Screenshots compared with stored ones. A picture may differ in `tolerance` of its pixels: another version of the browser draws
// edges and letters a little differently. With UPDATE_PICTURES set they are stored anew; look at them before they are committed.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import pixelmatch from 'pixelmatch';
import { PNG } from 'pngjs';

const stored = join(import.meta.dirname, 'pictures');
const failed = process.env.GYRE_PICTURES_OUT ?? join(import.meta.dirname, 'failed');

// How many of the pixels of two pictures differ, from 0 to 1.
export function difference(a, b) {
  const [left, right] = [PNG.sync.read(a), PNG.sync.read(b)];
  if (left.width !== right.width || left.height !== right.height) return { part: 1, image: null };
  const image = new PNG({ width: left.width, height: left.height });
  const pixels = pixelmatch(left.data, right.data, image.data, left.width, left.height, { threshold: 0.2 });
  return { part: pixels / (left.width * left.height), image: PNG.sync.write(image) };
}

// How many of the pixels changed at all, from 0 to 1: for two pictures of one browser.
export function changed(a, b) {
  const [left, right] = [PNG.sync.read(a).data, PNG.sync.read(b).data];
  let pixels = 0;
  for (let i = 0; i < left.length; i += 4) {
    if ([0, 1, 2].some((k) => Math.abs(left[i + k] - right[i + k]) > 20)) pixels++;
  }
  return (4 * pixels) / left.length;
}

export function comparePicture(name, picture, tolerance = 0.02) {
  const file = join(stored, `${name}.png`);
  if (process.env.UPDATE_PICTURES) {
    mkdirSync(stored, { recursive: true });
    writeFileSync(file, picture);
    return;
  }
  assert.ok(existsSync(file), `no stored picture ${name}: run with UPDATE_PICTURES=1, look at it, commit it`);
  const { part, image } = difference(readFileSync(file), picture);
  if (part <= tolerance) return;
  mkdirSync(failed, { recursive: true });
  writeFileSync(join(failed, `${name}.png`), picture);
  if (image) writeFileSync(join(failed, `${name}-difference.png`), image);
  assert.fail(`${name}: ${(100 * part).toFixed(2)} % of the picture differ (allowed ${100 * tolerance} %); see ${failed}`);
}
