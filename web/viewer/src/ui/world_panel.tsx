// Every setting of the world that can be changed while it runs. Some take effect with the next step; those that need another world
// make one from a snapshot of the present state, and it goes on from there.
import { Download, RotateCcw } from 'lucide-preact';
import { signal } from '@preact/signals';
import type { JSX } from 'preact';
import { fixed, words } from '../format';
import type { NewWorldSettings, Throwable, Vec3 } from '../protocol';
import { throwable, throwSpeed } from '../state/preferences';
import * as store from '../state/store';
import type { Viewer } from '../viewer';
import { Choice, say, Section, Segments, Slider, Switch } from './parts';

const GRAVITIES: { text: string; value: number }[] = [
  { text: 'None', value: 0 },
  { text: 'Moon', value: 1.62 },
  { text: 'Mars', value: 3.71 },
  { text: 'Earth', value: 9.81 },
  { text: 'Jupiter', value: 24.8 },
];
const AXES = ['x', 'y', 'z'] as const;
const changing = signal(false);

export function WorldPanel({ viewer }: { viewer: Viewer }): JSX.Element | null {
  const scene = store.scene.value;
  if (!scene) return null;
  if (!scene.live) return <RecordingFacts />;
  return (
    <>
      <Gravity viewer={viewer} />
      <Stepping viewer={viewer} />
      <NewWorld viewer={viewer} />
      <Throwing />
      <Section title="Keep">
        <div class="body-actions">
          <button type="button" onClick={() => void save(viewer, 'scene')}>
            <Download size={15} /> Scene as it stands
          </button>
          <button type="button" onClick={() => void save(viewer, 'snapshot')}>
            <Download size={15} /> Snapshot
          </button>
          <button type="button" onClick={() => viewer.playback.seek(0)}>
            <RotateCcw size={15} /> Start over
          </button>
        </div>
        <p class="hint">{scene.engine}</p>
      </Section>
    </>
  );
}

function update(change: Partial<NonNullable<typeof store.scene.value>['settings']>): void {
  const scene = store.scene.peek();
  if (scene) store.scene.value = { ...scene, settings: { ...scene.settings, ...change } };
}

function Gravity({ viewer }: { viewer: Viewer }): JSX.Element {
  const { gravity } = store.scene.value!.settings;
  const set = (value: Vec3): void => {
    update({ gravity: value });
    viewer.playback.command({ do: 'gravity', value });
  };
  const preset = gravity[0] === 0 && gravity[2] === 0 ? GRAVITIES.find(({ value }) => Math.abs(-gravity[1] - value) < 0.005) : undefined;
  return (
    <Section title="Gravity">
      <Segments
        label="Gravity"
        value={preset ? preset.text : ''}
        options={GRAVITIES.map(({ text }) => ({ value: text, text }))}
        onChange={(text) => set([0, -GRAVITIES.find((entry) => entry.text === text)!.value || 0, 0])}
      />
      {AXES.map((axis, i) => (
        <Slider
          key={axis}
          label={axis}
          value={gravity[i]!}
          low={-30}
          high={30}
          step={0.01}
          text={`${fixed(gravity[i]!, 2)} m/s²`}
          onInput={(value) => set(gravity.map((old, j) => (i === j ? value : old)) as Vec3)}
        />
      ))}
    </Section>
  );
}

function Stepping({ viewer }: { viewer: Viewer }): JSX.Element {
  const { substeps, sleeping, timeStep } = store.scene.value!.settings;
  return (
    <Section title="Stepping">
      <Slider
        label="Sub-steps"
        value={substeps}
        low={1}
        high={32}
        step={1}
        text={String(substeps)}
        onInput={(value) => {
          update({ substeps: value });
          viewer.playback.command({ do: 'substeps', value });
        }}
      />
      <Switch
        label="Sleeping"
        hint="what rests is not computed until something touches it"
        on={sleeping}
        onChange={(value) => {
          update({ sleeping: value });
          viewer.playback.command({ do: 'sleeping', value });
        }}
      />
      <div class="row">
        <dt>Time step</dt>
        <dd>1/{Math.round(1 / timeStep)} s</dd>
      </div>
    </Section>
  );
}

