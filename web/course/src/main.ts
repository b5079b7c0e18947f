// The live scene of a page: <div data-lesson="NAME"> becomes a picture of the running engine with sliders and a chart. The engine and
// all drawing are those of the viewer (../../viewer). A page has one live scene.
import { effect } from '@preact/signals';
import { Vector3 } from 'three';
import { Console } from '../../viewer/src/console';
import type { Frame } from '../../viewer/src/protocol';
import * as preferences from '../../viewer/src/state/preferences';
import * as store from '../../viewer/src/state/store';
import { Viewer } from '../../viewer/src/viewer';
import { Chart } from './chart';
import type { Lesson, Seen, Slider } from './lesson';
import { lessons } from './lessons/all';

type Vector = [number, number, number];

function element<K extends keyof HTMLElementTagNameMap>(kind: K, style: string, text = ''): HTMLElementTagNameMap[K] {
  const made = document.createElement(kind);
  made.className = style;
  made.textContent = text;
  return made;
}

class Live {
  readonly values: Record<string, number> = {};
  private readonly viewer: Viewer;
  private readonly chart: Chart | null;
  private readonly text = element('pre', 'gyre-scene');
  private readonly words = element('p', 'gyre-words');
  private readonly message = element('p', 'gyre-message');
  private readonly control: Console;
  private opening: Promise<void> = Promise.resolve();
  private first = true;
  private rows = new Map<string, number>(); // of names in the frame

  constructor(
    holder: HTMLElement,
    private readonly lesson: Lesson,
  ) {
    const stage = element('div', 'gyre-stage');
    holder.replaceChildren(stage);
    holder.classList.add('gyre-live');
    this.viewer = new Viewer(stage);
    this.control = new Console(this.viewer);
    this.viewer.rig.controls.enableZoom = false; // the wheel scrolls the page
    this.chart = lesson.readings ? new Chart(lesson.readings) : null;
    holder.append(this.buttons());
    for (const one of lesson.sliders) holder.append(this.slider(one));
    if (this.chart) holder.append(this.chart.element);
    const shown = element('details', 'gyre-source');
    shown.append(element('summary', '', 'The scene file of this state'), this.text);
    holder.append(this.words, this.message, shown);
    this.viewer.playback.onFrame((frame) => this.read(frame));
    effect(() => {
      const notice = store.notice.value;
      this.message.textContent = notice ? `${notice.title}: ${notice.text}` : '';
    });
    effect(() => holder.setAttribute('data-step', String(store.step.value)));
    preferences.overlays.value = new Set(lesson.overlays ?? []);
    followTheme();
    // A scene that nobody sees need not run.
    new IntersectionObserver(([entry]) => {
      if (!this.first) store.playing.value = entry!.isIntersecting;
    }).observe(stage);
    setInterval(() => this.chart?.draw(), 100);
    window.gyre = this.control;
    void this.restart();
  }

  private buttons(): HTMLElement {
    const row = element('div', 'gyre-buttons');
    const play = element('button', '', 'Pause');
    play.onclick = () => this.viewer.playback.toggle();
    effect(() => {
      play.textContent = store.playing.value ? 'Pause' : 'Play';
    });
    const again = element('button', '', 'Start again');
    again.onclick = () => void this.restart();
    const step = element('button', '', 'One step');
    step.onclick = () => void this.viewer.playback.advance(1);
    const time = element('span', 'gyre-time');
    effect(() => {
      time.textContent = `${store.time.value.toFixed(2)} s`;
    });
    row.append(play, again, step, time);
    return row;
  }

