// What the worker opens in a page without the engine: recordings that the page's server decodes. See with_engine.ts.
import type { NewWorldSettings, Source } from '../protocol';
import { ServedPoses } from './served_poses';
import type { Session } from './session';
import { TrackSession } from './track_session';

const HOW = 'in the source tree, ./run --live builds the page with the engine';

export async function open(source: Source, _settings: NewWorldSettings): Promise<Session> {
  if (source.name.endsWith('.json')) {
    throw new Error(`This page was built without the engine, so it plays recordings and runs no scenes; ${HOW}. Or record the scene, then watch that: ./run ${source.name}`);
  }
  if (source.kind === 'bytes') {
    throw new Error(`This page was built without the engine, so its server has to read the recording: gyre view ${source.name}. Or, ${HOW}.`);
  }
  return TrackSession.open(await ServedPoses.open(source.url), `the page was built without the engine; ${HOW}`, source.name);
}
