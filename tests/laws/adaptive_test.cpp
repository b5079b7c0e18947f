// Steps that are cut at impacts: every one found at its time, against exact solutions. A bouncing ball, also one that bounces
// infinitely often in finite time (Zeno); a row of balls on strings; a break shot against an event-driven computation of hard spheres.
#include "laws/kit.h"

#include <array>

namespace gyre::laws::adaptive_test {
namespace {

World adaptive(IntegratorKind integrator = IntegratorKind::semi_implicit_euler,
               Vec3 gravity = {0, -float(kGravity), 0}, int max_impacts = 128) {
  WorldDef def;
  def.gravity = gravity;
  def.sleeping = false;
  def.stepping.integrator = integrator;
  def.stepping.time = TimeStepping::adaptive;
  def.stepping.max_impacts = max_impacts;
  return make_world(def);
}

// Height of a ball above where it lies, dropped from h, that bounces with e: pieces of parabolas.
double bounced_height(double h, double e, double time) {
  double v = std::sqrt(2.0 * kGravity * h), t = time - std::sqrt(2.0 * h / kGravity);
  if (t < 0.0) return h - 0.5 * kGravity * time * time;
  for (int i = 0; i < 100000; ++i) {
    v *= e;
    const double flight = 2.0 * v / kGravity;
    if (flight < 1e-12) return 0.0;
    if (t < flight) return v * t - 0.5 * kGravity * t * t;
    t -= flight;
  }
  return 0.0;
}

BodyId add_bouncing_ball(World& world, double h, float e) {
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}, .material = surface(0.5f, e)});
  return world.add_body({.pose = {.position = {0, 0.25 + h, 0}}},
                        {.geometry = Sphere{.radius = 0.25f}, .material = surface(0.5f, e)});
}

constexpr IntegratorKind kKinds[] = {IntegratorKind::semi_implicit_euler, IntegratorKind::explicit_euler,
                                     IntegratorKind::rk4, IntegratorKind::verlet};

TEST(Adaptive, ABouncingBallIsWhereItMustBe) {
  for (const IntegratorKind kind : kKinds) {
    for (const float e : {1.0f, 0.8f, 0.3f}) {
      World world = adaptive(kind);
      const BodyId ball = add_bouncing_ball(world, 2.0, e);
      double worst = 0.0;
      int most = 0;
      for (int i = 1; i <= 600; ++i) {
        world.step(kStep);
        worst = std::max(worst, std::fabs(world.pose(ball).position.y - 0.25 -
                                          bounced_height(2.0, double(e), i * double(kStep))));
        most = std::max(most, world.step_stats().impacts);
        EXPECT_FALSE(world.step_stats().bounded);
      }
      std::printf("[row] %-20s e %.1f: at most %d impacts a step\n", to_string(kind), double(e), most);
      EXPECT_TRUE(limit_row("bouncing ball, 10 s: farthest from exact, m", worst, 2e-3, 2e-4));
    }
  }
}

TEST(Adaptive, ZenosBallComesToRestInTime) {
  World world = adaptive();
  const BodyId ball = add_bouncing_ball(world, 2.0, 0.8f);
  // Up and down as high as its energy takes it, after each impact; the first way is the fall.
  double path = 2.0, rest = 0.0, time = 0.0;
  constexpr double kFine = 1.0 / 960.0;
  for (int i = 0; i < 7000; ++i) {
    world.step(float(kFine));
    time += kFine;
    const double v = double(world.linear_velocity(ball).y), height = world.pose(ball).position.y - 0.25;
    if (world.step_stats().impacts > 0) path += 2.0 * (height + 0.5 * v * v / kGravity);
    if (length(world.linear_velocity(ball)) > 1e-4f) rest = time;
    EXPECT_FALSE(world.step_stats().bounded);
  }
  // sqrt(2 h / g) (1 + e) / (1 - e) and h (1 + e^2) / (1 - e^2).
  EXPECT_TRUE(relative_row("A-92 time to rest", rest, std::sqrt(4.0 / kGravity) * 9.0, 1e-3, 1e-3));
  EXPECT_TRUE(relative_row("A-92 path", path, 2.0 * 1.64 / 0.36, 1e-3, 1e-3));
  EXPECT_LE(length(world.linear_velocity(ball)), 1e-6f);
}

