// Worlds, and recordings of them in memory.
import { type FluidId, RecorderBase, type RecordOptions, WorldBase, writeRecordOptions } from './generated.js';
import { type Handle, Runtime } from './runtime.js';
import { GyreError, type Numbers, type VectorInput } from './stream.js';

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

  /** The velocity (m/s) of a fluid at many points, 3 numbers each. */
  sampleVelocity(fluid: FluidId, points: Numbers | readonly VectorInput[]): Float32Array {
    const w = this.runtime.begin();
    w.id(fluid, 'sampleVelocity: fluid');
    w.list(points, 3, 'sampleVelocity: points');
    return this.runtime.call('gyre_sample_velocity', this.pointer).array(Float32Array, 3);
  }

  /** The particles of a liquid, 3 numbers each: m and m/s. */
  liquidParticles(fluid: FluidId): { positions: Float64Array; velocities: Float32Array } {
    const w = this.runtime.begin();
    w.id(fluid, 'liquidParticles: fluid');
    const r = this.runtime.call('gyre_liquid_particles', this.pointer);
    return { positions: r.array(Float64Array, 3), velocities: r.array(Float32Array, 3) };
  }

  /** The surface of a liquid, made anew at each call: vertices (3 numbers each, m) and triangles, counter-clockwise seen from outside. */
  liquidSurface(fluid: FluidId): { vertices: Float32Array; indices: Uint32Array } {
    const w = this.runtime.begin();
    w.id(fluid, 'liquidSurface: fluid');
    const r = this.runtime.call('gyre_liquid_surface', this.pointer);
    return { vertices: r.array(Float32Array, 3), indices: r.array(Uint32Array, 1) };
  }
}

Runtime.makeWorld = (runtime, pointer, owner) => new World(runtime, pointer, owner);
