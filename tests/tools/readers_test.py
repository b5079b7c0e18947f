#!/usr/bin/env python3
"""Every field of every definition can be read back from the world, or stands below with the reason why not.

A field has a reader if a function of World returns its definition or fills a span of them, if one has its name and takes the id of the object,
or if READERS names one. Whoever adds a field to a definition adds a reader, or a line here. The test walks all public headers: a new
definition must be in OBJECTS or in STATELESS, and every World::set_... must have its reader.
"""

import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "web" / "bindings"))

import headers  # noqa: E402
import model  # noqa: E402

# The definition of each object and the type of its id.
OBJECTS = {"WorldDef": None, "BodyDef": "BodyId", "CouplingDef": "CouplingId", "ShapeDef": "ShapeId", "FieldDef": "FieldId", "GasDef": "FluidId", "LiquidDef": "FluidId",
           "RopeDef": "SoftId", "ClothDef": "SoftId", "SolidDef": "SoftId", "SoftSettings": "SoftId", "MassDef": "BodyId", "LockedAxes": "BodyId",
           "Material": "ShapeId", "Filter": "ShapeId", "MaterialPair": None, "SurfaceRule": None, "Stepping": None, "SolverOptions": None,
           "JointAxisDef": "JointId", "Motor": "JointId", "PoseDrive": "JointId"}
# Definitions of what a world does not keep, and of joints, which a test below has.
STATELESS = {
    "ExplosionDef": "an event: impulses at once", "MeshDef": "cooked: view_mesh() shows the result",
    "HeightFieldDef": "cooked: view_height_field() shows the result", "DecompositionDef": "an order for work; its result has DecompositionStats",
}
# The readers of settings whose names differ from the setters'.
READERS_OF_SETTERS = {
    "set_velocity": "linear_velocity", "set_damping": "linear_damping", "set_joint_axis": "joint_axis_def", "set_sleeping": "def", "set_awake": "is_awake", "set_integrator": "def", "set_springs": "def",
    "set_time_stepping": "def", "set_solver": "def", "set_combine_rules": "def", "set_threads": "def", "set_broad_phase": "def",
    "set_mass": "mass_properties", "set_sensor": "is_sensor", "set_break_load": "joint_info", "set_vertices": "vertices",
    "set_emitters": "gas_def", "set_fluid_pose": "fluid_info", "set_fluid_velocity": "fluid_info",
}
WITHOUT_READER = {"set_problem_hook": "it belongs to the program and not to the world",
                  "set_vertex_limits": "the program sets them anew in each step; the vertices show what they do"}
READERS = {
    "MassDef.mass": "mass_properties", "MassDef.center_of_mass": "mass_properties", "MassDef.inertia": "mass_properties",
    "Stepping.substeps": "substeps", "Stepping.integrator": "def", "Stepping.springs": "def", "Stepping.time": "def", "Stepping.tolerance": "def",
    "Stepping.max_impacts": "def", "Stepping.solver": "def", "Stepping.solver_options": "def", "Stepping.broad_phase": "def",
    "SolverOptions.lcp_method": "def", "SolverOptions.friction_sides": "def", "SolverOptions.iterations": "def", "SolverOptions.direct_rows": "def",
    "BodyDef.locked": "locked_axes", "BodyDef.mass": "mass_properties", "BodyDef.center_of_mass": "mass_properties",
    "BodyDef.inertia": "mass_properties", "ShapeDef.local": "local_transform", "ShapeDef.sensor": "is_sensor",
    "SoftSettings.user_data": "soft_info", "SoftSettings.positions": "vertices", "SoftSettings.velocities": "vertices",
    "RopeDef.points": "vertices", "RopeDef.radius": "soft_info", "ClothDef.thickness": "soft_info", "ClothDef.pressure": "soft_info", "ClothDef.triangles": "soft_triangles",
    "RopeDef.linear_density": "soft_info", "ClothDef.area_density": "soft_info", "SolidDef.density": "soft_info",
    "SolidDef.surface": "soft_surface", "SolidDef.tetrahedra": "solid_tetrahedra",
}
# What nothing reads yet.
MATERIAL_OF_SOFT = "the material of ropes, cloths and solids is known to whoever made them; a snapshot keeps it"
UNREAD = {f"{name}.{part}": MATERIAL_OF_SOFT for name, parts in {
    "RopeDef": "segments links stretch_stiffness bend_stiffness settings",
    "ClothDef": "grid pose links stretch_stiffness shear_stiffness bend_stiffness self_collision ambient_pressure pressure_law settings",
    "SolidDef": "box pose model young_modulus poisson_ratio settings",
    "SoftSettings": "integrator damping static_friction dynamic_friction filter"}.items() for part in parts.split()}
