// What the page shows, as signals. The frame itself changes sixty times a second and is no signal: whoever draws it listens with
// onFrame; the interface reads the few numbers it shows from `shown`, which follows at a reader's pace.
import { batch, signal } from '@preact/signals';
import type { BodyReport, SceneDescription, SoftReport, Stats } from '../protocol';

// Whether the page can run scenes; one without the engine plays recordings (vite.config.ts).
export const hasEngine: boolean = import.meta.env.MODE !== 'recordings';

export type Panel = 'inspect' | 'overlays' | 'world' | 'charts';

export interface SceneEntry {
  name: string; // as in the scene file
  file: string; // under scenes/, one folder deep at most
  thumbnail: string | null; // under scenes/
  bodies: number;
  joints: number;
  ropes: number;
  cloths: number;
  softBodies: number;
  gases: number;
  liquids: number;
}

export interface Notice {
  title: string;
  text: string;
  fatal: boolean; // nothing is open behind it
}

export interface ReadingKey {
  what: 'stress' | 'strain';
  low: number; // Pa, or a share
  high: number;
}

export const scene = signal<SceneDescription | null>(null);
export const opening = signal<string | null>(null); // the name of what is being opened
export const notice = signal<Notice | null>(null);

export const playing = signal(false);
export const speed = signal(1);
export const step = signal(0);
export const lastStep = signal(0);
export const time = signal(0);
export const stats = signal<Stats | null>(null);
export const readingKey = signal<ReadingKey | null>(null); // of the colours of soft matter; null: they are its own
export const framesPerSecond = signal(0);

export const selected = signal<number | null>(null); // key of a body
export const selectedSoft = signal<number | null>(null); // key of a rope, cloth or solid; one of the two at most
export const report = signal<BodyReport | SoftReport | null>(null);
export const following = signal(false);

export const panel = signal<Panel | null>(null);
export const scenesOpen = signal(false);
export const helpOpen = signal(false);
export const sceneList = signal<SceneEntry[]>([]);

export function select(body: number | null, soft: number | null = null): void {
  batch(() => {
    selected.value = body;
    selectedSoft.value = soft;
  });
}
