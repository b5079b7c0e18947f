// One engine with one scene: node one.mjs ENGINE SCENE [STEPS]. Prints one line of JSON.
import { readFileSync } from 'node:fs';

import { scenes, settings } from './scenes.mjs';

const [engine, sceneName, stepsGiven] = process.argv.slice(2);
const steps = Number(stepsGiven ?? settings.steps);

/** Milliseconds that this thread was on a core (Linux): unlike a clock it does not count waiting for others' programs. */
function onCore() {
  try {
    return Number(readFileSync(`/proc/self/task/${process.pid}/schedstat`, 'utf8').split(' ')[0]) / 1e6;
  } catch {
    return performance.now();
  }
}

const scene = scenes[sceneName]();
const { create } = await import(`./engines/${engine}.mjs`);
const world = await create(scene, settings);

const wallClock = [];
const begin = onCore();
let late = begin;
for (let i = 0; i < steps; ++i) {
  if (i === steps - 100) late = onCore();
  const start = performance.now();
  world.step(settings.step);
  wallClock.push(performance.now() - start);
}
const end = onCore();

const places = world.places();
let largestMove = 0;
let lowest = Infinity;
scene.boxes.forEach(({ place: [x, y, z] }, i) => {
  largestMove = Math.max(largestMove, Math.hypot(places[3 * i] - x, places[3 * i + 1] - y, places[3 * i + 2] - z));
  lowest = Math.min(lowest, places[3 * i + 1]);
});
wallClock.sort((a, b) => a - b);
console.log(JSON.stringify({
  engine, scene: sceneName, steps, version: world.version,
  core: (end - begin) / steps, late: (end - late) / Math.min(100, steps), median: wallClock[steps >> 1], worst: wallClock[steps - 1],
  largestMove, lowest,
}));
process.exit(0);
