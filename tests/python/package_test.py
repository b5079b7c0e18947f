#!/usr/bin/env python3
"""The Python package: the bits of C++, arrays without copies, refusals in words, batches, and that nothing is left out.

GYRE_BUILD names the build folder; GYRE_PROGRAM the gyre program, without which its tests are skipped.
"""

import ast
import ctypes
import gc
import os
import re
import struct
import subprocess
import sys
import tempfile
import threading
import unittest
import zipfile
import zlib
from pathlib import Path

import numpy as np

import gyre
import gyre._api as api
from gyre._render import read_png
from gyre._runtime import AnyShape, Struct

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("GYRE_PROGRAM", "")


def heap(**settings):
    world = gyre.World(**settings)
    world.add_body(type="fixed", shapes=gyre.Plane())
    boxes = [world.add_body(pose=(0.1 * i, 0.6 + 1.1 * i, 0), shapes=gyre.Box(half_extents=(0.5, 0.4, 0.3))) for i in range(8)]
    return world, boxes


class Same(unittest.TestCase):
    @unittest.skipUnless(os.path.exists(PROGRAM), "no gyre program")
    def test_scenes_have_the_hash_of_the_program(self):
        for name in ("newtons_cradle", "machines"):
            scene = gyre.load_scene(name)
            scene.run(0.5)
            run = subprocess.run([PROGRAM, "simulate", str(ROOT / "scenes" / f"{name}.gyre.json"), "--duration", "0.5", "--hash"], check=True,
                                 capture_output=True, text=True)
            self.assertEqual(f"{scene.world.hash():016x}", run.stdout.split()[-1], name)

    def test_threads_and_widths_change_no_bit(self):
        hashes = set()
        for threads, width in ((1, 0), (2, 0), (1, 1)):
            world, _ = heap(threads=threads, simd_width=width)
            for _ in range(60):
                world.step(1 / 60)
            hashes.add(world.hash())
        self.assertEqual(len(hashes), 1)

    def test_layouts_are_those_of_c(self):
        """Each struct of Python has the size and the offsets that a C compiler gave it."""
        found, name = {}, ""
        for line in (ROOT / "capi" / "abi.txt").read_text(encoding="utf-8").splitlines():
            if line.startswith("  "):
                found[name][1][line.split()[0]] = int(line.split()[1])
            elif line.startswith("Gyre") and "." not in line:
                name = line.split()[0][4:]
                found[name] = (int(line.split()[1]), {})
        self.assertEqual(ctypes.sizeof(AnyShape), found["AnyShape"][0])
        seen = 0
        for name, (size, offsets) in found.items():
            cls = getattr(api, name, None)
            if isinstance(cls, type) and issubclass(cls, Struct):
                self.assertEqual(ctypes.sizeof(cls), size, name)
                self.assertEqual({member: raw.offset for member, raw in cls._raw.items()}, offsets, name)
                seen += 1
        self.assertGreater(seen, 100)

    def test_stubs_have_every_public_name(self):
        tree = ast.parse((Path(gyre.__file__).parent / "__init__.pyi").read_text(encoding="utf-8"))
        classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
        names = set(classes) | {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
        names |= {node.target.id for node in tree.body if isinstance(node, ast.AnnAssign)}
        self.assertEqual(set(gyre.__all__) - names, set())
        for cls in (gyre.World, gyre.Replay, gyre.Recorder, gyre.Batch, gyre.VectorEnv, gyre.Scene):
            members = {getattr(node, "name", None) for node in classes[cls.__name__].body}
            own = {name for name in vars(cls) if not name.startswith("_")} - {"handle", "owner"}
            self.assertEqual(own - members, set(), cls.__name__)

    def test_every_function_has_the_comment_of_its_header(self):
        self.assertIn("Advances the world", gyre.World.step.__doc__)
        self.assertIn("m/s^2", gyre.WorldDef.gravity.__doc__)



class Mechanisms(unittest.TestCase):
    def test_couplings_and_motors(self):
        world = gyre.World(gravity=(0, 0, 0))
        left, right = (world.add_body(pose=(x, 0, 0), can_sleep=False, mass=1, inertia=(1, 1, 1, 0, 0, 0)) for x in (-1, 1))
        a, b = (world.add_joint(gyre.SliderDef(b=body, anchor=(x, 0, 0), axis=(1, 0, 0))) for body, x in ((left, -1), (right, 1)))
        coupling = world.add_coupling(terms=[dict(joint=a, axis="linear_x", coefficient=1), dict(joint=b, axis="linear_x", coefficient=2)])
        for _ in range(30):
            world.add_joint_load(a, "linear_x", 5)
            world.step(1 / 60)
        self.assertAlmostEqual(2 * world.linear_velocity(right)[0], -world.linear_velocity(left)[0], 4)
        self.assertLess(world.coupling_state(coupling).force, 0)
        self.assertEqual(len(world.coupling(coupling).terms), 2)
        with self.assertRaisesRegex(gyre.GyreError, "2 to 8"):
            world.add_coupling(terms=[dict(joint=a, axis="linear_x")])

    def test_articulations_are_arrays(self):
        world = gyre.World()
        links = [world.add_body(pose=(i + 0.5, 0, 0), mass=1, inertia=(0.1, 0.1, 0.1, 0, 0, 0)) for i in range(3)]
        for i, link in enumerate(links):
            world.add_joint(gyre.HingeDef(a=links[i - 1] if i else None, b=link, anchor=(i, 0, 0), axis=(0, 0, 1)))
        arm = world.read_articulation(links[2])
        n, m = len(arm.velocities), len(arm.bodies)
        self.assertEqual((n, m), (3, 3))
        mass = arm.mass_matrix.reshape(n, n)
        self.assertAlmostEqual(mass[2, 2], 0.1 + 0.25, 6)
        jacobian = arm.jacobians.reshape(m, 6, n)
        np.testing.assert_allclose(jacobian[2, 1], [2.5, 1.5, 0.5], atol=1e-5)
        # A controller that computes torques holds the arm against its weight.
        for _ in range(30):
            for joint, axis, force in zip(arm.coordinate_joints, arm.coordinate_axes, world.inverse_dynamics(links[2], np.zeros(n))):
                world.add_joint_load(joint, gyre.JointAxis(axis), force)
            world.step(1 / 240)
        self.assertLess(np.abs(world.read_articulation(links[2]).positions).max(), 1e-3)
        poses = world.forward_kinematics(links[2], [np.pi / 2, 0, 0]).reshape(m, 7)
        np.testing.assert_allclose(poses[2, :3], [0, 2.5, 0], atol=1e-4)

    def test_disabled_bodies_and_grids(self):
        world = gyre.World(gravity=(0, 0, 0))
        ball = world.add_body(shapes=gyre.Sphere(0.5))
        world.set_enabled(ball, False)
        self.assertFalse(world.enabled(ball))
        self.assertIsNone(world.cast_ray((0, 0, 5), (0, 0, -10)))
        world.set_enabled(ball, True)
        vectors = np.zeros((2, 2, 2, 3), np.float32)
        vectors[..., 0] = 6
        world.add_field(kind="grid", bounds=dict(low=(-9, -9, -9), high=(9, 9, 9)), points=(2, 2, 2), vectors=vectors.reshape(-1, 3))
        for _ in range(60):
            world.step(1 / 60)
        self.assertAlmostEqual(world.linear_velocity(ball)[0], 6, 3)


class Values(unittest.TestCase):
    def test_definitions_have_the_defaults_of_cpp(self):
        self.assertEqual(gyre.BodyDef().type, gyre.BodyType.DYNAMIC)
        self.assertEqual(list(gyre.BodyDef().pose.orientation), [0, 0, 0, 1])
        self.assertIsNone(gyre.BodyDef().mass)
        self.assertEqual(gyre.ShapeDef().density, 1000)
        self.assertEqual(list(gyre.Plane().normal), [0, 1, 0])
        self.assertEqual(gyre.WorldDef().stepping.substeps, 4)

    def test_parts_change_in_place(self):
        shape = gyre.ShapeDef(geometry=gyre.Sphere(0.5))
        shape.material.static_friction = 0.25
        self.assertEqual(shape.material.static_friction, 0.25)
        rope = gyre.RopeDef(points=[(0, 1, 0), (1, 1, 0)])
        rope.settings.velocities = np.zeros((2, 3))
        gc.collect()
        self.assertEqual(rope.settings.velocities.shape, (2, 3))

    def test_unknown_fields_and_wrong_values_are_named(self):
        with self.assertRaisesRegex(TypeError, "BodyDef has no field 'posee', perhaps 'pose'"):
            gyre.BodyDef(posee=(0, 0, 0))
        with self.assertRaisesRegex(ValueError, "BodyDef.type: BodyType has no 'wobbly'"):
            gyre.BodyDef(type="wobbly")
        with self.assertRaisesRegex(ValueError, "linear_velocity: found 2 numbers, expected 3"):
            gyre.BodyDef(linear_velocity=(1, 2))
        with self.assertRaisesRegex(ValueError, "id: found 70000, expected 0 to 65535"):
            gyre.Material(id=70000)
        with self.assertRaisesRegex(TypeError, "expected a shape"):
            gyre.ShapeDef(geometry="sphere")

    def test_refused_calls_raise_the_words_of_the_engine(self):
        world, (box, *_) = heap()
        with self.assertRaisesRegex(gyre.GyreError, "gravity"):
            gyre.World(gravity=(np.nan, 0, 0))
        with self.assertRaisesRegex(gyre.GyreError, "radius"):
            world.add_shape(box, geometry=gyre.Sphere(-1))
        world.remove_body(box)
        with self.assertRaises(gyre.GyreError) as caught:
            world.set_velocity(box, (0, 0, 0), (0, 0, 0))
        self.assertEqual(caught.exception.code, gyre.ErrorCode.STALE_ID)

    def test_ids_are_numbers_that_outlive_nothing(self):
        world, (box, other, *_) = heap()
        self.assertIsInstance(box, gyre.BodyId)
        self.assertEqual(len({box, other, box}), 2)
        self.assertFalse(gyre.BodyId(0))
        self.assertIn(box, world.bodies().ids)
        world.remove_body(box)
        self.assertFalse(world.body_exists(box))
        self.assertTrue(world.body_exists(world.bodies().ids[1]))

    def test_joints_of_every_kind_are_taken(self):
        world, (a, b, *_) = heap()
        anchor = dict(a=a, b=b, anchor=(0, 1, 0))
        for definition in (gyre.BallDef, gyre.HingeDef, gyre.SliderDef, gyre.FixedDef, gyre.DistanceDef, gyre.ConeDef, gyre.UniversalDef,
                           gyre.SixDofDef, gyre.GearDef, gyre.WheelDef, gyre.MouseDef, gyre.MotorDef):
            joint = world.add_joint(definition(**anchor))
            self.assertTrue(world.joint_exists(joint), definition)
            world.remove_joint(joint)
        hinge = world.add_joint(gyre.HingeDef(**anchor, axis=(0, 0, 1), limits=(-0.5, 0.5), motor=dict(target_velocity=1, max_force=5)))
        self.assertEqual(world.joint_axis_state(hinge, "angular_x").position, 0)
        path = world.add_joint(gyre.PathDef(b=b, anchor=(0, 1, 0), points=[(0, 0, 0), (1, 0, 0), (2, 1, 0)]))
        self.assertTrue(world.joint_exists(path))
        with self.assertRaisesRegex(TypeError, "HingeDef"):
            world.add_joint(gyre.BodyDef())

    def test_shapes_come_back(self):
        world, (box, *_) = heap()
        hull = gyre.cook_hull([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)])
        self.assertEqual(hull.kind(), gyre.ShapeKind.HULL)
        self.assertEqual(len(gyre.view_hull(hull).vertices), 4)
        world.add_shape(box, geometry=hull)
        first, second = world.shapes(box)
        self.assertEqual(world.geometry(first), gyre.Box(half_extents=(0.5, 0.4, 0.3)))
        self.assertEqual(world.geometry(second).content_hash(), hull.content_hash())
        self.assertAlmostEqual(gyre.mass_properties(hull, 6).mass, 1, 5)


