// What the tests share: the package as its users get it, the scenes of the repository, and the native program to compare with.
import { execFileSync } from 'node:child_process';
import { existsSync, readdirSync, readFileSync, statSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

export const root = join(dirname(fileURLToPath(import.meta.url)), '../../..');
export const dist = join(root, 'web/gyre-physics/dist');
export const gyre = await import('../dist/index.js');

/** Whether a build was made. */
export function made(build) {
  const path = join(dist, 'engine', `${build}.js`);
  return existsSync(path) && statSync(path).size > 1000;
}

const engines = new Map();
/** The engine in one of its builds; tests of a file share it. */
export async function engine(build = 'simd') {
  if (!engines.has(build)) engines.set(build, gyre.load({ build, workers: build === 'threads' ? 2 : undefined }));
  return engines.get(build);
}

export const sceneFolder = join(root, 'scenes');
const scenesIn = (folder) => readdirSync(join(sceneFolder, folder)).filter((name) => name.endsWith('.gyre.json')).sort().map((name) => join(folder, name));
export const sceneNames = scenesIn('.');
/** Of ropes, cloths and soft bodies. */
export const softSceneNames = scenesIn('soft');
/** Of gases and liquids. */
export const fluidSceneNames = scenesIn('fluid');

export function sceneText(name) {
  return readFileSync(join(sceneFolder, name), 'utf8');
}

/** Mesh files by the names that scenes give them. */
export function meshFiles() {
  const files = {};
  for (const name of readdirSync(join(sceneFolder, 'meshes'))) {
    if (name.endsWith('.obj')) files[`meshes/${name}`] = readFileSync(join(sceneFolder, 'meshes', name));
  }
  return files;
}

/** The native program, or null: GYRE_CLI names it, else that of the release build. */
export const nativeProgram = [process.env.GYRE_CLI, join(root, 'build/release/bin/gyre')].find((path) => path && existsSync(path)) ?? null;

export function nativeHash(scene, steps) {
  const printed = execFileSync(nativeProgram, ['simulate', join(sceneFolder, scene), '--steps', String(steps), '--hash', '--quiet'], {
    encoding: 'utf8',
  });
  const hash = printed.match(/^[0-9a-f]{16}$/m);
  if (!hash) throw new Error(`no hash in what ${nativeProgram} printed: ${printed}`);
  return hash[0];
}

export function hashText(world) {
  return world.hash().toString(16).padStart(16, '0');
}
