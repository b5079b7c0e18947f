// Reading what was written gives the same scene: same text, and the same bits in every number.
#include "scene/scene_writer.h"

#include "scene/scene_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <type_traits>
#include <variant>

namespace gyre::scene_writer_test {
namespace {

const std::string kEverything = R"({
  "gyre_scene": 1,
  "name": "every member, \"quoted\" and \u00e4",
  "world": {"gravity": [0.1, -9.81, 1e-7], "time_step": 0.00833333333, "substeps": 8, "integrator": "semi_implicit_euler",
            "solver": "lcp", "lcp_method": "lemke", "friction_sides": 8, "iterations": 40, "direct_rows": 90, "broad_phase": "brute_force", "stepping": "fixed", "sleeping": false,
            "sleep_share": 0.25},
  "view": {"eye": [1, 2.5, 1e6], "target": [0, 1, 0], "field_of_view": 0.9},
  "materials": {
    "ice": {"color": "#a0C0ff", "density": 917, "static_friction": 0.1, "dynamic_friction": 0.03, "restitution": 0.05,
            "rolling_friction": 0.001, "spinning_friction": 0.002},
    "a, b": {"dynamic_friction": 0.3}
  },
  "material_pairs": [
    {"materials": ["ice", "ice"], "static_friction": 0.03, "dynamic_friction": 0.02, "restitution": 0.3},
    {"materials": ["ice", "a, b"], "static_friction": 0.5}
  ],
  "meshes": {"tetra": {"vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], "triangles": [[0,2,1],[0,1,3],[0,3,2],[1,2,3]]}},
  "bodies": [
    {"name": "ground", "type": "static", "shapes": [
      {"type": "plane", "normal": [0, 2, 0], "offset": -1},
      {"type": "mesh", "mesh": "tetra"},
      {"type": "height_field", "size": [3, 2], "spacing": 0.5, "heights": [0, 0.1, null, 0.2, 0.3, -1]}]},
    {"name": "mover", "type": "kinematic", "linear_velocity": [1, 0, 0], "shapes": [{"type": "box", "half_extents": [1, 2, 3]}]},
    {"name": "box", "type": "dynamic", "position": [123456789.123456789, 1, -0.1],
     "orientation": {"euler_xyz": [0.1, 0.2, 0.3]},
     "linear_velocity": [1, 2, 3], "angular_velocity": [0.1, 0.2, 0.3], "linear_damping": 0.1, "angular_damping": 0.2,
     "gravity_scale": 0.5, "continuous": true, "can_sleep": false, "sleep_speed": 0.125,
     "locked": {"linear": [true, false, false], "angular": [false, true, false]},
     "mass": 3.3, "center_of_mass": [0.1, 0, 0], "inertia": [1, 2, 2.5, 0.1, 0, 0.01],
     "filter": {"layer": 4, "collides_with": 4294967294, "group": -3}, "sensor": true, "color": "#000001",
     "shapes": [
       {"type": "sphere", "radius": 0.333333333, "position": [0.1, 0.2, 0.3], "orientation": [0, 0, 0.6, 0.8], "material": "ice"},
       {"type": "box", "half_extents": [0.5, 0.4, 0.3], "rounding": 0.1, "material": "a, b", "density": 5},
       {"type": "capsule", "radius": 0.3, "half_height": 0, "static_friction": 0.2, "color": "#123abc"},
       {"type": "cylinder", "radius": 0.3, "half_height": 0.5, "dynamic_friction": 0.1},
       {"type": "cone", "radius": 0.3, "half_height": 0.5, "restitution": 0.9},
       {"type": "convex_hull", "points": [[0,0,0],[1,0,0],[0,1,0],[0,0,1],[0.1,0.1,0.1]], "rolling_friction": 0.01},
       {"type": "convex_hull", "mesh": "tetra", "spinning_friction": 0.01, "material": null}],
     "forces": [
       {"force": [1, 2, 3], "torque": [4, 5, 6], "at": [7, 8, 9], "frame": "body", "start": 0.5, "end": 1.5},
       {"torque": [0, 1, 0], "at": null}]},
    {"name": "other"}
  ],
  "joints": [
    {"type": "ball", "name": "j1", "a": "box", "b": "world", "anchor": [0, 1, 0], "break_force": 100, "break_torque": 50},
    {"type": "hinge", "name": "j2", "a": "box", "b": "other", "anchor": [0, 1, 0], "axis": [1, 0, 0], "limits": [-0.5, 1.2],
     "motor": {"target_velocity": 1, "target_position": 0.5, "max_force": 10, "frequency": 2, "damping_ratio": 0.7}},
    {"type": "slider", "name": "j3", "a": "world", "b": "other", "axis": [0, 2, 0], "limits": null, "motor": null},
    {"type": "fixed", "a": "box", "b": "other", "collide_connected": true, "length": null},
    {"type": "distance", "a": "box", "b": "other", "anchor": [0, 1, 0], "anchor_b": [0, 2, 0], "length": 1,
     "min_length": 0.5, "max_length": 2, "stiffness": 100, "damping": 3},
    {"type": "distance", "a": "box", "b": "other"}
  ],
  "couplings": [{"terms": [{"joint": "j2", "axis": "angular_x", "coefficient": 2.5}, {"joint": "j3"}], "offset": 0.5},
    {"terms": [{"joint": "j3", "coefficient": -1}, {"joint": "j2"}], "offset": null}],
  "ignored_pairs": [["box", "other"]],
  "cloths": [], "ropes": [], "soft_bodies": [], "gases": [], "liquids": [],
  "force_fields": [
    {"type": "wind", "velocity": [5, 0, 0], "turbulence": 0.2, "bounds": null},
    {"type": "wind", "velocity": [5, 1, 0], "turbulence": 0.1, "turbulence_length": 3, "bounds": [[-1, -2, -3], [1, 2, 3]], "layers": 6},
    {"type": "radial", "center": [1, 2, 3], "strength": -4, "radius": 2, "falloff": 1.5, "core": 0.1},
    {"type": "vortex", "center": [0, 1, 0], "axis": [0, 2, 0], "strength": 8, "radius": 1, "density": 2, "linear_drag": 0.5},
    {"type": "drag", "drag_coefficient": 0.4, "density": null},
    {"type": "buoyancy", "normal": [0, 1, 0], "offset": 0.5, "density": 1025, "velocity": [0.5, 0, 0]},
    {"type": "magnetic", "strength": 2, "axis": [0, 0, 1]},
    {"type": "magnetic_dipole", "strength": 2, "axis": [0, 0, 1], "center": [1, 2, 3], "radius": 3, "core": 0.5},
    {"type": "stokes", "strength": 0.25, "velocity": [1, 0, 0]},
    {"type": "grid", "bounds": [[0, 0, 0], [1, 1, 1]], "points": [2, 2, 3],
     "vectors": [[1, 0, 0], [2, 0, 0], [3, 0, 0], [4, 0, 0], [5, 0, 0], [6, 0, 0], [7, 0, 0], [8, 0, 0], [9, 0, 0], [0, 1, 0], [0, 2, 0], [0, 3, 0]]},
    {"type": "explosion", "start": 1.5, "center": [0, 1, 0], "pressure": 50, "reference": 2, "falloff": 1, "radius": 8, "occlusion": false, "layers": 2}]
})";

TEST(SceneWriter, WritingWhatWasReadIsStable) {
  const SceneResult<Scene> first = read_scene(kEverything);
  ASSERT_TRUE(first) << first.error().text();
  const std::string text = write_scene(*first);
  const SceneResult<Scene> second = read_scene(text);
  ASSERT_TRUE(second) << second.error().text() << "\n" << text;
  EXPECT_EQ(write_scene(*second), text);
}

// Of the same kind, with the same anchors and stiffness where the kind has them.
void expect_same_joint(const JointDef& first, const JointDef& second) {
  ASSERT_EQ(first.index(), second.index());
  std::visit(
      [&](const auto& one) {
        const auto& other = std::get<std::decay_t<decltype(one)>>(second);
        if constexpr (requires { one.anchor; }) {
          EXPECT_EQ(one.anchor, other.anchor);
        }
        if constexpr (requires { one.anchor_b; }) {
          EXPECT_EQ(one.anchor_b, other.anchor_b);
        }
        if constexpr (requires { one.stiffness; }) {
          EXPECT_EQ(one.stiffness, other.stiffness);
        }
      },
      first);
}

TEST(SceneWriter, EveryNumberKeepsItsBits) {
  const SceneResult<Scene> first = read_scene(kEverything);
  ASSERT_TRUE(first);
  const SceneResult<Scene> second = read_scene(write_scene(*first));
  ASSERT_TRUE(second);
  EXPECT_EQ(first->name, second->name);
  EXPECT_EQ(first->world.time_step, second->world.time_step);
  EXPECT_EQ(first->world.gravity, second->world.gravity);
  EXPECT_EQ(first->world.substeps, 8);
  EXPECT_EQ(second->world.solver, SolverKind::lcp);
  EXPECT_EQ(second->world.solver_options.lcp_method, LcpMethod::lemke);
  EXPECT_EQ(second->world.solver_options.friction_sides, 8);
  EXPECT_EQ(second->world.solver_options.iterations, 40);
  EXPECT_EQ(second->world.solver_options.direct_rows, 90);
  EXPECT_EQ(second->world.broad_phase, BroadPhaseKind::brute_force);
  EXPECT_FALSE(second->world.sleeping);
  EXPECT_EQ(second->world.sleep_share, 0.25f);
  EXPECT_EQ(second->bodies[2].def.sleep_speed, 0.125f);
  ASSERT_EQ(second->couplings.size(), 2u);
  EXPECT_EQ(second->couplings[0].terms[0].coefficient, 2.5f);
  EXPECT_EQ(second->couplings[0].terms[1].axis, JointAxis::linear_x) << "the axis of a slider";
  EXPECT_EQ(second->couplings[0].offset, 0.5f);
  EXPECT_FALSE(second->couplings[1].offset);
  ASSERT_EQ(second->ignored_pairs.size(), 1u);
  const FieldDef& grid = second->fields.back();
  EXPECT_EQ(grid.kind, FieldKind::grid);
  EXPECT_EQ(grid.points[2], 3);
  ASSERT_EQ(grid.vectors.size(), 12u);
  EXPECT_EQ(grid.vectors[11], (Vec3{0, 3, 0}));
  ASSERT_EQ(first->bodies.size(), second->bodies.size());
  for (std::size_t i = 0; i < first->bodies.size(); ++i) {
    const SceneBody &a = first->bodies[i], &b = second->bodies[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.def.type, b.def.type);
    EXPECT_EQ(a.def.pose, b.def.pose);
    EXPECT_EQ(a.def.linear_velocity, b.def.linear_velocity);
    EXPECT_EQ(a.def.angular_velocity, b.def.angular_velocity);
    EXPECT_EQ(a.def.mass, b.def.mass);
    EXPECT_EQ(a.def.center_of_mass, b.def.center_of_mass);
    EXPECT_EQ(a.def.inertia, b.def.inertia);
    EXPECT_EQ(a.def.locked, b.def.locked);
    EXPECT_EQ(a.filter, b.filter);
    EXPECT_EQ(a.sensor, b.sensor);
    ASSERT_EQ(a.shapes.size(), b.shapes.size());
    for (std::size_t k = 0; k < a.shapes.size(); ++k) {
      EXPECT_EQ(a.shapes[k].geometry.index(), b.shapes[k].geometry.index());
      EXPECT_EQ(a.shapes[k].local, b.shapes[k].local);
      EXPECT_EQ(a.shapes[k].material, b.shapes[k].material);
      EXPECT_EQ(a.shapes[k].density, b.shapes[k].density);
    }
    ASSERT_EQ(a.forces.size(), b.forces.size());
    for (std::size_t k = 0; k < a.forces.size(); ++k) {
      EXPECT_EQ(a.forces[k].force, b.forces[k].force);
      EXPECT_EQ(a.forces[k].torque, b.forces[k].torque);
      EXPECT_EQ(a.forces[k].at, b.forces[k].at);
      EXPECT_EQ(a.forces[k].in_body_frame, b.forces[k].in_body_frame);
      EXPECT_EQ(a.forces[k].start, b.forces[k].start);
      EXPECT_EQ(a.forces[k].end, b.forces[k].end);
    }
  }
  ASSERT_EQ(first->joints.size(), second->joints.size());
  for (std::size_t i = 0; i < first->joints.size(); ++i) {
    EXPECT_EQ(first->joints[i].a, second->joints[i].a);
    EXPECT_EQ(first->joints[i].b, second->joints[i].b);
    expect_same_joint(first->joints[i].def, second->joints[i].def);
  }
}

TEST(SceneWriter, ReadsWhatTheFormatMeans) {
  const SceneResult<Scene> scene = read_scene(kEverything);
  ASSERT_TRUE(scene);
  // One friction alone stands for both.
  EXPECT_EQ(scene->materials[1].surface.static_friction, 0.3f);
  EXPECT_EQ(scene->materials[1].surface.dynamic_friction, 0.3f);
  EXPECT_EQ(scene->materials[1].density, 1000.0f);
  const auto& field = std::get<SceneHeightField>(scene->bodies[0].shapes[2].geometry);
  EXPECT_EQ(field.columns, 3u);
  EXPECT_EQ(field.rows, 2u);
  EXPECT_TRUE(std::isnan(field.heights[2]));
  EXPECT_EQ(field.heights[5], -1.0f);
  // Intrinsic x-y-z: R = Rx(0.1) Ry(0.2) Rz(0.3).
  const Quat expected =
      from_axis_angle({1, 0, 0}, 0.1f) * from_axis_angle({0, 1, 0}, 0.2f) * from_axis_angle({0, 0, 1}, 0.3f);
  EXPECT_NEAR(std::abs(dot(scene->bodies[2].def.pose.orientation, expected)), 1.0f, 1e-6f);
  // What a joint leaves open: a slider's anchor is at b's origin, a distance joint's at a's.
  EXPECT_EQ(std::get<SliderDef>(scene->joints[2].def).anchor, scene->bodies[3].def.pose.position);
  const DistanceDef& distance = std::get<DistanceDef>(scene->joints[5].def);
  EXPECT_EQ(distance.anchor, scene->bodies[2].def.pose.position);
  EXPECT_FALSE(distance.anchor_b);
  EXPECT_EQ(scene->joints[0].b, -1);
}

TEST(SceneWriter, DefaultsAreThoseOfTheFormat) {
  const SceneResult<Scene> scene = read_scene(R"({"gyre_scene": 1, "bodies": [{"name": "b"}]})");
  ASSERT_TRUE(scene) << scene.error().text();
  EXPECT_EQ(scene->world.gravity, (Vec3{0, -9.81f, 0}));
  EXPECT_EQ(scene->world.time_step, 0.016666667);
  EXPECT_EQ(scene->world.substeps, 4);
  EXPECT_TRUE(scene->world.sleeping);
  const SceneBody& body = scene->bodies[0];
  EXPECT_EQ(body.def.type, BodyType::dynamic);
  EXPECT_EQ(body.filter, Filter{});
  EXPECT_EQ(body.def.gravity_scale, 1.0f);
  EXPECT_TRUE(body.def.can_sleep);
  EXPECT_FALSE(body.def.mass);
}

TEST(SceneWriter, MeshesCanStandInTheScene) {
  Scene scene;
  SceneMesh mesh;
  mesh.name = "m";
  mesh.file = "m.obj";
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.indices = {0, 1, 2};
  scene.meshes.push_back(mesh);
  EXPECT_NE(write_scene(scene).find("\"file\": \"m.obj\""), std::string::npos);
  const SceneResult<Scene> read = read_scene(write_scene(scene, {.inline_meshes = true}));
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->meshes[0].indices, mesh.indices);
  EXPECT_TRUE(read->meshes[0].file.empty());
}

}  // namespace
}  // namespace gyre::scene_writer_test
