// Curves over time on a canvas: the newest stretch of time, scaled to what is on it.
import type { Reading } from './lesson';

const SHOWN = 12; // s
const HEIGHT = 130; // CSS pixels

export class Chart {
  readonly element = document.createElement('div');
  private readonly canvas = document.createElement('canvas');
  private readonly legend = document.createElement('div');
  private times: number[] = [];
  private values: number[][];

  constructor(private readonly readings: Reading[]) {
    this.values = readings.map(() => []);
    this.element.className = 'gyre-chart';
    this.legend.className = 'gyre-legend';
    this.canvas.setAttribute('role', 'img');
    this.canvas.setAttribute('aria-label', `Chart over time: ${readings.map(({ label }) => label).join(', ')}`);
    this.element.append(this.canvas, this.legend);
  }

  clear(): void {
    this.times = [];
    this.values = this.readings.map(() => []);
  }

  add(time: number, numbers: number[]): void {
    if (this.times.length > 0 && time <= this.times.at(-1)!) return;
    this.times.push(time);
    numbers.forEach((value, i) => this.values[i]!.push(value));
    let old = 0;
    while (this.times[old]! < time - SHOWN) old++;
    if (old === 0) return;
    this.times.splice(0, old);
    for (const list of this.values) list.splice(0, old);
  }

  draw(): void {
    const ratio = Math.min(devicePixelRatio, 2);
    const width = this.canvas.clientWidth;
    if (width === 0) return;
    this.canvas.width = width * ratio;
    this.canvas.height = HEIGHT * ratio;
    const pen = this.canvas.getContext('2d')!;
    pen.scale(ratio, ratio);
    const style = getComputedStyle(this.element);
    const all = this.values.flat().filter(Number.isFinite);
    if (all.length === 0) return;
    let low = Math.min(...all);
    let high = Math.max(...all);
    const least = 1e-3 * Math.max(Math.abs(low), Math.abs(high), 1e-9);
    if (high - low < least) [low, high] = [low - least, high + least];
    const begin = Math.max(0, this.times.at(-1)! - SHOWN);
    const x = (time: number): number => 56 + ((time - begin) / SHOWN) * (width - 64);
    const y = (value: number): number => 8 + ((high - value) / (high - low)) * (HEIGHT - 16);
    pen.strokeStyle = pen.fillStyle = style.color;
    pen.font = '11px sans-serif';
    pen.textAlign = 'right';
    pen.globalAlpha = 0.7;
    for (const value of [low, (low + high) / 2, high]) pen.fillText(short(value), 50, y(value) + 4);
    pen.globalAlpha = 0.2;
    for (const value of [low, (low + high) / 2, high]) pen.fillRect(56, y(value), width - 64, 1);
    pen.globalAlpha = 1;
    pen.lineWidth = 1.8;
    this.values.forEach((list, i) => {
      pen.strokeStyle = this.readings[i]!.color;
      pen.beginPath();
      list.forEach((value, k) => pen.lineTo(x(this.times[k]!), y(value)));
      pen.stroke();
    });
    this.legend.replaceChildren(...this.readings.map((reading, i) => this.entry(reading, this.values[i]!.at(-1)!)));
  }

  private entry({ label, unit, color }: Reading, value: number): HTMLElement {
    const entry = document.createElement('span');
    const mark = document.createElement('i');
    mark.style.background = color;
    entry.append(mark, `${label}: ${short(value)} ${unit}`);
    return entry;
  }
}

// Four digits are enough to compare two curves.
export function short(value: number): string {
  if (!Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e5 || size < 1e-3)) return value.toExponential(2);
  return String(Number(value.toPrecision(4)));
}
