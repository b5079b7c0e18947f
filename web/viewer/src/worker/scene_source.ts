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

export async function sceneText(source: Source, bytes: Uint8Array): Promise<SceneText> {
  const file = source.name;
  let text: string;
  try {
    text = new TextDecoder('utf-8', { fatal: true }).decode(bytes);
  } catch {
    throw new Error(`${file} is neither a scene (a text file, .gyre.json) nor a recording (.gyrec).`);
  }
  const json = sceneJson(text);
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
