"""A small game without pictures: a player who walks up stairs, a lift, a crate on the mouse, a trigger, a car on hills, a bridge.

Every step is played twice, as in a networked game: first with a guess of the player's input, then, eight steps later, rolled back and
played again with the true input. The end has the bits of a game that knew all input in time.
"""

import numpy as np

import gyre

STEP, WINDOW = 1 / 60, 8


class Game:
    def __init__(self):
        self.world = world = gyre.World()
        world.add_body(type="fixed", shapes=gyre.Plane())
        # Six stairs of 20 cm; a capsule rolls over no edge, so the player is lifted by its own speed: see walk().
        for i in range(6):
            world.add_body(type="fixed", pose=(3 + 0.4 * i, 0.1 * (i + 1), 0), shapes=gyre.Box(half_extents=(0.2, 0.1 * (i + 1), 1)))
        locked = gyre.LockedAxes(angular=(True, True, True))
        self.player = world.add_body(pose=(0, 0.9, 0), locked=locked, can_sleep=False, mass=80,
                                     shapes=gyre.ShapeDef(geometry=gyre.Capsule(0.3, 0.6), material=dict(static_friction=0, dynamic_friction=0)))
        self.lift = world.add_body(type="kinematic", pose=(-3, 0.1, 3), shapes=gyre.Box(half_extents=(1, 0.1, 1)))
        self.rider = world.add_body(pose=(-3, 0.7, 3), shapes=gyre.Box(half_extents=(0.3, 0.5, 0.3)))
        self.crate = world.add_body(pose=(0, 0.5, 4), shapes=gyre.Box())
        self.mouse = world.add_joint(gyre.MouseDef(b=self.crate, anchor=(0, 1, 4), drive=dict(frequency=2, max_force=3e4)))
        self.trigger = world.add_body(type="fixed", pose=(2.2, 1, 0), shapes=gyre.ShapeDef(geometry=gyre.Box(half_extents=(0.3, 1, 1)), sensor=True))
        self.add_bridge((-10, 3, 0), 10)
        self.add_car((0, 1.2, -20))
        self.entered = 0

    def add_bridge(self, start, planks):
        """Planks on hinges, with a load; a hinge breaks at 50 kN."""
        world, before = self.world, 0
        start = np.array(start, float)
        box = gyre.ShapeDef(geometry=gyre.Box(half_extents=(0.24, 0.05, 0.8)), density=600)
        for i in range(planks + 1):
            plank = world.add_body(pose=start + (0.5 * i + 0.25, 0, 0), shapes=box) if i < planks else 0
            world.add_joint(gyre.HingeDef(a=before, b=plank, anchor=start + (0.5 * i, 0, 0), axis=(0, 0, 1), break_force=5e4))
            before = plank
        world.add_body(pose=start + (2.5, 1, 0), shapes=gyre.Sphere(0.4))

    def add_car(self, at):
        """Four driven wheels on springs, on hills."""
        world = self.world
        x, z = np.meshgrid(np.arange(40), np.arange(20))
        hills = gyre.cook_height_field(heights=0.25 * np.sin(0.7 * x) * np.cos(0.5 * z), columns=40, rows=20, spacing=1.0)
        world.add_body(type="fixed", pose=(at[0] + 10, 0.3, at[2]), shapes=hills)
        self.car = world.add_body(pose=at, shapes=gyre.ShapeDef(geometry=gyre.Box(half_extents=(1.2, 0.25, 0.6)), density=400))
        tyre = gyre.ShapeDef(geometry=gyre.Sphere(0.35), density=300, material=dict(static_friction=1.2, dynamic_friction=1))
        for dx in (-0.9, 0.9):
            for dz in (-0.8, 0.8):
                place = np.add(at, (dx, -0.3, dz))
                wheel = world.add_body(pose=place, shapes=tyre)
                world.add_joint(gyre.WheelDef(a=self.car, b=wheel, anchor=place, axis=(0, 1, 0), axis_b=(0, 0, 1), stiffness=3e4, damping=2e3,
                                              limits=(-0.15, 0.15), motor=dict(target_velocity=-10, max_force=150)))

    def step(self, walk):
        """One step; `walk` is the player's speed along x, m/s."""
        world = self.world
        place = world.pose(self.player).position
        # A ray in front of the feet finds the next stair; where there is one, the player steps up.
        ahead = world.cast_ray(place + (0.45 * np.sign(walk), 0, 0), (0, -1.2, 0), ignored=self.player) if walk else None
        velocity = world.linear_velocity(self.player)
        rise = ahead.point[1] - (place[1] - 0.9) if ahead else 0
        up = 2.2 if 0.02 < rise < 0.3 else velocity[1]
        world.set_velocity(self.player, (walk, up, 0), (0, 0, 0))
        time = world.step_count() * STEP
        world.move_kinematic(self.lift, (-3, 1.1 - np.cos(time), 3), STEP)
        world.set_drive(self.mouse, position=(np.sin(time), 1 + 0.5 * np.sin(2 * time), 0), frequency=2, max_force=3e4)
        world.step(STEP)
        self.entered += int(world.events().sensors.begins.sum())


def true_input(step):
    """The player waits, walks, and turns round for a moment."""
    return 0.0 if step < 20 else -1.5 if 60 <= step < 70 else 1.5


def play(steps, late):
    """With `late`, each input is known only WINDOW steps after it was needed; until then the last known one is the guess."""
    game = Game()
    ring = gyre.Rollback(WINDOW + 2)
    entered = {}
    for step in range(steps):
        if not late:
            game.step(true_input(step))
            continue
        known = max(step - WINDOW, 0)
        ring.save(game.world)
        entered[step] = game.entered
        guess = true_input(known)
        game.step(guess)
        if step >= WINDOW and true_input(known) != true_input(max(known - 1, 0)) or step == steps - 1:
            # The guesses since the change were wrong.
            first = max(step - WINDOW, 0)
            ring.restore(game.world, first)
            game.entered = entered[first]
            for again in range(first, step + 1):
                ring.save(game.world)
                entered[again] = game.entered
                game.step(true_input(again))
    return game


def between(before, after, share):
    """Poses for a picture between two steps: positions, and orientations by normalised interpolation on the shorter way."""
    positions = before[0] + share * (after[0] - before[0])
    sign = np.where((before[1] * after[1]).sum(1) < 0, -1, 1)[:, None]
    turned = before[1] + share * (sign * after[1] - before[1])
    return positions, turned / np.linalg.norm(turned, axis=1)[:, None]


informed = play(200, late=False)
late = play(200, late=True)
print(f"informed {informed.world.hash():016x}\nlate     {late.world.hash():016x}, rolled back")
assert informed.world.hash() == late.world.hash()

place = informed.world.pose(informed.player).position
print(f"the player stands at {np.round(place, 2)}, the trigger saw {informed.entered} visitor(s), "
      f"the car drove to x = {informed.world.pose(informed.car).position[0]:.1f} m")
assert place[1] > 1.5 and informed.entered >= 1 and informed.world.pose(informed.car).position[0] > 2

bodies = informed.world.bodies()
before = bodies.positions.copy(), bodies.orientations.copy()
informed.step(0)
bodies = informed.world.bodies()
positions, _ = between(before, (bodies.positions, bodies.orientations), 0.25)
print(f"a picture a quarter of a step later shows {len(positions)} bodies between two steps")
