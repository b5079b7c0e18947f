// Scenes of which every run must give the same bits: made with the public interface, but for joints that recordings alone know
// (add_flat_joint), and by arithmetic that IEEE 754 fixes, so that any compiler and processor builds the same ones.
//
// build() fills a world; drive() gives the commands of one step. Both find bodies by their number in bodies(), so they work
// as well on a world that was loaded half-way.
#pragma once

#include "joint_scene.h"
#include "world/command.h"
#include "world/world_access.h"

#include <gyre/gyre.h>

#include <cstdint>
#include <vector>

namespace gyre::scenes {

constexpr float kStepSeconds = 1.0f / 60.0f;
constexpr int kSteps = 300;
constexpr int kHashEvery = 50;

struct Scene {
  const char* name;
  void (*build)(World& world);
  void (*drive)(World& world, int step);  // null: nothing to do
};

// A linear congruential generator; fractions of 1/65536 are exact in float.
class Random {
 public:
  explicit Random(std::uint32_t seed) : state_(seed) {}
  float next(float low, float high) {
    state_ = state_ * 1664525u + 1013904223u;
    return low + (high - low) * (float(state_ >> 16) / 65536.0f);
  }
  Vec3 next_vector(float size) {
    const float x = next(-size, size), y = next(-size, size), z = next(-size, size);
    return {x, y, z};
  }
  Quat next_rotation() {
    const float x = next(-1, 1), y = next(-1, 1), z = next(-1, 1), w = next(0.125f, 1);
    return {x, y, z, w};
  }

