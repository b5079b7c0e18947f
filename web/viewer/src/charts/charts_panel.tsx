// Live charts: step time by stage, energy, momentum, contacts. A window of the last seconds, thinned to what a screen can show.
import { signal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import type { JSX } from 'preact';
import { words } from '../format';
import type { Sample } from '../state/history';
import * as store from '../state/store';
import { Segments } from '../ui/parts';
import type { Viewer } from '../viewer';
import { Chart, type Line } from './chart';

const STAGE_COLORS = ['#5b8cff', '#35c2c1', '#f2b134', '#8f7bf0', '#ff7a59', '#e7609f', '#7bc043', '#9aa7b8', '#4cc9f0', '#c98a5b'];
const WINDOWS = [
  { value: '5', text: '5 s' },
  { value: '20', text: '20 s' },
  { value: 'all', text: 'All' },
];
const MOST_POINTS = 600;
const PACE = 150; // ms between two drawings

const span = signal('20');
const version = signal(0);

function visible(samples: readonly Sample[]): Sample[] {
  const last = samples.at(-1)?.time ?? 0;
  const from = span.value === 'all' ? -Infinity : last - Number(span.value);
  const chosen = samples.filter(({ time }) => time >= from);
  const every = Math.ceil(chosen.length / MOST_POINTS);
  return every > 1 ? chosen.filter((_, i) => i % every === 0 || i === chosen.length - 1) : chosen;
}

const column = (samples: readonly Sample[], read: (sample: Sample) => number): number[] => samples.map(read);

export function ChartsPanel({ viewer }: { viewer: Viewer }): JSX.Element {
  useEffect(() => {
    const timer = setInterval(() => (version.value = viewer.history.version), PACE);
    return () => clearInterval(timer);
  }, [viewer]);
  const shown = version.value;
  const scene = store.scene.value;
  const samples = visible(viewer.history.samples);
  const time = column(samples, (sample) => sample.time);
  const mark = store.time.value;
  const common = { mark, version: shown };
  if (scene?.posesOnly) {
    return <p class="hint">Only poses are known ({scene.posesOnly}): no times, energies or contacts. They need a recording with commands, or the scene itself.</p>;
  }
  return (
    <>
      <Segments label="Time shown" value={span.value} options={WINDOWS} onChange={(value) => (span.value = value)} />
      <StageChart samples={samples} time={time} stages={scene?.stages ?? []} {...common} />
      <Chart
        title="Energy"
        unit="J"
        lines={[
          { label: 'total', color: '#8fa3bd', width: 2.2 },
          { label: 'kinetic', color: '#ff7a59' },
          { label: 'potential', color: '#5b8cff' },
          { label: 'elastic', color: '#7bc043' },
        ]}
        data={[
          time,
          column(samples, (s) => s.kinetic + s.potential + s.elastic),
          column(samples, (s) => s.kinetic),
          column(samples, (s) => s.potential),
          column(samples, (s) => s.elastic),
        ]}
        {...common}
      />
      <Chart title="Momentum" unit="kg m/s" lines={[{ label: 'linear', color: '#35c2c1' }]} data={[time, column(samples, (s) => s.linear)]} {...common} />
      <Chart
        title="Angular momentum"
        unit="kg m²/s about the origin"
        lines={[{ label: 'angular', color: '#e7609f' }]}
        data={[time, column(samples, (s) => s.angular)]}
        {...common}
      />
      <Chart
        title="Contacts and bodies"
        unit="count"
        lines={[
          { label: 'points', color: '#f2b134' },
          { label: 'touching pairs', color: '#8f7bf0' },
          { label: 'awake', color: '#7bc043' },
        ]}
        data={[time, column(samples, (s) => s.contacts), column(samples, (s) => s.touching), column(samples, (s) => s.awake)]}
        {...common}
      />
    </>
  );
}

// Stages lie on each other, the first at the bottom; the whole step is the line above.
function StageChart(props: { samples: Sample[]; time: number[]; stages: readonly string[]; mark: number; version: number }): JSX.Element {
  const { samples, time, stages, mark, version: shown } = props;
  const own = stages.map((_, stage) => column(samples, (sample) => sample.stageMs[stage] ?? 0));
  const sums: number[][] = [];
  own.forEach((values, i) => sums.push(values.map((value, k) => value + (sums[i - 1]?.[k] ?? 0))));
  const step = column(samples, (sample) => sample.stepMs);
  // The topmost sum is drawn first, so that each lower one covers it.
  const order = stages.map((_, i) => i).reverse();
  const lines: Line[] = [
    { label: 'step', color: '#8fa3bd' },
    ...order.map((i) => ({ label: words(stages[i]!), color: STAGE_COLORS[i % STAGE_COLORS.length]! })),
  ];
  return (
    <Chart
      title="Step"
      unit="ms"
      stacked
      lines={lines}
      data={[time, step, ...order.map((i) => sums[i]!)]}
      own={[step, ...order.map((i) => own[i]!)]}
      mark={mark}
      version={shown}
    />
  );
}
