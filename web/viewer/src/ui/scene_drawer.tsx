// The scenes, with pictures, and files of one's own.
import { FolderOpen, X } from 'lucide-preact';
import { useRef } from 'preact/hooks';
import type { JSX } from 'preact';
import { plural } from '../format';
import { openFile, openListed } from '../open';
import * as store from '../state/store';
import type { Viewer } from '../viewer';
import { IconButton } from './parts';

const WITHOUT_SCENES = store.hasEngine
  ? 'No list of scenes lies beside this page. Open a file instead.'
  : 'This page was built without the engine: it plays recordings. In the source tree, ./run SCENE records a scene and shows it; ./run --live builds the page with the engine.';

export function SceneDrawer({ viewer }: { viewer: Viewer }): JSX.Element | null {
  const input = useRef<HTMLInputElement>(null);
  if (!store.scenesOpen.value) return null;
  const close = (): void => {
    store.scenesOpen.value = false;
  };
  return (
    <aside class="bar drawer" aria-label="Scenes">
      <div class="panel-head">
        <h2>Scenes</h2>
        <div class="head-actions">
          {store.hasEngine && (
            <button type="button" class="quiet" onClick={() => input.current?.click()}>
              <FolderOpen size={16} /> Open a file
            </button>
          )}
          <IconButton label="Close" shortcut="Esc" onClick={close}>
            <X size={18} />
          </IconButton>
        </div>
        <input
          ref={input}
          type="file"
          accept=".json,.gyrec,.glb,.gltf"
          hidden
          onChange={(event) => {
            const file = event.currentTarget.files?.[0];
            if (file) void openFile(viewer, file);
            event.currentTarget.value = '';
          }}
        />
      </div>
      <div class="scene-grid">
        {store.sceneList.value.map((entry) => (
          <button
            key={entry.file}
            type="button"
            class="scene-card"
            data-file={entry.file}
            aria-current={store.scene.value?.file === entry.file}
            onClick={() => {
              if (innerWidth < 900) close();
              void openListed(viewer, entry);
            }}
          >
            {entry.thumbnail && <img src={`./scenes/${entry.thumbnail}`} alt="" width="320" height="200" loading="lazy" />}
            <span class="scene-card-name">{entry.name}</span>
            <span class="hint">
              {contents(entry)}
            </span>
          </button>
        ))}
        {store.sceneList.value.length === 0 && <p class="hint">{WITHOUT_SCENES}</p>}
      </div>
    </aside>
  );
}

// "3 bodies, 1 rope": the bodies, and whatever else there is.
function contents({ bodies, joints, ropes, cloths, softBodies, gases, liquids }: store.SceneEntry): string {
  const told = [
    joints > 0 && plural(joints, 'joint'),
    ropes > 0 && plural(ropes, 'rope'),
    cloths > 0 && plural(cloths, 'cloth'),
    softBodies > 0 && plural(softBodies, 'soft body', 'soft bodies'),
    gases > 0 && plural(gases, 'gas', 'gases'),
    liquids > 0 && plural(liquids, 'liquid'),
  ].filter((words) => words !== false);
  return [plural(bodies, 'body', 'bodies'), ...told].join(', ');
}
