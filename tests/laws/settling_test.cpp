// Heaps come to rest: planks, cylinders, cones and what bounces do not tremble for ever.
#include "laws/kit.h"

namespace gyre::laws::settling_test {
namespace {

AnyShape plank_hull() {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({i & 1 ? 0.1f : -0.1f, i & 2 ? 0.015f : -0.015f, i & 4 ? 0.5f : -0.5f});
  return *cook_hull(corners);
}

struct Heap {
  const char* name;
  std::vector<AnyShape> shapes;
  float restitution = 0.0f;
  float rolling_friction = 0.0f;
  int falls = 9;
};

// Seconds until all of 32 bodies in a pit of 2 m sleep, from when the last of them has fallen in; 28 if they do not.
double settle(const Heap& heap, int variant, double* overlap) {
  World world = make_world();
  Material material = surface(0.6f, heap.restitution);
  material.rolling_friction = material.spinning_friction = heap.rolling_friction;
  add_ground(world, material);
  for (int k = 0; k < 4; ++k) {
    const double side = k % 2 == 0 ? 1.5 : -1.5;
    const DVec3 place = k / 2 == 0 ? DVec3{side, 0, 0} : DVec3{0, 0, side};
    const Vec3 half = k / 2 == 0 ? Vec3{0.5f, 40, 2} : Vec3{2, 40, 0.5f};
    world.add_body({.type = BodyType::fixed, .pose = {.position = place}},
                   {.geometry = Box{half}, .material = material});
  }
  for (int i = 0; i < 32; ++i) {
    BodyDef def;
    const int n = i + variant;
    def.pose.position = {0.4 * ((n * 37 % 11) / 5.0 - 1.0), 0.8 + 0.6 * i, 0.4 * ((n * 53 % 13) / 6.0 - 1.0)};
    def.pose.orientation =
        from_rotation_vector({0.4f * float(n % 7), 0.5f * float(n % 5), 0.7f * float(n % 3)});
    world.add_body(def, {.geometry = heap.shapes[std::size_t(i) % heap.shapes.size()], .material = material});
  }
  int steps = 0;
  while (steps < 1800 && world.stats().awake_bodies > 0) {
    world.step(kStep);
    ++steps;
  }
  *overlap = double(world.max_penetration());
  const double fall = std::sqrt(2.0 * (0.8 + 0.6 * 31.0) / kGravity);
  return steps / 60.0 - fall;
}

// What rolls, or spins on a point, is braked by nothing but rolling and spinning friction: such heaps have some, a fortieth
// of a radius and less. Overlap: a fifth of what the planks are thick at half. How long a heap takes is chance to a part, so
// each falls nine times, and the middle one counts. Of heaps of coins a third takes longer than ten seconds: the middle one of
// nine would exceed them one time in seven, of 27 one time in 28.
TEST(Heap, OfAnythingSleepsWithinTenSeconds) {
  const AnyShape plank = Box{{0.1f, 0.015f, 0.5f}}, hull = plank_hull(), cylinder = Cylinder{0.2f, 0.3f};
  const AnyShape coin = Cylinder{0.2f, 0.02f}, cone = Cone{0.2f, 0.2f}, box = Box{{0.2f, 0.2f, 0.2f}};
  const AnyShape capsule = Capsule{0.1f, 0.2f}, ball = Sphere{0.2f};
  const Heap heaps[] = {
      {"planks", {plank}},
      {"planks as hulls", {hull}},
      {"planks, e = 0.5", {plank}, 0.5f},
      {"cylinders", {cylinder}, 0.0f, 5e-3f},
      {"coins", {coin}, 0.0f, 5e-3f, 27},
      {"boxes, e = 0.8", {box}, 0.8f},
      {"balls, e = 0.5", {ball}, 0.5f, 5e-3f},
      {"capsules", {capsule}, 0.0f, 5e-3f},
      {"all kinds", {plank, cylinder, cone, box, hull, capsule, ball, coin}, 0.0f, 5e-3f},
      {"all kinds, e = 0.4", {plank, cylinder, cone, box, hull, capsule, ball, coin}, 0.4f, 5e-3f}};
  for (const Heap& heap : heaps) {
    const std::size_t falls = std::size_t(heap.falls);
    std::vector<double> times(falls), overlaps(falls);
    for (int variant = 0; variant < heap.falls; ++variant) {
      times[std::size_t(variant)] = settle(heap, variant, &overlaps[std::size_t(variant)]);
    }
    std::sort(times.begin(), times.end());
    std::sort(overlaps.begin(), overlaps.end());
    const double time = times[falls / 2], overlap = overlaps[falls / 2];
    say("[row] B-31 %s\n", heap.name);
    EXPECT_TRUE(limit_row("B-31 time until all sleep (s)", time, 10.0, 6.0)) << heap.name;
    EXPECT_TRUE(limit_row("B-31 deepest overlap then (m)", overlap, 3e-3, 1e-3)) << heap.name;
  }
}

// Two planks that cross, all but parallel: of their edges now one pair and then another is nearest, and each time a single point
// bore the weight.
TEST(Planks, ThatCrossLieStill) {
  for (const bool as_hull : {false, true}) {
    World world = make_world({.sleeping = false});
    add_ground(world);
    const AnyShape shape = as_hull ? plank_hull() : AnyShape(Box{{0.1f, 0.015f, 0.5f}});
    world.add_body({.pose = {.position = {0, 0.015, 0}}}, {.geometry = shape});
    // One end on the floor, the other on the plank.
    const Quat turn = from_axis_angle({0, 1, 0}, 2.15f) * from_axis_angle({1, 0, 0}, 0.03f);
    const BodyId top = world.add_body({.pose = {.position = {0.085, 0.05, 0.246}, .orientation = turn}},
                                      {.geometry = shape});
    run(world, 3.0);
    double fastest = 0.0;
    for (int i = 0; i < 120; ++i) {
      world.step(kStep);
      fastest = std::max(
          fastest, double(length(world.linear_velocity(top)) + 0.5f * length(world.angular_velocity(top))));
    }
    EXPECT_TRUE(limit_row("speed of crossed planks at rest (m/s)", fastest, 1e-2, 1e-4));
    EXPECT_LT(double(world.max_penetration()), 2e-3);
  }
}

}  // namespace
}  // namespace gyre::laws::settling_test
