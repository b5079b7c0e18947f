// Above: what is open, and the ways to everything else.
import { ChartSpline, CircleHelp, Globe, Layers, LayoutGrid, Moon, MousePointerClick, Sun } from 'lucide-preact';
import type { JSX } from 'preact';
import { plural } from '../format';
import { theme, toggleTheme } from '../state/preferences';
import * as store from '../state/store';
import { IconButton } from './parts';

export const PANELS = [
  { name: 'inspect', label: 'Inspect', key: 'I', icon: MousePointerClick },
  { name: 'overlays', label: 'Overlays', key: 'O', icon: Layers },
  { name: 'world', label: 'World', key: 'W', icon: Globe },
  { name: 'charts', label: 'Charts', key: 'C', icon: ChartSpline },
] as const;

export function togglePanel(name: store.Panel): void {
  store.panel.value = store.panel.value === name ? null : name;
  if (innerWidth < 900) store.scenesOpen.value = false;
}

export function TopBar(): JSX.Element {
  const scene = store.scene.value;
  const stats = store.stats.value;
  return (
    <header class="top-bar">
      <div class="bar brand">
        <button type="button" class="brand-button" onClick={() => (store.scenesOpen.value = !store.scenesOpen.value)} aria-expanded={store.scenesOpen.value}>
          <img src="./icon.svg" alt="" width="26" height="26" />
          <span class="brand-words">
            <span class="brand-name">Gyre</span>
            <span class="scene-title">{scene ? scene.title : 'Choose a scene'}</span>
          </span>
          <LayoutGrid size={18} aria-hidden="true" />
          <span class="hidden">Scenes</span>
        </button>
      </div>
      {scene && stats && (
        <div class="bar facts" aria-label="In numbers">
          {!scene.live && <span class="badge">recording</span>}
          <span title="Pictures a second">
            <b>{store.framesPerSecond.value}</b> fps
          </span>
          {scene.live && (
            <span title="Time of a step, in the worker">
              <b>{stats.stepMs.toFixed(2)}</b> ms
            </span>
          )}
          <span>{plural(stats.bodies, 'body', 'bodies')}</span>
          {stats.softs > 0 && (
            <span class="extra" title="Of ropes, cloths and solids">
              {plural(stats.softVertices, 'vertex', 'vertices')}
            </span>
          )}
          {scene.live && <span class="extra">{stats.awake.toLocaleString('en')} awake</span>}
          {scene.live && <span class="extra">{plural(stats.contactPoints, 'contact')}</span>}
        </div>
      )}
      <nav class="bar tools" aria-label="Panels">
        {PANELS.map(({ name, label, key, icon: Icon }) => (
          <IconButton key={name} label={label} shortcut={key} pressed={store.panel.value === name} onClick={() => togglePanel(name)}>
            <Icon size={19} />
          </IconButton>
        ))}
        <span class="divider" />
        <IconButton label={theme.value === 'dark' ? 'Light' : 'Dark'} shortcut="T" onClick={toggleTheme}>
          {theme.value === 'dark' ? <Sun size={19} /> : <Moon size={19} />}
        </IconButton>
        <IconButton label="Help" shortcut="?" pressed={store.helpOpen.value} onClick={() => (store.helpOpen.value = !store.helpOpen.value)}>
          <CircleHelp size={19} />
        </IconButton>
      </nav>
    </header>
  );
}
