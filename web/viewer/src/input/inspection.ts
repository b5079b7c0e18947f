// Keeps the report on the selected body fresh: asked for at a reader's pace, never two questions at a time.
import { effect } from '@preact/signals';
import type { Playback } from '../playback/playback';
import type { Frame } from '../protocol';
import * as store from '../state/store';

const PACE = 120; // ms

export class Inspection {
  private asked = 0;
  private waiting = false;
  private again = false;

  constructor(private readonly playback: Playback) {
    effect(() => {
      const key = store.selected.value;
      store.report.value = null;
      if (key === null) store.following.value = false;
      else this.ask();
    });
  }

  follow(_frame: Frame): void {
    if (store.selected.peek() === null) return;
    if (store.playing.peek() && performance.now() - this.asked < PACE) return;
    this.ask();
  }

  private ask(): void {
    if (this.waiting) {
      this.again = true;
      return;
    }
    const key = store.selected.peek();
    if (key === null) return;
    this.waiting = true;
    this.again = false;
    this.asked = performance.now();
    this.playback.client
      .request('inspect', { key })
      .then(
        (report) => {
          if (store.selected.peek() !== key) return;
          store.report.value = report;
          if (!report) store.selected.value = null;
        },
        () => undefined, // the reason is shown by what failed first
      )
      .finally(() => {
        this.waiting = false;
        if (this.again) this.ask();
      });
  }
}
