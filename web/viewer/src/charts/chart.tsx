// One chart: lines over time with a legend that reads the value at the mark, drawn by uPlot. Filled, the lines lie on each other.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { useEffect, useRef } from 'preact/hooks';
import type { JSX } from 'preact';
import { compact, short } from '../format';
import { theme } from '../state/preferences';

export interface Line {
  label: string;
  color: string;
  width?: number;
}

interface Props {
  title: string;
  unit: string;
  lines: readonly Line[];
  stacked?: boolean;
  data: uPlot.AlignedData; // time, then each line (of a stack: already summed)
  own?: readonly (readonly number[])[]; // of a stack: each line by itself, for the legend
  mark: number; // s
  version: number;
}

const HEIGHT = 118;

function axisColors(): { text: string; grid: string } {
  return theme.value === 'dark' ? { text: '#8b98a9', grid: 'rgba(140,160,185,.13)' } : { text: '#5c6979', grid: 'rgba(60,80,110,.13)' };
}

function options(props: Props, width: number): uPlot.Options {
  const { text, grid } = axisColors();
  const axis: uPlot.Axis = {
    stroke: text,
    font: '11px "Inter Variable", sans-serif',
    grid: { stroke: grid, width: 1 },
    ticks: { show: false },
  };
  return {
    width,
    height: HEIGHT,
    padding: [8, 14, 0, 0],
    legend: { show: false },
    cursor: { show: false },
    scales: { x: { time: false }, y: { range: (_, low, high) => padded(low, high, props.stacked ?? false) } },
    axes: [
      { ...axis, size: 22, space: 60, values: (_, values) => values.map((value) => `${short(value)} s`) },
      { ...axis, size: 46, space: 26, values: (_, values) => values.map((value) => compact(value)) },
    ],
    series: [
      {},
      ...props.lines.map((line) => ({
        label: line.label,
        stroke: line.color,
        width: line.width ?? (props.stacked ? 1 : 1.6),
        ...(props.stacked ? { fill: `${line.color}66` } : {}),
        points: { show: false },
      })),
    ],
  };
}

function padded(low: number | null, high: number | null, fromZero: boolean): [number, number] {
  let bottom = fromZero ? 0 : (low ?? 0);
  let top = high ?? 1;
  if (fromZero && bottom > 0) bottom = 0;
  if (top - bottom < 1e-9 * Math.max(Math.abs(top), 1)) {
    const reach = Math.max(Math.abs(top) * 0.1, 0.5);
    bottom -= fromZero ? 0 : reach;
    top += reach;
  }
  return [bottom, top + 0.06 * (top - bottom)];
}

export function Chart(props: Props): JSX.Element {
  const holder = useRef<HTMLDivElement>(null);
  const plot = useRef<uPlot | null>(null);
  const names = props.lines.map(({ label }) => label).join();

  useEffect(() => {
    const element = holder.current!;
    plot.current = new uPlot(options(props, element.clientWidth || 280), props.data, element);
    const observer = new ResizeObserver(() => plot.current?.setSize({ width: element.clientWidth, height: HEIGHT }));
    observer.observe(element);
    return () => {
      observer.disconnect();
      plot.current?.destroy();
      plot.current = null;
    };
  }, [names, theme.value]);
  useEffect(() => plot.current?.setData(props.data), [props.version]);

  const times = props.data[0] as number[];
  let at = times.length - 1;
  while (at > 0 && times[at]! > props.mark + 1e-9) at--;
  const value = (i: number): number | null | undefined => (props.own ? props.own[i]?.[at] : (props.data[i + 1] as number[])[at]);
  const part = times.length > 1 ? (props.mark - times[0]!) / (times.at(-1)! - times[0]!) : 1;
  return (
    <figure class="chart">
      <figcaption>
        <b>{props.title}</b> <span class="hint">{props.unit}</span>
      </figcaption>
      <div class="plot" ref={holder}>
        {part >= 0 && part < 0.999 && <span class="mark" style={{ left: `calc(46px + (100% - 60px) * ${part})` }} />}
      </div>
      <ul class="legend">
        {props.lines.map((line, i) => {
          const here = value(i);
          return (
            <li key={line.label}>
              <span class="swatch" style={{ background: line.color }} />
              {line.label}
              <b>{here === null || here === undefined ? '–' : short(here)}</b>
            </li>
          );
        })}
      </ul>
    </figure>
  );
}
