// The keyboard. The same list makes the help.
import { overlayKinds } from '../overlays/all';
import * as preferences from '../state/preferences';
import * as store from '../state/store';
import { stepBack, SPEEDS } from '../ui/playbar';
import { togglePanel } from '../ui/top_bar';
import type { Viewer } from '../viewer';

interface Shortcut {
  keys: string[]; // as shown
  match: string[]; // KeyboardEvent.key, lower case
  does: string;
  run: (viewer: Viewer, event: KeyboardEvent) => void;
}

function changeSpeed(by: number): void {
  const at = SPEEDS.indexOf(store.speed.peek());
  store.speed.value = SPEEDS[Math.min(Math.max((at < 0 ? 3 : at) + by, 0), SPEEDS.length - 1)]!;
}

function closeTopmost(): void {
  if (store.helpOpen.peek()) store.helpOpen.value = false;
  else if (store.notice.peek() && !store.notice.peek()!.fatal) store.notice.value = null;
  else if (store.scenesOpen.peek()) store.scenesOpen.value = false;
  else if (store.panel.peek()) store.panel.value = null;
  else store.select(null);
}

export const shortcuts: readonly Shortcut[] = [
  { keys: ['Space'], match: [' '], does: 'throw a ball (or what the World panel says)', run: (viewer) => viewer.thrower.throw() },
  { keys: ['B'], match: ['b'], does: 'put one down under the pointer', run: (viewer) => viewer.thrower.putDown() },
  { keys: ['K', 'Enter'], match: ['k', 'enter', 'p'], does: 'play, pause', run: (viewer) => viewer.playback.toggle() },
  { keys: ['←', '→'], match: ['arrowleft', 'arrowright'], does: 'a step back, a step on (with Shift: ten)', run: stepByKey },
  { keys: ['Home', 'End'], match: ['home', 'end'], does: 'to the beginning, to the end', run: (viewer, event) => viewer.playback.seek(event.key === 'Home' ? 0 : store.lastStep.peek()) },
  { keys: ['−', '+'], match: ['-', '+', '='], does: 'slower, faster', run: (_, event) => changeSpeed(event.key === '-' ? -1 : 1) },
  { keys: ['F'], match: ['f'], does: 'whole scene, or the selected body', run: (viewer) => viewer.frameScene() },
  { keys: ['G'], match: ['g'], does: 'follow the selected body', run: () => (store.following.value = store.selected.peek() !== null && !store.following.peek()) },
  { keys: ['Del'], match: ['delete', 'backspace'], does: 'remove the selected body', run: removeSelected },
  { keys: ['S'], match: ['s'], does: 'scenes', run: () => (store.scenesOpen.value = !store.scenesOpen.peek()) },
  { keys: ['I', 'O', 'W', 'C'], match: ['i', 'o', 'w', 'c'], does: 'inspector, overlays, world, charts', run: (_, event) => togglePanel(({ i: 'inspect', o: 'overlays', w: 'world', c: 'charts' } as const)[event.key.toLowerCase() as 'i']) },
  { keys: ['1', '…', '9'], match: overlayKinds.filter(({ fluid, soft }) => !fluid && !soft).map(({ key }) => key), does: 'overlays', run: (_, event) => toggleByKey(event.key) },
  { keys: ['V', 'X', 'L'], match: overlayKinds.filter(({ fluid }) => fluid).map(({ key }) => key), does: 'of fluids: arrows, speed, particles', run: (_, event) => toggleByKey(event.key.toLowerCase()) },
  { keys: ['N', 'M'], match: overlayKinds.filter(({ soft }) => soft).map(({ key }) => key), does: 'of ropes, cloths and solids: strain, stress', run: (_, event) => toggleByKey(event.key.toLowerCase()) },
  { keys: ['0'], match: ['0'], does: 'no overlay', run: () => (preferences.overlays.value = new Set()) },
  { keys: ['T'], match: ['t'], does: 'light, dark', run: () => preferences.toggleTheme() },
  { keys: ['H'], match: ['h'], does: 'hide everything but the scene', run: () => document.documentElement.classList.toggle('bare') },
  { keys: ['?'], match: ['?'], does: 'this', run: () => (store.helpOpen.value = !store.helpOpen.peek()) },
  { keys: ['Esc'], match: ['escape'], does: 'close what is open, select nothing', run: closeTopmost },
];

function stepByKey(viewer: Viewer, event: KeyboardEvent): void {
  const steps = event.shiftKey ? 10 : 1;
  if (event.key === 'ArrowRight') return void viewer.playback.advance(steps);
  if (steps === 1) return stepBack(viewer);
  viewer.playback.pause();
  viewer.playback.seek(store.step.peek() - steps);
}

function removeSelected(viewer: Viewer): void {
  const key = store.selected.peek();
  const soft = store.selectedSoft.peek();
  if (!store.scene.peek()?.live) return;
  if (key !== null) viewer.playback.command({ do: 'remove', key });
  else if (soft !== null) viewer.playback.command({ do: 'remove_soft', key: soft });
}

function toggleByKey(key: string): void {
  const kind = overlayKinds.find((entry) => entry.key === key);
  if (kind) preferences.toggleOverlay(kind.name);
}

export function listenToKeys(viewer: Viewer): void {
  window.addEventListener('keydown', (event) => {
    const target = event.target as HTMLElement;
    const typing = target.matches('input[type=text], input[type=search], select, textarea');
    if (typing || event.ctrlKey || event.metaKey || event.altKey) return;
    // A focused button is pressed by the space bar, and sliders have arrows of their own.
    const key = event.key.toLowerCase();
    if (target.matches('button') && (key === ' ' || key === 'enter')) return;
    if (target.matches('input[type=range]:not(.timeline)') && key.startsWith('arrow')) return;
    const shortcut = shortcuts.find(({ match }) => match.includes(key));
    if (!shortcut) return;
    event.preventDefault();
    shortcut.run(viewer, event);
  });
}
