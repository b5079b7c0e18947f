// A lesson: a scene that depends on a few sliders, and what is read from it while it runs.
import type { Frame, OverlayName } from '../../viewer/src/protocol';

// A number that the reader may change. With `choices` it is the index into them.
export interface Slider {
  name: string; // in the values that scene() gets
  label: string;
  unit?: string;
  low: number;
  high: number;
  step: number;
  value: number; // at first
  choices?: string[];
  decimals?: number;
}

export type Values = Readonly<Record<string, number>>;

// The state after a step, as readings see it.
export interface Seen {
  frame: Frame;
  time: number; // s
  position(name: string): [number, number, number];
  velocity(name: string): [number, number, number];
  spin(name: string): [number, number, number];
  vertices(name: string): number[]; // of a rope, cloth or solid: x, y, z each
}

// A curve of the chart.
export interface Reading {
  label: string;
  unit: string;
  color: string;
  value(seen: Seen, values: Values): number;
}

export interface Lesson {
  title: string;
  sliders: Slider[];
  scene(values: Values): object; // a scene file
  overlays?: OverlayName[];
  readings?: Reading[];
  // A reading in words, under the chart.
  words?(seen: Seen, values: Values): string;
}

export const palette = { red: '#d9603b', blue: '#4a86c5', green: '#4f9d69', yellow: '#c9a227', grey: '#8d99a8', sand: '#cf9a62' };

export const ground = { name: 'ground', type: 'static', shapes: [{ type: 'plane' }], color: '#d6d8dc' };

export function slider(name: string, label: string, low: number, high: number, step: number, value: number, unit = ''): Slider {
  return { name, label, low, high, step, value, unit };
}

export function choice(name: string, label: string, choices: string[], value = 0): Slider {
  return { name, label, low: 0, high: choices.length - 1, step: 1, value, choices };
}

// Numbers that look random and are the same every time (Park and Miller's generator).
export function randoms(seed: number): () => number {
  let state = seed;
  return () => {
    state = (state * 48271) % 2147483647;
    return state / 2147483647;
  };
}