class Arrays(unittest.TestCase):
    def test_columns_are_the_memory_of_the_world(self):
        world, boxes = heap()
        for _ in range(10):
            world.step(1 / 60)
        one, two = world.bodies(), world.bodies()
        for name in ("ids", "positions", "orientations", "linear_velocities", "angular_velocities"):
            self.assertEqual(getattr(one, name).__array_interface__["data"], getattr(two, name).__array_interface__["data"], name)
        self.assertEqual(one.positions.dtype, np.float64)
        with self.assertRaises(ValueError):
            one.positions[0, 0] = 1
        for identity, place in zip(one.ids, one.positions):
            self.assertTrue(np.array_equal(place, world.pose(identity).position))

    def test_a_view_keeps_its_world(self):
        world, _ = heap()
        view = world.bodies().positions
        copy = view.copy()
        del world
        gc.collect()
        self.assertTrue(np.array_equal(view, copy))

    def test_contacts_and_events(self):
        world, boxes = heap()
        begins = 0
        for _ in range(120):
            world.step(1 / 60)
            begins += len(world.events().begins)
        self.assertGreaterEqual(begins, len(boxes))
        contacts = world.contacts()
        self.assertEqual(len(contacts), world.stats().contact_points)
        self.assertEqual(contacts.position.shape, (len(contacts), 3))
        weight = sum(world.mass_properties(box).mass for box in boxes) * 9.81
        ground = contacts[(contacts.body_a == world.bodies().ids[0]) | (contacts.body_b == world.bodies().ids[0])]
        self.assertAlmostEqual(float(ground.normal_impulse.sum()) * 60 / weight, 1, delta=0.1)

    def test_many_rays_are_one_call(self):
        world, _ = heap()
        rays = [((0.1 * i, 30, 0), (0, -40, 0)) for i in range(-20, 20)]
        hits = world.cast_ray_batch(rays)
        for ray, hit in zip(rays, hits):
            single = world.cast_ray(*ray)
            self.assertEqual(single.body, hit.body)
            self.assertTrue(np.array_equal(single.point, hit.point))
        self.assertEqual(len(world.cast_ray_all(*rays[20])), 7)  # six boxes and the ground

    def test_soft_matter_and_fluids(self):
        world = gyre.World()
        cloth = world.add_cloth(grid=dict(size=(1, 1), cells=(6, 6)), pose=(0, 2, 0))
        world.pin(cloth, 0)
        pool = world.add_liquid(upper=(0.4, 0.4, 0.4), cell_size=0.1, fill=[((0, 0, 0), (0.4, 0.2, 0.4))])
        room = world.add_gas(lower=(-1, 0, -1), upper=(1, 1, 1), cells=(8, 4, 8),
                             emitters=[dict(position=(0, 0.2, 0), radius=0.3, temperature=400)])
        world.step(1 / 60)
        vertices = world.vertices(cloth)
        self.assertEqual(vertices.x.shape, (49,))
        self.assertEqual(vertices.x.__array_interface__["data"], world.vertices(cloth).x.__array_interface__["data"])
        self.assertEqual(vertices.positions[0, 1], 2)
        self.assertEqual(world.soft_triangles(cloth).size % 3, 0)
        smoke = world.fluid_grid(room, "smoke")
        self.assertEqual(smoke.shape, (8, 4, 8))
        self.assertGreater(smoke.max(), 0)
        positions, velocities = world.liquid_particles(pool)
        self.assertEqual(positions.shape, velocities.shape)
        self.assertEqual(len(positions), world.fluid_info(pool).particles)
        surface, triangles = world.liquid_surface(pool)
        self.assertLess(triangles.max(), len(surface))
        self.assertEqual(len(world.gas_def(room).emitters), 1)
        self.assertEqual(world.sample_velocity(room, [(0, 0.5, 0), (0, 0.7, 0)]).shape, (2, 3))

    def test_other_threads_run_during_a_step(self):
        world = gyre.World()
        world.add_body(type="fixed", shapes=gyre.Plane())
        for i in range(600):
            world.add_body(pose=(1.01 * (i % 10), 0.5 + i // 100, 1.01 * (i // 10 % 10)), shapes=gyre.Box())
        world.set_substeps(64)
        started, ended, turns = threading.Event(), threading.Event(), 0

        def work():
            started.set()
            world.step(1 / 60)
            ended.set()

        thread = threading.Thread(target=work)
        thread.start()
        started.wait()
        while not ended.is_set():
            turns += 1
        thread.join()
        self.assertGreater(turns, 1000)


class States(unittest.TestCase):
    def test_snapshots_rollback_recordings(self):
        world, (box, *_) = heap()
        ring = gyre.Rollback(4)
        world.step(1 / 60)
        ring.save(world)
        before, data = world.hash(), world.save_snapshot()
        self.assertIsInstance(data, bytes)
        recorder = world.record()
        for _ in range(5):
            world.add_force(box, (100, 0, 0))
            world.step(1 / 60)
        after = world.hash()
        recording = recorder.finish()
        self.assertEqual(gyre.load_snapshot(data).hash(), before)
        self.assertTrue(ring.restore(world, 1))
        self.assertEqual(world.hash(), before)
        world.restore_snapshot(data)
        replay = gyre.Replay.open(recording)
        self.assertTrue(replay.play())
        self.assertEqual(replay.world().hash(), after)
        self.assertEqual(gyre.PoseTrack.open(recording).frame().ids.shape, (9,))
        with self.assertRaises(gyre.GyreError):
            gyre.Replay.open(b"no recording")

    def test_robots_and_gltf_files_load_as_scenes(self):
        scene = gyre.load_scene("formats/playground.gltf", decompose=True)
        self.assertIn("cart", scene.bodies)
        scene.step()
        robot = gyre.load_scene("formats/pendulum.urdf", base="free", keep_fixed=True)
        self.assertEqual(len(robot.bodies), 5)
        with self.assertRaisesRegex(gyre.GyreError, "gyre convert"):
            gyre.load_scene("formats/playground.gltf", package="/nowhere", strict=True, base="sideways")
        with self.assertRaisesRegex(TypeError, "robots and glTF files only"):
            gyre.load_scene("newtons_cradle", base="free")

    def test_scenes_have_names(self):
        scene = gyre.load_scene("newtons_cradle")
        self.assertIn("ball 1", scene.bodies)
        self.assertTrue(scene.world.body_exists(scene.bodies["ball 1"]))
        scene.step()
        again = gyre.read_scene(scene.write())
        self.assertEqual(len(again.bodies), len(scene.bodies))
        self.assertIn("machines", gyre.scene_names())
        with self.assertRaisesRegex(FileNotFoundError, "no scene 'nothing'"):
            gyre.load_scene("nothing")
        with self.assertRaisesRegex(gyre.GyreError, "gyre_scene"):
            gyre.read_scene("{}")


class Batches(unittest.TestCase):
    def make(self, worlds=6, **options):
        world, boxes = heap()
        hinge = world.add_joint(gyre.HingeDef(b=boxes[7], anchor=(0.7, 9, 0), axis=(0, 0, 1)))
        self.world, self.box, self.hinge = world, boxes[0], hinge
        return gyre.Batch(world, worlds, [gyre.Reading.position(self.box), gyre.Reading.linear_velocity(self.box, "xz"),
                                          gyre.Reading.joint_position(hinge), gyre.Reading.touching(self.box)],
                          [gyre.Action.force(self.box, "x"), gyre.Action.motor_force(hinge)], **options)

    def actions(self, worlds=6):
        return np.linspace(-1, 1, 2 * worlds, dtype=np.float32).reshape(worlds, 2) * (2000, 500)

    def test_each_world_has_the_bits_of_one_alone(self):
        batch, actions = self.make(threads=2, steps=2), self.actions()
        self.assertEqual((batch.observation_width, batch.action_width), (7, 2))
        for _ in range(15):
            rows = batch.step(actions)
        for i in (0, 5):
            alone = gyre.load_snapshot(heap_with_hinge())
            ids, joint = alone.bodies().ids, alone.read_joints((0, 0, 0)).ids[0]
            for _ in range(15):
                push = float(np.float32(actions[i, 1]))
                alone.set_motor(joint, target_velocity=-1e4 if push < 0 else 1e4, max_force=abs(push))
                for _ in range(2):
                    alone.add_force(ids[1], (float(np.float32(actions[i, 0])), 0, 0))
                    alone.step(1 / 60)
            self.assertEqual(batch.world(i).hash(), alone.hash())
            self.assertTrue(np.array_equal(rows[i, :3], np.float32(alone.pose(ids[1]).position)))
            self.assertEqual(rows[i, 5], np.float32(alone.joint_axis_state(joint, "angular_x").position))

    def test_threads_change_nothing_and_a_reset_goes_back(self):
        one, two = self.make(threads=1), self.make(threads=3)
        start = one.observe()
        for _ in range(10):
            rows, others = one.step(self.actions()), two.step(self.actions())
        self.assertTrue(np.array_equal(rows, others))
        self.assertFalse(np.array_equal(rows, start))
        which = np.array([1, 0, 0, 0, 0, 1], bool)
        one.reset(which)
        self.assertTrue(np.array_equal(one.observe()[which, :6], start[which, :6]))
        self.assertTrue(np.array_equal(one.observe()[~which], rows[~which]))
        one.reset()
        for _ in range(10):
            again = one.step(self.actions())
        self.assertTrue(np.array_equal(again, rows))

    def test_columns_draws_and_hashes_of_all_worlds(self):
        batch = self.make()
        box = self.box
        batch.set_draws([gyre.Draw.position(box, (-1, 0, -1), (1, 0, 1)), gyre.Draw.friction(box, 0.5, 1.5)], seed=7)
        positions, orientations = batch.poses()
        self.assertEqual((positions.shape, orientations.shape), ((6, batch.body_count, 3), (6, batch.body_count, 4)))
        place = list(self.world.bodies().ids).index(box)
        moved = positions[:, place] - self.world.pose(box).position
        self.assertTrue(np.allclose(moved, batch.drawn()[:, 0]))
        self.assertEqual(len(set(batch.hashes().tolist())), 6)
        batch.step(self.actions())
        self.assertGreater(np.abs(batch.velocities()[0]).max(), 0)
        before = batch.hashes()
        self.assertEqual(int(before[3]), batch.world(3).hash())
        batch.set_draws([gyre.Draw.position(box, (-1, 0, -1), (1, 0, 1)), gyre.Draw.friction(box, 0.5, 1.5)], seed=7)
        batch.step(self.actions())
        self.assertTrue(np.array_equal(batch.hashes(), before))

    def test_refusals(self):
        batch = self.make()
        with self.assertRaisesRegex(ValueError, "expected \\(6, 2\\)"):
            batch.step(np.zeros((5, 2)))
        with self.assertRaisesRegex(gyre.GyreError, "no such body"):
            gyre.Batch(self.world, 2, [gyre.Reading.position(gyre.BodyId(12345 | 1 << 32))])
        with self.assertRaisesRegex(ValueError, "found axes 'xq'"):
            gyre.Reading.position(self.box, "xq")
        with self.assertRaises(gyre.GyreError):
            batch.step(np.full((6, 2), np.nan))
        with self.assertRaises(IndexError):
            batch.world(6)

    def test_vector_environment(self):
        world = gyre.World()
        ball = world.add_body(pose=(0, 1, 0), shapes=gyre.Sphere(0.1))

        class Fall(gyre.VectorEnv):
            def rewards(self, observations, actions):
                return observations[:, 0]

            def ends(self, observations):
                return observations[:, 0] < 0

            def randomize(self, which):
                for i in np.flatnonzero(which):
                    self.world(i).set_pose(self.body(i, ball), (0, self.rng.uniform(0.5, 1), 0))

        env = Fall(world, 5, [gyre.Reading.position(ball, "y")], max_steps=40)
        rows, info = env.reset(seed=3)
        self.assertEqual((rows.shape, info), ((5, 1), {}))
        self.assertGreater(np.ptp(rows), 0)
        self.assertEqual(env.single_observation_space.shape, (1,))
        again, _ = env.reset(seed=3)
        self.assertTrue(np.array_equal(rows, again))
        ends = 0
        for _ in range(60):
            rows, rewards, terminated, truncated, info = env.step(np.zeros((5, 0)))
            ends += terminated.sum()
            if terminated.any():
                self.assertTrue((info["final_observation"][terminated] < 0).all())
                self.assertTrue((rows >= 0).all())
        self.assertGreater(ends, 5)


def heap_with_hinge():
    world, boxes = heap()
    world.add_joint(gyre.HingeDef(b=boxes[7], anchor=(0.7, 9, 0), axis=(0, 0, 1)))
    return world.save_snapshot()


class Pictures(unittest.TestCase):
    def test_every_filter_of_a_png_is_undone(self):
        pixels = np.random.default_rng(2).integers(0, 256, (5, 7, 3), np.uint8)
        rows, raw, up = [], pixels.reshape(5, 21).astype(int), np.zeros(21, int)
        for kind, row in enumerate(raw):
            left, corner = np.r_[0, 0, 0, row[:-3]], np.r_[0, 0, 0, up[:-3]]
            paeth = [min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2] for a, b, c in zip(left, up, corner)]
            guess = [0 * row, left, up, (left + up) // 2, np.array(paeth)][kind]
            rows.append(bytes([kind]) + ((row - guess) % 256).astype(np.uint8).tobytes())
            up = row
        chunks = [(b"IHDR", struct.pack(">IIBBBBB", 7, 5, 8, 2, 0, 0, 0)), (b"IDAT", zlib.compress(b"".join(rows))), (b"IEND", b"")]
        data = b"\x89PNG\r\n\x1a\n" + b"".join(struct.pack(">I", len(b)) + k + b + struct.pack(">I", zlib.crc32(k + b)) for k, b in chunks)
        self.assertTrue(np.array_equal(read_png(data), pixels))

    @unittest.skipUnless(os.path.exists(PROGRAM), "no gyre program")
    def test_a_world_is_drawn(self):
        world, _ = heap()
        try:
            picture = gyre.render(world, 64, 48, samples=1)
        except gyre.GyreError as error:
            if "built without" in str(error) or "OpenGL" in str(error) or "EGL" in str(error):
                self.skipTest(str(error))
            raise
        self.assertEqual((picture.shape, picture.dtype), ((48, 64, 3), np.uint8))
        self.assertGreater(picture.std(), 5)


class Docs(unittest.TestCase):
    def test_the_programs_of_the_pages_run(self):
        for page in ("docs/python.md", "README.md", "python/README.md"):
            blocks = re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"), re.DOTALL)
            self.assertTrue(blocks, page)
            with tempfile.TemporaryDirectory() as folder:
                run = subprocess.run([sys.executable, "-W", "ignore", "-c", "\n".join(blocks)], cwd=folder, capture_output=True, text=True,
                                     check=False)
            self.assertEqual(run.returncode, 0, f"{page}: {run.stderr}")


class Wheels(unittest.TestCase):
    def test_a_wheel_works_where_it_lies(self):
        try:
            import setuptools  # noqa: F401
            import wheel  # noqa: F401
        except ImportError as missing:
            self.skipTest(str(missing))
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, "-W", "ignore", "setup.py", "-q", "egg_info", "--egg-base", folder, "build", "--build-base", folder,
                            "bdist_wheel", "-d", folder, "-b", os.path.join(folder, "packed")], cwd=ROOT / "python", check=True,
                           capture_output=True)
            packed, = Path(folder).glob("gyre-*-py3-none-*.whl")
            zipfile.ZipFile(packed).extractall(os.path.join(folder, "installed"))
            environment = {key: value for key, value in os.environ.items() if not key.startswith("GYRE_")}
            code = "import gyre; gyre.load_scene('machines').run(0.02); print(gyre.__file__)"
            run = subprocess.run([sys.executable, "-c", code], env={**environment, "PYTHONPATH": os.path.join(folder, "installed")},
                                 cwd=folder, check=False, capture_output=True, text=True)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertIn(folder, run.stdout)


if __name__ == "__main__":
    unittest.main()
