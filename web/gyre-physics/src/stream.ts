// Arguments to the engine and answers from it: rows of numbers in the engine's memory (web/bindings/stream.h says how each kind of
// value is laid out). Nothing here keeps an object per value, and nothing has to be freed.

/** What rows of numbers need of the engine that they belong to. */
export interface Calls {
  readonly exports: Readonly<Record<string, (...numbers: number[]) => number>>;
}
/** What can be handed to the engine: something that lives in it. */
export interface Living {
  readonly runtime: Calls;
  readonly pointer: number;
}

/** Numbers in a row: an array or a typed array. */
export type Numbers = ArrayLike<number>;
/** What results can be written into: an array or a typed array. */
export interface WritableNumbers {
  readonly length: number;
  [index: number]: number;
}
/** Three numbers, or an object with x, y and z (such as a vector of three.js). */
export type VectorInput = ArrayLike<number> | { readonly x: number; readonly y: number; readonly z: number };
/** Four numbers x y z w, or an object with these. */
export type QuaternionInput =
  | ArrayLike<number>
  | { readonly x: number; readonly y: number; readonly z: number; readonly w: number };
export type Bytes = Uint8Array | ArrayBuffer | ArrayBufferView;

/** What the engine refused, in its own words. */
export class GyreError extends Error {
  constructor(
    message: string,
    /** One of ErrorCode. */
    readonly code: number,
  ) {
    super(message);
    this.name = 'GyreError';
  }
}

/** A view over the engine's memory, made anew when that has grown. */
export class Heap {
  buffer: ArrayBufferLike = new ArrayBuffer(0);
  doubles = new Float64Array(0);
  bytes = new Uint8Array(0);

  constructor(private readonly memory: WebAssembly.Memory) {}

  refresh(): void {
    if (this.memory.buffer === this.buffer) return;
    this.buffer = this.memory.buffer;
    this.doubles = new Float64Array(this.buffer);
    this.bytes = new Uint8Array(this.buffer);
  }
}

const encoder = new TextEncoder();
const decoder = new TextDecoder();
const choices = new WeakMap<object, Set<unknown>>();

function shown(value: unknown): string {
  if (typeof value === 'string') return JSON.stringify(value.slice(0, 40));
  if (typeof value === 'bigint') return `${value}n`;
  if (typeof value === 'function') return 'a function';
  if (Array.isArray(value)) return `an array of ${value.length}`;
  if (ArrayBuffer.isView(value)) return `a typed array of ${value.byteLength} bytes`;
  if (typeof value === 'object' && value !== null) return `an object with ${Object.keys(value).join(', ') || 'nothing in it'}`;
  return String(value);
}

export class Writer {
  private at = 0;
  private start = 0;
  private size = 0;
  private readonly allocated: number[] = [];

  constructor(
    private readonly runtime: Calls,
    private readonly heap: Heap,
  ) {}

  begin(): this {
    // Left over from a call whose arguments were refused here.
    for (const address of this.allocated) this.runtime.exports._gyre_free!(address);
    this.allocated.length = 0;
    if (this.size === 0) this.grow(0);
    this.heap.refresh();
    this.at = 0;
    return this;
  }

  /** The engine has taken what was allocated for it. */
  handedOver(): void {
    this.allocated.length = 0;
  }

  private grow(more: number): void {
    const wanted = Math.max(8192, this.size, 2 * (this.at + more));
    this.start = (this.runtime.exports._gyre_arguments!(wanted) >>> 0) / 8;
    this.size = wanted;
    this.heap.refresh();
  }

  private push(value: number): void {
    if (this.at >= this.size) this.grow(1);
    this.heap.doubles[this.start + this.at++] = value;
  }

  wrong(where: string, found: unknown, expected: string): TypeError {
    return new TypeError(`${where}: found ${shown(found)}, expected ${expected}`);
  }

  number(value: number, where: string): void {
    if (typeof value !== 'number') throw this.wrong(where, value, 'a number');
    this.push(value);
  }

  integer(value: number, low: number, high: number, where: string): void {
    if (!Number.isInteger(value) || value < low || value > high) {
      throw this.wrong(where, value, `a whole number from ${low} to ${high}`);
    }
    this.push(value);
  }

  boolean(value: boolean, where: string): void {
    if (typeof value !== 'boolean') throw this.wrong(where, value, 'true or false');
    this.push(value ? 1 : 0);
  }

