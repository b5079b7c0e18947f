// Coulomb friction on planes: thresholds, accelerations, stopping distances, directions, spinning boxes.
// Source: Coulomb's law; the torque of a uniformly pressed square is the integral of the distance from its centre.
#include "laws/kit.h"

namespace gyre::laws::friction_test {
namespace {

const float kFrictions[] = {0.1f, 0.25f, 0.5f, 0.8f, 1.0f};

struct Incline {
  World world;
  BodyId box;
  DVec3 start;
  DVec3 downhill;
  double travelled() const { return dot(world.pose(box).position - start, downhill); }
};
// A box on a plane that falls towards +x.
Incline on_incline(double degrees, const Material& material, Vec3 half = {0.5f, 0.25f, 0.5f}) {
  const double angle = degrees * kPiDouble / 180.0;
  const DVec3 normal{std::sin(angle), std::cos(angle), 0};
  Incline s{make_world({.sleeping = false}), {}, {}, {std::cos(angle), -std::sin(angle), 0}};
  s.world.add_body({.type = BodyType::fixed},
                   {.geometry = Plane{.normal = to_float(normal)}, .material = material});
  s.start = double(half.y) * normal;
  s.box = s.world.add_body(
      {.pose = {.position = s.start, .orientation = from_axis_angle({0, 0, 1}, float(-angle))}},
      {.geometry = Box{half}, .material = material});
  return s;
}
double slide_angle(double friction) { return std::atan(friction) / double(kDegree); }

TEST(Incline, HoldsBelowTheAngleOfFrictionAndSlidesAbove) {
  for (const float friction : kFrictions) {
    for (const double beside : {0.1, 0.5}) {
      Incline below = on_incline(slide_angle(double(friction)) - beside, surface(friction));
      Incline above = on_incline(slide_angle(double(friction)) + beside, surface(friction));
      run(below.world, 5.0);
      run(above.world, 5.0);
      const double exact =
          0.5 * 25.0 * kGravity *
          (std::sin(std::atan(double(friction)) + beside * double(kDegree)) -
           double(friction) * std::cos(std::atan(double(friction)) + beside * double(kDegree)));
      EXPECT_TRUE(
          limit_row("A-60 creep in 5 s below the threshold (m)", std::fabs(below.travelled()), 1e-3, 1e-6));
      EXPECT_GT(above.travelled(), 0.5 * exact) << friction << " " << beside;
    }
  }
}

TEST(Incline, SlidesAsFastAsItShould) {
  const double accelerations[] = {0.85926, 0.88131, 0.95592, 1.09493, 1.20915};
  for (int k = 0; k < 5; ++k) {
    const float friction = kFrictions[k];
    // A slab, whose friction does not lift its back edge.
    Incline s = on_incline(slide_angle(double(friction)) + 5.0, surface(friction), {0.5f, 0.1f, 0.5f});
    run(s.world, 1.0);
    const double before = dot(wide(s.world.linear_velocity(s.box)), s.downhill);
    run(s.world, 2.0);
    const double after = dot(wide(s.world.linear_velocity(s.box)), s.downhill);
    EXPECT_TRUE(relative_row("A-61 acceleration 5 degrees above", 0.5 * (after - before), accelerations[k],
                             5e-3, 1e-4));
  }
}

TEST(Incline, StaticFrictionAboveDynamic) {
  const Material material{.static_friction = 0.6f, .dynamic_friction = 0.4f};
  Incline below = on_incline(30.964 - 1.0, material), near = on_incline(30.964 - 0.2, material);
  Incline above = on_incline(30.964 + 1.0, material, {0.5f, 0.125f, 0.5f});
  run(below.world, 5.0);
  run(near.world, 5.0);
  EXPECT_TRUE(limit_row("A-65 creep 1 degree below (m)", std::fabs(below.travelled()), 1e-3, 1e-6));
  EXPECT_TRUE(limit_row("A-65 creep 0.2 degrees below (m)", std::fabs(near.travelled()), 1e-3, 1e-6));
  run(above.world, 1.0);
  const double before = dot(wide(above.world.linear_velocity(above.box)), above.downhill);
  run(above.world, 1.0);
  const double after = dot(wide(above.world.linear_velocity(above.box)), above.downhill);
  const double angle = 31.964 * double(kDegree);
  EXPECT_TRUE(relative_row("A-65 acceleration once it slides", after - before,
                           kGravity * (std::sin(angle) - 0.4 * std::cos(angle)), 1e-2, 1e-3));
}

TEST(Incline, TallBoxTipsWhereItsDiagonalIsUpright) {
  for (const double beside : {0.1, 0.5}) {
    Incline below = on_incline(26.565 - beside, surface(1.5f), {0.25f, 0.5f, 0.25f});
    Incline above = on_incline(26.565 + beside, surface(1.5f), {0.25f, 0.5f, 0.25f});
    const Quat start = below.world.pose(below.box).orientation;
    run(below.world, 10.0);
    run(above.world, 10.0);
    EXPECT_GT(std::fabs(dot(below.world.pose(below.box).orientation, start)), 0.999f)
        << "A-72 tips too early by " << beside;
    EXPECT_LT(std::fabs(dot(above.world.pose(above.box).orientation, start)), 0.95f)
        << "A-72 stands too long by " << beside;
  }
}

// A thin slab: its friction does not press its front edge noticeably.
DVec3 stopping_place(double direction, float friction, float speed, double* yaw) {
  World world = make_world({.sleeping = false});
  add_ground(world, surface(friction));
  const BodyId box = world.add_body(
      {.pose = {.position = {0, 0.1, 0}},
       .linear_velocity = {speed * float(std::cos(direction)), 0, speed * float(std::sin(direction))}},
      {.geometry = Box{{0.5f, 0.1f, 0.5f}}, .material = surface(friction)});
  run(world, 6.0);
  const DVec3 x = turned(world.pose(box).orientation, {1, 0, 0});
  if (yaw != nullptr) *yaw = std::fabs(std::atan2(x.z, x.x));
  return world.pose(box).position;
}

TEST(Sliding, StoppingDistance) {
  const double distances[] = {6.37105, 2.54842, 1.59276};
  const float frictions[] = {0.2f, 0.5f, 0.8f};
  for (int k = 0; k < 3; ++k) {
    const DVec3 end = stopping_place(0.0, frictions[k], 5.0f, nullptr);
    EXPECT_TRUE(relative_row("A-63 stopping distance", end.x, distances[k], 1e-2, 5e-4));
  }
}

TEST(Sliding, IsTheSameInEveryDirection) {
  const double first = stopping_place(0.0, 0.5f, 5.0f, nullptr).x;
  for (int k = 0; k < 16; ++k) {
    const double direction = 2.0 * kPiDouble * k / 16.0;
    double yaw = 0.0;
    const DVec3 end = stopping_place(direction, 0.5f, 5.0f, &yaw);
    EXPECT_TRUE(relative_row("A-64 distance in 16 directions", std::sqrt(end.x * end.x + end.z * end.z),
                             first, 1e-3, 1e-4));
    EXPECT_TRUE(row("A-64 sideways (m)", -std::sin(direction) * end.x + std::cos(direction) * end.z, 0.0,
                    2.5e-3, 2.5e-4));
    EXPECT_TRUE(limit_row("A-64 yaw (rad)", yaw, 1e-3, 1e-4));
  }
}

double sliding_ratio(CombineRule rule, bool pair) {
  World world = make_world({.sleeping = false, .friction_rule = rule});
  Material ground = surface(0.9f), top = surface(0.8f);
  ground.id = 1, top.id = 2;
  add_ground(world, ground);
  if (pair) world.set_material_pair({.a = 2, .b = 1, .static_friction = 0.3f, .dynamic_friction = 0.3f});
  world.add_body({.pose = {.position = {0, 0.1, 0}}, .linear_velocity = {20, 0, 0}},
                 {.geometry = Box{{0.5f, 0.1f, 0.5f}}, .material = top});
  run(world, 0.5);
  ContactPoint points[16];
  const std::size_t n = world.contacts(points);
  double normal = 0.0;
  DVec3 friction;
  for (std::size_t i = 0; i < n && i < 16; ++i) {
    normal += double(points[i].normal_impulse);
    friction += points[i].friction_impulse;
  }
  return length(friction) / normal;
}

TEST(Friction, CombinesByEveryRule) {
  EXPECT_TRUE(relative_row("A-66 geometric mean", sliding_ratio(CombineRule::geometric_mean, false),
                           std::sqrt(0.72), 1e-4, 1e-6));
  EXPECT_TRUE(relative_row("A-66 average", sliding_ratio(CombineRule::average, false), 0.85, 1e-4, 1e-6));
  EXPECT_TRUE(relative_row("A-66 minimum", sliding_ratio(CombineRule::minimum, false), 0.8, 1e-4, 1e-6));
  EXPECT_TRUE(relative_row("A-66 maximum", sliding_ratio(CombineRule::maximum, false), 0.9, 1e-4, 1e-6));
  EXPECT_TRUE(relative_row("A-66 product", sliding_ratio(CombineRule::product, false), 0.72, 1e-4, 1e-6));
  EXPECT_TRUE(relative_row("A-66 a pair's own", sliding_ratio(CombineRule::product, true), 0.3, 1e-4, 1e-6));
}

TEST(Friction, SpinningBoxIsBrakedLikeAUniformlyPressedPatch) {
  World world = make_world({.sleeping = false});
  add_ground(world, surface(0.245f));
  const BodyId box = world.add_body({.pose = {.position = {0, 1, 0}}, .angular_velocity = {0, 10, 0}},
                                    {.geometry = Box{{1, 1, 1}}, .material = surface(0.245f)});
  run(world, 1.0);
  // Mean distance from the centre of a square of side 2: 0.765196 m; k^2 = 2/3 m^2.
  const double patch = 10.0 - 0.245 * kGravity * 0.765196 / (2.0 / 3.0) * (60.0 * double(kStep));
  const double corners = 10.0 - 0.245 * kGravity * std::sqrt(2.0) / (2.0 / 3.0) * (60.0 * double(kStep));
  say("[row] A-69 four corners would give %g\n", corners);
  EXPECT_TRUE(row("A-69 spin after 1 s (rad/s)", double(world.angular_velocity(box).y), patch, 5e-3, 5e-3));
}

TEST(Friction, DoesNotHeat) {
  World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
  const Material lively = surface(0.5f, 1.0f);
  for (int side = 0; side < 6; ++side) {
    const float s = side % 2 == 0 ? 1.0f : -1.0f;
    const Vec3 n{side / 2 == 0 ? s : 0, side / 2 == 1 ? s : 0, side / 2 == 2 ? s : 0};
    world.add_body({.type = BodyType::fixed},
                   {.geometry = Plane{.normal = n, .offset = -5.0f}, .material = lively});
  }
  for (int i = 0; i < 64; ++i) {
    const DVec3 p{double(i % 4) * 2 - 3, double(i / 4 % 4) * 2 - 3, double(i / 16) * 2 - 3};
    const Vec3 v{float((i * 37) % 11) - 5, float((i * 53) % 13) - 6, float((i * 71) % 9) - 4};
    world.add_body({.pose = {.position = p}, .linear_velocity = v},
                   {.geometry = Sphere{0.4f}, .material = lively});
  }
  double before = world.energy().kinetic, gain = 0.0;
  const double start = before;
  for (int i = 0; i < 600; ++i) {
    world.step(kStep);
    const double now = world.energy().kinetic;
    gain = std::max(gain, (now - before) / start);
    before = now;
  }
  EXPECT_TRUE(limit_row("A-70 energy gained in a step", gain, 1e-4, 0.0));
}

}  // namespace
}  // namespace gyre::laws::friction_test
