// Rolling without and with slipping, on planes and meshes. Closed forms: a = g sin / (1 + k), k = I / (m R^2).
#include "laws/kit.h"

namespace gyre::laws::rolling_test {
namespace {

struct Roller {
  const char* name;
  double k;  // I / (m R^2)
  bool wheel;
};
const Roller kRollers[] = {
    {"sphere", 0.4, false}, {"cylinder", 0.5, true}, {"shell", 2.0 / 3.0, false}, {"hoop", 1.0, true}};

BodyDef roller_body(const Roller& roller, DVec3 place) {
  BodyDef def;
  def.pose.position = place;
  def.mass = 1.0f;
  const float along = float(roller.k * 0.25), across = roller.wheel ? 0.5f * along + 0.02f : along;
  def.inertia = roller.wheel ? Sym3{across, along, across, 0, 0, 0} : Sym3{along, along, along, 0, 0, 0};
  if (roller.wheel) def.pose.orientation = from_axis_angle({1, 0, 0}, 0.5f * kPi);
  return def;
}
ShapeDef roller_shape(const Roller& roller, float friction) {
  if (roller.wheel)
    return {.geometry = Cylinder{.radius = 0.5f, .half_height = 0.25f}, .material = surface(friction)};
  return {.geometry = Sphere{0.5f}, .material = surface(friction)};
}

// Speed and slip after `seconds` from rest on a slope of 20 degrees towards +x.
struct Rolled {
  double speed, slip;
};
Rolled roll_down(const Roller& roller, float friction, double seconds) {
  World world = make_world({.sleeping = false});
  const double angle = 20.0 * double(kDegree);
  const DVec3 normal{std::sin(angle), std::cos(angle), 0}, downhill{std::cos(angle), -std::sin(angle), 0};
  world.add_body({.type = BodyType::fixed},
                 {.geometry = Plane{.normal = to_float(normal)}, .material = surface(friction)});
  const BodyId body = world.add_body(roller_body(roller, 0.5 * normal), roller_shape(roller, friction));
  run(world, seconds);
  const double v = dot(wide(world.linear_velocity(body)), downhill);
  return {v, v + 0.5 * double(world.angular_velocity(body).z)};
}

TEST(RollingDown, AccelerationOfEveryShape) {
  const double expected[] = {2.39658, 2.23681, 2.01313, 1.67761};
  for (int k = 0; k < 4; ++k) {
    const double from = roll_down(kRollers[k], 0.8f, 0.5).speed, to = roll_down(kRollers[k], 0.8f, 2.5).speed;
    EXPECT_TRUE(
        relative_row(kRollers[k].name, (to - from) / (120.0 * double(kStep)), expected[k], 3e-3, 1e-4))
        << "A-80";
  }
  const double from = roll_down(kRollers[0], 0.0f, 0.5).speed, to = roll_down(kRollers[0], 0.0f, 2.5).speed;
  EXPECT_TRUE(
      relative_row("A-80 without friction", (to - from) / (120.0 * double(kStep)), 3.35522, 3e-3, 1e-4));
}

TEST(RollingDown, SlipsOnlyBelowTheThreshold) {
  const double thresholds[] = {0.10399, 0.12132, 0.14559, 0.18199};
  for (int k = 0; k < 4; ++k) {
    for (const double beside : {0.02, 0.1}) {
      const Rolled above = roll_down(kRollers[k], float(thresholds[k] * (1.0 + beside)), 2.0);
      const Rolled below = roll_down(kRollers[k], float(thresholds[k] * (1.0 - beside)), 2.0);
      EXPECT_LT(std::fabs(above.slip), 2e-3 * above.speed) << "A-81 " << kRollers[k].name << " " << beside;
      EXPECT_GT(below.slip, 0.25 * beside * below.speed) << "A-81 " << kRollers[k].name << " " << beside;
    }
  }
}

// Sliding balls end up rolling: 5/7 v0 without spin, 3/7 v0 with backspin, after 2/7 and 4/7 v0 / (mu g).
TEST(Billiards, SlidingTurnsIntoRolling) {
  for (const bool draw : {false, true}) {
    World world = make_world({.sleeping = false});
    add_ground(world, surface(0.2f));
    const BodyId ball = world.add_body({.pose = {.position = {0, 0.5, 0}},
                                        .linear_velocity = {8, 0, 0},
                                        .angular_velocity = {0, 0, draw ? 16.0f : 0.0f}},
                                       {.geometry = Sphere{0.5f}, .material = surface(0.2f)});
    double when = -1.0, last_slip = 1e9;
    for (int i = 1; i <= 300; ++i) {
      world.step(kStep);
      // Of the contact point, midway between the two surfaces.
      const double arm = 0.5 * (0.5 + world.pose(ball).position.y);
      const double slip =
          double(world.linear_velocity(ball).x) + arm * double(world.angular_velocity(ball).z);
      if (when < 0.0 && slip < 0.01) when = double(i) * double(kStep) + std::min(0.0, (slip / 6.87 / 1.0));
      last_slip = slip;
    }
    const double expected = (draw ? 4.0 : 2.0) / 7.0 * 8.0 / (0.2 * kGravity);
    EXPECT_TRUE(relative_row("A-83 time until it rolls", when, expected, 2e-2, 1e-3));
    EXPECT_TRUE(relative_row("A-83 final speed", double(world.linear_velocity(ball).x),
                             draw ? 24.0 / 7.0 : 40.0 / 7.0, 2e-2, 1e-3));
    EXPECT_NEAR(last_slip, 0.0, 1e-3);
  }
}

TEST(Billiards, ManifoldMatch) {
  World world = make_world({.sleeping = false});
  world.set_material_pair(
      {.a = 1, .b = 1, .static_friction = 0.0f, .dynamic_friction = 0.0f, .restitution = 1.0f});
  Material cloth = surface(0.2f), ivory = surface(0.2f);
  ivory.id = 1;
  add_ground(world, cloth);
  const BodyId cue = world.add_body(
      {.pose = {.position = {0, 0.5, 0}}, .linear_velocity = {3, 0, 0}, .angular_velocity = {0, 0, -6}},
      {.geometry = Sphere{0.5f}, .material = ivory});
  const BodyId object =
      world.add_body({.pose = {.position = {2.02, 0.5, 0}}}, {.geometry = Sphere{0.5f}, .material = ivory});
  run(world, 4.0);
  EXPECT_TRUE(relative_row("A-84 cue ball", double(world.linear_velocity(cue).x), 0.8571, 2e-2, 2e-3));
  EXPECT_TRUE(relative_row("A-84 object ball", double(world.linear_velocity(object).x), 2.1429, 2e-2, 2e-3));
}

Geometry flat_mesh(float cell, int cells_x, int cells_z, float x0, float z0) {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;
  for (int z = 0; z <= cells_z; ++z) {
    for (int x = 0; x <= cells_x; ++x) vertices.push_back({x0 + cell * float(x), 0, z0 + cell * float(z)});
  }
  const auto at = [&](int x, int z) { return std::uint32_t(z * (cells_x + 1) + x); };
  for (int z = 0; z < cells_z; ++z) {
    for (int x = 0; x < cells_x; ++x) {
      const std::uint32_t a = at(x, z), b = at(x + 1, z), c = at(x + 1, z + 1), d = at(x, z + 1);
      for (const std::uint32_t i : {a, c, b, a, d, c}) indices.push_back(i);
    }
  }
  return *cook_mesh({.vertices = vertices, .indices = indices});
}

TEST(Rolling, GoesOnForAMinuteOnPlaneAndMesh) {
  for (const bool mesh : {false, true}) {
    World world = make_world({.sleeping = false});
    AnyShape floor = Plane{};
    if (mesh) floor = flat_mesh(2.0f, 160, 20, -5.0f, -5.0f);
    world.add_body({.type = BodyType::fixed}, {.geometry = floor, .material = surface(0.6f)});
    const float vx = 4.9f, vz = 0.3f;
    const BodyId ball = world.add_body({.pose = {.position = {0, 0.5, 0}},
                                        .linear_velocity = {vx, 0, vz},
                                        .angular_velocity = {2.0f * vz, 0, -2.0f * vx}},
                                       {.geometry = Sphere{0.5f}, .material = surface(0.6f)});
    run(world, 60.0);
    const DVec3 p = world.pose(ball).position;
    const DVec3 v = wide(world.linear_velocity(ball));
    EXPECT_TRUE(relative_row(mesh ? "A-85 speed after 60 s on a mesh" : "A-85 speed after 60 s on a plane",
                             length(v), std::sqrt(4.9 * 4.9 + 0.09), 1e-2, 1e-4));
    EXPECT_TRUE(row("A-85 heading (rad)", std::atan2(p.z, p.x), std::atan2(0.3, 4.9), 1e-2, 1e-4));
  }
}

TEST(Rolling, ResistanceStopsASphereWhereTheEnergyIsSpent) {
  World world = make_world({.sleeping = false});
  // A resistance length of c R: torque c R N on a sphere that rolls is a force c N.
  Material material = surface(0.6f);
  material.rolling_friction = 0.02f * 0.5f;
  add_ground(world, material);
  const BodyId ball = world.add_body(
      {.pose = {.position = {0, 0.5, 0}}, .linear_velocity = {5, 0, 0}, .angular_velocity = {0, 0, -10}},
      {.geometry = Sphere{0.5f}, .material = material});
  run(world, 50.0);
  EXPECT_NEAR(double(length(world.linear_velocity(ball))), 0.0, 1e-3);
  EXPECT_TRUE(
      relative_row("A-86 distance", world.pose(ball).position.x, 0.7 * 25.0 / (0.02 * kGravity), 3e-2, 5e-3));
}

}  // namespace
}  // namespace gyre::laws::rolling_test
