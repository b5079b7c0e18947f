// Bodies that pass each other closely, and bodies that strike each other off their centres: drawn shapes, sizes, speeds and times
// within a step.
// Source: a body that touches nothing moves on (Newton's first law); two frictionless balls exchange the velocities along the line of their
// centres at the moment of impact, which conserves momentum, its moment and energy.
#include "laws/kit.h"
#include "random.h"

namespace gyre::laws::passing_test {
namespace {

using testing_random::Random;

struct Drawn {
  AnyShape shape;
  double reach = 0.0;  // m, in the drawn direction
};

double dot_of(Vec3 a, Vec3 b) {
  return double(a.x) * double(b.x) + double(a.y) * double(b.y) + double(a.z) * double(b.z);
}

constexpr int kKinds = 6, kMesh = 6, kField = 7, kOthers = 8;

// A rough peak, as a mesh or a height field; upright.
Drawn draw_surface(Random& random, int kind, float size) {
  constexpr std::uint32_t kSide = 7;
  std::vector<float> heights;
  double reach = -1.0e9;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    const float x = float(i % kSide) - 3.0f, z = float(i / kSide) - 3.0f;
    heights.push_back(size * (random.real(-0.3f, 0.3f) - 0.12f * (x * x + z * z)));
    reach = std::max(reach, double(heights.back()));
  }
  const float spacing = 0.3f * size;
  if (kind == kField)
    return {*cook_height_field({.heights = heights, .columns = kSide, .rows = kSide, .spacing = spacing}),
            reach};
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i)
    vertices.push_back(
        {spacing * (float(i % kSide) - 3.0f), heights[i], spacing * (float(i / kSide) - 3.0f)});
  for (std::uint32_t z = 0; z + 1 < kSide; ++z) {
    for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
      const std::uint32_t a = z * kSide + x, b = a + 1, c = a + kSide, d = c + 1;
      indices.insert(indices.end(), {a, c, b, b, c, d});
    }
  }
  return {*cook_mesh({.vertices = vertices, .indices = indices}), reach};
}

// A shape of about a size; its reach along a direction of its own frame.
Drawn draw_shape(Random& random, int kind, float size, Vec3 d) {
  const auto length = [&] { return size * random.real(0.6f, 1.0f); };
  const double across = std::sqrt(std::max(0.0, 1.0 - double(d.y) * double(d.y)));
  if (kind == 0) {
    const float radius = length();
    return {Sphere{radius}, double(radius)};
  }
  if (kind == 1 || kind == 2) {
    const Vec3 half{length(), length(), length()};
    const float rounding = kind == 2 ? 0.2f * size : 0.0f;
    const Vec3 core = half - Vec3{rounding, rounding, rounding};
    return {Box{half, rounding}, dot_of(core, absolute(d)) + double(rounding)};
  }
  if (kind == 3) {
    const float radius = 0.5f * length(), half = length();
    return {Capsule{radius, half}, double(half) * std::fabs(double(d.y)) + double(radius)};
  }
  if (kind == 4) {
    const float radius = length(), half = length();
    return {Cylinder{radius, half}, double(half) * std::fabs(double(d.y)) + double(radius) * across};
  }
  if (kind == kMesh || kind == kField) return draw_surface(random, kind, size);
  std::vector<Vec3> points;
  double reach = 0.0;
  for (int i = 0; i < 14; ++i) {
    points.push_back(size * normalized(random.vector(-1, 1)));
    reach = std::max(reach, dot_of(points.back(), d));
  }
  return {*cook_hull(points), reach};
}
// The largest change of a body's velocity, as a share of its speed, that passes over another with air between them.
double pass(Random& random, int kind, int other_kind, BodyType other_type) {
  const float size = 0.01f * std::pow(1000.0f, random.real(0, 1)), speed = size * random.real(1.0f, 60.0f);
  const Vec3 up{0, 1, 0};
  const Quat turn = from_rotation_vector(random.vector(-3, 3)),
             other_turn = other_kind < kKinds ? from_rotation_vector(random.vector(-3, 3)) : Quat{};
  const Drawn body = draw_shape(random, kind, size, rotate_inverse(turn, -up));
  const Drawn other = draw_shape(random, other_kind, size, rotate_inverse(other_turn, up));
  const double air = double(size) * double(random.real(0.02f, 0.1f));
  World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
  const float fast = std::min(speed, 30.0f);
  const double start = -3.0 * double(size) - double(fast * kStep) * double(random.real(0, 1));
  world.add_body({.type = other_type, .pose = {{0, -other.reach, 0}, other_turn}}, {.geometry = other.shape});
  const BodyId mover =
      world.add_body({.pose = {{start, body.reach + air, double(size) * double(random.real(-1, 1))}, turn},
                      .linear_velocity = {fast, 0, 0}},
                     {.geometry = body.shape});
  double most = 0.0;
  while (world.pose(mover).position.x < 3.0 * double(size)) {
    if (!world.step(kStep)) return 1.0e9;
    const Vec3 change = world.linear_velocity(mover) - Vec3{fast, 0, 0};
    most =
        std::max(most, double(length(change) + size * length(world.angular_velocity(mover))) / double(fast));
    if (most > 0.5) break;
  }
  return most;
}

