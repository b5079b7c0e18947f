// Below: play, pause, step, the time line, speed, and what to throw.
import { ChevronFirst, Circle, Pause, Play, Scan, SkipBack, SkipForward, Video } from 'lucide-preact';
import type { JSX } from 'preact';
import { clock } from '../format';
import * as store from '../state/store';
import type { Viewer } from '../viewer';
import { IconButton } from './parts';

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];

export function Playbar({ viewer }: { viewer: Viewer }): JSX.Element | null {
  const scene = store.scene.value;
  if (!scene) return null;
  const { playback } = viewer;
  const playing = store.playing.value;
  return (
    <footer class="bar playbar">
      <TimeLine viewer={viewer} />
      <div class="play-row">
        <div class="play-group">
          <IconButton label="To the beginning" shortcut="Home" onClick={() => playback.seek(0)}>
            <ChevronFirst size={20} />
          </IconButton>
          <IconButton label="A step back" shortcut="Left" onClick={() => stepBack(viewer)}>
            <SkipBack size={17} />
          </IconButton>
          <IconButton label={playing ? 'Pause' : 'Play'} shortcut="K" className="primary" onClick={() => playback.toggle()}>
            {playing ? <Pause size={21} fill="currentColor" strokeWidth={0} /> : <Play size={21} fill="currentColor" strokeWidth={0} />}
          </IconButton>
          <IconButton label="A step on" shortcut="Right" onClick={() => void playback.advance()}>
            <SkipForward size={17} />
          </IconButton>
        </div>
        <output class="clock">
          <b>{clock(store.time.value)}</b>
          <span>step {store.step.value.toLocaleString('en')}</span>
        </output>
        <div class="play-group end">
          <select class="speed" aria-label="Speed" value={String(store.speed.value)} onChange={(event) => (store.speed.value = Number(event.currentTarget.value))}>
            {SPEEDS.map((speed) => (
              <option key={speed} value={String(speed)}>
                {speed}×
              </option>
            ))}
          </select>
          <IconButton label="Whole scene, or the selected body" shortcut="F" onClick={() => viewer.frameScene()}>
            <Scan size={18} />
          </IconButton>
          <IconButton
            label="Follow the selected body"
            shortcut="G"
            pressed={store.following.value}
            disabled={store.selected.value === null}
            onClick={() => (store.following.value = !store.following.value)}
          >
            <Video size={18} />
          </IconButton>
          {scene.live && (
            <button type="button" class="throw" onClick={() => viewer.thrower.throw()} title="Throw (Space)">
              <ThrowIcon />
              <span>Throw</span>
            </button>
          )}
        </div>
      </div>
    </footer>
  );
}

function ThrowIcon(): JSX.Element {
  return <Circle size={15} fill="currentColor" strokeWidth={0} />;
}

export function stepBack(viewer: Viewer): void {
  viewer.playback.pause();
  viewer.playback.seek(store.step.peek() - 1);
}

function TimeLine({ viewer }: { viewer: Viewer }): JSX.Element {
  const last = Math.max(store.lastStep.value, 1);
  const part = (store.step.value / last) * 100;
  const seek = (event: JSX.TargetedEvent<HTMLInputElement>): void => {
    viewer.playback.pause();
    viewer.playback.seek(event.currentTarget.valueAsNumber);
  };
  return (
    <input
      class="timeline"
      type="range"
      aria-label="Time line"
      aria-valuetext={`step ${store.step.value} of ${store.lastStep.value}`}
      min={0}
      max={last}
      step={1}
      value={store.step.value}
      style={{ '--part': `${Math.min(part, 100)}%` }}
      onInput={seek}
    />
  );
}

