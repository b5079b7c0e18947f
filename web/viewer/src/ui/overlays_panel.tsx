// What to draw over the scene, how to colour it, how well to draw it.
import type { JSX } from 'preact';
import { overlayKinds } from '../overlays/all';
import type { OverlayKind } from '../overlays/overlay';
import * as preferences from '../state/preferences';
import * as store from '../state/store';
import { Section, Segments, Switch } from './parts';

// What poses alone are enough for.
const OF_POSES = new Set(['hulls']);

const shown = ({ fluid, soft }: OverlayKind): boolean =>
  (!fluid || (store.stats.value?.fluids ?? 0) > 0) && (!soft || (store.stats.value?.softs ?? 0) > 0);

export function OverlaysPanel(): JSX.Element {
  const { overlays, colorBy, quality } = preferences;
  const missing = store.scene.value?.posesOnly ?? '';
  return (
    <>
      <Section title="Draw" {...(missing ? { note: `Only poses are known (${missing}). Contacts, trees and forces need a recording with commands, or the scene itself.` } : {})}>
        {overlayKinds.filter(shown).map(({ name, label, hint, key }) => (
          <Switch
            key={name}
            label={label}
            hint={hint}
            shortcut={key}
            on={overlays.value.has(name)}
            disabled={missing !== '' && !OF_POSES.has(name)}
            onChange={() => preferences.toggleOverlay(name)}
          />
        ))}
      </Section>
      <Section title="Colour by">
        <Segments
          label="Colour by"
          value={colorBy.value}
          options={[
            { value: 'scene', text: 'Scene' },
            { value: 'material', text: 'Material' },
            { value: 'body', text: 'Body' },
            { value: 'sleep', text: 'Sleep' },
            { value: 'speed', text: 'Speed' },
          ]}
          onChange={(value) => (colorBy.value = value)}
        />
      </Section>
      <Section title="Picture">
        <Segments
          label="Picture"
          value={quality.value}
          options={[
            { value: 'high', text: 'Fine' },
            { value: 'low', text: 'Fast' },
          ]}
          onChange={(value) => (quality.value = value)}
        />
      </Section>
    </>
  );
}
