// gyre-physics beside the engines that npm offers, in Node.
//
//   node run.mjs [--rounds N] [--steps N] [--scenes wall,pile] [--json FILE] [engine...]
//
// Each run of an engine is a process of its own; they take turns, round by round, so that whatever else the machine does falls on
// all alike. A ratio is Gyre's time over the engine's in the same round; the median over the rounds is told, and as its error half
// the distance between the quartiles.
import { execFileSync } from 'node:child_process';
import { existsSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const folder = dirname(fileURLToPath(import.meta.url));
const known = ['gyre', 'rapier', 'physx', 'havok', 'jolt', 'ammo', 'cannon'];
const slow = { cannon: 1, ammo: 3 }; // rounds for engines that are many times slower

function options(words) {
  const out = { rounds: 5, steps: 300, scenes: ['wall', 'pile'], json: '', engines: [] };
  for (let i = 0; i < words.length; ++i) {
    const word = words[i];
    if (word === '--rounds') out.rounds = Number(words[++i]);
    else if (word === '--steps') out.steps = Number(words[++i]);
    else if (word === '--scenes') out.scenes = words[++i].split(',');
    else if (word === '--json') out.json = words[++i];
    else if (known.includes(word)) out.engines.push(word);
    else throw new Error(`found ${word}, expected an option or one of ${known.join(', ')}`);
  }
  if (out.engines.length === 0) out.engines = known;
  if (!out.engines.includes('gyre')) out.engines.unshift('gyre');
  if (!(out.rounds >= 1 && out.steps >= 100)) throw new Error('at least one round and 100 steps');
  return out;
}

function prepare() {
  if (!existsSync(join(folder, '../../web/gyre-physics/dist/engine/simd.js'))) {
    throw new Error('web/gyre-physics is not built: run tools/build_web.sh first');
  }
  if (!existsSync(join(folder, 'node_modules/gyre-physics'))) {
    console.error('Installing the engines from npm');
    execFileSync('npm', ['install', '--no-audit', '--no-fund', '--loglevel=error'], { cwd: folder, stdio: ['ignore', 'inherit', 'inherit'] });
  }
}

function once(engine, scene, steps) {
  const text = execFileSync(process.execPath, [join(folder, 'one.mjs'), engine, scene, String(steps)], {
    encoding: 'utf8', timeout: 400000, stdio: ['ignore', 'pipe', 'pipe'],
  });
  return JSON.parse(text.trim().split('\n').filter((line) => line.startsWith('{')).at(-1));
}

function quartiles(values) {
  const sorted = [...values].sort((a, b) => a - b);
  const at = (part) => {
    const place = part * (sorted.length - 1), low = Math.floor(place);
    return sorted[low] + (place - low) * ((sorted[low + 1] ?? sorted[low]) - sorted[low]);
  };
  return [at(0.25), at(0.5), at(0.75)];
}

function measured(values, digits) {
  const [low, middle, high] = quartiles(values);
  return values.length > 1 ? `${middle.toFixed(digits)} ± ${((high - low) / 2).toFixed(digits)}` : middle.toFixed(digits);
}

function table(scene, rows, rounds) {
  const gyre = rows.get('gyre');
  const lines = [['engine', 'ms/step on a core', 'last 100', 'worst step, ms', 'Gyre / engine', 'last 100', scene === 'wall' ? 'largest move, m' : 'lowest box, m']];
  for (const [engine, results] of rows) {
    if (results.length === 0) {
      lines.push([engine, 'failed', '', '', '', '', '']);
      continue;
    }
    const ratio = (what) => measured(results.map((result) => gyre.find(({ round }) => round === result.round)[what] / result[what]), 2);
    lines.push([engine, measured(results.map(({ core }) => core), 2), measured(results.map(({ late }) => late), 2),
      measured(results.map(({ worst }) => worst), 0), engine === 'gyre' ? '1' : ratio('core'), engine === 'gyre' ? '1' : ratio('late'),
      (scene === 'wall' ? results[0].largestMove : results[0].lowest).toFixed(4)]);
  }
  const widths = lines[0].map((_, i) => Math.max(...lines.map((line) => line[i].length)));
  console.log(`\n${scene}, ${rounds} rounds`);
  for (const line of lines) console.log(line.map((cell, i) => (i === 0 ? cell.padEnd(widths[i]) : cell.padStart(widths[i]))).join('  '));
}

const wanted = options(process.argv.slice(2));
prepare();
console.log(`Node ${process.version}, ${os.cpus()[0].model}, ${os.cpus().length} cores, load ${os.loadavg()[0].toFixed(1)}`);
const everything = {};
for (const scene of wanted.scenes) {
  const rows = new Map(wanted.engines.map((engine) => [engine, []]));
  for (let round = 0; round < wanted.rounds; ++round) {
    for (const engine of wanted.engines) {
      if (round >= (slow[engine] ?? Infinity)) continue;
      try {
        rows.get(engine).push({ round, ...once(engine, scene, wanted.steps) });
      } catch (error) {
        console.error(`${engine} failed with ${scene}: ${String(error.stderr || error.message).split('\n').slice(0, 4).join(' | ')}`);
        if (engine === 'gyre') process.exit(1);
      }
    }
  }
  table(scene, rows, wanted.rounds);
  everything[scene] = Object.fromEntries(rows);
}
console.log(`load ${os.loadavg()[0].toFixed(1)} at the end`);
if (wanted.json) writeFileSync(wanted.json, JSON.stringify(everything, null, 1));
