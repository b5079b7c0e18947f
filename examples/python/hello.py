"""Creates a world with a floor and lets a box fall on it."""

import gyre

world = gyre.World()
world.add_body(type="fixed", shapes=gyre.Plane())
box = world.add_body(pose=(0, 5, 0), shapes=gyre.Box())
for _ in range(120):
    world.step(1 / 60)
height = world.pose(box).position[1]
print(f"the box rests at a height of {height:.2f} m")
assert abs(height - 0.5) < 0.01
