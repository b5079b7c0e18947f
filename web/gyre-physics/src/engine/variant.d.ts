// What each file of dist/engine exports; tools/build_web.sh makes them from the output of emscripten.

/** Emscripten's loader. */
declare const create: (module: Record<string, unknown>) => Promise<Record<string, unknown>>;
export default create;
/** The WebAssembly module in base64. */
export declare const wasm: string;
/** Whether the module was packed with gzip first. */
export declare const compressed: boolean;
/** With threads: the code of a worker; otherwise empty. */
export declare const worker: string;
