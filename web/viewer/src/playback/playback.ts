// The clock. Each animation frame says how much time passed; this asks the worker for as many steps as fit, one request at a
// time, and tells how far between the last two states the picture should stand. An engine that cannot keep up plays slower; the
// page never waits for it.
import { batch } from '@preact/signals';
import type { Command, Frame, FrameMessage, NewWorldSettings, OverlayName, Source, Structure } from '../protocol';
import { Client } from '../state/client';
import * as store from '../state/store';

const LONGEST_GAP = 0.1; // s between two pictures that are caught up with; a page that slept does not race afterwards
const READING_PACE = 100; // ms between two updates of the numbers on the page

type FrameListener = (frame: Frame, structure: Structure | null, jumped: boolean) => void;

export class Playback {
  readonly client = new Client();
  private current: Frame | null = null;
  private previous: Frame | null = null;
  private shownTime = 0;
  private busy: Promise<unknown> | null = null;
  private wantedStep: number | null = null;
  private wantedOverlays: OverlayName[] | null = null;
  private commands: Command[] = [];
  private readonly listeners: FrameListener[] = [];
  private readonly openListeners: (() => void)[] = [];
  private overlayNames: OverlayName[] = [];
  private lastRead = 0;

  onFrame(listener: FrameListener): void {
    this.listeners.push(listener);
  }

  // Called when another scene is open, before its first frame.
  onOpen(listener: () => void): void {
    this.openListeners.push(listener);
  }

  get frame(): Frame | null {
    return this.current;
  }

  // Two states and where between them the picture stands, from 0 to 1.
  between(): { from: Frame; to: Frame; part: number } | null {
    const to = this.current;
    if (!to) return null;
    const from = this.previous;
    if (!from || from.structure !== to.structure || from.time >= to.time || to.time - from.time > 0.5) return { from: to, to, part: 1 };
    const part = (this.shownTime - from.time) / (to.time - from.time);
    return { from, to, part: Math.min(Math.max(part, 0), 1) };
  }

  // ------------------------------------------------------------------------------------------------------------ one scene

  async open(source: Source, settings: NewWorldSettings = {}): Promise<void> {
    this.commands = [];
    this.wantedStep = null;
    await this.idle();
    const transfer = source.kind === 'bytes' ? [source.bytes.buffer] : [];
    const answer = await this.exclusively(() => this.client.request('open', { source, settings }, transfer as Transferable[]));
    batch(() => {
      store.scene.value = answer.scene;
      store.select(null);
      store.report.value = null;
      store.following.value = false;
      store.speed.value = 1;
    });
    this.current = null;
    this.previous = null;
    for (const listener of this.openListeners) listener();
    this.take(answer.frame, true);
    if (this.overlayNames.length > 0) this.overlays(this.overlayNames);
  }

  async configure(settings: NewWorldSettings): Promise<void> {
    await this.idle();
    const answer = await this.exclusively(() => this.client.request('configure', { settings }));
    store.scene.value = answer.scene;
    this.take(answer.frame, true);
  }

  // ----------------------------------------------------------------------------------------------------------- being driven

  tick(seconds: number): void {
    const passed = Math.min(seconds, LONGEST_GAP) * store.speed.value;
    const frame = this.current;
    if (!frame) return;
    if (store.playing.value) {
      this.shownTime = Math.min(this.shownTime + passed, frame.time);
      if (!this.busy) this.askFor(passed);
    } else {
      this.shownTime = frame.time;
      this.pump();
    }
  }

  // As many steps as the time to the next picture will need, once the picture has nearly used up what is there.
  private askFor(passed: number): void {
    const scene = store.scene.peek();
    const frame = this.current;
    if (!scene || !frame || this.pump()) return;
    const { timeStep } = scene.settings;
    if (this.shownTime + passed < frame.time) return;
    if (!scene.live && frame.step >= frame.lastStep) {
      store.playing.value = false;
      return;
    }
    const steps = Math.max(1, Math.min(Math.round(passed / timeStep), 32));
    this.send(() => this.client.request('advance', { steps, commands: this.takeCommands() }), false);
  }

  private takeCommands(): Command[] {
    const commands = this.commands;
    this.commands = [];
    return commands;
  }

