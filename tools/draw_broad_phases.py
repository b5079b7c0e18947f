#!/usr/bin/env python3
"""Draws what broad phases cost a body against the number of bodies, and prints the tables of docs/broad_phases.md.

    cmake --preset bench && cmake --build build/bench --target gyre_bench
    build/bench/bin/gyre_bench --benchmark_filter=broad_phase --benchmark_out=times.json --benchmark_out_format=json
    /usr/bin/python3 tools/draw_broad_phases.py times.json          writes docs/charts/broad_phases.svg

The growth exponent is the slope of a straight line through log(time) against log(bodies), from 1,000 bodies up: 1 is linear,
2 is every pair. Needs python3-matplotlib.
"""

import argparse
import json
import math
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LAYOUTS = {"uniform": "Uniform", "clustered": "Clustered", "unequal": "Very unequal sizes"}
KINDS = {
    "bvh": ("BVH (default)", "#0072b2", "o"),
    "kd_tree": ("kd-tree", "#d55e00", "s"),
    "bsp_tree": ("BSP tree", "#cc79a7", "D"),
    "grid": ("hashed grid", "#009e73", "^"),
    "octree": ("loose octree", "#8c6d00", "v"),
    "quadtree": ("loose quadtree", "#e69f00", "<"),
    "sweep_and_prune": ("sweep and prune", "#56b4e9", "P"),
    "brute_force": ("brute force", "#666666", "x"),
}
FIRST_FOR_SLOPE = 1000


def read_times(path):
    """{(layout, kind): {bodies: milliseconds}}; what was left out is not in it."""
    times = {}
    for run in json.loads(Path(path).read_text())["benchmarks"]:
        parts = run["name"].split("/")
        if parts[0] != "broad_phase":
            continue
        _, layout, kind, bodies = parts[:4]
        series = times.setdefault((layout, kind), {})
        if not run.get("error_occurred"):
            # Of repeated runs the fastest: others only add.
            series[int(bodies)] = min(series.get(int(bodies), math.inf), run["real_time"])
    return times


def exponent(series):
    points = [(math.log(n), math.log(t)) for n, t in series.items() if n >= FIRST_FOR_SLOPE]
    mean_x = sum(x for x, _ in points) / len(points)
    mean_y = sum(y for _, y in points) / len(points)
    return sum((x - mean_x) * (y - mean_y) for x, y in points) / sum((x - mean_x) ** 2 for x, _ in points)


def shown(milliseconds):
    if milliseconds is None:
        return "–"
    digits = max(0, 1 - math.floor(math.log10(milliseconds)))
    return f"{milliseconds:,.{min(digits, 4)}f}"


def print_tables(times):
    counts = [100, 1000, 10000, 100000, 1000000]
    for layout, title in LAYOUTS.items():
        print(f"\n**{title}**\n")
        print("| | " + " | ".join(f"{n:,}" for n in counts) + " | exponent |")
        print("|---" + "|---:" * (len(counts) + 1) + "|")
        rows = [times[layout, kind] for kind in KINDS]
        best = [min(row.get(n, math.inf) for row in rows) for n in counts]
        for kind, (name, _, _) in KINDS.items():
            row = times[layout, kind]
            cells = [f"**{shown(row[n])}**" if row.get(n) == best[i] else shown(row.get(n)) for i, n in enumerate(counts)]
            print(f"| {name} | " + " | ".join(cells) + f" | {exponent(row):.2f} |")


def draw(times, path):
    import matplotlib

    matplotlib.use("svg")
    import matplotlib.pyplot as plot

    matplotlib.rcParams.update({"svg.hashsalt": "gyre", "svg.fonttype": "path", "font.size": 9})
    figure, axes = plot.subplots(1, 3, figsize=(12, 4.6), sharey=True)
    for place, (layout, title) in zip(axes, LAYOUTS.items()):
        for kind, (name, color, marker) in KINDS.items():
            series = sorted(times[layout, kind].items())
            place.loglog([n for n, _ in series], [1000 * t / n for n, t in series], color=color, marker=marker, markersize=4,
                         linewidth=2.2 if kind == "bvh" else 1.2, label=name, zorder=3 if kind == "bvh" else 2)
        place.set_title(title)
        place.set_xlabel("bodies")
        place.grid(True, which="major", color="#e4e4e4", linewidth=0.6)
        place.set_ylim(0.01, 30)
        place.set_xlim(80, 1.3e6)
    axes[0].set_ylabel("update and pairs of one step, microseconds a body")
    figure.tight_layout(rect=(0, 0.07, 1, 1))
    handles, names = axes[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="lower center", ncol=len(names), fontsize=8, frameon=False)
    figure.savefig(path, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("times", help="what gyre_bench wrote as JSON")
    parser.add_argument("--out", default=ROOT / "docs" / "charts" / "broad_phases.svg")
    options = parser.parse_args()
    times = read_times(options.times)
    missing = [f"{layout}/{kind}" for layout in LAYOUTS for kind in KINDS if not times.get((layout, kind))]
    if missing:
        sys.exit("not in these times: " + ", ".join(missing))
    draw(times, options.out)
    print_tables(times)


if __name__ == "__main__":
    main()
