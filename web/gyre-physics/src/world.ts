// Worlds, and recordings of them in memory.
import { WorldBase } from './generated.js';
import { type Handle, Runtime } from './runtime.js';

/** Records a world from now on, until finish(). */
export class Recorder {
  /** @internal Made by World.record(). */
  constructor(private readonly world: World) {}

  /** The bytes since the last take(), to be stored one after the other; finish() gives the rest. */
  take(): Uint8Array {
    return this.bytes(false);
  }

  /** Ends the recording. */
  finish(): Uint8Array {
    return this.bytes(true);
  }

  private bytes(finish: boolean): Uint8Array {
    this.world.runtime.begin();
    return this.world.runtime.call('gyre_recorder_take', this.world.pointer, finish ? 1 : 0).bytes();
  }
}

export class World extends WorldBase {
  constructor(runtime: Runtime, pointer: number, owner?: Handle) {
    super(runtime, pointer, owner);
  }

  /** Records every command and step from here on into memory. A world has one recorder at a time. */
  record(): Recorder {
    this.runtime.begin();
    this.runtime.call('gyre_recorder_start', this.pointer);
    return new Recorder(this);
  }
}

Runtime.makeWorld = (runtime, pointer, owner) => new World(runtime, pointer, owner);
