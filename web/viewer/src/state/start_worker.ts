// Starts the worker with the engine, from a file beside the page. The pages of the course have it inside themselves instead
// (web/course/src/start_worker.ts), so that they also run from a folder of files without a server.
export function startWorker(): Worker {
  return new Worker(new URL('../worker/worker.ts', import.meta.url), { type: 'module', name: 'gyre' });
}
