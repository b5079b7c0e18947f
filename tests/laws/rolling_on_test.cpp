// Balls on what turns or curves, and many balls at once.
// Sources: E. Routh, "Dynamics of a System of Rigid Bodies", part II (sphere on a turning plane); SimBenchmark ("666").
#include "laws/kit.h"

namespace gyre::laws::rolling_on_test {
namespace {

// The rate at which the velocity of a solid ball turns on a table that turns at `spin`, over three orbits.
double orbit_rate(double spin, float step) {
  World world = make_world({.sleeping = false});
  world.add_body({.type = BodyType::kinematic,
                  .pose = {.position = {0, -0.5, 0}},
                  .angular_velocity = {0, float(spin), 0}},
                 {.geometry = Cylinder{10.0f, 0.5f}, .material = surface(0.8f)});
  const double radius = 0.1;
  const DVec3 place{1.5, radius, 0}, v{0, 0, -0.3}, table = cross(DVec3{0, spin, 0}, place);
  BodyDef def{.pose = {.position = place}};
  def.linear_velocity = to_float(v);
  def.angular_velocity = to_float(1.0 / radius * cross(DVec3{0, 1, 0}, v - table));
  const BodyId ball = world.add_body(def, {.geometry = Sphere{float(radius)}, .material = surface(0.8f)});
  Unwrapped angle;
  const double seconds = 3.0 * 2.0 * kPiDouble / (2.0 / 7.0 * spin);
  const int steps = int(seconds / double(step));
  for (int i = 0; i <= steps; ++i) {
    const Vec3 u = world.linear_velocity(ball);
    angle.add(std::atan2(-double(u.z), double(u.x)));
    if (i < steps) world.step(step);
  }
  return angle.turned() / (steps * double(step));
}
TEST(Turntable, BallOrbitsAtTwoSevenths) {
  for (const double spin : {1.0, 3.0, 6.0}) {
    EXPECT_TRUE(relative_row("A-87 rate over that of the table", orbit_rate(spin, kStep) / spin, 2.0 / 7.0,
                             2e-2, 2e-3));
  }
}

// A trough of many strips along z: circle of radius 1 about (0, 1, z).
Geometry trough(int strips, double half_angle) {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;
  for (int i = 0; i <= strips; ++i) {
    const double a = half_angle * (2.0 * i / strips - 1.0);
    for (const float z : {-0.5f, 0.5f}) vertices.push_back({float(std::sin(a)), float(1.0 - std::cos(a)), z});
  }
  for (int i = 0; i < strips; ++i) {
    const std::uint32_t a = std::uint32_t(2 * i), b = a + 1, c = a + 2, d = a + 3;
    for (const std::uint32_t k : {a, b, c, c, b, d}) indices.push_back(k);
  }
  return *cook_mesh({.vertices = vertices, .indices = indices});
}
TEST(Bowl, BallSwingsAsItRolls) {
  World world = make_world({.sleeping = false});
  world.add_body({.type = BodyType::fixed}, {.geometry = trough(401, 0.5), .material = surface(0.8f)});
  const double swing = 0.15, way = 0.9;
  const BodyId ball =
      world.add_body({.pose = {.position = {way * std::sin(swing), 1.0 - way * std::cos(swing), 0}}},
                     {.geometry = Sphere{0.1f}, .material = surface(0.8f)});
  ZeroCrossings through;
  for (int i = 0; i < 900; ++i) {
    through.add(double(i) * double(kStep), world.pose(ball).position.x);
    world.step(kStep);
  }
  ASSERT_GT(through.count(), 4);
  // A pendulum's at this swing. It loses a little where it comes from one strip of the trough to the next.
  const double expected = 2.2518 * (1.0 + swing * swing / 16.0);
  EXPECT_TRUE(relative_row("A-88 period (s)", through.mean_period(), expected, 1e-2, 5e-4));
}

// 216 balls in a block, shaken by a millimetre, that fall 1 mm or 1 m.
struct Balls {
  double mean_overlap = 0.0;  // over all contacts and steps, in radii
  double last_overlap = 0.0;  // the deepest at the end
  double energy_change = 0.0;
};
Balls drop_balls(double height, float bounce, double seconds) {
  World world = make_world({.sleeping = false});
  const Material material = surface(bounce > 0.0f ? 0.0f : 0.5f, bounce);
  add_ground(world, material);
  std::uint32_t random = 7;
  const auto shake = [&] {
    random = random * 1664525u + 1013904223u;
    return 1e-3 * (double(random >> 8) / double(1u << 24) - 0.5);
  };
  for (int i = 0; i < 216; ++i) {
    const DVec3 place{0.21 * (i % 6) + shake(), height + 0.21 * (i / 36) + std::fabs(shake()),
                      0.21 * (i / 6 % 6) + shake()};
    world.add_body({.pose = {.position = place}}, {.geometry = Sphere{0.1f}, .material = material});
  }
  const auto energy = [&] { return world.energy().kinetic + world.energy().potential; };
  const double start = energy();
  Balls seen;
  std::vector<ContactPoint> room(4000);
  const int steps = int(seconds / double(kStep));
  for (int i = 0; i < steps; ++i) {
    world.step(kStep);
    const auto points = std::span(room).first(world.contacts(room));
    double sum = 0.0, deepest = 0.0;
    for (const ContactPoint& point : points) {
      sum += std::max(0.0, -double(point.separation));
      deepest = std::max(deepest, -double(point.separation));
    }
    if (!points.empty()) seen.mean_overlap += sum / double(points.size()) / 0.1 / steps;
    seen.last_overlap = deepest / 0.1;
    seen.energy_change = std::max(seen.energy_change, std::fabs(energy() / start - 1.0));
  }
  return seen;
}
TEST(SixSixSix, BallsHardlyOverlap) {
  const Balls heap = drop_balls(0.101, 0.0f, 6.0);
  EXPECT_TRUE(limit_row("A-102 mean overlap (radii)", heap.mean_overlap, 1e-2, 1e-3));
  EXPECT_TRUE(limit_row("A-102 deepest overlap at rest (radii)", heap.last_overlap, 1e-2, 1e-3));
}
TEST(SixSixSix, ElasticBallsKeepTheirEnergy) {
  EXPECT_TRUE(limit_row("A-102 change of energy", drop_balls(1.101, 1.0f, 6.0).energy_change, 5e-2, 5e-3));
}

}  // namespace
}  // namespace gyre::laws::rolling_on_test
