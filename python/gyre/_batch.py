"""Many copies of one world, stepped over all cores: observations and actions are one array each."""

import ctypes
import dataclasses

import numpy as np

from ._api import BodyId, JointAxis, JointId, Pose, World
from ._runtime import COUNT, POINTER, Handle, IdBits, call, done


class _Channel(ctypes.Structure):
    _fields_ = [("what", ctypes.c_uint8), ("components", ctypes.c_uint8), ("axis", ctypes.c_uint8), ("body", IdBits), ("joint", IdBits),
                ("max_force", ctypes.c_float), ("frequency", ctypes.c_float), ("damping_ratio", ctypes.c_float)]


class _Draw(ctypes.Structure):
    _fields_ = [("what", ctypes.c_uint8), ("body", IdBits), ("low", ctypes.c_float * 3), ("high", ctypes.c_float * 3)]


def _bits(identity):
    return IdBits(identity & 0xffffffff, identity >> 32 & 0xffff, identity >> 48)


@dataclasses.dataclass(frozen=True)
class Channel:
    """One reading or action of every world in a batch; made by Reading and Action."""

    what: int
    body: int = 0
    joint: int = 0
    components: int = 0
    axis: int = 0
    max_force: float = 0.0
    frequency: float = 0.0
    damping_ratio: float = 1.0

    def raw(self):
        return _Channel(self.what, self.components, self.axis, _bits(self.body), _bits(self.joint), self.max_force, self.frequency,
                        self.damping_ratio)


@dataclasses.dataclass(frozen=True)
class Drawn:
    """One parameter that every world draws when it begins; made by Draw."""

    what: int
    body: int
    low: tuple
    high: tuple

    def raw(self):
        return _Draw(self.what, _bits(self.body), self.low, self.high)


def _vector(value):
    x, y, z = value
    return float(x), float(y), float(z)


class Draw:
    """What each world draws when it begins, evenly between two values. Ids are those of the world that the batch is made of."""

    @staticmethod
    def position(body, low, high):
        """m, added to that of the start: three numbers each"""
        return Drawn(0, body, _vector(low), _vector(high))

    @staticmethod
    def linear_velocity(body, low, high):
        """m/s, added: three numbers each"""
        return Drawn(1, body, _vector(low), _vector(high))

    @staticmethod
    def angular_velocity(body, low, high):
        """rad/s, added: three numbers each"""
        return Drawn(2, body, _vector(low), _vector(high))

    @staticmethod
    def gravity(low, high):
        """m/s^2, added to that of the world: three numbers each"""
        return Drawn(3, 0, _vector(low), _vector(high))

    @staticmethod
    def gravity_scale(body, low, high):
        """a factor"""
        return Drawn(4, body, (low, 0, 0), (high, 0, 0))

    @staticmethod
    def friction(body, low, high):
        """a factor for all shapes of the body"""
        return Drawn(5, body, (low, 0, 0), (high, 0, 0))

    @staticmethod
    def restitution(body, low, high):
        """0 to 1, of all shapes of the body"""
        return Drawn(6, body, (low, 0, 0), (high, 0, 0))


def _components(axes, known):
    wrong = set(axes) - set(known)
    if wrong or not axes:
        raise ValueError(f"found axes '{axes}', expected some of '{known}'")
    return sum(1 << known.index(axis) for axis in set(axes))


def _axis(axis):
    return int(JointAxis.of(axis))


class Reading:
    """What a batch observes. Ids are those of the world that the batch is made of. Axes come in the order x, y, z, w."""

    @staticmethod
    def position(body, axes="xyz"):
        """m, of the body's origin, world frame"""
        return Channel(0, body=body, components=_components(axes, "xyz"))

    @staticmethod
    def orientation(body, axes="xyzw"):
        """a quaternion"""
        return Channel(1, body=body, components=_components(axes, "xyzw"))

    @staticmethod
    def linear_velocity(body, axes="xyz"):
        """m/s, of the centre of mass, world frame"""
        return Channel(2, body=body, components=_components(axes, "xyz"))

    @staticmethod
    def angular_velocity(body, axes="xyz"):
        """rad/s, world frame"""
        return Channel(3, body=body, components=_components(axes, "xyz"))

    @staticmethod
    def joint_position(joint, axis="angular_x"):
        """rad or m, zero where the joint was added. A hinge turns about angular_x, a slider moves along linear_x."""
        return Channel(4, joint=joint, axis=_axis(axis))

    @staticmethod
    def joint_velocity(joint, axis="angular_x"):
        """rad/s or m/s"""
        return Channel(5, joint=joint, axis=_axis(axis))

    @staticmethod
    def joint_force(joint, axis="angular_x"):
        """N m or N, of limits, motor, spring and friction together"""
        return Channel(6, joint=joint, axis=_axis(axis))

    @staticmethod
    def touching(body):
        """N, sum of the normal forces on a body in the last step"""
        return Channel(7, body=body)


