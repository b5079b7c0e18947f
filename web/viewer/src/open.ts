// Ways to open something: from the list, from an address (/?file=/files/wall.gyre.json), from the visitor's own files.
import type { Source } from './protocol';
import * as store from './state/store';
import type { SceneEntry } from './state/store';
import type { Viewer } from './viewer';

const FIRST = 'showcase.gyre.json'; // what plays when nothing was asked for

async function open(viewer: Viewer, source: Source, play: boolean): Promise<boolean> {
  store.opening.value = source.name;
  store.notice.value = null;
  store.playing.value = false;
  try {
    await viewer.playback.open(source);
    document.title = `${store.scene.peek()!.title} – Gyre`;
    store.playing.value = play;
    const { notes } = store.scene.peek()!;
    if (notes.length > 0) store.notice.value = { title: 'Not all of it is simulated', text: notes.join('\n'), fatal: false };
    return true;
  } catch (error) {
    store.notice.value = { title: `${source.name} cannot be opened`, text: (error as Error).message, fatal: store.scene.peek() === null };
    return false;
  } finally {
    store.opening.value = null;
  }
}

const wantsToPlay = (): boolean => new URLSearchParams(location.search).get('play') !== '0';

// Folders stay folders.
const inAddress = (name: string): string => name.split('/').map(encodeURIComponent).join('/');

function remember(search: string): void {
  const query = new URLSearchParams(location.search);
  query.delete('file');
  query.delete('scene');
  const rest = query.toString();
  const all = [search, rest].filter(Boolean).join('&');
  history.replaceState(null, '', all ? `?${all}` : location.pathname);
}

export function openListed(viewer: Viewer, entry: SceneEntry): Promise<boolean> {
  remember(`scene=${inAddress(entry.file.replace(/\.gyre\.json$/, ''))}`);
  return open(viewer, { kind: 'url', url: new URL(`./scenes/${entry.file}`, document.baseURI).href, name: entry.file }, true);
}

export async function openFile(viewer: Viewer, file: File): Promise<boolean> {
  remember('');
  return open(viewer, { kind: 'bytes', name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) }, true);
}

export async function loadSceneList(): Promise<void> {
  if (!store.hasEngine) return;
  try {
    const response = await fetch('./scenes/index.json');
    if (response.ok) store.sceneList.value = ((await response.json()) as { scenes: SceneEntry[] }).scenes;
  } catch {
    // The drawer says that there is no list.
  }
}

// What the address asks for, or the first scene.
export async function openFromAddress(viewer: Viewer): Promise<void> {
  const query = new URLSearchParams(location.search);
  const file = query.get('file');
  const listed = query.get('scene');
  if (file) {
    const url = new URL(file, document.baseURI);
    // Only what this page's own server offers: a link must not make the page fetch from elsewhere.
    if (url.origin !== location.origin) {
      store.notice.value = { title: 'Not opened', text: `${file} lies on another server than this page.`, fatal: true };
      return;
    }
    await open(viewer, { kind: 'url', url: url.href, name: decodeURIComponent(url.pathname.split('/').at(-1) ?? file) }, wantsToPlay());
    return;
  }
  const name = listed ? `${listed}.gyre.json` : FIRST;
  if (!listed && !store.sceneList.peek().some((entry) => entry.file === FIRST)) {
    store.scenesOpen.value = true;
    return;
  }
  await open(viewer, { kind: 'url', url: new URL(`./scenes/${inAddress(name)}`, document.baseURI).href, name }, wantsToPlay());
}
