// Where a scene or recording comes from: bytes from the visitor, or an address, with the files that lie beside it. A glTF file becomes the
// text of a scene here.
import { importGltf } from 'gyre-physics';
import type { Source } from '../protocol';

export interface SceneText {
  file: string;
  text: string;
  files: Record<string, Uint8Array>;
  json: SceneJson;
  notes: string[]; // of an imported file: what is not simulated
}

// What the worker itself reads of a scene; the engine checks all of it.
export interface SceneJson {
  meshes?: Record<string, { file?: string }>;
  bodies?: { sensor?: boolean }[];
}

const beginsWith = (bytes: Uint8Array, text: string): boolean => [...text].every((letter, i) => bytes[i] === letter.charCodeAt(0));

export async function bytesOf(source: Source): Promise<Uint8Array> {
  if (source.kind === 'bytes') return source.bytes;
  return fetchBytes(source.url, source.name);
}

async function fetchBytes(url: string, name: string): Promise<Uint8Array> {
  let response: Response;
  try {
    response = await fetch(url);
  } catch {
    throw new Error(`${name} could not be fetched: the server does not answer.`);
  }
  if (response.status === 404) throw new Error(`There is no ${name} on this server.`);
  if (!response.ok) throw new Error(`${name} could not be fetched: the server answered ${response.status} ${response.statusText}.`);
  return new Uint8Array(await response.arrayBuffer());
}

export function isRecording(bytes: Uint8Array, name: string): boolean {
  if (beginsWith(bytes, 'GYRESNAP')) {
    throw new Error(`${name} is a snapshot, which a program loads (loadSnapshot). The page opens scenes (.gyre.json) and recordings (.gyrec).`);
  }
  return name.endsWith('.gyrec') || beginsWith(bytes, 'GYREPLAY');
}

function isGltf(bytes: Uint8Array, name: string): boolean {
  return /\.(glb|gltf)$/i.test(name) || beginsWith(bytes, 'glTF');
}

async function gltfText(source: Source, bytes: Uint8Array): Promise<SceneText> {
  const file = source.name;
  const named = beginsWith(bytes, 'glTF') ? [] : bufferFiles(sceneJson(new TextDecoder().decode(bytes)));
  const { text, notes } = await importGltf(bytes, { file, files: await filesBeside(source, named) });
  return { file, text, files: {}, json: sceneJson(text), notes };
}

export async function sceneText(source: Source, bytes: Uint8Array): Promise<SceneText> {
  if (isGltf(bytes, source.name)) return gltfText(source, bytes);
  const file = source.name;
  let text: string;
  try {
    text = new TextDecoder('utf-8', { fatal: true }).decode(bytes);
  } catch {
    throw new Error(`${file} is neither a scene (a text file, .gyre.json), nor a recording (.gyrec), nor glTF (.glb).`);
  }
  const json = sceneJson(text);
  return { file, text, files: await filesBeside(source, meshFiles(json)), json, notes: [] };
}

// The bytes of the files that another one names, by these names.
async function filesBeside(source: Source, names: string[]): Promise<Record<string, Uint8Array>> {
  const files: Record<string, Uint8Array> = {};
  for (const name of names) {
    if (source.kind === 'bytes') {
      throw new Error(`${source.name} needs the file ${name}, which a page cannot find beside it. Open it with: gyre view ${source.name}`);
    }
    if (/^[a-z]+:|^\/|\\|(^|\/)\.\.(\/|$)/i.test(name)) throw new Error(`${source.name}: the file ${name} lies outside its folder.`);
    files[name] = await fetchBytes(new URL(name.split('/').map(encodeURIComponent).join('/'), source.url).href, name);
  }
  return files;
}

// The files of binary data that a glTF file names. The reader knows them without the escapes of addresses.
function bufferFiles(json: unknown): string[] {
  const { buffers } = json as { buffers?: unknown };
  if (!Array.isArray(buffers)) return [];
  return (buffers as ({ uri?: unknown } | null)[])
    .map((buffer) => buffer?.uri)
    .filter((uri): uri is string => typeof uri === 'string' && !uri.startsWith('data:'))
    .map(unescaped);
}

function unescaped(uri: string): string {
  try {
    return decodeURIComponent(uri);
  } catch {
    return uri;
  }
}

// Of a file that is no scene, nothing: the engine's reader says what is wrong and where, in better words.
function sceneJson(text: string): SceneJson {
  try {
    const json: unknown = JSON.parse(text);
    return typeof json === 'object' && json !== null ? json : {};
  } catch {
    return {};
  }
}

function meshFiles(json: SceneJson): string[] {
  const meshes: unknown = json.meshes;
  if (typeof meshes !== 'object' || meshes === null) return [];
  return Object.values(meshes as Record<string, { file?: unknown } | null>)
    .map((mesh) => mesh?.file)
    .filter((file): file is string => typeof file === 'string');
}
