// The page's end of the line to the worker: a promise for every request.
import type { AnswerMessage, RequestMessage, RequestName, Requests } from '../protocol';
import { startWorker } from './start_worker';

interface Waiting {
  resolve: (answer: never) => void;
  reject: (error: Error) => void;
}

export class Client {
  private readonly worker: Worker;
  private readonly waiting = new Map<number, Waiting>();
  private nextId = 1;
  private broken: Error | null = null;

  constructor() {
    this.worker = startWorker();
    this.worker.onmessage = (event: MessageEvent<AnswerMessage>) => this.receive(event.data);
    this.worker.onerror = (event) => {
      event.preventDefault();
      this.fail(new Error(`The engine stopped: ${event.message || 'its worker could not be started'}.`));
    };
  }

  request<N extends RequestName>(name: N, ask: Requests[N]['ask'], transfer: Transferable[] = []): Promise<Requests[N]['answer']> {
    if (this.broken) return Promise.reject(this.broken);
    const id = this.nextId++;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve: resolve as (answer: never) => void, reject });
      const message: RequestMessage<N> = { id, name, ask };
      this.worker.postMessage(message, transfer);
    });
  }

  private receive(message: AnswerMessage): void {
    const waiting = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    if (message.ok) waiting?.resolve(message.answer as never);
    else if (waiting) waiting.reject(new Error(message.error));
    else this.fail(new Error(message.error));
  }

  private fail(error: Error): void {
    this.broken = error;
    for (const waiting of this.waiting.values()) waiting.reject(error);
    this.waiting.clear();
  }
}
