// Puts the scenes of the repository beside the page: scenes/*.gyre.json and those one folder deeper (joints, fields ...) with their
// mesh files, thumbnails/*.webp, and a list of them, scenes/index.json. The development server reads them from where they lie, a build copies them.
import { existsSync, readdirSync, readFileSync, statSync } from 'node:fs';
import { basename, join, normalize, resolve } from 'node:path';
import type { Plugin } from 'vite';

const scenes = resolve(import.meta.dirname, '../../scenes');
const thumbnails = resolve(import.meta.dirname, 'thumbnails');

const isScene = (file: string): boolean => file.endsWith('.gyre.json');

const folders = (): string[] =>
  readdirSync(scenes, { withFileTypes: true })
    .filter((entry) => entry.isDirectory())
    .map((entry) => entry.name)
    .sort();

// The showcase first, the others by name; then those of the folders, as folder/file.
function sceneFiles(): string[] {
  const rank = (file: string): string => (file.startsWith('showcase.') ? '' : file);
  const files = readdirSync(scenes).filter(isScene);
  files.sort((a, b) => (rank(a) < rank(b) ? -1 : 1));
  const deeper = folders().flatMap((folder) =>
    readdirSync(join(scenes, folder))
      .filter(isScene)
      .sort()
      .map((file) => `${folder}/${file}`),
  );
  return [...files, ...deeper];
}

// scenes/meshes and the meshes of folders.
function meshFiles(): string[] {
  return ['.', ...folders()]
    .map((folder) => join(folder, 'meshes'))
    .filter((folder) => existsSync(join(scenes, folder)))
    .flatMap((folder) => readdirSync(join(scenes, folder)).map((file) => `${folder}/${file}`));
}

interface SceneJson {
  name?: string;
  bodies?: unknown[];
  joints?: unknown[];
  ropes?: unknown[];
  cloths?: unknown[];
  soft_bodies?: unknown[];
  gases?: unknown[];
  liquids?: unknown[];
}

const pictureOf = (file: string): string => file.replace(/\.gyre\.json$/, '.webp');

function list(): string {
  const entries = sceneFiles().map((file) => {
    const scene = JSON.parse(readFileSync(join(scenes, file), 'utf8')) as SceneJson;
    return {
      name: scene.name ?? basename(file, '.gyre.json'),
      file,
      thumbnail: existsSync(join(thumbnails, pictureOf(file))) ? pictureOf(file) : null,
      bodies: scene.bodies?.length ?? 0,
      joints: scene.joints?.length ?? 0,
      ropes: scene.ropes?.length ?? 0,
      cloths: scene.cloths?.length ?? 0,
      softBodies: scene.soft_bodies?.length ?? 0,
      gases: scene.gases?.length ?? 0,
      liquids: scene.liquids?.length ?? 0,
    };
  });
  return `${JSON.stringify({ scenes: entries }, null, 1)}\n`;
}

// Where scenes/NAME is taken from; null if there is no such file.
function fileFor(name: string): string | null {
  const clean = normalize(name);
  if (clean.startsWith('..') || clean.startsWith('/')) return null;
  const file = clean.endsWith('.webp') ? join(thumbnails, clean) : join(scenes, clean);
  return existsSync(file) && statSync(file).isFile() ? file : null;
}

export function gyreScenes(): Plugin {
  return {
    name: 'gyre-scenes',
    configureServer(server) {
      server.middlewares.use('/scenes/', (request, response, next) => {
        const name = decodeURIComponent((request.url ?? '').replace(/^\//, '').replace(/\?.*/, ''));
        if (name === 'index.json') return void response.setHeader('Content-Type', 'application/json').end(list());
        const file = fileFor(name);
        if (!file) return next();
        response.end(readFileSync(file));
      });
    },
    generateBundle() {
      this.emitFile({ type: 'asset', fileName: 'scenes/index.json', source: list() });
      const emit = (name: string): void => {
        const file = fileFor(name);
        if (file) this.emitFile({ type: 'asset', fileName: `scenes/${name}`, source: readFileSync(file) });
      };
      for (const file of sceneFiles()) {
        emit(file);
        emit(pictureOf(file));
      }
      for (const mesh of meshFiles()) emit(mesh);
    },
  };
}
