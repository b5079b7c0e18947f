// The panel at the right (on a phone: a sheet from below): inspector, overlays, world, charts.
import { X } from 'lucide-preact';
import type { JSX } from 'preact';
import * as store from '../state/store';
import type { Viewer } from '../viewer';
import { ChartsPanel } from '../charts/charts_panel';
import { InspectPanel } from './inspect_panel';
import { OverlaysPanel } from './overlays_panel';
import { IconButton } from './parts';
import { PANELS } from './top_bar';
import { WorldPanel } from './world_panel';

export function SidePanel({ viewer }: { viewer: Viewer }): JSX.Element | null {
  const panel = store.panel.value;
  if (!panel) return null;
  return (
    <aside class="bar side-panel" aria-label={panel}>
      <div class="panel-head">
        <div class="tabs" role="tablist">
          {PANELS.map(({ name, label }) => (
            <button key={name} type="button" role="tab" aria-selected={panel === name} onClick={() => (store.panel.value = name)}>
              {label}
            </button>
          ))}
        </div>
        <IconButton label="Close" shortcut="Esc" onClick={() => (store.panel.value = null)}>
          <X size={18} />
        </IconButton>
      </div>
      <div class="panel-body" role="tabpanel">
        {panel === 'inspect' && <InspectPanel viewer={viewer} />}
        {panel === 'overlays' && <OverlaysPanel />}
        {panel === 'world' && <WorldPanel viewer={viewer} />}
        {panel === 'charts' && <ChartsPanel viewer={viewer} />}
      </div>
    </aside>
  );
}
