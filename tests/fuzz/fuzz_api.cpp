// Any calls in any order with any arguments: nothing crashes, what can be read is finite, and a recording of it all plays
// back to the same bits with other threads and another width.
#include "../determinism/scenes.h"
#include "../memory_sink.h"
#include "edits.h"

#include <gyre/debug.h>

#include <cstdio>
#include <cstdlib>

namespace {

using namespace gyre;
using fuzz::Input;

float number(Input& in) {
  const std::uint8_t kind = in.byte();
  switch (kind % 16) {
    case 0:
      return 0.0f;
    case 1:
      return -0.0f;
    case 2:
      return __builtin_inff();
    case 3:
      return -__builtin_inff();
    case 4:
      return __builtin_nanf("");
    case 5:
      return 3.0e38f;
    case 6:
      return -1.0e-38f;
    case 7:
      return 1.0e-9f;
    case 8:
      return __builtin_bit_cast(float, in.word());
    case 9:
      return -1.0f;
    case 10:
      return 1.0e6f;
    default:
      return float(in.byte()) * (1.0f / 64.0f) - (kind & 16 ? 2.0f : 0.0f);
  }
}
Vec3 vector(Input& in) {
  const float x = number(in), y = number(in), z = number(in);
  return {x, y, z};
}
Quat rotation(Input& in) {
  if (in.byte() % 2 == 0) return {};
  const Vec3 v = vector(in);
  return {v.x, v.y, v.z, number(in)};
}
Pose pose(Input& in) {
  const Vec3 place = vector(in);
  return {DVec3(place), rotation(in)};
}
bool flag(Input& in) { return in.byte() % 2 != 0; }

AnyShape shape(Input& in) {
  const std::uint8_t kind = in.byte();
  switch (kind % 8) {
    case 0:
      return Sphere{number(in)};
    case 1:
      return Box{vector(in), number(in)};
    case 2:
      return Capsule{number(in), number(in)};
    case 3:
      return Plane{vector(in), number(in)};
    case 4:
      return Geometry{};
    case 5: {
      std::vector<Vec3> points;
      for (int i = 0; i < 4 + kind / 16; ++i) points.push_back(vector(in));
      const Result<Geometry> hull = cook_hull(points);
      return hull ? AnyShape(*hull) : AnyShape(Cone{number(in), number(in)});
    }
    case 6: {
      const Vec3 corners[] = {vector(in), vector(in), vector(in), vector(in)};
      const std::uint32_t indices[] = {0, 1, 2, 2, 1, 3};
      const Result<Geometry> mesh = cook_mesh({corners, indices, flag(in)});
      return mesh ? AnyShape(*mesh) : AnyShape(Cylinder{number(in), number(in)});
    }
    default:
      return scenes::convex(kind / 8, 0.5f);
  }
}

Material material(Input& in) {
  Material m;
  m.static_friction = number(in), m.dynamic_friction = number(in), m.restitution = number(in);
  if (flag(in)) m.rolling_friction = number(in), m.spinning_friction = number(in);
  m.id = in.byte() % 4;
  return m;
}
ShapeDef shape_def(Input& in) {
  ShapeDef def;
  def.geometry = shape(in);
  if (flag(in)) def.local = {vector(in), rotation(in)};
  if (flag(in)) def.density = number(in);
  if (flag(in)) def.material = material(in);
  def.sensor = in.byte() % 8 == 0;
  return def;
}
BodyDef body_def(Input& in) {
  BodyDef def;
  def.type = BodyType(in.byte() % 16 == 0 ? 0 : in.byte() % 8 == 0 ? 1 : 2);
  def.pose = pose(in);
  if (flag(in)) def.linear_velocity = vector(in), def.angular_velocity = vector(in);
  if (in.byte() % 4 == 0) def.linear_damping = number(in), def.gravity_scale = number(in);
  if (in.byte() % 4 == 0) def.mass = number(in);
  if (in.byte() % 8 == 0) def.center_of_mass = vector(in);
  if (in.byte() % 8 == 0) def.inertia = Sym3{number(in), number(in), number(in), 0, 0, 0};
  if (in.byte() % 4 == 0) def.locked.angular[in.byte() % 3] = def.locked.linear[in.byte() % 3] = true;
  def.continuous = flag(in);
  return def;
}

// Ids that were given out, some of them stale by now, and some that never were.
struct Ids {
  std::vector<BodyId> bodies;
  std::vector<ShapeId> shapes;
  std::vector<JointId> joints;

