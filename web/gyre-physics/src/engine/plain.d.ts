export { default, wasm, compressed, worker } from './variant.js';
