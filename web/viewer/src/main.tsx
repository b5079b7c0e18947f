// Starts the page: viewer, interface, keyboard, and what the address asks for.
import '@fontsource-variable/inter';
import { render } from 'preact';
import './style/base.css';
import './style/panels.css';
import './style/playbar.css';
import './style/phone.css';
import { listenToKeys } from './input/keys';
import { loadSceneList, openFromAddress } from './open';
import * as store from './state/store';
import { Console } from './console';
import { App } from './ui/app';
import { Viewer } from './viewer';

function start(): void {
  let viewer: Viewer;
  try {
    viewer = new Viewer(document.getElementById('stage')!);
  } catch (error) {
    store.notice.value = {
      title: 'This browser cannot draw in 3D',
      text: `The viewer needs WebGL 2: ${(error as Error).message}`,
      fatal: true,
    };
    render(<p class="no-webgl">{store.notice.value.text}</p>, document.getElementById('interface')!);
    return;
  }
  render(<App viewer={viewer} />, document.getElementById('interface')!);
  listenToKeys(viewer);
  window.gyre = new Console(viewer);
  void loadSceneList().then(() => openFromAddress(viewer));
}

start();