TEST(Adaptive, ImpactsInAStepAreBoundedAndToldSo) {
  // A ball between two walls, 1 mm apart beside it, at 20 m/s: 330 impacts a step.
  World world = adaptive(IntegratorKind::semi_implicit_euler, {}, 10);
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}, .material = surface(0.0f, 1.0f)});
  world.add_body({.type = BodyType::fixed, .pose = {.position = {0, 0.201, 0}}},
                 {.geometry = Plane{.normal = {0, -1, 0}}, .material = surface(0.0f, 1.0f)});
  const BodyId ball = world.add_body({.pose = {.position = {0, 0.1005, 0}}, .linear_velocity = {0, 20, 0}},
                                     {.geometry = Sphere{.radius = 0.1f}, .material = surface(0.0f, 1.0f)});
  world.step(kStep);
  EXPECT_EQ(world.step_stats().impacts, 10);
  EXPECT_TRUE(world.step_stats().bounded);
  EXPECT_NEAR(world.pose(ball).position.y, 0.1005,
              0.02);  // the rest of the step was a fixed one, in which walls give way
  World all = adaptive(IntegratorKind::semi_implicit_euler, {}, 4096);
  all.add_body({.type = BodyType::fixed}, {.geometry = Plane{}, .material = surface(0.0f, 1.0f)});
  all.add_body({.type = BodyType::fixed, .pose = {.position = {0, 0.201, 0}}},
               {.geometry = Plane{.normal = {0, -1, 0}}, .material = surface(0.0f, 1.0f)});
  const BodyId whole = all.add_body({.pose = {.position = {0, 0.1005, 0}}, .linear_velocity = {0, 20, 0}},
                                    {.geometry = Sphere{.radius = 0.1f}, .material = surface(0.0f, 1.0f)});
  all.step(kStep);
  EXPECT_FALSE(all.step_stats().bounded);
  EXPECT_NEAR(all.step_stats().impacts, 333, 4);
  EXPECT_NEAR(std::fabs(double(all.linear_velocity(whole).y)), 20.0, 1e-4);
}

// Five steel balls in touch on pairs of strings; the first `lifted` are let go at 30 degrees.
struct Cradle {
  World world;
  std::array<BodyId, 5> balls{};
};
constexpr double kString = 1.0, kLift = 30.0 * 3.14159265358979323846 / 180.0;
Cradle make_cradle(int lifted) {
  Cradle c{adaptive()};
  constexpr double kRadius = 0.1;
  for (int i = 0; i < 5; ++i) {
    const double x = 2.0 * kRadius * i, angle = i < lifted ? kLift : 0.0;
    BodyDef def;
    def.pose.position = {x - kString * std::sin(angle), -kString * std::cos(angle), 0};
    c.balls[std::size_t(i)] = c.world.add_body(
        def,
        {.geometry = Sphere{.radius = float(kRadius)}, .density = 7800.0f, .material = surface(0.0f, 1.0f)});
    // A rod to its middle: a pendulum of a point, as the ball does not turn.
    c.world.add_joint(DistanceDef{.b = c.balls[std::size_t(i)], .anchor = {x, 0, 0}});
  }
  return c;
}

