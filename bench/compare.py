#!/usr/bin/env python3
"""Runs the benchmark scenes in Gyre and in other engines by turns, and prints what took how long beside how good it was.

Every round runs each program once, one after another, so that all see the same noise of the machine. Times are processor time a
step, which other programs disturb least; ratios are taken within a round, and the middle one counts. Its error is half of what
lies between the quarters of the rounds.
"""

import argparse
import csv
import json
import math
import platform
import subprocess
import sys
from pathlib import Path
from statistics import median

# What is looked at beside the time: the figure of the JSON line, its name, its factor.
QUALITY = {
    "pen_p99": ("overlap, 99 % (mm)", 1e3),
    "drift_max": ("drift (mm)", 1e3),
    "sink_max": ("sinking (mm)", 1e3),
    "joint_peak": ("joint error (mm)", 1e3),
    "limit_peak_deg": ("beyond limits (degrees)", 1),
    "stretch_peak_pct": ("stretch (%)", 1),
    "creep_mean": ("creep (mm/s)", 1e3),
    "lost": ("lost", 1),
}
SCENES = ["pyramid", "many_pyramids", "box_pile", "hull_pile", "mixed_pile", "mesh_rain", "ragdolls", "joint_grid", "tumbler",
          "dominoes", "chain", "chain_swing", "tower", "heavy_stack"]
# Scenes of which some engine keeps nothing standing are judged by quality alone.
NOT_TIMED = {"chain", "chain_swing", "tower", "heavy_stack"}


def quarter_spread(values):
    values = sorted(values)

    def at(share):
        place = share * (len(values) - 1)
        low = int(place)
        high = min(low + 1, len(values) - 1)
        return values[low] + (place - low) * (values[high] - values[low])

    return 0.5 * (at(0.75) - at(0.25))


def run_once(program, scene, threads, steps, sleep):
    arguments = [str(program), scene, str(threads), str(steps)] + (["sleep"] if sleep else [])
    done = subprocess.run(arguments, capture_output=True, text=True)
    if done.returncode != 0 or not done.stdout.strip():
        return {"skipped": (done.stderr.strip().splitlines() or ["it failed"])[-1]}
    return json.loads(done.stdout.strip().splitlines()[-1])


def measure(programs, scene, options):
    """Results of each program, a list of one for each round."""
    results = {program.name: [] for program in programs}
    for round_number in range(options.rounds):
        # Forwards and backwards in turn: whoever comes first has no advantage.
        order = programs if round_number % 2 == 0 else programs[::-1]
        for program in order:
            results[program.name].append(run_once(program, scene, options.threads, options.steps, options.sleep))
    return results


def time_of(result, options):
    return result.get("cpu_ms_per_step" if options.threads == 1 else "mean_ms", math.nan)


def report(scene, results, options, ratios):
    print(f"\n{scene}")
    ours = results["gyre"]
    for name, rounds in results.items():
        if "skipped" in rounds[0]:
            print(f"  {name:10s} skipped: {rounds[0]['skipped']}")
            continue
        times = [time_of(r, options) for r in rounds]
        line = f"  {name:10s} {median(times):9.3f} +- {quarter_spread(times):6.3f} ms"
        line += f"  99 % {median([r['p99_ms'] for r in rounds]):8.3f}  worst {median([r['max_ms'] for r in rounds]):8.3f}"
        if name != "gyre" and "skipped" not in ours[0]:
            ratio = [time_of(mine, options) / time_of(theirs, options) for mine, theirs in zip(ours, rounds)]
            ratios.setdefault(scene, {})[name] = median(ratio)
            line += f"  gyre / {name} {median(ratio):5.2f} +- {quarter_spread(ratio):4.2f}"
        print(line)
    for key, (label, factor) in QUALITY.items():
        values = {name: rounds[0][key] * factor for name, rounds in results.items() if key in rounds[0]}
        if any(value != 0 for value in values.values()):
            print(f"    {label:24s} " + "  ".join(f"{name} {value:.4g}" for name, value in values.items()))


def write_csv(folder, scene, results):
    folder.mkdir(parents=True, exist_ok=True)
    rows = [r for rounds in results.values() for r in rounds if "skipped" not in r]
    if not rows:
        return
    with open(folder / f"{scene.replace(':', '_')}.csv", "w", newline="") as out:
        table = csv.DictWriter(out, fieldnames=list(rows[0]))
        table.writeheader()
        table.writerows(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--programs", type=Path, required=True, help="folder of the engines' programs")
    parser.add_argument("--scenes", nargs="*", default=SCENES)
    parser.add_argument("--engines", nargs="*", help="some of them; all that were built otherwise")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--steps", type=int, default=0, help="0: as many as the scene has")
    parser.add_argument("--sleep", action="store_true", help="let bodies sleep")
    parser.add_argument("--results", type=Path, help="folder for one table a scene")
    options = parser.parse_args()

    programs = sorted((p for p in options.programs.iterdir() if p.is_file()), key=lambda p: (p.name != "gyre", p.name))
    if options.engines:
        programs = [p for p in programs if p.name in options.engines or p.name == "gyre"]
    if not programs or programs[0].name != "gyre":
        sys.exit(f"compare: no program gyre in {options.programs}")
    print(f"{platform.machine()}, {options.rounds} rounds, {options.threads} thread(s); "
          + ("processor time a step" if options.threads == 1 else "wall time a step"))

    ratios = {}
    for scene in options.scenes:
        results = measure(programs, scene, options)
        report(scene, results, options, ratios)
        sys.stdout.flush()
        if options.results:
            write_csv(options.results, scene, results)

    print("\ngyre's time over theirs, geometric mean of the scenes that all keep standing:")
    for name in [p.name for p in programs[1:]]:
        found = [ratios[s][name] for s in ratios if s.split(":")[0] not in NOT_TIMED and name in ratios[s]]
        if found:
            print(f"  {name:10s} {math.exp(sum(map(math.log, found)) / len(found)):5.2f} over {len(found)} scenes, worst {max(found):.2f}")


if __name__ == "__main__":
    main()