  // Sends what waits; false if nothing did. While time runs, commands travel with the next step.
  private pump(): boolean {
    if (this.busy) return true;
    if (this.wantedOverlays) {
      const names = this.wantedOverlays;
      this.wantedOverlays = null;
      this.send(() => this.client.request('overlays', { names }), false);
    } else if (this.wantedStep !== null) {
      const step = this.wantedStep;
      this.wantedStep = null;
      this.send(() => this.client.request('seek', { step }), true);
    } else if (this.commands.length > 0 && !store.playing.peek()) {
      this.send(() => this.client.request('advance', { steps: 0, commands: this.takeCommands() }), false);
    } else {
      return false;
    }
    return true;
  }

  play(): void {
    const scene = store.scene.peek();
    if (!scene) return;
    if (!scene.live && store.step.peek() >= store.lastStep.peek()) this.seek(0);
    store.playing.value = true;
  }

  pause(): void {
    store.playing.value = false;
  }

  toggle(): void {
    if (store.playing.peek()) this.pause();
    else this.play();
  }

  // One step on; resolves when it is on the page.
  async advance(steps = 1): Promise<void> {
    this.pause();
    await this.idle();
    await this.sendAndWait(() => this.client.request('advance', { steps, commands: this.takeCommands() }), steps !== 1);
  }

  // The last place asked for wins; those in between are passed over.
  seek(step: number): void {
    this.wantedStep = Math.max(0, Math.round(step));
    this.pump();
  }

  async seekAndWait(step: number): Promise<void> {
    this.pause();
    await this.idle();
    await this.sendAndWait(() => this.client.request('seek', { step }), true);
  }

  // While a body is pulled or a gas stirred, only the newest place matters.
  command(command: Command): void {
    if ((command.do === 'pull' || command.do === 'stir') && this.commands.at(-1)?.do === command.do) this.commands.pop();
    this.commands.push(command);
    this.pump();
  }

  overlays(names: OverlayName[]): void {
    this.overlayNames = names;
    this.wantedOverlays = names;
    if (this.current) this.pump();
    else this.wantedOverlays = null;
  }

  // ------------------------------------------------------------------------------------------------------------ the worker

  // Until nothing is under way or waits to be sent.
  async idle(): Promise<void> {
    while (this.pump()) await this.busy?.catch(() => undefined);
  }

  private async exclusively<T>(work: () => Promise<T>): Promise<T> {
    const promise = work();
    this.busy = promise;
    try {
      return await promise;
    } finally {
      this.busy = null;
    }
  }

  private async sendAndWait(work: () => Promise<FrameMessage>, jumped: boolean): Promise<void> {
    this.take(await this.exclusively(work), jumped);
  }

  private send(work: () => Promise<FrameMessage>, jumped: boolean): void {
    this.sendAndWait(work, jumped).then(
      () => this.pump(),
      (error: Error) => {
        store.playing.value = false;
        store.notice.value = { title: 'The simulation stopped', text: error.message, fatal: false };
      },
    );
  }

  private take(message: FrameMessage, jumped: boolean): void {
    const { frame, structure } = message;
    if (jumped || this.current?.structure !== frame.structure) this.previous = null;
    else if (this.current.step !== frame.step) this.previous = this.current;
    this.current = frame;
    if (!this.previous) this.shownTime = frame.time;
    for (const listener of this.listeners) listener(frame, structure, jumped);
    this.tell(frame, jumped);
    this.tellSettings(frame);
    if (frame.problem) {
      store.playing.value = false;
      store.notice.value = { title: 'The engine refused', text: frame.problem, fatal: false };
    }
  }

  // Where the past or what was done in it is played again, its settings come with it. Those that the visitor is just changing are
  // on the page already, and on their way to the engine.
  private tellSettings({ settings: now }: Frame): void {
    const scene = store.scene.peek();
    if (!scene || !now || this.commands.length > 0) return;
    const { gravity, substeps, sleeping } = scene.settings;
    if (substeps === now.substeps && sleeping === now.sleeping && gravity.every((value, i) => value === now.gravity[i])) return;
    store.scene.value = { ...scene, settings: { ...scene.settings, ...now } };
  }

  private tell(frame: Frame, jumped: boolean): void {
    const now = performance.now();
    batch(() => {
      store.step.value = frame.step;
      store.lastStep.value = frame.lastStep;
      store.time.value = frame.time;
      if (jumped || !store.playing.peek() || now - this.lastRead > READING_PACE) {
        this.lastRead = now;
        store.stats.value = frame.stats;
      }
    });
  }
}