class Action:
    """What a batch acts on."""

    @staticmethod
    def force(body, axes="xyz"):
        """N, on the centre of mass, world frame"""
        return Channel(0, body=body, components=_components(axes, "xyz"))

    @staticmethod
    def torque(body, axes="xyz"):
        """N m, world frame"""
        return Channel(1, body=body, components=_components(axes, "xyz"))

    @staticmethod
    def motor_velocity(joint, max_force):
        """rad/s or m/s, the target of the joint's motor"""
        return Channel(2, joint=joint, max_force=max_force)

    @staticmethod
    def motor_position(joint, max_force, frequency=0.0, damping_ratio=1.0):
        """rad or m; frequency 0 is as stiff as the step allows"""
        return Channel(3, joint=joint, max_force=max_force, frequency=frequency, damping_ratio=damping_ratio)

    @staticmethod
    def motor_force(joint):
        """N m or N, constant through the steps"""
        return Channel(4, joint=joint)

    @staticmethod
    def velocity(body, axes="xyz"):
        """m/s, set before the steps; the axes that are left out become 0"""
        return Channel(5, body=body, components=_components(axes, "xyz"))


class _Vec3(ctypes.Structure):
    _fields_ = [("x", ctypes.c_float), ("y", ctypes.c_float), ("z", ctypes.c_float)]


class Batch(Handle):
    """`worlds` copies of `world` as it is. Row i of every array belongs to world i.

        batch = gyre.Batch(world, 1000, observations=[gyre.Reading.position(ball)], actions=[gyre.Action.force(ball, "x")])
        observations = batch.step(actions)   # (1000, 3) from (1000, 1)

    Results do not depend on `threads` (0: as many as the machine has): each world has the bits of one that is stepped alone.
    """

    _draws = 0
    _destroy = call("gyre_batch_destroy", None, POINTER)
    _create = call("gyre_batch_create", POINTER, POINTER, ctypes.c_int32, ctypes.c_int32)
    _observations = call("gyre_batch_set_observations", ctypes.c_bool, POINTER, POINTER, COUNT)
    _actions = call("gyre_batch_set_actions", ctypes.c_bool, POINTER, POINTER, COUNT)
    _set_draws = call("gyre_batch_set_draws", ctypes.c_bool, POINTER, POINTER, COUNT, ctypes.c_uint64)
    _body_count = call("gyre_batch_body_count", COUNT, POINTER)
    _columns = call("gyre_batch_columns", ctypes.c_bool, POINTER, POINTER, POINTER, POINTER)
    _hashes = call("gyre_batch_hashes", None, POINTER, POINTER)
    _drawn = call("gyre_batch_drawn", _Vec3, POINTER, COUNT, COUNT)
    _observation_width = call("gyre_batch_observation_width", COUNT, POINTER)
    _action_width = call("gyre_batch_action_width", COUNT, POINTER)
    _step = call("gyre_batch_step", ctypes.c_bool, POINTER, POINTER, POINTER, ctypes.c_int32, ctypes.c_float)
    _reset = call("gyre_batch_reset", ctypes.c_bool, POINTER, POINTER)
    _observe = call("gyre_batch_observe", None, POINTER, POINTER)
    _world = call("gyre_batch_world", POINTER, POINTER, COUNT)
    _body = call("gyre_batch_body", ctypes.c_uint64, POINTER, COUNT, ctypes.c_uint64)
    _joint = call("gyre_batch_joint", ctypes.c_uint64, POINTER, COUNT, ctypes.c_uint64)

    def __init__(self, world, worlds, observations=(), actions=(), time_step=1 / 60, steps=1, threads=0, draws=(), seed=0):
        self.handle, self.owner = done(self._create(world.handle, worlds, threads)), None
        self.time_step, self.steps, self.num_envs = time_step, steps, worlds
        for function, channels in ((self._observations, observations), (self._actions, actions)):
            raw = (_Channel * len(channels))(*[channel.raw() for channel in channels])
            done(function(self.handle, raw, len(channels)))
        self.observation_width, self.action_width = self._observation_width(self.handle), self._action_width(self.handle)
        self.body_count = self._body_count(self.handle)
        self.set_draws(draws, seed)

    def set_draws(self, draws, seed=0):
        """The parameters that each world draws when it begins. Sets all worlds back to the start. Equal seeds draw equal numbers."""
        if draws or self._draws:
            done(self._set_draws(self.handle, (_Draw * len(draws))(*[draw.raw() for draw in draws]), len(draws), seed))
        self._draws = len(draws)

    def drawn(self):
        """The numbers that each world has drawn: by world, draw and component."""
        rows = np.empty((self.num_envs, self._draws, 3), np.float32)
        for i in range(self.num_envs):
            for k in range(self._draws):
                value = self._drawn(self.handle, i, k)
                rows[i, k] = value.x, value.y, value.z
        return rows

    def __len__(self):
        return self.num_envs

    def advance(self, actions=None, out=None):
        """Applies a row of actions to each world, steps it `steps` times by `time_step`, and returns a row of observations of each."""
        out = np.empty((self.num_envs, self.observation_width), np.float32) if out is None else out
        if out.shape != (self.num_envs, self.observation_width) or out.dtype != np.float32 or not out.flags.c_contiguous:
            raise ValueError(f"out must be a contiguous array of np.float32, {self.num_envs} by {self.observation_width}")
        at = None
        if self.action_width:
            if actions is None:
                raise ValueError(f"actions are needed: {self.num_envs} by {self.action_width}")
            actions = np.ascontiguousarray(actions, np.float32)
            if actions.size != self.num_envs * self.action_width:
                raise ValueError(f"found actions of the shape {actions.shape}, expected ({self.num_envs}, {self.action_width})")
            at = actions.ctypes.data
        done(self._step(self.handle, at, out.ctypes.data, self.steps, self.time_step))
        return out

    step = advance

    def restart(self, which=None):
        """Sets all worlds, or those whose element is true, back to the start."""
        if which is not None:
            which = np.ascontiguousarray(which, np.uint8)
            if which.shape != (self.num_envs,):
                raise ValueError(f"found the shape {which.shape}, expected ({self.num_envs},)")
        done(self._reset(self.handle, None if which is None else which.ctypes.data))

    reset = restart

    def observe(self):
        """The observations of the present state."""
        out = np.empty((self.num_envs, self.observation_width), np.float32)
        self._observe(self.handle, out.ctypes.data)
        return out

    def poses(self):
        """All bodies of all worlds: positions (worlds, bodies, 3), m, and orientations (worlds, bodies, 4). Removed bodies are zero."""
        rows = np.zeros((self.num_envs, self.body_count), Pose._rows_dtype())
        done(self._columns(self.handle, rows.ctypes.data, None, None))
        return rows["position"], rows["orientation"]

    def velocities(self):
        """All bodies of all worlds: linear (m/s) and angular (rad/s) velocities, (worlds, bodies, 3) each."""
        linear, angular = np.zeros((2, self.num_envs, self.body_count, 3), np.float32)
        done(self._columns(self.handle, None, linear.ctypes.data, angular.ctypes.data))
        return linear, angular

    def hashes(self):
        """World.hash() of each world."""
        out = np.empty(self.num_envs, np.uint64)
        self._hashes(self.handle, out.ctypes.data)
        return out

    def world(self, index):
        """One of the worlds, to be read and changed between two steps. body() and joint() give its ids."""
        if not 0 <= index < self.num_envs:
            raise IndexError(f"found world {index}, expected 0 to {self.num_envs - 1}")
        return World.from_handle(self._world(self.handle, index), self)

    def body(self, index, body):
        return BodyId(self._body(self.handle, index, body))

    def joint(self, index, joint):
        return JointId(self._joint(self.handle, index, joint))