TEST(Adaptive, ACradleHandsOnAsManyBallsAsFall) {
  for (const int lifted : {1, 2, 3}) {
    Cradle c = make_cradle(lifted);
    const double exact = std::sqrt(2.0 * kGravity * kString * (1.0 - std::cos(kLift)));
    // A quarter of a period of a pendulum with this swing: K(sin(lift / 2)) sqrt(l / g); 0.5109 s. Looked at soon after the blow.
    run(c.world, 0.5167);
    for (int i = 0; i < 5; ++i) {
      const double v = double(c.world.linear_velocity(c.balls[std::size_t(i)]).x),
                   y = c.world.pose(c.balls[std::size_t(i)]).position.y;
      const bool flies = i >= 5 - lifted;
      // Its speed at the lowest point, by energy.
      const double speed =
          std::sqrt(v * v + std::pow(double(c.world.linear_velocity(c.balls[std::size_t(i)]).y), 2) +
                    std::max(2.0 * kGravity * (y + kString), 0.0));
      EXPECT_NEAR(speed, flies ? exact : 0.0, 1e-3 * exact) << lifted << " lifted, ball " << i;
    }
    // And back: four blows later they rise as high as they were lifted. Looked at where they are slowest: there the energy that
    // semi-implicit Euler shows is the one that it keeps.
    run(c.world, 3.0);
    double slowest = 1e9, height = 0.0;
    for (int i = 0; i < 120; ++i) {
      c.world.step(kStep);
      const BodyId last = c.balls[4];
      const double speed = double(length(c.world.linear_velocity(last))),
                   y = c.world.pose(last).position.y + kString;
      if (y < 0.5 * kString * (1.0 - std::cos(kLift)) || speed > slowest) continue;
      slowest = speed;
      height = y + 0.5 * speed * speed / kGravity;
    }
    EXPECT_TRUE(relative_row("cradle: rises after 4 blows to, m", height, kString * (1.0 - std::cos(kLift)),
                             1e-3, 1e-4));
  }
}

// Hard spheres that move straight on between impacts, one after the other at their exact times.
struct Disc {
  double x = 0, y = 0, vx = 0, vy = 0;
};
int play_exactly(std::vector<Disc>& discs, double radius, double e, double seconds) {
  int impacts = 0;
  for (double left = seconds; left > 0.0;) {
    double first = left;
    std::size_t a = 0, b = 0;
    for (std::size_t i = 0; i < discs.size(); ++i) {
      for (std::size_t j = i + 1; j < discs.size(); ++j) {
        const double dx = discs[j].x - discs[i].x, dy = discs[j].y - discs[i].y;
        const double ux = discs[j].vx - discs[i].vx, uy = discs[j].vy - discs[i].vy;
        const double along = dx * ux + dy * uy, speed = ux * ux + uy * uy;
        const double root = along * along - speed * (dx * dx + dy * dy - 4.0 * radius * radius);
        if (along >= 0.0 || root < 0.0) continue;
        const double time = (-along - std::sqrt(root)) / speed;
        if (time < first) first = std::max(time, 0.0), a = i, b = j;
      }
    }
    for (Disc& disc : discs) disc.x += first * disc.vx, disc.y += first * disc.vy;
    left -= first;
    if (a == b) break;
    const double dx = (discs[b].x - discs[a].x) / (2.0 * radius),
                 dy = (discs[b].y - discs[a].y) / (2.0 * radius);
    const double closing = (discs[a].vx - discs[b].vx) * dx + (discs[a].vy - discs[b].vy) * dy;
    const double blow = 0.5 * (1.0 + e) * closing;
    discs[a].vx -= blow * dx, discs[a].vy -= blow * dy, discs[b].vx += blow * dx, discs[b].vy += blow * dy;
    ++impacts;
  }
  return impacts;
}

