// Every key, and what the hand does.
import { X } from 'lucide-preact';
import type { JSX } from 'preact';
import { shortcuts } from '../input/keys';
import * as store from '../state/store';
import { IconButton } from './parts';

const HAND: [string, string][] = [
  ['Drag a body', 'pull it, as with a spring'],
  ['Drag in a flat gas', 'stir it; with Alt any gas'],
  ['Drag beside it', 'turn the view (right button or two fingers: shift it)'],
  ['Wheel or pinch', 'nearer, farther'],
  ['Click', 'select a body and ask why it is awake'],
  ['Double-click', 'follow a body'],
  ['Drop a file', 'open a scene (.gyre.json), a recording (.gyrec) or glTF (.glb)'],
];

export function Help(): JSX.Element | null {
  if (!store.helpOpen.value) return null;
  const close = (): void => {
    store.helpOpen.value = false;
  };
  return (
    <div class="veil" onClick={(event) => event.target === event.currentTarget && close()}>
      <div class="bar card help" role="dialog" aria-labelledby="help-title">
        <div class="panel-head">
          <h2 id="help-title">Keys and hands</h2>
          <IconButton label="Close" shortcut="Esc" onClick={close}>
            <X size={18} />
          </IconButton>
        </div>
        <div class="help-columns">
          <dl>
            {shortcuts.map(({ keys, does }) => (
              <div class="help-row" key={does}>
                <dt>
                  {keys.map((key) => (
                    <kbd key={key}>{key}</kbd>
                  ))}
                </dt>
                <dd>{does}</dd>
              </div>
            ))}
          </dl>
          <dl>
            {HAND.map(([what, does]) => (
              <div class="help-row hand" key={what}>
                <dt>{what}</dt>
                <dd>{does}</dd>
              </div>
            ))}
          </dl>
        </div>
      </div>
    </div>
  );
}
