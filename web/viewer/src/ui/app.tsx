// The page around the picture.
import type { JSX } from 'preact';
import * as store from '../state/store';
import type { Viewer } from '../viewer';
import { DropZone } from './drop_zone';
import { Help } from './help';
import { NoticeCard } from './notice';
import { toast } from './parts';
import { Playbar } from './playbar';
import { ReadingKey } from './reading_key';
import { SceneDrawer } from './scene_drawer';
import { SidePanel } from './side_panel';
import { TopBar } from './top_bar';

export function App({ viewer }: { viewer: Viewer }): JSX.Element {
  return (
    <>
      <TopBar />
      <SceneDrawer viewer={viewer} />
      <SidePanel viewer={viewer} />
      <Playbar viewer={viewer} />
      <ReadingKey />
      <Opening />
      <NoticeCard />
      <Help />
      <DropZone viewer={viewer} />
      <div class={`toast ${toast.value ? 'shown' : ''}`} role="status">
        {toast.value}
      </div>
    </>
  );
}

function Opening(): JSX.Element | null {
  if (store.opening.value === null) return null;
  return (
    <div class="opening" role="status">
      <span class="spinner" />
      Opening {store.opening.value}
    </div>
  );
}