# Of joints, JointInfo has what they connect and when they break; joint_axis_def(), motor() and drive() have what acts on their axes;
# read_joints() (gyre/debug.h) has the frames and limits.


class Readers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        include = ROOT / "include" / "gyre"
        # All headers that the bindings read, in the order of their includes.
        cls.api = headers.read_headers([include / f"{name}.h" for name in model.HEADERS])
        cls.texts = {path.name: path.read_text() for path in sorted(include.glob("*.h"))}
        cls.readers = [f for f in cls.api.classes["World"].functions if f.const]

    def returned(self, definition):
        return any(f.result == definition or any(p.type.replace(" ", "") == f"span<{definition}>" for p in f.parameters) for f in self.readers)

    def named(self, name, identity):
        return any(f.name == name and (not f.parameters or f.parameters[0].type == identity) for f in self.readers)

    def fields(self):
        for name, identity in OBJECTS.items():
            for part in self.api.structs[name].fields:
                yield name, part.name, identity

    def test_every_field_has_a_reader_or_a_reason(self):
        missing = [f"{name}.{field}" for name, field, identity in self.fields()
                   if not self.returned(name) and not self.named(field, identity) and f"{name}.{field}" not in UNREAD
                   and not self.named(READERS.get(f"{name}.{field}", ""), identity)]
        self.assertEqual(missing, [], "add a reader to World, or a line to this test")

    def test_every_definition_of_the_headers_is_known(self):
        found = {name for text in self.texts.values() for name in re.findall(r"^struct (\w+Def)\b[^;]*{", text, re.M)}
        self.assertGreater(len(found), 25)
        joints = {part.strip() for part in self.api.aliases["JointDef"].removeprefix("variant<").removesuffix(">").split(",")}
        self.assertEqual(sorted(found - set(OBJECTS) - set(STATELESS) - joints), [], "add them to OBJECTS or STATELESS")
        self.assertEqual(sorted(set(STATELESS) - found), [], "these are gone")

    def test_what_is_set_can_be_read(self):
        names = {f.name for f in self.readers}
        setters = {f.name for f in self.api.classes["World"].functions if f.name.startswith("set_")}
        self.assertGreater(len(setters), 30)
        missing = [name for name in sorted(setters - set(WITHOUT_READER))
                   if READERS_OF_SETTERS.get(name, name.removeprefix("set_")) not in names]
        self.assertEqual(missing, [], "add a reader to World, or a line to this test")
        self.assertLessEqual(set(READERS_OF_SETTERS) | set(WITHOUT_READER), setters)

    def test_every_joint_tells_what_it_connects(self):
        joints = [part.strip() for part in self.api.aliases["JointDef"].removeprefix("variant<").removesuffix(">").split(",")]
        self.assertGreater(len(joints), 10)
        info = {part.name for part in self.api.structs["JointInfo"].fields}
        for name in joints:
            fields = {part.name for part in self.api.structs[name].fields}
            self.assertLessEqual({"a", "b", "break_force", "break_torque", "collide_connected"}, fields & (info | {"anchor"}), name)

    def test_the_lists_name_nothing_that_is_gone(self):
        known = {f"{name}.{field}" for name, field, _ in self.fields()}
        self.assertLessEqual(set(READERS) | set(UNREAD), known)
        functions = {f.name for f in self.readers}
        self.assertLessEqual(set(READERS.values()), functions)
        read = [key for key in UNREAD if self.named(key.split(".")[1], OBJECTS[key.split(".")[0]])]
        self.assertEqual(read, [], "these have a reader now")


if __name__ == "__main__":
    unittest.main()
