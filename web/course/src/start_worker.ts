// Starts the worker with the engine from text inside the page: a page that was opened as a file may load no other file as a worker.
import InlineWorker from '../../viewer/src/worker/worker.ts?worker&inline';

export function startWorker(): Worker {
  return new InlineWorker({ name: 'gyre' });
}
