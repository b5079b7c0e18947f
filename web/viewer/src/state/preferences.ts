// What the visitor chose and wants to find again: theme, overlays, colours, quality. Kept in the browser.
import { effect, signal, type Signal } from '@preact/signals';
import type { OverlayName, Throwable } from '../protocol';

export type Theme = 'light' | 'dark';
export type ColorBy = 'scene' | 'material' | 'body' | 'sleep' | 'speed';
export type Quality = 'high' | 'low';

function kept<T>(name: string, first: T, valid: (value: unknown) => boolean): Signal<T> {
  const key = `gyre.${name}`;
  let start = first;
  try {
    const text = localStorage.getItem(key);
    const value: unknown = text === null ? undefined : JSON.parse(text);
    if (valid(value)) start = value as T;
  } catch {
    // Storage is switched off or holds something else: the first value is as good.
  }
  const result = signal<T>(start);
  effect(() => {
    const value = result.value;
    try {
      localStorage.setItem(key, JSON.stringify(value));
    } catch {
      // Not kept, then.
    }
  });
  return result;
}

const oneOf =
  (...values: string[]) =>
  (value: unknown): boolean =>
    typeof value === 'string' && values.includes(value);

const query = new URLSearchParams(location.search);
const systemTheme: Theme = matchMedia('(prefers-color-scheme: light)').matches ? 'light' : 'dark';

export const theme = kept<Theme>('theme', systemTheme, oneOf('light', 'dark'));
export const colorBy = kept<ColorBy>('colorBy', 'scene', oneOf('scene', 'material', 'body', 'sleep', 'speed'));
export const quality = kept<Quality>('quality', 'high', oneOf('high', 'low'));
export const throwable = kept<Throwable>('throwable', 'ball', oneOf('ball', 'box', 'capsule', 'cylinder', 'cone'));
export const throwSpeed = kept<number>('throwSpeed', 18, (v) => typeof v === 'number' && v > 0 && v <= 200);
export const overlays = signal<ReadonlySet<OverlayName>>(new Set());

// An address can ask for a look: /?theme=dark&quality=low&overlays=contacts,bounds
if (oneOf('light', 'dark')(query.get('theme'))) theme.value = query.get('theme') as Theme;
if (oneOf('high', 'low')(query.get('quality'))) quality.value = query.get('quality') as Quality;
const asked = query.get('overlays');
if (asked) overlays.value = new Set(asked.split(',').filter((name) => name in { contacts: 1, friction: 1, bounds: 1, tree: 1, islands: 1, mass: 1, joints: 1, velocities: 1, hulls: 1, flow: 1, speed: 1, particles: 1, stress: 1, strain: 1 }) as OverlayName[]);

export function toggleOverlay(name: OverlayName): void {
  const next = new Set(overlays.value);
  if (!next.delete(name)) next.add(name);
  // Soft matter has one colour.
  if (name === 'stress') next.delete('strain');
  if (name === 'strain') next.delete('stress');
  overlays.value = next;
}

export function toggleTheme(): void {
  theme.value = theme.value === 'dark' ? 'light' : 'dark';
}