  private slider(one: Slider): HTMLElement {
    this.values[one.name] = one.value;
    const row = element('label', 'gyre-slider');
    const shown = element('output', '');
    const say = (): void => {
      const value = this.values[one.name]!;
      shown.textContent = one.choices ? one.choices[value]! : `${value} ${one.unit ?? ''}`;
    };
    const change = (value: number): void => {
      this.values[one.name] = value;
      say();
      void this.restart();
    };
    row.append(element('span', '', one.label));
    if (one.choices) {
      const select = element('select', '');
      one.choices.forEach((name, i) => select.append(new Option(name, String(i), i === one.value, i === one.value)));
      select.name = one.name;
      select.onchange = () => change(Number(select.value));
      row.append(select);
    } else {
      const range = element('input', '');
      Object.assign(range, { type: 'range', min: String(one.low), max: String(one.high), step: String(one.step), name: one.name });
      range.value = String(one.value);
      range.onchange = () => change(Number(range.value));
      range.oninput = () => {
        shown.textContent = `${range.value} ${one.unit ?? ''}`;
      };
      row.append(range, shown);
    }
    say();
    return row;
  }

  // The scene anew with the values of the sliders. The reader's view of it stays.
  restart(): Promise<void> {
    this.opening = this.opening.then(() => this.open());
    return this.opening;
  }

  private async open(): Promise<void> {
    const text = JSON.stringify(this.lesson.scene(this.values), null, 1);
    this.text.textContent = compact(text);
    this.chart?.clear();
    this.rows.clear();
    const { camera } = this.viewer.stage;
    const { controls } = this.viewer.rig;
    const [eye, target]: [Vector3, Vector3] = [camera.position.clone(), controls.target.clone()];
    store.notice.value = null;
    store.opening.value = this.lesson.title;
    try {
      await this.viewer.playback.open({ kind: 'bytes', name: `${this.lesson.title}.gyre.json`, bytes: new TextEncoder().encode(text) });
      if (!this.first) {
        camera.position.copy(eye);
        controls.target.copy(target);
      }
      this.first = false;
      store.playing.value = true;
    } catch (error) {
      store.notice.value = { title: 'The scene was refused', text: (error as Error).message, fatal: false };
    } finally {
      store.opening.value = null;
    }
  }

  private read(frame: Frame): void {
    const seen = this.seen(frame);
    const { readings, words } = this.lesson;
    if (readings && this.chart) this.chart.add(frame.time, readings.map((reading) => reading.value(seen, this.values)));
    if (words) this.words.textContent = words.call(this.lesson, seen, this.values);
  }

  private seen(frame: Frame): Seen {
    const row = (name: string): number => {
      const known = this.rows.get(name);
      if (known !== undefined) return known;
      const key = this.control.key(name);
      const found = key === null ? undefined : this.viewer.bodies.rowOf.get(key);
      if (found === undefined) throw new Error(`no body is named ${name}`);
      this.rows.set(name, found);
      return found;
    };
    const three = (list: Float32Array, at: number): Vector => [list[at]!, list[at + 1]!, list[at + 2]!];
    return {
      frame,
      time: frame.time,
      position: (name) => three(frame.poses, 7 * row(name)),
      velocity: (name) => three(frame.velocities, 6 * row(name)),
      spin: (name) => three(frame.velocities, 6 * row(name) + 3),
      vertices: (name) => this.control.vertices(name) ?? [],
    };
  }
}

// Short lists of numbers on one line each.
function compact(text: string): string {
  return text.replace(/\[\s+([^[\]{}]*?)\s+\]/g, (_, inside: string) => `[${inside.replace(/\s+/g, ' ')}]`);
}

// The page's own switch between light and dark.
function followTheme(): void {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  const obey = (): void => {
    const asked = document.body.dataset.theme;
    preferences.theme.value = asked === 'dark' || (asked !== 'light' && dark.matches) ? 'dark' : 'light';
  };
  new MutationObserver(obey).observe(document.body, { attributeFilter: ['data-theme'] });
  dark.addEventListener('change', obey);
  obey();
}

function start(): void {
  const holder = document.querySelector<HTMLElement>('[data-lesson]');
  if (!holder) return;
  const lesson = lessons[holder.dataset.lesson ?? ''];
  if (!lesson) throw new Error(`there is no lesson "${holder.dataset.lesson}"`);
  try {
    const live = new Live(holder, lesson);
    Object.assign(window, { gyreLesson: { lesson, live } }); // for the console, and for tests
  } catch (error) {
    holder.textContent = `The live scene needs WebGL 2: ${(error as Error).message}`;
  }
}

start();
