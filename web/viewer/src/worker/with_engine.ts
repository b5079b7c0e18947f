// What the worker opens with the engine in the page. A page without it (vite.config.ts) has without_engine.ts in this place.
import type { NewWorldSettings, Source } from '../protocol';
import { DecodedPoses } from './decoded_poses';
import { engine } from './engine';
import { LiveSession } from './live_session';
import { ReplayedWorld } from './replayed_world';
import { bytesOf, isRecording, sceneText } from './scene_source';
import type { Session } from './session';
import { TrackSession } from './track_session';

export async function open(source: Source, settings: NewWorldSettings): Promise<Session> {
  const [gyre, bytes] = await Promise.all([engine(), bytesOf(source)]);
  if (!isRecording(bytes, source.name)) return new LiveSession(gyre, await sceneText(source, bytes), settings);
  const poses = new DecodedPoses(gyre, bytes);
  return TrackSession.open(poses, ReplayedWorld.open(gyre, bytes, poses.origin), source.name);
}