TEST(NearMiss, NothingIsDeflectedThatNeverTouches) {
  Random random;
  double worst = 0.0;
  for (int kind = 0; kind < kKinds; ++kind) {
    for (int other = 0; other < kOthers; ++other) {
      double most = 0.0;
      int deflected = 0;
      for (int i = 0; i < 16; ++i) {
        const double change =
            pass(random, kind, other, i % 2 == 0 || other >= kKinds ? BodyType::fixed : BodyType::dynamic);
        most = std::max(most, change);
        deflected += change > 1e-3 ? 1 : 0;
      }
      if (deflected > 0)
        say("kinds %d over %d: %d of 16 deflected, worst %g\n", kind, other, deflected, most);
      worst = std::max(worst, most);
    }
  }
  EXPECT_TRUE(limit_row("deflection of bodies that never touch", worst, 1e-3, 1e-5));
}

// Two equal balls; one rests. `offset`: of the line of flight from the centre of the other, in diameters.
struct Shot {
  double direction = 0.0, momentum = 0.0, moment = 0.0, energy = 0.0;  // errors: radians, and shares
};
Shot shoot(float radius, float speed, double offset, double phase) {
  World world = make_world({.gravity = {0, 0, 0}, .sleeping = false});
  const Material smooth = surface(0.0f, 1.0f);
  const double step = double(speed * kStep), diameter = 2.0 * double(radius);
  const DVec3 start{-2.0 * diameter - phase * step, offset * diameter, 0};
  const BodyId a = world.add_body({.pose = {start, {}}, .linear_velocity = {speed, 0, 0}, .mass = 1.0f},
                                  {.geometry = Sphere{radius}, .material = smooth});
  const BodyId b = world.add_body({.mass = 1.0f}, {.geometry = Sphere{radius}, .material = smooth});
  run(world, double(4.0f * 2.0f * radius / speed + 3 * kStep));
  const DVec3 va(world.linear_velocity(a)), vb(world.linear_velocity(b));
  const DVec3 xa = world.pose(a).position, xb = world.pose(b).position;
  const double along = std::sqrt(1.0 - offset * offset);
  Shot shot;
  shot.direction = std::fabs(std::atan2(vb.y, vb.x) - std::atan2(-offset, along));
  shot.momentum = length(va + vb - DVec3{double(speed), 0, 0}) / double(speed);
  const double moment = -offset * diameter * double(speed);
  shot.moment = std::fabs((cross(xa, va) + cross(xb, vb)).z - moment) / (diameter * double(speed));
  shot.energy = (dot(va, va) + dot(vb, vb)) / square(double(speed)) - 1.0;
  return shot;
}

TEST(CutShot, LeavesAlongTheLineOfCentres) {
  Random random;
  Shot worst;
  for (int i = 0; i < 200; ++i) {
    const float radius = 0.01f * std::pow(100.0f, random.real(0, 1));
    const float speed = std::min(radius * random.real(0.3f, 0.9f) / kStep, 30.0f);
    const Shot shot = shoot(radius, speed, double(random.real(-0.9f, 0.9f)), double(random.real(0, 1)));
    worst.direction = std::max(worst.direction, shot.direction);
    worst.momentum = std::max(worst.momentum, shot.momentum);
    worst.moment = std::max(worst.moment, shot.moment);
    worst.energy = std::max(worst.energy, std::fabs(shot.energy));
  }
  EXPECT_TRUE(limit_row("cut shot: direction (degrees)", worst.direction / double(kDegree), 1.0, 0.1));
  EXPECT_TRUE(limit_row("cut shot: momentum", worst.momentum, 1e-6, 1e-7));
  EXPECT_TRUE(limit_row("cut shot: angular momentum", worst.moment, 1e-3, 1e-5));
  EXPECT_TRUE(limit_row("cut shot: energy", worst.energy, 1e-4, 1e-6));
}

// Balls that approach by up to eight radii a step.
TEST(CutShot, OfFastBallsLeavesAlongTheLineOfCentres) {
  Random random;
  double worst = 0.0;
  for (int i = 0; i < 100; ++i) {
    const float radius = 0.01f * std::pow(100.0f, random.real(0, 1));
    const Shot shot = shoot(radius, radius * random.real(1.0f, 8.0f) / kStep, double(random.real(-0.9f, 0.9f)), double(random.real(0, 1)));
    worst = std::max(worst, shot.direction);
  }
  EXPECT_TRUE(limit_row("fast cut shot: direction (degrees)", worst / double(kDegree), 1.0, 0.15));
}

}  // namespace
}  // namespace gyre::laws::passing_test