  choice(value: number, kind: Readonly<Record<string, number>>, where: string): void {
    let known = choices.get(kind);
    if (known === undefined) choices.set(kind, (known = new Set(Object.values(kind))));
    if (!known.has(value)) {
      const names = Object.entries(kind).map(([name, number]) => `${name} (${number})`);
      throw this.wrong(where, value, `one of ${names.join(', ')}`);
    }
    this.push(value);
  }

  id(value: number | null | undefined, where: string): void {
    if (value === null || value === undefined) return this.push(0);
    if (!Number.isSafeInteger(value) || value < 0) throw this.wrong(where, value, 'an id');
    this.push(value);
  }

  /** A 64-bit number; Infinity is the largest. */
  long(value: bigint | number, where: string): void {
    if (value === Infinity) {
      this.push(0xffffffff);
      return this.push(0xffffffff);
    }
    if (typeof value === 'number' && Number.isSafeInteger(value) && value >= 0) {
      this.push(value % 4294967296);
      return this.push(Math.floor(value / 4294967296));
    }
    if (typeof value !== 'bigint' || value < 0n || value > 0xffffffffffffffffn) {
      throw this.wrong(where, value, 'a whole number from 0 to 2^64 - 1');
    }
    this.push(Number(value & 0xffffffffn));
    this.push(Number(value >> 32n));
  }

  /** Of a fixed count, as [x, y, z] or { x, y, z }. */
  vector(value: VectorInput | QuaternionInput | Numbers, count: number, where: string): void {
    if (typeof value !== 'object' || value === null) throw this.wrong(where, value, `${count} numbers`);
    if ('length' in value) {
      if (value.length !== count) throw this.wrong(where, value, `${count} numbers`);
      for (let i = 0; i < count; ++i) this.number(value[i]!, where);
      return;
    }
    const parts = value as { x: number; y: number; z: number; w?: number };
    if (count > 4) throw this.wrong(where, value, `${count} numbers`);
    this.number(parts.x, `${where}.x`);
    this.number(parts.y, `${where}.y`);
    this.number(parts.z, `${where}.z`);
    if (count === 4) this.number(parts.w!, `${where}.w`);
  }

  /** Any number of rows of `width` numbers: flat, or an array of rows. */
  list(value: Numbers | readonly (VectorInput | QuaternionInput)[], width: number, where: string): void {
    if (typeof value !== 'object' || value === null || !('length' in value)) throw this.wrong(where, value, 'an array of numbers');
    if (value.length > 0 && typeof value[0] === 'object') {
      this.reserve(1 + value.length * width);
      this.push(value.length);
      for (let i = 0; i < value.length; ++i) this.vector(value[i] as unknown as Numbers, width, `${where}[${i}]`);
      return;
    }
    const flat = value as Numbers;
    if (flat.length % width !== 0) throw this.wrong(where, value, `a length that is a multiple of ${width}`);
    this.reserve(1 + flat.length);
    this.push(flat.length / width);
    for (let i = 0; i < flat.length; ++i) this.number(flat[i]!, where);
  }

  private reserve(more: number): void {
    if (this.at + more > this.size) this.grow(more);
  }

  fixed<T>(value: readonly T[], count: number, put: (part: T) => void, where: string): void {
    if (!Array.isArray(value) || value.length !== count) throw this.wrong(where, value, `an array of ${count}`);
    for (const part of value as T[]) put(part);
  }

  /** One struct or an array of them. */
  structs<T>(value: T | readonly T[], put: (writer: Writer, part: T) => void, where: string): void {
    const parts = Array.isArray(value) ? (value as T[]) : [value as T];
    for (const part of parts) this.object(part as object, where);
    this.push(parts.length);
    for (const part of parts) put(this, part);
  }

  object<T extends object>(value: T, where: string): T {
    if (typeof value !== 'object' || value === null) throw this.wrong(where, value, 'an object');
    return value;
  }

  /** Begins a struct; `mark` then tells which of its fields follow. */
  open(value: object, keys: ReadonlySet<string>, name: string): number {
    this.object(value, name);
    for (const key in value) {
      if (!keys.has(key)) throw new TypeError(`${name} has no field "${key}"; it has ${[...keys].join(', ')}`);
    }
    this.push(0);
    return this.at - 1;
  }

