#!/usr/bin/env python3
"""Makes the tables and charts of docs/numerics.md anew, part by part, from what the program measures.

    . tools/setup.sh; build release
    /usr/bin/python3 tools/make_numerics.py [integrators ...]     all parts, or those named

A part prints rows of CSV (gyre validate), writes a chart to docs/charts and puts its table between the lines
<!-- PART begin --> and <!-- PART end --> of the page. Needs python3-matplotlib.
"""

import csv
import io
import math
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
GYRE = ROOT / "build/release/bin/gyre"
PAGE = ROOT / "docs/numerics.md"

SCHEMES = {
    "explicit_euler": ("explicit Euler", "#d55e00", "s"),
    "semi_implicit_euler": ("semi-implicit Euler (default)", "#0072b2", "o"),
    "verlet": ("Verlet", "#009e73", "^"),
    "rk4": ("Runge-Kutta 4", "#cc79a7", "D"),
}
MOTIONS = {
    "drag": ("Free flight in a medium", "m"),
    "orbit": ("Free flight round a centre", "m"),
    "spring": ("Spring", "m"),
    "spin": ("Turning without a torque", "rad"),
    "torque": ("Turning with a torque", "rad"),
}


def rows_of(*arguments):
    text = subprocess.run([GYRE, "validate", *arguments], check=True, capture_output=True, text=True).stdout
    return list(csv.DictReader(io.StringIO(text)))


def put(part, text):
    page = PAGE.read_text()
    begin, end = f"<!-- {part} begin -->\n", f"<!-- {part} end -->"
    head, rest = page.split(begin)
    PAGE.write_text(head + begin + text + end + rest.split(end)[1])


def errors_of(rows):
    out = {}
    for row in rows:
        out.setdefault((row["motion"], row["integrator"]), []).append((float(row["step"]), float(row["error"])))
    return out


def draw(errors, path):
    import matplotlib

    matplotlib.use("svg")
    import matplotlib.pyplot as plt

    matplotlib.rcParams["svg.hashsalt"] = "gyre"
    matplotlib.rcParams["svg.fonttype"] = "none"
    figure, axes = plt.subplots(1, len(MOTIONS), figsize=(15, 4.2), sharey=True)
    for axis, (motion, (title, unit)) in zip(axes, MOTIONS.items()):
        for scheme, (name, colour, mark) in SCHEMES.items():
            steps, values = zip(*errors[motion, scheme])
            axis.loglog(steps, values, marker=mark, color=colour, label=name, markersize=4, linewidth=1.2)
        axis.set_title(f"{title} ({unit})", fontsize=9)
        axis.set_xlabel("step (s)", fontsize=8)
        axis.grid(True, which="major", color="#dddddd", linewidth=0.6)
        axis.tick_params(labelsize=7)
    axes[0].set_ylabel("error at the end", fontsize=8)
    axes[0].legend(fontsize=7, frameon=False, loc="lower right")
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None})


def integrators():
    errors = errors_of(rows_of("--integrators", "--csv"))
    draw(errors, ROOT / "docs/charts/integrators.svg")
    lines = ["| motion | scheme | step | error | half the step | error | order |", "|---|---|---:|---:|---:|---:|---:|"]
    for motion, (title, unit) in MOTIONS.items():
        for scheme, (name, _, _) in SCHEMES.items():
            (coarse, large), (fine, small) = errors[motion, scheme][-2:]
            exact = motion == "spin" and scheme == "semi_implicit_euler"
            order = "exact" if exact else f"{math.log2(large / small):.3f}"
            lines.append(f"| {title} | {name} | {coarse:.3g} s | {large:.2e} {unit} | {fine:.3g} s | {small:.2e} {unit} | {order} |")
    put("integrators", "\n".join(lines) + "\n")


PARTS = {"integrators": integrators}

if __name__ == "__main__":
    for part in sys.argv[1:] or PARTS:
        PARTS[part]()
