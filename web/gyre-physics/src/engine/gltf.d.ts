export { default, wasm, worker } from './variant.js';