// A rack of fifteen with small gaps, all different (touching ones have no exact solution), and a cue ball at 8 m/s, a little beside
// the middle. On a table without friction, or without gravity.
TEST(Adaptive, ABreakShotIsThatOfHardSpheres) {
  constexpr double kRadius = 0.028575, kSeconds = 0.35, kSpeed = 8.0, kRestitution = 0.95;
  for (const bool table : {false, true}) {
    World world = adaptive(IntegratorKind::semi_implicit_euler, {0, table ? -float(kGravity) : 0.0f, 0}, 512);
    if (table) add_ground(world, surface(0.0f, 0.0f));
    std::vector<Disc> discs;
    discs.push_back({-0.6, 0.003, kSpeed, 0.0});
    for (int row = 0; row < 5; ++row) {
      for (int k = 0; k <= row; ++k) {
        // 1 to 3 mm between neighbours.
        const double wide = 2.0 * kRadius + 0.002, wobble = 0.0004;
        discs.push_back({row * wide * std::sqrt(0.75) + wobble * std::sin(7.0 * row + 3.0 * k),
                         (k - 0.5 * row) * wide + wobble * std::cos(5.0 * row + 11.0 * k), 0.0, 0.0});
      }
    }
    std::vector<BodyId> balls;
    for (const Disc& disc : discs) {
      balls.push_back(world.add_body(
          {.pose = {.position = {disc.x, kRadius, disc.y}},
           .linear_velocity = {float(disc.vx), 0, float(disc.vy)}},
          {.geometry = Sphere{.radius = float(kRadius)}, .material = surface(0.0f, float(kRestitution))}));
    }
    const int impacts = play_exactly(discs, double(float(kRadius)), double(float(kRestitution)), kSeconds);
    const int steps = 21;
    int found = 0;
    for (int i = 0; i < steps; ++i) {
      world.step(float(kSeconds / steps));
      found += world.step_stats().impacts;
      EXPECT_FALSE(world.step_stats().bounded);
    }
    double place = 0.0, speed = 0.0;
    for (std::size_t i = 0; i < balls.size(); ++i) {
      const DVec3 at = world.pose(balls[i]).position;
      const Vec3 v = world.linear_velocity(balls[i]);
      place = std::max(place, std::hypot(at.x - discs[i].x, at.z - discs[i].y));
      speed = std::max(speed, std::hypot(double(v.x) - discs[i].vx, double(v.z) - discs[i].vy));
    }
    std::printf("[row] break shot: %d impacts found, exact %d\n", found, impacts);
    EXPECT_NEAR(found, impacts, 2);
    EXPECT_TRUE(limit_row(
        table ? "break shot on a table: farthest from exact, m" : "break shot: farthest from exact, m", place,
        1e-3 * kSpeed * kSeconds, 1e-4 * kSpeed * kSeconds));
    EXPECT_TRUE(limit_row("break shot: speeds off by at most, m/s", speed, 1e-3 * kSpeed, 1e-4 * kSpeed));
  }
}

TEST(Adaptive, ABoxThatFallsOnItsFaceComesToRest) {
  World world = adaptive();
  add_ground(world, surface(0.6f, 0.2f));
  const BodyId box =
      world.add_body({.pose = {.position = {0, 2, 0}, .orientation = from_axis_angle({1, 0, 1}, 0.4f)}},
                     {.geometry = Box{{0.5f, 0.3f, 0.4f}}, .material = surface(0.6f, 0.2f)});
  run(world, 5.0);
  EXPECT_LE(length(world.linear_velocity(box)), 1e-5f);
  EXPECT_LE(length(world.angular_velocity(box)), 1e-5f);
  EXPECT_LE(world.max_penetration(), 2e-3f);
}

TEST(Adaptive, AStackStands) {
  World world = adaptive();
  add_ground(world, surface(0.6f));
  BodyId top{};
  for (int i = 0; i < 6; ++i)
    top = world.add_body({.pose = {.position = {0, 0.5 + 1.001 * i, 0}}},
                         {.geometry = Box{{0.5f, 0.5f, 0.5f}}, .material = surface(0.6f)});
  run(world, 3.0);
  EXPECT_NEAR(world.pose(top).position.y, 5.5, 0.01);
  EXPECT_LE(length(world.linear_velocity(top)), 1e-4f);
}

// ------------------------------------------------------------------------------------------------------ to a tolerance

World controlled(float tolerance, int substeps = 1, Vec3 gravity = {0, -float(kGravity), 0}) {
  WorldDef def;
  def.gravity = gravity;
  def.sleeping = false;
  def.stepping.substeps = substeps;
  def.stepping.time = TimeStepping::error_controlled;
  def.stepping.tolerance = tolerance;
  return make_world(def);
}

// Two rods that hang on each other, raised to the side. Returns the lower.
BodyId add_double_pendulum(World& world, float damping = 0.0f) {
  BodyId last{};
  for (int i = 0; i < 2; ++i) {
    BodyDef def;
    def.pose.position = {0.5 + i, 0, 0};
    def.angular_damping = def.linear_damping = damping;
    const BodyId rod = world.add_body(def, {.geometry = Box{{0.5f, 0.05f, 0.05f}}, .density = 1000});
    world.add_joint(BallDef{.a = last, .b = rod, .anchor = {double(i), 0, 0}});
    last = rod;
  }
  return last;
}

