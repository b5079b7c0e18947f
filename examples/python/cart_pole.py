"""A pole on a cart learns to stand, from nothing but falling: the cross-entropy method in a few lines of NumPy.

Forty-eight carts run at once, each with a policy of its own: the force is a weighted sum of the cart's place and speed and the pole's angle
and rate. The best policies of each round are the middle of the next.
"""

import numpy as np

import gyre

CARTS, STEPS, MOST_FORCE = 48, 150, 10.0


def make_world():
    """A cart of 1 kg on a rail, a pole of 0.1 kg and 1 m on the cart. Returns the world, the cart, the rail and the hinge."""
    world = gyre.World(sleeping=False)
    cart = world.add_body(pose=(0, 0, 0), mass=1.0, shapes=gyre.Box(half_extents=(0.25, 0.1, 0.15)))
    pole = world.add_body(pose=(0, 0.5, 0), mass=0.1, shapes=gyre.Capsule(0.02, 0.48))
    rail = world.add_joint(gyre.SliderDef(b=cart, axis=(1, 0, 0)))
    hinge = world.add_joint(gyre.HingeDef(a=cart, b=pole, axis=(0, 0, 1)))
    return world, cart, rail, hinge


class CartPole(gyre.VectorEnv):
    def __init__(self, worlds, seed=0, **options):
        world, self.cart, rail, hinge = make_world()
        self.pole = world.bodies().ids[1]
        readings = [gyre.Reading.joint_position(rail, "linear_x"), gyre.Reading.joint_velocity(rail, "linear_x"),
                    gyre.Reading.joint_position(hinge), gyre.Reading.joint_velocity(hinge)]
        super().__init__(world, worlds, readings, [gyre.Action.force(self.cart, "x")], action_limit=MOST_FORCE, **options)

    def rewards(self, observations, actions):
        return np.ones(len(self))

    def ends(self, observations):
        return (abs(observations[:, 0]) > 2.4) | (abs(observations[:, 2]) > 0.21)

    def randomize(self, which):
        for i in np.flatnonzero(which):
            world, spin = self.world(i), self.rng.uniform(-0.3, 0.3)
            world.set_velocity(self.body(i, self.pole), (-0.5 * spin, 0, 0), (0, 0, spin))


def time_upright(env, policies, seed):
    """For how many steps each policy keeps its pole up, in its own world."""
    observations, _ = env.reset(seed=seed)
    upright, standing = np.zeros(len(env)), np.ones(len(env), bool)
    for _ in range(STEPS):
        forces = np.clip((observations * policies).sum(1), -MOST_FORCE, MOST_FORCE)
        observations, rewards, terminated, _, _ = env.step(forces[:, None])
        upright += rewards * standing
        standing &= ~terminated
        if not standing.any():
            break
    return upright


def learn(env, rounds=12, seed=1):
    rng = np.random.default_rng(seed)
    middle, spread = np.zeros(4), np.full(4, 20.0)
    for turn in range(rounds):
        policies = middle + spread * rng.standard_normal((len(env), 4))
        upright = time_upright(env, policies, seed=turn)
        best = policies[np.argsort(-upright, kind="stable")[:len(env) // 6]]
        middle, spread = best.mean(0), best.std(0) + 0.5
        print(f"round {turn + 1}: the mean pole stood for {upright.mean() / 60:.2f} s, the best for {upright.max() / 60:.2f} s")
        if upright.mean() > 0.9 * STEPS:
            break
    return middle


env = CartPole(CARTS)
policy = learn(env)
stood = time_upright(env, np.tile(policy, (CARTS, 1)), seed=1000)
print(f"policy {np.round(policy, 2)} keeps {np.mean(stood >= STEPS):.0%} of {CARTS} new poles up")
assert np.mean(stood >= STEPS) > 0.9
