// What each file of dist/engine exports; tools/build_web.sh makes them from the output of emscripten.

/** Emscripten's loader. */
declare const create: (module: Record<string, unknown>) => Promise<Record<string, unknown>>;
export default create;
/** The WebAssembly module, packed with zstd, in base64. */
export declare const wasm: string;
/** With threads: the code of a worker; otherwise empty. */
export declare const worker: string;
