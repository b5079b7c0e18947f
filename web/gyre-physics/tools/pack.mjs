// Makes one JavaScript file of what emscripten wrote: the loader, and the WebAssembly module, packed with zstd (12 % smaller than the
// smallest gzip, and unpacked as soon) and in base64.
//
//   node pack.mjs simd|threads|plain|gltf FROM TO     FROM is the folder of emscripten's output; "none" makes an empty build
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';
import { transformSync } from 'esbuild';

const [build, from, to] = process.argv.slice(2);
if (!to) throw new Error('usage: pack.mjs simd|threads|plain|gltf FROM TO');

if (from === 'none') {
  mkdirSync(to, { recursive: true });
  writeFileSync(join(to, `${build}.js`), "export default undefined;\nexport const wasm = '';\nexport const worker = '';\n");
  process.exit(0);
}

/** Replaces what must be there; another emscripten may write it in another way, and then somebody has to look. */
function replace(text, what, by) {
  if (!text.includes(what)) throw new Error(`pack.mjs: emscripten's loader no longer has ${what}`);
  return text.replace(what, by);
}

const program = build === 'gltf' ? 'gyre_import' : 'gyre_web';
let glue = readFileSync(join(from, `${program}.mjs`), 'utf8');
// Twice more, for size: 1.4 % of a packed module, where -Oz, here or for emscripten's link, leaves fewer bytes that pack worse. Nothing
// lies in the first 1,024 bytes (GLOBAL_BASE, ../../bindings), so what is added to an address can go into the access: another 1.2 %.
const module = join(from, `${program}.small.wasm`);
// The reader of glTF may come from a folder with SIMD; nothing is added where it does not.
const features = {
  simd: ['--enable-simd'],
  threads: ['--enable-simd', '--enable-threads', '--enable-bulk-memory', '--enable-sign-ext'],
  plain: [],
  gltf: ['--enable-simd'],
}[build];
execFileSync('wasm-opt', ['--enable-mutable-globals', ...features, '--low-memory-unused', '-Os', '-Os', join(from, `${program}.wasm`), '-o', module]);
const wasm = readFileSync(module);
const packed = execFileSync('zstd', ['--ultra', '-22', '--no-check', '-q', '-c', module], { maxBuffer: wasm.length });

// The views over the memory are made on our side.
glue = replace(glue, 'updateGlobalBufferAndViews(wasmMemory.buffer)', 'Module["wasmMemory"]=wasmMemory,updateGlobalBufferAndViews(wasmMemory.buffer)');

// Bundlers take `new URL("file", import.meta.url)` for a file to copy; the module is handed over as bytes instead.
glue = glue.replace(/new URL\((["'][^"']*["']),\s*import\.meta\.url\)(\.toString\(\)|\.href)?/g, '$1');

// Emscripten leaves blanks and long names: a fifth of what the loader packs to.
const minified = (text) => transformSync(text, { minify: true, format: 'esm', target: 'es2020' }).code;

const parts = [];
if (build === 'threads') {
  // Node has no navigator; src/load.ts knows how many cores there are.
  glue = replace(glue, 'navigator["hardwareConcurrency"]', '(Module["cores"]||1)');
  // Workers are made by src/load.ts, each from one text: the loader, and emscripten's code around a thread.
  if (!/new Worker\(/.test(glue)) throw new Error('pack.mjs: the loader makes no workers');
  glue = glue.replace(/new Worker\([^()]*\)/g, 'Module["createWorker"]()');
  const around = readFileSync(join(from, 'gyre_web.worker.js'), 'utf8');
  const loading = /\(e\.data\.urlOrBlob\s*\?[^.]*import\(e\.data\.urlOrBlob\)\s*:\s*import\([^)]*\)\)\.then\(function\s*\(exports\)\s*\{\s*return exports\.default\(Module\);?\s*\}\)/;
  if (!loading.test(around)) throw new Error('pack.mjs: the worker loads its code in another way');
  let inside = replace(glue, 'import.meta.url', '""');
  inside = replace(inside, 'export default createGyre;', '');
  parts.push(`export const worker = ${JSON.stringify(minified(inside + around.replace(loading, 'createGyre(Module)')))};`);
} else {
  parts.push(`export const worker = '';`);
}
// The number by which tools/build_web.sh sees that a file is out of date.
const version = readFileSync(join(from, 'bindings/bindings.cpp'), 'utf8').match(/gyre_bindings_version\(\) \{ return (\d+); \}/)[1];
parts.unshift(`// bindings ${version}`, minified(glue), `export const wasm = '${packed.toString('base64')}';`);
mkdirSync(to, { recursive: true });
writeFileSync(join(to, `${build}.js`), parts.join('\n'));
const size = gzipSync(parts.join('\n'), { level: 9 }).length;
console.log(`${build}: module ${wasm.length} bytes, ${packed.length} packed; file ${size} packed`);
