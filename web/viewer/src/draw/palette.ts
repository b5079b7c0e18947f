// Colours: of materials and bodies, and of the two themes. Picked to be told apart on light and dark ground alike.
import { Color, SRGBColorSpace } from 'three';
import type { Theme } from '../state/preferences';

const HUES = ['#e76f51', '#3d8bd4', '#e9b949', '#2fa58e', '#9277d8', '#d9628f', '#7fae42', '#5b7186', '#c98a5b', '#44b4c8'];

// Names of materials that everybody has a picture of.
const KNOWN: Record<string, string> = {
  stone: '#9a9a94',
  concrete: '#a5a49e',
  brick: '#b5583f',
  wood: '#c18a4f',
  oak: '#b07a42',
  steel: '#8fa3b8',
  metal: '#8fa3b8',
  lead: '#6b7280',
  gold: '#e3b341',
  copper: '#c9774b',
  ice: '#a8d8ea',
  rubber: '#4b5563',
  glass: '#9fd3cf',
  cloth: '#2f8f6b',
  felt: '#2f8f6b',
  card: '#e8e2d4',
  table: '#8a6b4d',
  pin: '#f1efe9',
  ivory: '#f1e9d2',
};

export interface ThemeColors {
  sky: Color;
  horizon: Color;
  ground: Color;
  gridMajor: Color;
  gridMinor: Color;
  fixed: Color; // bodies that never move and have no material
  selection: Color;
  link: Color; // rods, ropes, springs
  hemisphereSky: Color;
  hemisphereGround: Color;
  sun: number; // intensity
  ambient: number;
}

export const themes: Record<Theme, ThemeColors> = {
  dark: {
    sky: new Color('#12161d'),
    horizon: new Color('#1b212b'),
    ground: new Color('#2b323d'),
    gridMajor: new Color('#3f4a5a'),
    gridMinor: new Color('#343d4a'),
    fixed: new Color('#5d6875'),
    selection: new Color('#7aa2ff'),
    link: new Color('#a3b1c4'),
    hemisphereSky: new Color('#b8c8e8'),
    hemisphereGround: new Color('#2a2723'),
    sun: 3.0,
    ambient: 1.5,
  },
  light: {
    sky: new Color('#e9eef5'),
    horizon: new Color('#dfe6ef'),
    ground: new Color('#d9e0e9'),
    gridMajor: new Color('#b3bfce'),
    gridMinor: new Color('#c8d2de'),
    fixed: new Color('#a7b1bd'),
    selection: new Color('#2f6bff'),
    link: new Color('#56637a'),
    hemisphereSky: new Color('#ffffff'),
    hemisphereGround: new Color('#b9b2a6'),
    sun: 2.6,
    ambient: 1.75,
  },
};

// A name that is not known gets a hue by its letters, the same in every scene.
export function materialColor(name: string, out: Color): Color {
  let sum = 0;
  for (const letter of name) sum = (sum * 31 + letter.codePointAt(0)!) % 9973;
  return out.set(KNOWN[name.toLowerCase()] ?? HUES[sum % HUES.length]!);
}

export function bodyColor(index: number, out: Color): Color {
  return out.set(HUES[index % HUES.length]!);
}

// Neighbouring numbers get colours far apart: steps of the golden angle around the wheel.
export function numberColor(number: number, out: Color): Color {
  return out.setHSL((number * 0.61803398875) % 1, 0.55, 0.55);
}

// From still (blue) over moving (green) to fast (red); `part` from 0 to 1.
export function heatColor(part: number, out: Color): Color {
  const clamped = Math.min(Math.max(part, 0), 1);
  return out.setHSL(0.62 * (1 - clamped), 0.7, 0.5);
}

// The same as the page's own colours have them, so that a picture looks as its key does.
export function readingColor(part: number, out: Color): Color {
  const clamped = Math.min(Math.max(part, 0), 1);
  return out.setHSL(0.62 * (1 - clamped), 0.7, 0.5, SRGBColorSpace);
}

export const awakeColor = new Color('#e9a13b');
export const asleepColor = new Color('#5f7696');

export const overlayColors = {
  bears: new Color('#ffc933'),
  slides: new Color('#ff5d5d'),
  near: new Color('#8fa0b5'),
  tangent1: new Color('#35d0ba'),
  tangent2: new Color('#5aa9ff'),
  friction: new Color('#ff7a2f'),
  bounds: new Color('#7ac943'),
  linear: new Color('#2fb6f0'),
  angular: new Color('#f0388f'),
  center: new Color('#ffc933'),
  ellipsoid: new Color('#b388ff'),
  axisX: new Color('#ff5d5d'),
  axisY: new Color('#5fd05f'),
  axisZ: new Color('#5aa9ff'),
  gap: new Color('#ff3df2'),
  link: new Color('#9fb0c5'),
};
