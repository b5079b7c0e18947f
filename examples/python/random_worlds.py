"""A thousand random worlds: heaps of shapes that are thrown at random, all at once over all cores, and one hash of everything.

    random_worlds.py [WORLDS]

The number of threads changes nothing: run it again with other numbers of cores.
"""

import sys
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import gyre

WORLDS = 30 if "--test" in sys.argv else int(sys.argv[1]) if len(sys.argv) > 1 else 1000


def random_world(seed):
    """Ten bodies of random shapes over a plane, for four seconds. Returns the hash and how many bodies sleep."""
    rng = np.random.default_rng(seed)
    world = gyre.World()
    world.add_body(type="fixed", shapes=gyre.Plane())
    for _ in range(10):
        size = rng.uniform(0.2, 0.6)
        shape = rng.choice([gyre.Sphere(size), gyre.Box(half_extents=size * rng.uniform(0.5, 1, 3)), gyre.Capsule(size / 2, size / 2)])
        world.add_body(pose=rng.uniform((-2, 1, -2), (2, 6, 2)), linear_velocity=rng.uniform(-3, 3, 3), shapes=shape)
    for _ in range(240):
        world.step(1 / 60)
    stats = world.stats()
    return world.hash(), stats.bodies - 1 - stats.awake_bodies


def run(threads):
    """The engine lets go of the interpreter during a step, so threads of Python use all cores."""
    start = time.perf_counter()
    with ThreadPoolExecutor(threads) as pool:
        results = list(pool.map(random_world, range(WORLDS)))
    seconds = time.perf_counter() - start
    combined = 0
    for value, _ in results:
        combined = (combined * 0x100000001B3 ^ value) % 2**64
    print(f"{threads} thread(s): {WORLDS} worlds in {seconds:.2f} s, {WORLDS / seconds:.0f} a second; "
          f"{sum(asleep for _, asleep in results)} of {10 * WORLDS} bodies sleep; hash {combined:016x}")
    return combined


assert run(1) == run(2)
