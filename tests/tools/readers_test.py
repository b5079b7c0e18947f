#!/usr/bin/env python3
"""Every field of every definition can be read back from the world, or stands below with the reason why not.

A field has a reader if a function of World returns its definition, if one has its name and takes the id of the object, or if READERS names
one. Whoever adds a field to a definition adds a reader, or a line here.
"""

import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "web" / "bindings"))

import headers  # noqa: E402

# The definition of each object and the type of its id.
OBJECTS = {"WorldDef": None, "BodyDef": "BodyId", "ShapeDef": "ShapeId", "FieldDef": "FieldId", "GasDef": "FluidId", "LiquidDef": "FluidId",
           "RopeDef": "SoftId", "ClothDef": "SoftId", "SolidDef": "SoftId", "SoftSettings": "SoftId"}
READERS = {
    "BodyDef.locked": "locked_axes", "BodyDef.mass": "mass_properties", "BodyDef.center_of_mass": "mass_properties",
    "BodyDef.inertia": "mass_properties", "ShapeDef.local": "local_transform", "ShapeDef.sensor": "is_sensor",
    "SoftSettings.user_data": "soft_info", "SoftSettings.positions": "vertices", "SoftSettings.velocities": "vertices",
    "RopeDef.points": "vertices", "RopeDef.radius": "soft_info", "ClothDef.thickness": "soft_info", "ClothDef.pressure": "soft_info", "ClothDef.triangles": "soft_triangles",
    "RopeDef.linear_density": "soft_info", "ClothDef.area_density": "soft_info", "SolidDef.density": "soft_info",
    "SolidDef.surface": "soft_surface",
}
# What nothing reads yet.
MATERIAL_OF_SOFT = "the material of ropes, cloths and solids is known to whoever made them; a snapshot keeps it"
UNREAD = {f"{name}.{part}": MATERIAL_OF_SOFT for name, parts in {
    "RopeDef": "segments links stretch_stiffness bend_stiffness settings",
    "ClothDef": "grid pose links stretch_stiffness shear_stiffness bend_stiffness self_collision ambient_pressure pressure_law settings",
    "SolidDef": "box tetrahedra pose model young_modulus poisson_ratio settings",
    "SoftSettings": "integrator damping static_friction dynamic_friction filter"}.items() for part in parts.split()}
# Of joints, JointInfo has what they connect and when they break. Nothing reads their axes, springs and motors as they were set;
# joint_axis_state() has their effect, read_joints() (gyre/debug.h) the frames and limits.


class Readers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        include = ROOT / "include" / "gyre"
        names = ("math", "ids", "result", "geometry", "queries", "stepping", "defs", "joints", "events", "soft", "fluid", "fields", "world")
        cls.api = headers.read_headers([include / f"{name}.h" for name in names])
        cls.readers = [f for f in cls.api.classes["World"].functions if f.const]

    def returned(self, definition):
        return any(f.result == definition for f in self.readers)

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
