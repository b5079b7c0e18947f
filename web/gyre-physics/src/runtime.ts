// One loaded engine: its functions, its memory, and the handles of what lives in it.
import { GyreError, Heap, Reader, Writer } from './stream.js';

/** Which of the three builds of the engine runs. */
export type Build = 'simd' | 'threads' | 'plain';

export type EngineExports = Record<string, (...numbers: number[]) => number>;
export interface Engine {
  exports: EngineExports;
  memory: WebAssembly.Memory;
  build: Build;
  /** Threads that stand ready besides the one that calls. */
  workers: number;
  close(): void;
}

/** What a call gives back, to be read in order. */
export type Answer = Reader<Runtime>;

export class Runtime {
  readonly exports: EngineExports;
  readonly build: Build;
  /** Makes the class of worlds; set by it, since it builds on this. */
  static makeWorld: (runtime: Runtime, pointer: number, owner?: Handle) => Handle;

  private readonly writer: Writer;
  private readonly reader: Answer;
  private readonly registry: FinalizationRegistry<number> | undefined;
  private stopped = '';

  constructor(readonly engine: Engine) {
    this.exports = engine.exports;
    this.build = engine.build;
    const heap = new Heap(engine.memory);
    this.writer = new Writer(this, heap);
    this.reader = new Reader(this, heap);
    if (typeof FinalizationRegistry !== 'undefined') {
      this.registry = new FinalizationRegistry((pointer) => this.release(pointer));
    }
  }

  /** Begins the arguments of a call. */
  begin(): Writer {
    if (this.stopped !== '') throw new GyreError(this.stopped, -1);
    return this.writer.begin();
  }

  /** Calls the engine; throws what it refuses. The reader stands at the answer. */
  call(name: string, pointer: number, extra = 0): Answer {
    this.writer.handedOver();
    const run = this.exports[`_${name}`];
    if (run === undefined) throw new GyreError(`the engine has no function ${name}`, -1);
    let address: number;
    try {
      address = run(pointer, extra);
    } catch (error) {
      this.stopped = `the engine has stopped (${String(error)}); load() it again`;
      throw new GyreError(this.stopped, -1);
    }
    if (address !== 0) return this.reader.begin(address);
    const reader = this.reader.begin(this.exports._gyre_error!());
    const code = reader.number();
    throw new GyreError(reader.text(), code);
  }

  /** `World` is the class that makeWorld makes, which builds on this one and so is not named here. */
  world<World extends Handle>(pointer: number, owner?: Handle): World {
    return Runtime.makeWorld(this, pointer, owner) as World;
  }

  watch(handle: Handle, pointer: number): void {
    this.registry?.register(handle, pointer, handle);
  }

  unwatch(handle: Handle): void {
    this.registry?.unregister(handle);
  }

  release(pointer: number): void {
    if (this.stopped === '') this.exports._gyre_release!(pointer);
  }

  close(): void {
    this.stopped = 'the engine was closed';
    this.engine.close();
  }
}

/** Something that lives in the engine. It goes when nobody refers to it any more, or at once with dispose(). */
export abstract class Handle {
  private address: number;

  constructor(
    readonly runtime: Runtime,
    pointer: number,
    /** What it is a part of, and lives as long as. */
    protected readonly owner?: Handle,
  ) {
    this.address = pointer;
    if (owner === undefined) runtime.watch(this, pointer);
  }

  /** @internal */
  get pointer(): number {
    if (this.address === 0) throw new GyreError('this object was disposed of', -1);
    this.owner?.pointer; // gone with its owner
    return this.address;
  }

  get disposed(): boolean {
    return this.address === 0 || (this.owner?.disposed ?? false);
  }

  /** Gives the memory back now instead of when the object is found unused. */
  dispose(): void {
    if (this.address === 0) return;
    const pointer = this.address;
    this.address = 0;
    if (this.owner !== undefined) return;
    this.runtime.unwatch(this);
    this.runtime.release(pointer);
  }

  /** @internal For `using`; left out of the types, which older compilers read too. */
  [Symbol.dispose](): void {
    this.dispose();
  }
}
