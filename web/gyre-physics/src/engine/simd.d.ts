export { default, wasm, compressed, glue, worker } from './variant.js';