function NewWorld({ viewer }: { viewer: Viewer }): JSX.Element {
  const { settings, choices } = store.scene.value!;
  const named = (names: string[]): { value: string; text: string }[] => names.map((name) => ({ value: name, text: words(name) }));
  const change = async (change: NewWorldSettings): Promise<void> => {
    changing.value = true;
    try {
      await viewer.playback.configure(change);
      say('A new world goes on from here');
    } catch (error) {
      store.notice.value = { title: 'The setting was refused', text: (error as Error).message, fatal: false };
    } finally {
      changing.value = false;
    }
  };
  const threads = Array.from({ length: choices.maxThreads }, (_, i) => ({ value: i + 1, text: String(i + 1) }));
  return (
    <Section title="Method" note="These make a new world that goes on from the present state. Broad phase, threads and SIMD width change no bit of the result.">
      <Choice label="Solver" value={settings.solver} options={named(choices.solver)} disabled={choices.solver.length < 2 || changing.value} onChange={(solver) => void change({ solver })} />
      <Choice label="Integrator" value={settings.integrator} options={named(choices.integrator)} disabled={choices.integrator.length < 2 || changing.value} onChange={(integrator) => void change({ integrator })} />
      <Choice label="Broad phase" value={settings.broadPhase} options={named(choices.broadPhase)} disabled={choices.broadPhase.length < 2 || changing.value} onChange={(broadPhase) => void change({ broadPhase })} />
      <Choice
        label="SIMD width"
        value={settings.simdWidth}
        options={choices.simdWidth.map((width) => ({ value: width, text: width === 0 ? 'Widest' : width === 1 ? '1 lane' : `${width} lanes` }))}
        disabled={choices.simdWidth.length < 2 || changing.value}
        onChange={(simdWidth) => void change({ simdWidth })}
      />
      <Choice label="Threads" value={settings.threads} options={threads} disabled={threads.length < 2 || changing.value} onChange={(count) => void change({ threads: count })} />
    </Section>
  );
}

const THROWABLES: { value: Throwable; text: string }[] = [
  { value: 'ball', text: 'Ball' },
  { value: 'box', text: 'Box' },
  { value: 'capsule', text: 'Capsule' },
  { value: 'cylinder', text: 'Cylinder' },
  { value: 'cone', text: 'Cone' },
];

function Throwing(): JSX.Element {
  return (
    <Section title="Throw (space) or put down (B)">
      <Segments label="What to throw" value={throwable.value} options={THROWABLES} onChange={(value) => (throwable.value = value)} />
      <Slider label="Speed" value={throwSpeed.value} low={1} high={60} step={1} text={`${throwSpeed.value}`} onInput={(value) => (throwSpeed.value = value)} />
    </Section>
  );
}

function RecordingFacts(): JSX.Element {
  const scene = store.scene.value!;
  return (
    <Section title="Recording" {...(scene.truncated ? { note: 'The file ends before its closing chunk: it is played up to the last whole frame.' } : {})}>
      <dl>
        <div class="row">
          <dt>File</dt>
          <dd>{scene.file}</dd>
        </div>
        <div class="row">
          <dt>Frames</dt>
          <dd>{(scene.lastStep + 1).toLocaleString('en')}</dd>
        </div>
      </dl>
      <p class="hint">{scene.engine}</p>
    </Section>
  );
}

async function save(viewer: Viewer, what: 'scene' | 'snapshot'): Promise<void> {
  try {
    const { name, bytes } = await viewer.playback.client.request('save', { what });
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([bytes as Uint8Array<ArrayBuffer>]));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  } catch (error) {
    store.notice.value = { title: 'Not saved', text: (error as Error).message, fatal: false };
  }
}
