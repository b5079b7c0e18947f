// Worlds, and recordings of them in memory.
import { RecorderBase, type RecordOptions, WorldBase, writeRecordOptions } from './generated.js';
import { type Handle, Runtime } from './runtime.js';
import { GyreError } from './stream.js';

/** Records a world from now on, until finish(). */
export class Recorder extends RecorderBase {
  private over = false;

  /** @internal Made by World.record(). */
  constructor(
    private readonly world: World,
    pointer: number,
  ) {
    super(world.runtime, pointer, world);
  }

  /** The bytes since the last take(), to be stored one after the other; finish() gives the rest. */
  take(): Uint8Array {
    return this.bytes(false);
  }

  /** Ends the recording. */
  finish(): Uint8Array {
    const rest = this.bytes(true);
    this.over = true;
    this.dispose();
    return rest;
  }

  /** Ends the recording; what was not taken is lost. */
  override dispose(): void {
    if (!this.over && !this.world.disposed) {
      this.bytes(true);
      this.over = true;
    }
    super.dispose();
  }

  private bytes(finish: boolean): Uint8Array {
    if (this.over) throw new GyreError('this recording has been finished', -1);
    this.world.runtime.begin();
    return this.world.runtime.call('gyre_recorder_take', this.world.pointer, finish ? 1 : 0).bytes();
  }
}

export class World extends WorldBase {
  constructor(runtime: Runtime, pointer: number, owner?: Handle) {
    super(runtime, pointer, owner);
  }

  /** Records from here on into memory, beginning with the present state. A world has one recorder at a time. */
  record(options?: RecordOptions): Recorder {
    const w = this.runtime.begin();
    if (w.given(options)) writeRecordOptions(w, options);
    return new Recorder(this, this.runtime.call('gyre_recorder_start', this.pointer).number());
  }
}

Runtime.makeWorld = (runtime, pointer, owner) => new World(runtime, pointer, owner);
