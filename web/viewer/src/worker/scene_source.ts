// Where a scene or recording comes from: bytes from the visitor, or an address, with the mesh files that lie beside it.
import type { Source } from '../protocol';

export interface SceneText {
  file: string;
  text: string;
  files: Record<string, Uint8Array>;
  json: SceneJson;
}

// What the worker itself reads of a scene; the engine checks all of it.
export interface SceneJson {
  world?: Record<string, unknown>;
  meshes?: Record<string, { file?: string }>;
  bodies?: { sensor?: boolean }[];
}

const RECORDING = [0x47, 0x59, 0x52, 0x45]; // every file of the engine's own begins so: GYRE

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
  return name.endsWith('.gyrec') || RECORDING.every((byte, i) => bytes[i] === byte);
}

export async function sceneText(source: Source, bytes: Uint8Array): Promise<SceneText> {
  const file = source.name;
  let text: string;
  try {
    text = new TextDecoder('utf-8', { fatal: true }).decode(bytes);
  } catch {
    throw new Error(`${file} is neither a scene (a text file, .gyre.json) nor a recording (.gyrec).`);
  }
  let json: SceneJson = {};
  try {
    json = JSON.parse(text) as SceneJson;
  } catch {
    // The engine's reader says what is wrong and where, in better words.
  }
  const files: Record<string, Uint8Array> = {};
  for (const mesh of meshFiles(json)) {
    if (source.kind === 'bytes') {
      throw new Error(`${file} needs the mesh file ${mesh}, which a page cannot find beside it. Open it with: gyre view ${file}`);
    }
    if (/^[a-z]+:|^\/|\\|(^|\/)\.\.(\/|$)/i.test(mesh)) throw new Error(`${file}: the mesh file ${mesh} lies outside the scene's folder.`);
    files[mesh] = await fetchBytes(new URL(mesh.split('/').map(encodeURIComponent).join('/'), source.url).href, mesh);
  }
  return { file, text, files, json };
}

function meshFiles(json: SceneJson): string[] {
  const meshes: unknown = json?.meshes;
  if (typeof meshes !== 'object' || meshes === null) return [];
  return Object.values(meshes as Record<string, { file?: unknown } | null>)
    .map((mesh) => mesh?.file)
    .filter((file): file is string => typeof file === 'string');
}