@dataclasses.dataclass
class Space:
    """What a row of an array may hold, in the words of Gymnasium."""

    low: float
    high: float
    shape: tuple
    dtype: type = np.float32


class VectorEnv(Batch):
    """A batch in the manner of Gymnasium's vector environments: reset() and step() return what theirs do. A subclass says what it is about:

        rewards(observations, actions)   one number a world
        ends(observations)               one truth value a world: the episode is over
        randomize(which)                 changes worlds that begin an episode, with self.rng

    Worlds whose episode is over, or that have done `max_steps`, begin anew at once; `info["final_observation"]` has their last row.
    """

    def __init__(self, world, worlds, observations, actions=(), max_steps=0, action_limit=1.0, **options):
        super().__init__(world, worlds, observations, actions, **options)
        self.max_steps, self.rng = max_steps, np.random.default_rng()
        self.episode_steps = np.zeros(worlds, np.int64)
        self.single_observation_space = Space(-np.inf, np.inf, (self.observation_width,))
        self.single_action_space = Space(-action_limit, action_limit, (self.action_width,))
        self.observation_space = Space(-np.inf, np.inf, (worlds, self.observation_width))
        self.action_space = Space(-action_limit, action_limit, (worlds, self.action_width))

    def rewards(self, observations, actions):
        return np.zeros(self.num_envs, np.float32)

    def ends(self, observations):
        return np.zeros(self.num_envs, bool)

    def randomize(self, which):
        pass

    def begin(self, which):
        self.restart(which)
        self.episode_steps[which] = 0
        self.randomize(which)

    def reset(self, seed=None, options=None):
        if seed is not None:
            self.rng = np.random.default_rng(seed)
        self.begin(np.ones(self.num_envs, bool))
        return self.observe(), {}

    def step(self, actions):
        observations = self.advance(actions)
        self.episode_steps += 1
        rewards = np.asarray(self.rewards(observations, actions))
        terminated = np.asarray(self.ends(observations), bool)
        truncated = (self.episode_steps >= self.max_steps) & ~terminated if self.max_steps else np.zeros(self.num_envs, bool)
        over, info = terminated | truncated, {}
        if over.any():
            info["final_observation"] = observations.copy()
            self.begin(over)
            observations = self.observe()
        return observations, rewards, terminated, truncated, info
