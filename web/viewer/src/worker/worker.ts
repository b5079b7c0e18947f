// The worker: answers the page's requests one after the other. What goes wrong is sent back in words.
import type { AnswerMessage, FrameMessage, RequestMessage, RequestName, Requests } from '../protocol';
import type { Session } from './session';
import { open } from './with_engine';

let session: Session | null = null;

function opened(): Session {
  if (!session) throw new Error('Nothing is open.');
  return session;
}

type Handlers = { [N in RequestName]: (ask: Requests[N]['ask']) => Requests[N]['answer'] | Promise<Requests[N]['answer']> };

const handlers: Handlers = {
  async open({ source, settings }) {
    // What is open stays so until the next one is there.
    const next = await open(source, settings);
    session?.close();
    session = next;
    return { scene: next.describe(), frame: next.frame(true) };
  },
  advance: ({ steps, commands }) => opened().advance(steps, commands),
  seek: ({ step }) => opened().seek(step),
  overlays({ names }) {
    opened().setOverlays(names);
    return opened().frame();
  },
  configure({ settings }) {
    opened().configure(settings);
    return { scene: opened().describe(), frame: opened().frame() };
  },
  inspect: ({ key }) => opened().inspect(key),
  inspect_soft: ({ key }) => opened().inspectSoft(key),
  hash: () => opened().hash(),
  save: ({ what }) => opened().save(what),
};

// The large arrays of an answer are handed over instead of copied. Surfaces stay: the worker still needs their vertices.
function handedOver(answer: unknown): Transferable[] {
  const message = (answer as { frame?: unknown } | null)?.frame;
  const frame = (message && typeof message === 'object' && 'frame' in message ? (message as FrameMessage).frame : message) as FrameMessage['frame'] | undefined;
  if (!frame?.poses) return [];
  const fluids = frame.fluids.flatMap(({ voxels, vertices, normals, indices }) => [voxels, vertices, normals, indices]);
  return [frame.poses, frame.velocities, frame.flags, frame.softVertices, ...fluids].map(({ buffer }) => buffer) as ArrayBuffer[];
}

let last: Promise<void> = Promise.resolve();

async function answer(request: RequestMessage): Promise<void> {
  let message: AnswerMessage;
  try {
    const handler = handlers[request.name] as (ask: unknown) => unknown;
    message = { id: request.id, ok: true, answer: await handler(request.ask) };
  } catch (error) {
    message = { id: request.id, ok: false, error: error instanceof Error ? error.message : String(error) };
  }
  self.postMessage(message, { transfer: message.ok ? handedOver(message.answer) : [] });
}

self.onmessage = (event: MessageEvent<RequestMessage>) => {
  last = last.then(() => answer(event.data));
};