 private:
  std::uint32_t state_;
};

inline BodyId body_number(const World& world, std::size_t number) { return world.bodies().ids[number]; }

inline BodyId add(World& world, BodyType type, DVec3 place, const AnyShape& geometry,
                  const Material& material = {}) {
  BodyDef body;
  body.type = type;
  body.pose.position = place;
  ShapeDef shape;
  shape.geometry = geometry;
  shape.material = material;
  return world.add_body(body, shape);
}
inline BodyId add_fixed(World& world, DVec3 place, const AnyShape& geometry) {
  return add(world, BodyType::fixed, place, geometry);
}
inline BodyId add_moving(World& world, DVec3 place, const AnyShape& geometry, const Material& material = {}) {
  return add(world, BodyType::dynamic, place, geometry, material);
}

// A solid of eleven corners, none of them symmetric to another.
inline AnyShape pebble(float size) {
  const Vec3 corners[] = {{1, 0, 0},           {-0.9f, 0.1f, 0.1f},  {0, 0.8f, 0.1f},    {0.1f, -0.9f, 0},
                          {0.1f, 0.2f, 1},     {0, -0.1f, -0.9f},    {0.6f, 0.6f, 0.4f}, {-0.6f, 0.5f, -0.5f},
                          {0.5f, -0.6f, 0.5f}, {-0.5f, -0.6f, 0.4f}, {0.5f, 0.4f, -0.6f}};
  std::vector<Vec3> scaled;
  for (const Vec3& corner : corners) scaled.push_back(size * corner);
  const Result<Geometry> hull = cook_hull(scaled);
  return hull ? AnyShape(*hull) : AnyShape(Sphere{size});
}

// The convex kinds, one after the other.
inline AnyShape convex(int number, float size) {
  switch (number % 7) {
    case 0:
      return Sphere{size};
    case 1:
      return Box{{size, 0.75f * size, 1.25f * size}};
    case 2:
      return Capsule{0.5f * size, 0.75f * size};
    case 3:
      return Cylinder{0.75f * size, 0.75f * size};
    case 4:
      return Cone{0.875f * size, size};
    case 5:
      return pebble(size);
    default:
      return Box{{size, size, 0.5f * size}, 0.125f * size};
  }
}

// ---------------------------------------------------------------------------------------------------------- the scenes

inline void build_stacks(World& world) {
  add_fixed(world, {0, -0.5, 0}, Box{{20, 0.5f, 20}});
  for (int i = 0; i < 8; ++i) add_moving(world, {-4, 0.5 + i, 0}, Box{});
  constexpr int kBase = 6;
  for (int row = 0; row < kBase; ++row) {
    for (int i = 0; i < kBase - row; ++i)
      add_moving(world, {1.0 + 1.0625 * i + 0.53125 * row, 0.5 + row, 0}, Box{});
  }
  // Comes in from the side and strikes the pyramid when it has settled.
  const BodyId ball = add_moving(world, {-16, 0.5, 0}, Sphere{0.5f}, {.rolling_friction = 0.001f});
  world.set_velocity(ball, {4.5f, 0, 0.25f}, {0, 0, -9});
}

inline void build_pile(World& world) {
  add_fixed(world, {}, Plane{});
  for (const double side : {-1.0, 1.0}) {
    add_fixed(world, {3.25 * side, 1.5, 0}, Box{{0.25f, 1.5f, 3.5f}});
    add_fixed(world, {0, 1.5, 3.25 * side}, Box{{3, 1.5f, 0.25f}});
  }
  Random random(1);
  for (int i = 0; i < 56; ++i) {
    BodyDef body;
    body.pose.position = {-1.875 + 1.25 * (i % 4), 1.0 + 1.125 * (i / 16), -1.875 + 1.25 * (i / 4 % 4)};
    body.pose.position = body.pose.position + random.next_vector(0.0625f);
    body.pose.orientation = random.next_rotation();
    body.angular_velocity = random.next_vector(2);
    ShapeDef shape;
    shape.geometry = convex(i, 0.4375f);
    shape.material.restitution = i % 3 == 0 ? 0.5f : 0.0f;
    shape.material.rolling_friction = i % 5 == 0 ? 0.01f : 0.0f;
    world.add_body(body, shape);
  }
}

// A joint as recordings hold it: with an axis also where the kind has none now, which is part of the state whose hashes are stored.
inline JointId add_flat_joint(World& world, const FlatJoint& joint) {
  return submit(state_of(world), AddJoint{joint}).joint;
}

inline JointId join(World& world, JointKind kind, BodyId a, BodyId b, DVec3 anchor, Vec3 axis = {0, 0, 1}) {
  FlatJoint joint;
  joint.kind = kind;
  joint.a = a;
  joint.b = b;
  joint.anchor = anchor;
  joint.axis = axis;
  return add_flat_joint(world, joint);
}

inline void add_doll(World& world, DVec3 place) {
  const BodyId torso = add_moving(world, place, Box{{0.1875f, 0.3125f, 0.125f}});
  const BodyId head = add_moving(world, place + DVec3{0, 0.5, 0}, Sphere{0.15625f});
  join(world, JointKind::ball, torso, head, place + DVec3{0, 0.34375, 0});
  for (const double side : {-1.0, 1.0}) {
    HingeDef limb;
    limb.axis = {0, 0, 1};
    limb.limits = Limits{-1.5f, 0.75f};
    const BodyId upper =
        add_moving(world, place + DVec3{0.375 * side, 0.25, 0}, Box{{0.15625f, 0.0625f, 0.0625f}});
    limb.a = torso, limb.b = upper, limb.anchor = place + DVec3{0.21875 * side, 0.25, 0};
    world.add_joint(limb);
    const BodyId leg = add_moving(world, place + DVec3{0.125 * side, -0.5625, 0}, Capsule{0.0625f, 0.15625f});
    limb.a = torso, limb.b = leg, limb.anchor = place + DVec3{0.125 * side, -0.34375, 0};
    limb.axis = {1, 0, 0};
    world.add_joint(limb);
  }
}

inline void build_joints(World& world) {
  add_fixed(world, {}, Plane{});
  BodyId previous;
  for (int i = 0; i < 10; ++i) {
    const BodyId link = add_moving(world, {-6 + 0.5 * i, 6, 0}, Capsule{0.125f, 0.125f});
    join(world, i % 3 == 2 ? JointKind::hinge : JointKind::ball, previous, link, {-6.25 + 0.5 * i, 6, 0});
    previous = link;
  }
  add_doll(world, {0, 2, 1});
  add_doll(world, {0.25, 4, 1.125});
  SliderDef slider;
  slider.b = add_moving(world, {4, 1, 0}, Box{{0.25f, 0.25f, 0.5f}});
  slider.anchor = {4, 1, 0};
  slider.axis = {0, 1, 0};
  slider.limits = Limits{-0.25f, 2};
  slider.motor = {.target_velocity = 1, .max_force = 4000};
  world.add_joint(slider);
  DistanceDef spring;
  spring.b = add_moving(world, {6, 3, 0}, Sphere{0.25f});
  spring.anchor = {6, 5, 0};
  spring.stiffness = 500.0f;
  spring.damping = 2.0f;
  world.add_joint(spring);
  DistanceDef rope = spring;
  rope.b = add_moving(world, {8, 4, 0}, Box{{0.25f, 0.25f, 0.25f}});
  rope.anchor = {8, 5, 0};
  rope.stiffness.reset(), rope.damping.reset();
  rope.max_length = 2.0f;
  world.add_joint(rope);
  FixedDef weak;
  weak.a = add_moving(world, {10, 3, 0}, Box{{0.5f, 0.125f, 0.125f}});
  weak.b = add_moving(world, {11, 3, 0}, Box{{0.5f, 0.125f, 0.125f}});
  weak.anchor = {10.5, 3, 0};
  weak.break_force = 2000.0f;
  world.add_joint(weak);
  join(world, JointKind::hinge, {}, weak.a, {9.5, 3, 0});
}

inline float hill(int column, int row) {
  const int x = column * 7 % 5, z = row * 5 % 7;
  return 0.1875f * float(x * z % 6) - 0.03125f * float(x + z);
}

inline void build_terrain(World& world) {
  constexpr std::uint32_t kSamples = 17;
  std::vector<float> heights;
  for (std::uint32_t row = 0; row < kSamples; ++row) {
    for (std::uint32_t column = 0; column < kSamples; ++column)
      heights.push_back(hill(int(column), int(row)));
  }
  heights[5 * kSamples + 6] = __builtin_nanf("");
  const Result<Geometry> field = cook_height_field({heights, kSamples, kSamples, 0.75f});
  if (field) add_fixed(world, {}, *field);
  // The same kind of ground once more as a mesh, beside it, and a net below for what falls through the hole.
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;
  for (int row = 0; row < 9; ++row) {
    for (int column = 0; column < 9; ++column)
      vertices.push_back({0.75f * float(column), hill(row, column), 0.75f * float(row)});
  }
  for (std::uint32_t row = 0; row < 8; ++row) {
    for (std::uint32_t column = 0; column < 8; ++column) {
      const std::uint32_t at = 9 * row + column;
      for (const std::uint32_t corner : {at, at + 9, at + 1, at + 1, at + 9, at + 10})
        indices.push_back(corner);
    }
  }
  const Result<Geometry> mesh = cook_mesh({vertices, indices, false});
  if (mesh) add_fixed(world, {6.5, 0, -3}, *mesh);
  add_fixed(world, {0, -4, 0}, Plane{});
  Random random(2);
  for (int i = 0; i < 42; ++i) {
    BodyDef body;
    body.pose.position = {-4.5 + 2.25 * (i % 7), 2.5 + 0.5 * (i % 3) + 1.25 * (i / 14),
                          -2.0 + 2.0 * (i / 7 % 3)};
    body.pose.orientation = random.next_rotation();
    body.linear_velocity = random.next_vector(1);
    ShapeDef shape;
    shape.geometry = convex(i, 0.34375f);
    world.add_body(body, shape);
  }
}

inline void build_cloud(World& world) {
  world.set_gravity({});
  Random random(3);
  for (int i = 0; i < 48; ++i) {
    BodyDef body;
    const DVec3 place{-2.25 + 1.5 * (i % 4), -2.25 + 1.5 * (i / 4 % 4), -1.5 + 1.5 * (i / 16)};
    body.pose.position = place + random.next_vector(0.125f);
    body.pose.orientation = random.next_rotation();
    // Towards the middle.
    body.linear_velocity = Vec3{float(-place.x), float(-place.y), float(-place.z)} + random.next_vector(0.5f);
    body.angular_velocity = random.next_vector(8);
    body.can_sleep = false;
    ShapeDef shape;
    shape.geometry = convex(i, 0.40625f);
    shape.material.restitution = 0.875f;
    shape.material.static_friction = shape.material.dynamic_friction = 0.25f;
    world.add_body(body, shape);
  }
}

inline void build_pusher(World& world) {
  add_fixed(world, {}, Plane{});
  BodyDef ramp;
  ramp.type = BodyType::fixed;
  ramp.pose = {{-6, 1, 0}, {0, 0, -0.1875f, 1}};
  ShapeDef slope;
  slope.geometry = Box{{4, 0.25f, 3}};
  world.add_body(ramp, slope);
  // Body 2: the pusher.
  BodyDef pusher;
  pusher.type = BodyType::kinematic;
  pusher.pose.position = {12, 0.5, 0};
  ShapeDef blade;
  blade.geometry = Box{{0.25f, 0.5f, 4}};
  world.add_body(pusher, blade);
  for (int i = 0; i < 6; ++i) {
    const Material slippery{.static_friction = 0.0625f * float(i), .dynamic_friction = 0.0625f * float(i)};
    add_moving(world, {-8.5, 2.75, -2.5 + i}, Box{{0.25f, 0.25f, 0.25f}}, slippery);
  }
  for (int i = 0; i < 4; ++i) {
    AnyShape round = Sphere{0.25f};
    if (i % 2 != 0) round = Cylinder{0.25f, 0.25f};
    add_moving(world, {-7, 2.5, -2.25 + 1.5 * i}, round, {.rolling_friction = 0.002f});
  }
  for (int i = 0; i < 15; ++i)
    add_moving(world, {5.0 + 1.0625 * (i % 3), 0.5 + i / 6, -2.5 + 1.25 * (i / 3 % 2)}, Box{});
  add_moving(world, {7, 0.5, 3}, Sphere{0.5f}, {.rolling_friction = 0.01f, .spinning_friction = 0.01f});
}

// The pusher waits until all is asleep, goes in, and comes back.
inline void drive_pusher(World& world, int step) {
  const BodyId pusher = body_number(world, 2);
  if (step >= 120 && step < 200)
    world.move_kinematic(pusher, {{12 - 0.0625 * (step - 119), 0.5, 0}, {}}, kStepSeconds);
  if (step == 200) world.set_velocity(pusher, {3, 0, 0}, {});
  if (step == 240) world.set_velocity(pusher, {}, {});
}

inline void build_changes(World& world) {
  add_fixed(world, {0, -0.5, 0}, Box{{10, 0.5f, 10}});
  BodyDef gate;
  gate.type = BodyType::fixed;
  gate.pose.position = {0, 1, 0};
  ShapeDef sensor;
  sensor.geometry = Box{{2, 0.5f, 2}};
  sensor.sensor = true;
  world.add_body(gate, sensor);
  world.set_material_pair(
      {.a = 1, .b = 2, .static_friction = 0.25f, .dynamic_friction = 0.125f, .restitution = 0.25f});
}

// No body stays kinematic for long: one that joints pull one way and the floor another has nowhere to go.
inline void make_dynamic(World& world) {
  for (std::size_t i = 0; i < world.bodies().ids.size(); ++i) {
    const BodyId body = body_number(world, i);
    if (world.type(body) == BodyType::kinematic) world.set_type(body, BodyType::dynamic);
  }
}

// Bodies come and go, and every kind of change is made to some of them.
inline void drive_changes(World& world, int step) {
  if (step % 4 == 0) {
    BodyDef body;
    body.pose.position = {-3.0 + 0.75 * (step / 4 % 9), 4, -2.0 + 0.5 * (step / 4 % 7)};
    body.pose.orientation = {0.25f, 0.125f * float(step % 5), -0.375f, 1};
    body.user_data = std::uint64_t(step);
    std::vector<ShapeDef> shapes(std::size_t(1 + step / 4 % 2));
    shapes[0].geometry = convex(step / 4, 0.375f);
    shapes[0].material.id = std::uint16_t(step / 4 % 3);
    if (shapes.size() > 1) shapes[1].local.position = {0.5f, 0.25f, 0};
    if (shapes.size() > 1) shapes[1].geometry = Sphere{0.25f};
    world.add_body(body, shapes);
  }
  const std::size_t count = world.bodies().ids.size();
  if (count < 8) return;
  const std::size_t number = 2 + std::size_t(step * 7) % (count - 2);
  const BodyId one = body_number(world, number);
  switch (step % 23) {
    case 1:
      world.remove_body(count > 24 ? one : BodyId{});
      break;
    case 3:
      world.set_pose(one, {{0, 5, 0.25 * (step % 8)}, {0, 0.5f, 0, 1}});
      break;
    case 5:
      world.add_impulse(one, {200, 300, -100});
      break;
    case 7:
      world.set_type(one, BodyType::kinematic), world.set_velocity(one, {0.25f, 0, 0}, {0, 0.5f, 0});
      break;
    case 14:
      make_dynamic(world);
      break;
    case 9:
      world.add_shape(one, {.geometry = Box{{0.125f, 0.5f, 0.125f}}, .density = 500});
      break;
    case 11:
      world.set_filter(world.shapes(one)[0], {.layer = 2, .collides_with = 1, .group = 0});
      break;
    case 12:
      world.set_awake(one, false);
      break;
    case 13:
      join(world, JointKind::ball, {}, one, world.center_of_mass(one) + DVec3{0, 0.5, 0});
      break;
    case 15:
      world.set_material(world.shapes(one)[0],
                         {.static_friction = 0.125f, .dynamic_friction = 0.125f, .id = 2});
      break;
    case 16:
      world.add_force_at(one, {0, 5000, 0}, world.center_of_mass(one) + DVec3{0.25, 0, 0});
      break;
    case 17:
      world.set_damping(one, 0.5f, 0.25f);
      break;
    case 18:
      world.set_gravity_scale(one, 0.5f);
      break;
    case 19:
      world.set_substeps(2 + step % 4);
      break;
    case 20:
      world.set_gravity({0.25f, -9.81f, 0});
      break;
    case 21:
      world.add_torque(one, {0, 400, 50});
      break;
    default:
      break;
  }
}

inline FieldDef pool(float level) {
  FieldDef def;
  def.kind = FieldKind::buoyancy;
  def.bounds = FieldBounds{{-6, -8, -6}, {6, 8, 6}};
  def.linear_drag = 0.5f;
  def.velocity = {0.25f, 0, 0.125f};
  def.offset = level;
  return def;
}

// Every kind of field at once: a pool with a whirl over it, gusts across both, a pull to one side.
inline void build_fields(World& world) {
  add_fixed(world, {0, -3, 0}, Box{{8, 0.5f, 8}});
  world.add_field(pool(0.0f));
  FieldDef whirl;
  whirl.kind = FieldKind::vortex;
  whirl.center = {0.5, 0, -0.25};
  whirl.strength = 6;
  whirl.radius = 3;
  whirl.velocity = {0, 1.5f, 0};
  world.add_field(whirl);
  FieldDef gusts;
  gusts.velocity = {4, 0, 1};
  gusts.turbulence = 0.5f;
  gusts.turbulence_length = 4;
  world.add_field(gusts);
  FieldDef geometric_stiffness;
  geometric_stiffness.kind = FieldKind::radial;
  geometric_stiffness.center = {7, 1, 0};
  geometric_stiffness.strength = 2;
  geometric_stiffness.radius = 4;
  geometric_stiffness.falloff = 1.5f;
  geometric_stiffness.core = 0.5f;
  world.add_field(geometric_stiffness);
  Random random(8);
  for (int i = 0; i < 40; ++i) {
    BodyDef body;
    body.pose.position = {-3.0 + 1.5 * (i % 5), 0.5 + 1.25 * (i / 20), -2.0 + 1.25 * (i / 5 % 4)};
    body.pose.orientation = random.next_rotation();
    body.locked.angular[1] = i % 11 == 3;
    ShapeDef shape;
    shape.geometry = convex(i, 0.375f);
    shape.density = 0.5f * float(1 << (i % 13));  // from 0.5 to 2,048: from foam to stone
    world.add_body(body, shape);
  }
}

inline void drive_fields(World& world, int step) {
  FieldId ids[4];
  world.fields(ids);
  if (step % 60 == 20) world.set_field(ids[0], pool(step % 120 == 20 ? 0.5f : 0.0f));
  if (step == 150) world.remove_field(ids[1]);
  if (step == 200) world.add_field({});
  if (step % 75 == 50) {
    ExplosionDef blow;
    blow.center = {-1, -1, 0.5};
    blow.pressure = 200;
    world.explode(blow);
  }
}

// The other solvers, by some of the scenes above.
inline void build_pile_sequential(World& world) {
  build_pile(world);
  world.set_solver(SolverKind::sequential_impulses);
}
inline void build_joint_kinds_sequential(World& world) {
  build_joint_kinds(world);
  world.set_solver(SolverKind::sequential_impulses, {.friction_sides = 6, .iterations = 5});
}
inline void build_stacks_lcp(World& world) {
  build_stacks(world);
  world.set_solver(SolverKind::lcp);
}
inline void build_joint_kinds_lcp(World& world) {
  build_joint_kinds(world);
  world.set_solver(SolverKind::lcp, {.friction_sides = 4, .direct_rows = 60});
}
inline void build_changes_lcp(World& world) {
  build_changes(world);
  world.set_solver(SolverKind::lcp, {.iterations = 20, .direct_rows = 24});
}

// A rope that carries a ball, a cloth over a ball, a jelly on which a box lands.
inline void build_soft(World& world) {
  add_fixed(world, {0, 0, 0}, Plane{});
  add_fixed(world, {0, 0.5, 0}, Sphere{0.4f});
  world.add_cloth({.grid = ClothGrid{{1.0f, 1.0f}, {10, 10}}, .pose = {{0.03, 1.0, 0.02}, {}}});
  const BodyId load = add(world, BodyType::dynamic, {2.0, 1.0, 0}, Sphere{0.15f});
  const SoftId rope = world.add_rope({.points = {{1.0, 2.0, 0}, {2.0, 1.0, 0}}, .segments = 16});
  world.pin(rope, 0);
  world.attach(rope, 16, load);
  world.add_solid({.box = SolidBox{{0.3f, 0.2f, 0.3f}, {3, 2, 3}}, .pose = {{-1.5, 0.25, 0}, {}}});
  add(world, BodyType::dynamic, {-1.4, 0.9, 0.05}, Box{{0.1f, 0.1f, 0.1f}});
}

// Warm smoke round a turning paddle, with a cloth in it; a column of water that falls on two floats.
inline void build_fluids(World& world) {
  add_fixed(world, {0, 0, 0}, Plane{});
  GasDef gas;
  gas.lower = {-1, 0, -1}, gas.upper = {1, 2, 1};
  gas.cells = {14, 14, 14};
  gas.viscosity = 0.001f, gas.vorticity = 0.25f;
  gas.emitters = {{.position = {0.125, 0.25, 0}, .radius = 0.25f, .temperature = 400.0f}};
  world.add_gas(gas);
  const BodyId paddle = add(world, BodyType::kinematic, {-0.25, 1, 0.125}, Box{{0.4f, 0.25f, 0.08f}});
  world.set_velocity(paddle, {}, {0, 3, 0});
  world.add_cloth({.grid = ClothGrid{{0.5f, 0.5f}, {5, 5}}, .pose = {{0.25, 1.5, 0}, {}}});
  add(world, BodyType::dynamic, {3.75, 0.125, 0.25}, Box{{0.1f, 0.1f, 0.1f}});
  add(world, BodyType::dynamic, {3.5, 0.5, 0.25}, Sphere{0.1f});
  LiquidDef water;
  water.lower = {3, 0, 0}, water.upper = {4, 0.75, 0.5};
  water.cell_size = 0.0625f;
  water.viscosity = 0.5f, water.surface_tension = 0.0625f;
  water.fill = {{{3, 0, 0}, {3.375, 0.5, 0.5}}};
  world.add_liquid(water);
}

inline constexpr Scene kScenes[] = {
    {"stacks", build_stacks, nullptr},
    {"pile", build_pile, nullptr},
    {"joints", build_joints, nullptr},
    {"terrain", build_terrain, nullptr},
    {"cloud", build_cloud, nullptr},
    {"pusher", build_pusher, drive_pusher},
    {"changes", build_changes, drive_changes},
    {"fields", build_fields, drive_fields},
    {"joint_kinds", build_joint_kinds, nullptr},
    {"pile_sequential", build_pile_sequential, nullptr},
    {"joint_kinds_sequential", build_joint_kinds_sequential, nullptr},
    {"stacks_lcp", build_stacks_lcp, nullptr},
    {"joint_kinds_lcp", build_joint_kinds_lcp, nullptr},
    {"changes_lcp", build_changes_lcp, drive_changes},
    {"soft", build_soft, nullptr},
    {"fluids", build_fluids, nullptr},
};

// One step of a scene; `step` counts from 0.
inline void step_scene(const Scene& scene, World& world, int step) {
  if (scene.drive != nullptr) scene.drive(world, step);
  world.step(kStepSeconds);
}

}  // namespace gyre::scenes
