"""Why springs explode: a mass on a spring under every integrator, with the energy that each of them leaves after ten seconds.

The exact solution swings for ever. Explicit Euler gains energy at any step; the others hold up to a step that the engine tells.
"""

import sys

import numpy as np

import gyre

MASS, STIFFNESS, STEP = 1.0, 400.0, 1 / 60  # kg, N/m, s: 20 rad/s


def swing(integrator, springs, seconds=10.0, substeps=1):
    """Energies over time (J) of a mass that starts 0.1 m from rest, and what the engine says about the step."""
    world = gyre.World(gravity=(0, 0, 0), sleeping=False, stepping=dict(integrator=integrator, springs=springs, substeps=substeps))
    bob = world.add_body(pose=(1.1, 0, 0), mass=MASS, shapes=gyre.Sphere(0.1))
    world.add_joint(gyre.DistanceDef(b=bob, anchor=(0, 0, 0), length=1.0, stiffness=STIFFNESS))
    energies = []
    for _ in range(round(seconds / STEP)):
        world.step(STEP)
        stretch = np.linalg.norm(world.pose(bob).position) - 1
        energies.append(0.5 * MASS * np.sum(world.linear_velocity(bob) ** 2) + 0.5 * STIFFNESS * stretch**2)
        if energies[-1] > 1e6:
            break
    return np.array(energies), world.spring_stability()


def chart(energies, start, columns=60, rows=8):
    """A small plot in letters: the energy over time, on a scale that ends at twice the start."""
    picked = energies[np.linspace(0, len(energies) - 1, columns).astype(int)]
    level = np.clip(np.round(picked / (2 * start) * (rows - 1)), 0, rows - 1).astype(int)
    return "\n".join("  |" + "".join("*" if level[i] == row else " " for i in range(columns)) for row in range(rows - 1, -1, -1))


start = 0.5 * STIFFNESS * 0.1**2
print(f"energy at the start {start:.2f} J; a spring of {np.sqrt(STIFFNESS / MASS) / (2 * np.pi):.2f} Hz, steps of {STEP * 1000:.1f} ms\n")
kept = {}
for springs in ("implicit", "explicit_force"):
    for integrator in gyre.IntegratorKind:
        energies, stability = swing(integrator, springs)
        kept[springs, integrator.name] = energies[-1] / start
        said = f", critical step {stability.critical_step * 1000:.1f} ms" if springs == "explicit_force" else ""
        print(f"{springs:>15} {integrator.name.lower():<20} keeps {energies[-1] / start:8.3g} of the energy{said}")
        if "--test" not in sys.argv:
            print(chart(energies, start))

# RK4 is of order 4: half the step, a sixteenth of the error or less.
errors = [abs(swing("rk4", "explicit_force", 2.0, substeps)[0][-1] / start - 1) for substeps in (1, 2)]
print(f"\nRK4 loses {errors[0]:.2e} of the energy in 2 s, with half the step {errors[1]:.2e}: {errors[0] / errors[1]:.0f} times less")
assert kept["explicit_force", "EXPLICIT_EULER"] > 10
assert all(0.5 < kept["explicit_force", name] < 1.5 for name in ("SEMI_IMPLICIT_EULER", "RK4", "VERLET"))
assert errors[0] / errors[1] > 14
