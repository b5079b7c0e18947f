// A wedge under a load: statics with friction on two faces. It stays while its angle is below twice the angle of friction:
// tan(angle) < 2 mu / (1 - mu^2).
#include "laws/kit.h"

#include "random.h"

namespace gyre::laws::wedge_test {
namespace {

// A prism along z: (x, y) corners.
Geometry prism(const std::vector<Vec3>& corners, float half_width) {
  std::vector<Vec3> points;
  for (const Vec3 p : corners) {
    points.push_back({p.x, p.y, -half_width});
    points.push_back({p.x, p.y, half_width});
  }
  return *cook_hull(points);
}

// How far a wedge of 1 kg is pushed out from under a block of 100 kg that can only go up and down: in ten seconds, and in the
// last of them, when overlap from the load's arrival is taken back.
struct Way {
  double all, last;
};
Way pushed_out(double degrees, double mu) {
  World world = make_world({.sleeping = false});
  add_ground(world, surface(float(mu)));
  const float rise = float(std::tan(degrees * double(kDegree)));
  BodyDef wedge_def{.pose = {.position = {0, 0, 0}}};
  wedge_def.mass = 1.0f;
  const BodyId wedge = world.add_body(
      wedge_def, {.geometry = prism({{-1, 0, 0}, {1, 0, 0}, {1, 2.0f * rise, 0}, {-1, 1e-3f, 0}}, 0.5f),
                  .material = surface(float(mu))});
  BodyDef block_def{.locked = {.linear = {true, false, true}, .angular = {true, true, true}}};
  block_def.mass = 100.0f;
  // Its underside lies on the wedge between x = -0.5 and x = 0.5.
  const float slope = (2.0f * rise - 1e-3f) / 2.0f;
  const auto height = [&](float x) { return 1e-3f + slope * (x + 1.0f); };
  world.add_body(
      block_def,
      {.geometry = prism(
           {{-0.5f, height(-0.5f), 0}, {0.5f, height(0.5f), 0}, {0.5f, 1.5f, 0}, {-0.5f, 1.5f, 0}}, 0.5f),
       .material = surface(float(mu))});
  run(world, 9.0);
  const double before = world.pose(wedge).position.x;
  run(world, 1.0);
  return {world.pose(wedge).position.x, std::fabs(world.pose(wedge).position.x - before)};
}
TEST(Wedge, LocksBelowTwiceTheAngleOfFriction) {
  EXPECT_TRUE(limit_row("A-73 8 degrees, mu 0.2: last second (m)", pushed_out(8.0, 0.2).last, 1e-3, 1e-5));
  EXPECT_GT(pushed_out(8.0, 0.05).all, 1.0) << "A-73 8 degrees, mu 0.05";
  for (const double mu : {0.05, 0.0699, 0.2}) {
    const double limit = 2.0 * std::atan(mu) / double(kDegree);
    const Way below = pushed_out(limit - 0.3, mu), above = pushed_out(limit + 0.3, mu);
    say("[row] A-73 mu %g, 0.3 degrees below the limit: %g m in all, %g m in the last second; above: %g m\n",
        mu, below.all, below.last, above.all);
    EXPECT_LT(below.last, 1e-3) << mu;
    EXPECT_LT(below.all, 0.3) << mu;
    EXPECT_GT(above.all, 0.5) << mu;
  }
}

// Discs that fall into the groove between a wall and a slope and come to rest in it at every angle. Across the groove two points of friction
// would hold a disc by any thrust, the larger the better, also against what turns it about the line between them: an answer of thousands of
// times its weight was taken for how it is held, and the next steps let go of it.
TEST(Wedge, DiscsInAGrooveAreNotPressedByNothing) {
  for (const float friction : {0.6f, 0.9f, 1.2f}) {
    World world = make_world({.sleeping = false});
    const Material rough = surface(friction);
    world.add_body({.type = BodyType::fixed}, {.geometry = Plane{{0, 0, -1}, 0.0f}, .material = rough});
    world.add_body({.type = BodyType::fixed},
                   {.geometry = Plane{{0, 0.99f, 0.14f}, 0.0f}, .material = rough});
    testing_random::Random random;
    std::vector<BodyId> discs;
    for (int i = 0; i < 100; ++i) {
      const float radius = random.real(0.02f, 0.06f);
      const BodyDef def{.pose = {{0.5 * i, 0.1, -0.08}, random.turn(3.0f)}};
      discs.push_back(world.add_body(def, {.geometry = Cylinder{radius, radius * random.real(0.2f, 0.5f)},
                                           .density = 100.0f,
                                           .material = rough}));
    }
    run(world, 0.5);
    double fastest = 0.0;
    for (int i = 0; i < 600; ++i) {
      ASSERT_TRUE(world.step(kStep));
      for (const BodyId disc : discs)
        fastest = std::max(fastest, double(length(world.linear_velocity(disc))));
    }
    EXPECT_TRUE(limit_row("fastest disc in a groove (m/s)", fastest, 1.0, 0.6));
  }
}

}  // namespace
}  // namespace gyre::laws::wedge_test
