// Keeps the report on what is selected fresh: asked for at a reader's pace, never two questions at a time.
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
      const body = store.selected.value;
      const soft = store.selectedSoft.value;
      store.report.value = null;
      if (body === null) store.following.value = false;
      if (body !== null || soft !== null) this.ask();
    });
  }

  private question(): { name: 'inspect' | 'inspect_soft'; key: number } | null {
    const body = store.selected.peek();
    const soft = store.selectedSoft.peek();
    if (body !== null) return { name: 'inspect', key: body };
    return soft === null ? null : { name: 'inspect_soft', key: soft };
  }

  follow(_frame: Frame): void {
    if (this.question() === null) return;
    if (store.playing.peek() && performance.now() - this.asked < PACE) return;
    this.ask();
  }

  private ask(): void {
    if (this.waiting) {
      this.again = true;
      return;
    }
    const question = this.question();
    if (question === null) return;
    const { name, key } = question;
    this.waiting = true;
    this.again = false;
    this.asked = performance.now();
    this.playback.client
      .request(name, { key })
      .then(
        (report) => {
          const now = this.question();
          if (now?.name !== name || now.key !== key) return;
          store.report.value = report;
          if (!report) store.select(null);
        },
        () => undefined, // the reason is shown by what failed first
      )
      .finally(() => {
        this.waiting = false;
        if (this.again) this.ask();
      });
  }
}