  template <class Id>
  static Id pick(const std::vector<Id>& list, Input& in) {
    if (list.empty() || in.byte() % 16 == 0)
      return {in.word() % 64, std::uint16_t(in.byte()), std::uint16_t(in.byte())};
    return list[in.byte() % list.size()];
  }
};

void add_joint(World& world, Ids& ids, Input& in) {
  FlatJoint def;
  def.kind = JointKind(in.byte() % 6);
  if (flag(in)) def.a = Ids::pick(ids.bodies, in);
  def.b = Ids::pick(ids.bodies, in);
  def.anchor = DVec3(vector(in)), def.axis = vector(in);
  if (flag(in)) def.limits = Limits{number(in), number(in)};
  if (flag(in)) def.motor = {number(in), number(in), number(in), number(in), number(in)};
  if (flag(in)) def.stiffness = number(in);
  if (flag(in)) def.max_length = number(in);
  if (flag(in)) def.break_force = number(in);
  ids.joints.push_back(scenes::add_flat_joint(world, def));
}

FieldDef field_def(Input& in) {
  FieldDef def;
  def.kind = FieldKind(in.byte() % 6);
  if (flag(in)) def.bounds = FieldBounds{DVec3(vector(in)), DVec3(vector(in))};
  if (flag(in)) def.layers = in.word();
  def.velocity = vector(in);
  if (flag(in)) def.density = number(in);
  def.drag_coefficient = number(in);
  def.linear_drag = number(in);
  def.turbulence = number(in);
  def.turbulence_length = number(in);
  def.center = DVec3(vector(in));
  def.strength = number(in);
  def.radius = number(in);
  def.falloff = number(in);
  def.core = number(in);
  if (flag(in)) def.axis = vector(in);
  if (flag(in)) def.normal = vector(in);
  def.offset = double(number(in));
  return def;
}
FieldId any_field(const World& world, Input& in) {
  FieldId ids[8];
  const std::size_t count = world.fields(ids);
  return count == 0 ? FieldId{} : ids[in.byte() % (count < 8 ? count : 8)];
}

void call(World& world, Ids& ids, Input& in) {
  constexpr std::size_t kMaxBodies = 24;
  const BodyId body = Ids::pick(ids.bodies, in);
  switch (in.byte() % 28) {
    case 0:
    case 1:
      if (world.bodies().ids.size() < kMaxBodies)
        ids.bodies.push_back(world.add_body(body_def(in), shape_def(in)));
      break;
    case 2:
      world.remove_body(body);
      break;
    case 3:
      ids.shapes.push_back(world.add_shape(body, shape_def(in)));
      break;
    case 4:
      world.remove_shape(Ids::pick(ids.shapes, in));
      break;
    case 5:
      add_joint(world, ids, in);
      break;
    case 6:
      world.remove_joint(Ids::pick(ids.joints, in));
      break;
    case 7:
      world.set_pose(body, pose(in));
      break;
    case 8:
      world.set_velocity(body, vector(in), vector(in));
      break;
    case 9:
      world.move_kinematic(body, pose(in), number(in));
      break;
    case 10:
      world.set_type(body, BodyType(in.byte() % 4));
      break;
    case 11:
      world.set_gravity(vector(in));
      break;
    case 12:
      world.set_material(Ids::pick(ids.shapes, in), material(in));
      break;
    case 13:
      world.set_material_pair(
          {std::uint16_t(in.byte() % 4), std::uint16_t(in.byte() % 4), number(in), number(in), number(in)});
      break;
    case 14:
      world.set_filter(Ids::pick(ids.shapes, in), {in.word(), in.word(), std::int32_t(in.byte()) - 128});
      break;
    case 15:
      world.set_motor(Ids::pick(ids.joints, in),
                      {number(in), number(in), number(in), number(in), number(in)});
      break;
    case 16:
      world.set_awake(body, flag(in));
      break;
    case 17:
      world.set_substeps(int(in.byte() % 8) - 1);
      break;
    case 18:
      world.add_force_at(body, vector(in), DVec3(vector(in)));
      break;
    case 19:
      world.add_impulse_at(body, vector(in), DVec3(vector(in)));
      break;
    case 20:
      world.set_damping(body, number(in), number(in));
      break;
    case 21:
      world.set_gravity_scale(body, number(in));
      break;
    case 22:
      world.set_sleeping(flag(in));
      break;
    case 23:
      if (world.fields({}) < 6) world.add_field(field_def(in));
      break;
    case 24:
      world.set_field(any_field(world, in), field_def(in));
      break;
    case 25:
      world.remove_field(any_field(world, in));
      break;
    case 26:
      world.explode({DVec3(vector(in)), number(in), number(in), number(in), number(in), flag(in), in.word()});
      break;
    default:
      world.step(number(in));
      break;
  }
}

void check_world(const World& world) {
  const Error fault = validate(world);
  if (fault) {
    std::fprintf(stderr, "%s\n", fault.message);
    std::abort();
  }
  const BodyColumns bodies = world.bodies();
  for (std::size_t i = 0; i < bodies.ids.size(); ++i) {
    if (!is_finite(bodies.poses[i].position) || !is_finite(bodies.poses[i].orientation)) std::abort();
    if (!is_finite(bodies.linear_velocities[i]) || !is_finite(bodies.angular_velocities[i])) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr int kMaxCalls = 200, kMostSteps = 40;
  Input in(data, size);
  MemorySink sink;
  World world = *World::create();
  std::uint64_t steps = 0;
  {
    Recorder recorder(world, sink);
    Ids ids;
    for (int i = 0; i < kMaxCalls && !in.empty() && world.step_count() < kMostSteps; ++i) {
      call(world, ids, in);
      check_world(world);
      if (i % 4 == 3) world.step(scenes::kStepSeconds);
    }
    world.step(scenes::kStepSeconds);
    check_world(world);
    steps = world.step_count();
  }
  WorldDef other;
  other.threads = 2;
  other.simd_width = 1;
  other.stepping.broad_phase = BroadPhaseKind(steps % kBroadPhaseKindCount);
  Result<Replay> replay = Replay::open(std::move(sink.bytes), other);
  if (!replay || replay->truncated() || replay->step_count() != steps) std::abort();
  bool matches = true;
  while (replay->step(&matches)) {
    if (!matches) std::abort();
  }
  return 0;
}
