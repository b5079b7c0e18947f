#!/usr/bin/env python3
"""Makes the measured parts of docs/numerics.md: tables between its markers, and charts beside it.

    cmake --preset bench && cmake --build build/bench --target bench_solvers
    build/bench/bin/bench/solvers > solvers.csv
    /usr/bin/python3 tools/make_solver_comparison.py --solvers solvers.csv

What stands between <!-- solvers --> and <!-- /solvers --> is written anew, and docs/charts/solvers.svg. Needs
python3-matplotlib.
"""

import argparse
import csv
import math
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "numerics.md"
WAYS = {
    "soft_step": ("soft step", "#0072b2", "o"),
    "sequential_10": ("sequential, 10 sweeps", "#e69f00", "v"),
    "sequential_50": ("sequential, 50 sweeps", "#d55e00", "^"),
    "lcp_automatic": ("lcp, automatic", "#009e73", "s"),
    "lcp_dantzig": ("lcp, Dantzig", "#cc79a7", "D"),
    "lcp_lemke": ("lcp, Lemke", "#8c6d00", "P"),
    "lcp_nncg": ("lcp, NNCG", "#56b4e9", "X"),
}
# Column, heading, unit, factor from SI, smallest that is drawn.
MEASURES = (
    ("overlap", "Deepest overlap", "mm", 1.0e3, 1.0e-7),
    ("widest", "Widest joint", "mm", 1.0e3, 1.0e-7),
    ("farthest", "Farthest from where it was built", "mm", 1.0e3, 1.0e-7),
    ("residual", "Residual of complementarity", "N s", 1.0, 1.0e-12),
    ("step_ms", "Time of a step, median", "ms", 1.0, 1.0e-3),
)
MOVES_ON_PURPOSE = {"dominoes", "swing", "pile", "bridge"}


def shown(value, drawn_from):
    if value is None:
        return "–"
    if value < drawn_from:
        return "0"
    if value < 0.001 or value >= 1.0e5:
        mantissa, exponent = f"{value:.0e}".split("e")
        return f"{mantissa}e{int(exponent)}"
    digits = max(0, 1 - math.floor(math.log10(value)))
    return f"{value:,.{digits}f}"


def read_runs(path):
    """{scene: {way: row}} in the order of the file."""
    runs = {}
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            runs.setdefault(row["scene"], {})[row["way"]] = row
    return runs


def value_of(row, column, factor):
    if row is None or (column == "residual" and row["way"] == "soft_step"):
        return None
    return float(row[column]) * factor


def is_measured(column, scene, rows):
    if column == "widest":
        return any(float(row["widest"]) > 0 for row in rows.values())
    return not (column == "farthest" and scene in MOVES_ON_PURPOSE)


def tables(runs):
    lines = []
    for column, heading, unit, factor, drawn_from in MEASURES:
        lines += ["", f"**{heading} ({unit})**", ""]
        lines.append("| scene | rows | " + " | ".join(name for name, _, _ in WAYS.values()) + " |")
        lines.append("| --- | ---: |" + " ---: |" * len(WAYS))
        for scene, rows in runs.items():
            if not is_measured(column, scene, rows):
                continue
            cells = [shown(value_of(rows.get(way), column, factor), drawn_from) for way in WAYS]
            most = max(int(row["rows"]) for row in rows.values())
            lines.append(f"| {scene.replace('_', ' ')} | {most} | " + " | ".join(cells) + " |")
    return lines + [""]


def draw(runs, path):
    import matplotlib

    matplotlib.use("svg")
    import matplotlib.pyplot as plt

    plt.rcParams.update({"svg.hashsalt": "gyre", "font.size": 9, "svg.fonttype": "none"})
    scenes = list(runs)
    figure, axes = plt.subplots(len(MEASURES), 1, figsize=(9, 13), sharex=True, layout="constrained")
    for axis, (column, heading, unit, factor, drawn_from) in zip(axes, MEASURES):
        for n, (way, (name, color, marker)) in enumerate(WAYS.items()):
            xs, ys = [], []
            for x, scene in enumerate(scenes):
                if not is_measured(column, scene, runs[scene]):
                    continue
                value = value_of(runs[scene].get(way), column, factor)
                if value is None:
                    continue
                xs.append(x + 0.1 * (n - (len(WAYS) - 1) / 2))
                ys.append(max(value, drawn_from))
            axis.plot(xs, ys, marker, color=color, label=name, markersize=5, linestyle="none")
        axis.set_yscale("log")
        axis.set_ylabel(f"{heading}\n({unit})")
        axis.grid(True, axis="y", color="#dddddd", linewidth=0.6)
        axis.set_axisbelow(True)
        for x in range(len(scenes) - 1):
            axis.axvline(x + 0.5, color="#eeeeee", linewidth=0.8)
    axes[-1].set_xticks(range(len(scenes)), [scene.replace("_", " ") for scene in scenes], rotation=30, ha="right")
    axes[0].legend(ncol=4, loc="lower center", bbox_to_anchor=(0.5, 1.02), frameon=False)
    path.parent.mkdir(exist_ok=True)
    figure.savefig(path, metadata={"Date": None})


def replace_part(name, lines):
    text = PAGE.read_text(encoding="utf-8")
    begin, end = f"<!-- {name} -->", f"<!-- /{name} -->"
    if begin not in text or end not in text:
        sys.exit(f"{PAGE} has no {begin} ... {end}")
    head, rest = text.split(begin, 1)
    tail = rest.split(end, 1)[1]
    PAGE.write_text(head + begin + "\n" + "\n".join(lines) + end + tail, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--solvers", help="what bench/solvers printed")
    options = parser.parse_args()
    if options.solvers:
        runs = read_runs(options.solvers)
        replace_part("solvers", tables(runs))
        draw(runs, ROOT / "docs" / "charts" / "solvers.svg")


if __name__ == "__main__":
    main()
