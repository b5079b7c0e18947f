// A scene as plain data: what a scene file says, checked and with names resolved, before any world exists. scene_reader makes
// one from JSON, scene_writer makes JSON from one, scene_runner makes a world from one.
//
// Materials, meshes and bodies are referred to by their index in the scene.
#pragma once

#include <gyre/coupling.h>
#include <gyre/decomposition.h>
#include <gyre/defs.h>
#include <gyre/fields.h>
#include <gyre/fluid.h>
#include <gyre/joints.h>
#include <gyre/soft.h>

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace gyre {

struct SceneWorld {
  Vec3 gravity{0, -9.81f, 0};
  double time_step = 0.016666667;  // s
  int substeps = 4;
  IntegratorKind integrator = IntegratorKind::semi_implicit_euler;
  SolverKind solver = SolverKind::soft_step;
  SolverOptions solver_options{};
  BroadPhaseKind broad_phase = BroadPhaseKind::bvh;
  SpringKind springs = SpringKind::implicit;
  TimeStepping stepping = TimeStepping::fixed;
  float tolerance = 1.0e-5f;  // m; of steps that are not fixed
  int max_impacts = 128;      // times of impact in a step; adaptive
  bool sleeping = true;
  float sleep_share = WorldDef{}.sleep_share;
};

// What of it a world takes as its Stepping, and back.
inline Stepping stepping_of(const SceneWorld& world) {
  return {.substeps = world.substeps,
          .integrator = world.integrator,
          .solver = world.solver,
          .broad_phase = world.broad_phase,
          .springs = world.springs,
          .time = world.stepping,
          .tolerance = world.tolerance,
          .max_impacts = world.max_impacts,
          .solver_options = world.solver_options};
}
inline void set_stepping(SceneWorld& world, const Stepping& stepping) {
  world.substeps = stepping.substeps;
  world.integrator = stepping.integrator;
  world.solver = stepping.solver;
  world.broad_phase = stepping.broad_phase;
  world.springs = stepping.springs;
  world.stepping = stepping.time;
  world.tolerance = stepping.tolerance;
  world.max_impacts = stepping.max_impacts;
  world.solver_options = stepping.solver_options;
}

// How something looks in pictures: sRGB, 0 to 255 each.
struct SceneColor {
  std::uint8_t red = 0, green = 0, blue = 0;

  constexpr bool operator==(const SceneColor&) const = default;
};

// Where a good picture of the scene is taken from.
struct SceneView {
  DVec3 eye, target;
  float field_of_view = 0.7f;  // rad, from bottom to top of the picture
};

struct SceneMaterial {
  std::string name;
  float density = 1000.0f;  // kg/m^3
  std::optional<SceneColor> color;
  Material surface;  // `id` stays 0: it is given when a world is made
  // As in SurfaceRule, in the frame of the body: a belt's speed (m/s), and the direction in which a one-way surface lets pass.
  Vec3 surface_velocity, one_way;
};

// What is not given follows from the two materials by the world's combine rules.
struct SceneMaterialPair {
  int a = 0, b = 0;
  std::optional<float> static_friction, dynamic_friction, restitution;
};

struct SceneMesh {
  std::string name;
  std::string file;  // relative to the scene's folder; empty: the mesh stands in the scene itself
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;  // three a triangle
};

struct SceneHull {
  std::vector<Vec3> points;
  int mesh = -1;  // the hull of this mesh's vertices instead
};
struct SceneTriangles {
  int mesh = 0;
};
struct SceneHeightField {
  std::uint32_t columns = 2, rows = 2;
  float spacing = 1.0f;
  std::vector<float> heights;  // NaN: a hole
};
// A concave mesh as convex hulls. As read it stands for all of them; split_decompositions() puts one shape for each hull in
// its place, so that what comes after sees as many shapes as the world has.
struct SceneDecomposition {
  int mesh = 0;
  int max_hulls = 32;
  float concavity = 0.02f;
  int max_hull_vertices = 128;
  SurfaceMeaning meaning = SurfaceMeaning::automatic;
  float shell_thickness = 0.0f;

  Geometry hull;               // none before it is split
  int part = 0;                // which of the hulls
  float density_scale = 1.0f;  // so that all hulls together weigh what the solid does
};
using SceneGeometry = std::variant<Sphere, Box, Capsule, Cylinder, Cone, Plane, SceneHull, SceneTriangles,
                                   SceneHeightField, SceneDecomposition>;

struct SceneShape {
  SceneGeometry geometry = Sphere{};
  Transform local;
  int material = -1;  // none: the default material
  std::optional<SceneColor> color;
  // Given in place; each wins over the material's.
  std::optional<float> density, static_friction, dynamic_friction, restitution, rolling_friction,
      spinning_friction;
};

// Acts in every step that begins in [start, end).
struct SceneForce {
  Vec3 force;                  // N
  Vec3 torque;                 // N m
  std::optional<DVec3> at;     // none: the centre of mass
  bool in_body_frame = false;  // force, torque and `at` are in the body's frame and turn with it
  double start = 0.0;          // s
  double end = 1.0e9;          // s
};

struct SceneBody {
  std::string name;
  BodyDef def;
  Filter filter;  // of all its shapes
  bool sensor = false;
  std::optional<SceneColor> color;
  std::vector<SceneShape> shapes;
  std::vector<SceneForce> forces;
};

struct SceneJoint {
  std::string name;    // may be empty
  JointDef def;        // `a` and `b` stay null
  int a = -1, b = -1;  // bodies; -1 is the world
};

// An axis of a joint in a coupling.
struct SceneCouplingTerm {
  int joint = 0;
  JointAxis axis = JointAxis::angular_x;
  float coefficient = 1.0f;
};
struct SceneCoupling {
  std::vector<SceneCouplingTerm> terms;
  std::optional<float> offset;
};

// A vertex that keeps its place in the frame of a body, or in the world.
struct SceneHold {
  int vertex = 0;
  int body = -1;  // -1 is the world

  bool operator==(const SceneHold&) const = default;
};

// A point between vertices, held likewise: the one that is nearest to `place` at the start.
struct SceneHeldPoint {
  DVec3 place{};  // m, in the world
  int body = -1;  // -1 is the world

  bool operator==(const SceneHeldPoint&) const = default;
};

// Data that ropes, cloths and soft bodies have in common beside their definitions.
struct SceneSoft {
  std::string name;
  std::optional<SceneColor> color;
  std::vector<SceneHold> holds;        // each vertex at most once
  std::vector<SceneHeldPoint> points;  // none of a rope
};
struct SceneRope : SceneSoft {
  RopeDef def;
};
struct SceneCloth : SceneSoft {
  ClothDef def;   // vertices and triangles stay empty
  int mesh = -1;  // none: the grid of the definition
};
struct SceneSoftBody : SceneSoft {
  SolidDef def;         // the surface stays empty
  int mesh = -1;        // the closed surface that is filled with tetrahedra; none: the box or tetrahedra of the definition
  int resolution = 16;  // of a mesh: cells along the longest side of its box
  std::optional<FieldBounds> pinned_region;  // vertices in this box of the world at the start stay where they are
};

// A point at which a fluid is read in every traced step.
struct SceneProbe {
  std::string name;  // unique within the fluid
  DVec3 position;    // m, in the world
};
// Data that gases and liquids have in common beside their definitions.
struct SceneFluid {
  std::string name;
  std::optional<SceneColor> color;
  std::vector<SceneProbe> probes;
};
struct SceneGas : SceneFluid {
  GasDef def;
};
struct SceneLiquid : SceneFluid {
  LiquidDef def;
};

// Goes off in the first step that begins at `start` or later.
struct SceneExplosion {
  ExplosionDef def;
  double start = 0.0;  // s
};

struct Scene {
  std::string name;
  SceneWorld world;
  std::optional<SceneView> view;
  std::vector<SceneMaterial> materials;
  std::vector<SceneMaterialPair> material_pairs;
  std::vector<SceneMesh> meshes;
  std::vector<SceneBody> bodies;
  std::vector<SceneJoint> joints;
  std::vector<SceneCoupling> couplings;
  std::vector<std::pair<int, int>> ignored_pairs;  // bodies
  std::vector<SceneRope> ropes;
  std::vector<SceneCloth> cloths;
  std::vector<SceneSoftBody> soft_bodies;
  std::vector<SceneGas> gases;
  std::vector<SceneLiquid> liquids;
  std::vector<FieldDef> fields;
  std::vector<SceneExplosion> explosions;
  std::vector<std::string> notes;  // what whoever runs it should know; never written
};

}  // namespace gyre
