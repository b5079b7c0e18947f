"""A seven-axis arm reaches down, grasps a box, lifts it and swings it round.

Inverse kinematics are damped least squares on a Jacobian that is written down from the axes of the joints. The motors follow the angles with
the velocity of the path, so they hardly lag. Torques come out of the joints, and forces of the fingers out of the contacts.
"""

import numpy as np

import gyre

STEP = 1 / 120
# Each joint: axis, and the way from its anchor to that of the next, at rest (m). The arm stands upright at rest.
JOINTS = [((0, 1, 0), 0.3), ((0, 0, 1), 0.3), ((0, 1, 0), 0.3), ((0, 0, 1), 0.3), ((0, 1, 0), 0.25), ((0, 0, 1), 0.2), ((0, 1, 0), 0.1)]
LIMIT_TORQUE = 300.0


def rotation(axis, angle):
    x, y, z = np.asarray(axis, float)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def kinematics(angles):
    """Place and rotation of the hand, and the place and axis of each joint, all in the world."""
    place, turned, places, axes = np.array([0, 0.1, 0]), np.eye(3), [], []
    for (axis, length), angle in zip(JOINTS, angles):
        places.append(place)
        axes.append(turned @ axis)
        turned = turned @ rotation(axis, angle)
        place = place + turned @ (0, length, 0)
    return place, turned, np.array(places), np.array(axes)


def solve(target, angles, rounds=200):
    """Angles at which the hand is at `target` and points down."""
    for _ in range(rounds):
        place, turned, places, axes = kinematics(angles)
        error = np.concatenate([target - place, np.cross(turned @ (0, 1, 0), (0, -1, 0))])
        if np.linalg.norm(error) < 1e-6:
            break
        jacobian = np.vstack([np.cross(axes, place - places).T, axes.T])
        angles = angles + jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + 1e-3 * np.eye(6), error)
    return angles


class Arm:
    def __init__(self, world):
        self.world, before, height = world, 0, 0.1
        self.joints = []
        for axis, length in JOINTS:
            link = world.add_body(pose=(0, height + length / 2, 0), shapes=dict(geometry=gyre.Capsule(0.05, length / 2 - 0.03), density=1500,
                                                                              filter=dict(group=-1)))
            self.joints.append(world.add_joint(gyre.HingeDef(a=before, b=link, anchor=(0, height, 0), axis=axis)))
            before, height = link, height + length
        # Two fingers slide along z of the hand.
        self.fingers, self.grip = [], []
        for side in (-1, 1):
            finger = world.add_body(pose=(0, height + 0.06, 0.08 * side), shapes=dict(
                geometry=gyre.Box(half_extents=(0.03, 0.06, 0.01)), density=2000, filter=dict(group=-1),
                material=dict(static_friction=1, dynamic_friction=0.9)))
            self.fingers.append(finger)
            self.grip.append(world.add_joint(gyre.SliderDef(a=before, b=finger, anchor=(0, height, 0), axis=(0, 0, -side), limits=(-0.02, 0.07))))

    def angles(self):
        return np.array([self.world.joint_axis_state(joint, "angular_x").position for joint in self.joints])

    def torques(self):
        return np.array([self.world.joint_axis_state(joint, "angular_x").force for joint in self.joints])

    def follow(self, angles, velocities, grip_force):
        for joint, angle, velocity in zip(self.joints, angles, velocities):
            self.world.set_motor(joint, target_position=angle, target_velocity=velocity, max_force=LIMIT_TORQUE)
        for joint in self.grip:
            self.world.set_motor(joint, target_velocity=np.sign(grip_force) * 0.2, max_force=abs(grip_force))


def smooth(start, end, share):
    """A path from one set of angles to another without jerks at its ends, and its derivative by `share`."""
    s, ds = share**3 * (10 - 15 * share + 6 * share**2), 30 * share**2 * (1 - share)**2
    return start + s * (end - start), ds * (end - start)


world = gyre.World(sleeping=False)
world.add_body(type="fixed", shapes=gyre.Plane())
arm = Arm(world)
box = world.add_body(pose=(0.55, 0.05, 0), shapes=dict(geometry=gyre.Box(half_extents=(0.04, 0.05, 0.04)), density=1000,
                                                       material=dict(static_friction=1, dynamic_friction=0.9)))

ready = np.array([0, -0.6, 0, -1.2, 0, -1.0, 0.0])
above = solve(np.array([0.55, 0.35, 0]), ready)
down = solve(np.array([0.55, 0.16, 0]), above)
round_ = above + np.array([np.pi / 2, 0, 0, 0, 0, 0, 0])
# (seconds, angles at the end, force of each finger, N: below 0 it opens)
plan = [(1.5, above, -20), (0.8, down, -20), (0.3, down, 40), (0.8, above, 40), (1.5, round_, 40)]

angles, worst = np.zeros(7), 0.0
for seconds, goal, force in plan:
    start, steps = angles, round(seconds / STEP)
    for i in range(1, steps + 1):
        angles, slope = smooth(start, goal, i / steps)
        arm.follow(angles, slope / seconds, force)
        world.step(STEP)
        worst = max(worst, abs(arm.angles() - angles).max())

contacts = world.contacts()
touching = [(contacts.body_a == finger) | (contacts.body_b == finger) for finger in arm.fingers]
pressed = [float(contacts.normal_impulse[rows].sum()) / STEP for rows in touching]
place = world.pose(box).position
print(f"the box is at {np.round(place, 3)}, gripped with {pressed[0]:.1f} N and {pressed[1]:.1f} N")
print(f"the joints kept within {worst:.4f} rad of their path; torques now: {np.round(arm.torques(), 1)} N m")
assert place[1] > 0.2 and abs(place[2]) > 0.4, "the box was carried up and round"
assert worst < 0.02
