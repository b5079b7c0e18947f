// What is open: a scene that is simulated (live_session.ts) or a recording that is played (track_session.ts).
import type { BodyReport, Command, FrameMessage, NewWorldSettings, OverlayName, SceneDescription, SoftReport } from '../protocol';

export interface Session {
  describe(): SceneDescription;
  // The frame as it stands. `fresh`: the page knows nothing yet.
  frame(fresh?: boolean): FrameMessage;
  advance(steps: number, commands: readonly Command[]): FrameMessage | Promise<FrameMessage>;
  seek(step: number): FrameMessage | Promise<FrameMessage>;
  setOverlays(names: readonly OverlayName[]): void;
  configure(settings: NewWorldSettings): void;
  inspect(key: number): BodyReport | null;
  inspectSoft(key: number): SoftReport | null;
  hash(): string;
  save(what: 'scene' | 'snapshot'): { name: string; bytes: Uint8Array };
  close(): void;
}