  mark(bits: number, field: number): void {
    this.heap.doubles[this.start + bits]! += 2 ** field;
  }

  given<T>(value: T | null | undefined): value is T {
    this.push(value == null ? 0 : 1);
    return value != null;
  }

  bytes(value: Bytes, where: string): void {
    let view: Uint8Array;
    if (value instanceof Uint8Array) {
      view = value;
    } else if (ArrayBuffer.isView(value)) {
      view = new Uint8Array(value.buffer, value.byteOffset, value.byteLength);
    } else if (value instanceof ArrayBuffer) {
      view = new Uint8Array(value);
    } else {
      throw this.wrong(where, value, 'bytes (a Uint8Array or an ArrayBuffer)');
    }
    const address = this.runtime.exports._gyre_allocate!(view.length) >>> 0;
    if (address === 0) throw new RangeError(`${where}: no memory for ${view.length} bytes`);
    this.allocated.push(address);
    this.heap.refresh();
    this.heap.bytes.set(view, address);
    this.push(address);
    this.push(view.length);
  }

  text(value: string, where: string): void {
    if (typeof value !== 'string') throw this.wrong(where, value, 'a text');
    this.bytes(encoder.encode(value), where);
  }

  handle(value: Living, where: string): void {
    if (typeof value !== 'object' || value === null || !('pointer' in value)) {
      throw this.wrong(where, value, 'an object of this package');
    }
    if (value.runtime !== this.runtime) throw new TypeError(`${where}: belongs to another load() of the engine`);
    this.push(value.pointer);
  }
}

type ArrayKind<T> = {
  new (buffer: ArrayBufferLike, offset: number, length: number): T;
  new (length: number): T;
  readonly BYTES_PER_ELEMENT: number;
};

/** `Owner` is what objects that are read belong to. */
export class Reader<Owner = unknown> {
  /** Whether arrays are copied: those of calls without an owner are overwritten by the next. */
  copies = false;
  private at = 0;

  constructor(
    readonly runtime: Owner,
    private readonly heap: Heap,
  ) {}

  begin(address: number): this {
    this.heap.refresh();
    this.at = (address >>> 0) / 8;
    this.copies = false;
    return this;
  }

  number(): number {
    return this.heap.doubles[this.at++]!;
  }

  boolean(): boolean {
    return this.number() !== 0;
  }

  /** 64 bits. */
  bits(): bigint {
    const low = this.number();
    return (BigInt(this.number()) << 32n) | BigInt(low);
  }

  /** A 64-bit count; the largest is Infinity. */
  count(): number {
    const low = this.number();
    const high = this.number();
    return low === 0xffffffff && high === 0xffffffff ? Infinity : low + high * 4294967296;
  }

  vector(count: number, out: WritableNumbers = new Array<number>(count)): WritableNumbers {
    for (let i = 0; i < count; ++i) out[i] = this.heap.doubles[this.at++]!;
    return out;
  }

  text(): string {
    const begin = this.number();
    // Decoders do not take shared memory, so the bytes are copied out.
    return decoder.decode(this.heap.bytes.slice(begin, begin + this.number()));
  }

  texts(count: number): string[] {
    const out = new Array<string>(count);
    for (let i = 0; i < count; ++i) out[i] = this.text();
    return out;
  }

  /** A copy of bytes. */
  bytes(): Uint8Array {
    const begin = this.number();
    const out = new Uint8Array(this.number());
    out.set(this.heap.bytes.subarray(begin, begin + out.length));
    return out;
  }

  array<T extends { slice(): T }>(kind: ArrayKind<T>, width: number): T {
    return this.column(kind, width, this.number());
  }

  /** A view over the engine's memory, valid until the world changes. */
  column<T extends { slice(): T }>(kind: ArrayKind<T>, width: number, rows: number): T {
    const address = this.number();
    if (rows === 0) return new kind(0);
    const view = new kind(this.heap.buffer, address, rows * width);
    return this.copies ? view.slice() : view;
  }

  list<T>(read: (reader: this) => T): T[] {
    const out = new Array<T>(this.number());
    for (let i = 0; i < out.length; ++i) out[i] = read(this);
    return out;
  }

  fixed<T>(count: number, read: () => T): T[] {
    const out = new Array<T>(count);
    for (let i = 0; i < count; ++i) out[i] = read();
    return out;
  }
}