DVec3 swung(World world, double seconds, float step, int* parts = nullptr) {
  const BodyId lower = add_double_pendulum(world);
  for (int i = 0; i < int(std::lround(seconds / double(step))); ++i) {
    world.step(step);
    if (parts != nullptr) *parts = std::max(*parts, world.step_stats().parts);
  }
  return world.pose(lower).position;
}

TEST(ErrorControl, ADoublePendulumIsAsExactAsAsked) {
  WorldDef def;
  def.gravity = {0, -float(kGravity), 0};
  def.sleeping = false;
  def.stepping.substeps = 64;
  const DVec3 exact = swung(make_world(def), 0.5, 1.0f / 960.0f);
  double last_error = 1.0;
  int last_parts = 0;
  for (const float tolerance : {1.0e-2f, 1.0e-3f, 2.0e-4f}) {
    int parts = 0;
    const double error = length(swung(controlled(tolerance), 0.5, 1.0f / 30.0f, &parts) - exact);
    // Of 15 steps each is within the tolerance.
    EXPECT_LT(error, 15.0 * double(tolerance)) << tolerance;
    EXPECT_LT(error, last_error) << tolerance;
    EXPECT_GT(parts, last_parts) << tolerance;
    last_error = error, last_parts = parts;
  }
}

TEST(ErrorControl, SubstepsFallBackWhenMotionDies) {
  World world = controlled(1.0e-4f);
  add_double_pendulum(world, 2.0f);
  int most = 0;
  for (int i = 0; i < 600; ++i) {
    world.step(1.0f / 60.0f);
    most = std::max(most, world.step_stats().parts);
  }
  EXPECT_GE(most, 16);
  EXPECT_EQ(world.step_stats().parts, 4);  // of two sub-steps, twice the one of the settings
}

TEST(ErrorControl, WhatIsWithinItsToleranceIsTheStepOfTwiceTheSubsteps) {
  // A step that was tried leaves no trace: to the bit what a world of four sub-steps does.
  WorldDef def;
  def.gravity = {0, -float(kGravity), 0};
  def.sleeping = false;
  def.stepping.substeps = 4;
  World plain = make_world(def), tried = controlled(1.0f, 2);
  std::vector<BodyId> bodies[2];
  for (World* world : {&plain, &tried}) {
    std::vector<BodyId>& own = bodies[world == &tried];
    own.push_back(add_double_pendulum(*world));
    world->add_body({.type = BodyType::fixed, .pose = {.position = {0, -3, 0}}}, {.geometry = Plane{}});
    for (int i = 0; i < 4; ++i) {
      const Pose pose{.position = {5.0, -2.5 + i, 0}};
      own.push_back(world->add_body({.pose = pose}, {.geometry = Box{{0.5f, 0.5f, 0.5f}}}));
    }
  }
  for (int i = 0; i < 120; ++i) {
    plain.step(1.0f / 60.0f);
    tried.step(1.0f / 60.0f);
    for (std::size_t k = 0; k < bodies[0].size(); ++k) {
      const Pose a = plain.pose(bodies[0][k]), b = tried.pose(bodies[1][k]);
      ASSERT_EQ(a.position, b.position) << i << " body " << k;
      ASSERT_EQ(a.orientation, b.orientation) << i << " body " << k;
    }
  }
  EXPECT_NE(plain.pose(bodies[0][0]).position.y, 0.0);
}

TEST(ErrorControl, ABlowIsToldToBeLessExact) {
  World world = controlled(1.0e-6f, 4);
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}, .material = surface(0.5f, 1.0f)});
  world.add_body({.pose = {.position = {0, 0.6, 0}}, .linear_velocity = {0, -5, 0}},
                 {.geometry = Sphere{.radius = 0.25f}, .material = surface(0.5f, 1.0f)});
  float blow = 0.0f, flight = 0.0f;
  for (int i = 0; i < 12; ++i) {
    world.step(1.0f / 60.0f);
    const float error = world.step_stats().error;
    (error > 1.0e-6f ? blow : flight) = std::max(error, error > 1.0e-6f ? blow : flight);
  }
  EXPECT_GT(blow, 1.0e-6f);
  EXPECT_LT(blow, 0.1f);
  EXPECT_GT(flight, 0.0f);
}

}  // namespace
}  // namespace gyre::laws::adaptive_test
