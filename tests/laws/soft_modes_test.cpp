// Ropes and rods follow closed forms: the elastica with all its angles, arcs, Euler's loads, modes, tensions and capstans.
// Sources: K. Mattiasson, "Numerical Results from Large Deflection Beam and Frame Problems Analysed by Means of Elliptic Integrals", 1981;
// L. Euler, 1744 (buckling) and 1769 (capstan); D. Bernoulli, 1751 (modes of a bar).
#include "laws/soft_kit.h"

namespace gyre::laws::soft_modes_test {
namespace {

constexpr double kG = kGravity;

// Returns a rod of 1 m from the origin along x. The segment before the origin is to be held: it is the clamp.
RopeDef clamped_rod(int segments, double density, double bending) {
  return {.points = line({-1.0 / segments, 0, 0}, {1, 0, 0}, segments + 1),
          .linear_density = float(density),
          .bend_stiffness = float(bending)};
}

struct Elastica {
  double load, drop, shortening, angle;  // P L^2 / EI or w L^3 / EI; of L, of L, rad
};
bool has_shape(const char* what, const World& world, SoftId rod, const Elastica& wanted) {
  const SoftVertices v = world.vertices(rod);
  const std::size_t tip = v.size() - 1;
  const std::string name = what;
  const double angle = std::atan2(v.y[tip - 1] - v.y[tip], v.x[tip] - v.x[tip - 1]);
  bool met = relative_row((name + ": drop").c_str(), -v.y[tip], wanted.drop, 2e-2, 5e-3);
  met &= relative_row((name + ": shortening").c_str(), 1.0 - v.x[tip], wanted.shortening, 2e-2, 5e-3);
  met &= relative_row((name + ": angle").c_str(), angle, wanted.angle, 2e-2, 5e-3);
  return met;
}

TEST(RopeBending, TipLoadsGiveTheShapesOfTheElastica) {
  for (const Elastica& c :
       {Elastica{0.2, 0.06636, 0.00265, 0.09964}, Elastica{0.5, 0.16214, 0.01592, 0.24453},
        Elastica{1, 0.30172, 0.05643, 0.46135}, Elastica{2, 0.49346, 0.16064, 0.78175},
        Elastica{3, 0.60325, 0.25442, 0.98602}, Elastica{4, 0.66996, 0.32894, 1.12124},
        Elastica{5, 0.71379, 0.38763, 1.21537}, Elastica{6, 0.74457, 0.43459, 1.28370},
        Elastica{8, 0.78498, 0.50483, 1.37443}, Elastica{10, 0.81061, 0.55500, 1.43029}}) {
    World world = make_world();
    const double mass = c.load / kG;  // EI = 1 N m^2
    const SoftId rod = world.add_rope(clamped_rod(40, 1.0e-3 * mass, 1.0));
    world.pin(rod, 0), world.pin(rod, 1);
    const Vec3 moments{float(1.0e-4 * mass), float(1.0e-4 * mass), float(1.0e-4 * mass)};
    world.attach(rod, 41, world.add_body(point_body(mass, moments, {1, 0, 0})));
    add_brake(world, 6.0);
    run(world, 8.0);
    EXPECT_TRUE(has_shape("S-40 rod under a tip load", world, rod, c)) << c.load;
  }
}

TEST(RopeBending, OwnWeightGivesTheShapesOfTheElastica) {
  for (const Elastica& c :
       {Elastica{0.5, 0.06231, 0.00222, 0.08314}, Elastica{1, 0.12347, 0.00875, 0.16512},
        Elastica{2, 0.23851, 0.03311, 0.32159}, Elastica{3, 0.33965, 0.06849, 0.46354},
        Elastica{4, 0.42516, 0.10989, 0.58859}, Elastica{5, 0.49591, 0.15334, 0.69700},
        Elastica{6, 0.55392, 0.19627, 0.79038}, Elastica{8, 0.64063, 0.27558, 0.94012},
        Elastica{10, 0.70020, 0.34365, 1.05264}, Elastica{20, 0.82988, 0.55477, 1.33950},
        Elastica{50, 0.90792, 0.75499, 1.52645}, Elastica{100, 0.93752, 0.84078, 1.56411}}) {
    World world = make_world();
    const SoftId rod = world.add_rope(clamped_rod(40, c.load / kG, 1.0));
    world.pin(rod, 0), world.pin(rod, 1);
    add_brake(world, 6.0);
    run(world, 8.0);
    EXPECT_TRUE(has_shape("S-41 rod under its own weight", world, rod, c)) << c.load;
  }
}

// A body that cannot turn holds the last segment of a clamped rod at an angle to the first. The body moves freely, so the rod bends to an arc. The
// clamp bears the moment of the arc. The rod starts bent unevenly. A segment that two points of a body hold bends over half of its length, unlike one of fixed
// points: both ends add half a segment to the length.
TEST(RopeBending, ATurnOfTheEndBendsItToAnArc) {
  constexpr int kSegments = 60;
  constexpr double kBentLength = 1.0 + 1.0 / kSegments;  // m
  for (const double turn : {30.0, 90.0, 180.0, 360.0}) {
    World world = make_world({.gravity = {}, .sleeping = false});
    const double a = turn * double(kDegree);
    RopeDef def = clamped_rod(kSegments, 0.1, 1.0);
    def.points.push_back({1.0 + 1.0 / kSegments, 0, 0});
    def.settings.positions = {def.points[0]};
    for (int s = 0; s <= kSegments + 1; ++s) {
      const double share = std::fmin(1.0, std::fmax(0.0, (s - 0.5) / kSegments)),
                   angle = a * share * (0.7 + 0.3 * share);
      def.settings.positions.push_back(def.settings.positions.back() +
                                       (1.0 / kSegments) * DVec3{std::cos(angle), std::sin(angle), 0});
    }
    const SoftId rod = world.add_rope(def);
    const BodyId clamp = world.add_body(point_body(100.0, {100, 100, 100}));
    const JointId wall = world.add_joint(FixedDef{.b = clamp});
    world.attach(rod, 0, clamp), world.attach(rod, 1, clamp);
    BodyDef end = point_body(5.0, {1, 1, 1}, world.vertices(rod).position(kSegments + 1));
    end.locked = LockedAxes{{false, false, true}, {true, true, true}};
    const BodyId handle = world.add_body(end);
    world.attach(rod, kSegments + 1, handle), world.attach(rod, kSegments + 2, handle);
    add_brake(world, 2.0);
    run(world, 20.0);
    const SoftVertices v = world.vertices(rod);
    double worst = 0.0;
    Unwrapped angle;
    for (std::size_t s = 0; s <= kSegments + 1; ++s) {
      angle.add(std::atan2(v.y[s + 1] - v.y[s], v.x[s + 1] - v.x[s]));
      const double exact = a * double(s) / (kSegments + 1);
      worst = std::fmax(worst, std::fabs(angle.turned() - exact));
    }
    EXPECT_TRUE(limit_row("S-42 rod whose end is turned: error of angles, degrees", worst / double(kDegree),
                          0.5, 0.05))
        << turn;
    EXPECT_TRUE(relative_row("S-42 its moment at the clamp, N m",
                             std::fabs(double(world.joint_state(wall).torque.z)), a / kBentLength, 2e-2,
                             2e-3))
        << turn;
    if (turn != 360.0) continue;
    const DVec3 gap =
        0.5 * (v.position(kSegments + 1) + v.position(kSegments + 2) - v.position(0) - v.position(1));
    EXPECT_TRUE(limit_row("S-42 rod closed to a circle: gap, m", length(gap), 1e-2, 2e-3));
  }
}

// Returns true if a rod of 1 m and 1 N m^2 bends further under a load on its upper end. The rod starts bent by a thousandth of its length. A clamped
// rod is free above, the other one has a hinge at both ends.
bool buckles(bool is_clamped, double load) {
  constexpr int kSegments = 30;
  World world = make_world({.sleeping = false});
  RopeDef def{.linear_density = 1.0e-3f, .bend_stiffness = 1.0f};
  for (int i = is_clamped ? -1 : 0; i <= kSegments; ++i) {
    const double y = double(i) / kSegments;
    def.points.push_back({0, y, 0});
    // The shape of the mode keeps the length to the first order.
    const double off = is_clamped ? 1.0 - std::cos(0.5 * kPiDouble * y) : std::sin(kPiDouble * y);
    def.settings.positions.push_back({i < 0 ? 0.0 : 1.0e-3 * off, y, 0});
  }
  const SoftId rod = world.add_rope(def);
  const int last = int(def.points.size()) - 1;
  world.pin(rod, 0);
  if (is_clamped) world.pin(rod, 1);
  BodyDef weight = point_body(load / kG, {1, 1, 1}, def.settings.positions.back());
  weight.locked = LockedAxes{{!is_clamped, false, true}, {true, true, true}};
  world.attach(rod, last, world.add_body(weight));
  const int probe = is_clamped ? last : last / 2;
  const auto off = [&] { return std::fabs(world.vertices(rod).x[std::size_t(probe)]); };
  add_brake(world, 10.0);  // it creeps, and does not swing
  run(world, 2.0);
  const double before = off();
  run(world, 2.0);
  return off() > before;
}
TEST(RopeBending, ARodBucklesUnderEulersLoad) {
  for (const bool is_clamped : {false, true}) {
    const double exact = (is_clamped ? 0.25 : 1.0) * kPiDouble * kPiDouble;
    double low = 0.8 * exact, high = 1.2 * exact;
    for (int n = 0; n < 6; ++n) {
      const double middle = 0.5 * (low + high);
      (buckles(is_clamped, middle) ? high : low) = middle;
    }
    EXPECT_TRUE(relative_row(
        is_clamped ? "S-43 Euler's load, clamped and free, N" : "S-43 Euler's load, hinges at both ends, N",
        0.5 * (low + high), exact, 5e-2, 1e-2));
  }
}

// A clamped rod without weight swings in each of its first three modes.
TEST(RopeMotion, ModesOfAClampedRod) {
  constexpr int kSegments = 60;
  for (const double beta : {1.875104, 4.694091, 7.854757}) {
    World world = make_world({.gravity = {}, .sleeping = false});
    RopeDef def = clamped_rod(kSegments, 1.0, 1.0);
    def.settings.integrator = SoftIntegrator::sdirk2;
    const double ratio = (std::cosh(beta) + std::cos(beta)) / (std::sinh(beta) + std::sin(beta));
    for (const DVec3 p : def.points) {
      const double x = std::fmax(0.0, p.x) * beta;
      def.settings.positions.push_back(
          p + DVec3{0, 1.0e-3 * (std::cosh(x) - std::cos(x) - ratio * (std::sinh(x) - std::sin(x))), 0});
    }
    const SoftId rod = world.add_rope(def);
    world.pin(rod, 0), world.pin(rod, 1);
    const double exact = 2.0 * kPiDouble / (beta * beta);  // s: EI, density and length are 1
    const float step = float(exact / 100.0);
    ZeroCrossings through;
    for (int i = 0; i < 500; ++i) {
      through.add(double(i) * double(step), world.vertices(rod).y[kSegments + 1]);
      world.step(step);
    }
    ASSERT_GE(through.count(), 3);
    EXPECT_TRUE(relative_row("S-44 periods of three modes of a clamped rod, s", through.mean_period(), exact,
                             2e-2, 5e-3));
  }
}

// The tension at the end of a catenary is the force that a body there bears.
TEST(RopeRest, CatenariesPullAtTheirEnds) {
  struct Case {
    double length, sag, tension;  // over the span, and over the weight of a length like the span
  };
  for (const Case c :
       {Case{1.05, 0.139304, 1.058944}, Case{1.1, 0.200301, 0.855265}, Case{1.2, 0.292344, 0.761885},
        Case{1.5, 0.502633, 0.810870}, Case{2.0, 0.796388, 1.026029}}) {
    World world = make_world({.sleeping = false});
    const double depth = std::sqrt(0.25 * c.length * c.length - 0.25);
    std::vector<DVec3> points = line({-0.5, 0, 0}, {0, -depth, 0}, 50);
    for (const DVec3 p : line({0, -depth, 0}, {0.5, 0, 0}, 50))
      if (p.x > 1e-9) points.push_back(p);
    const double density = 0.2;  // kg/m
    const SoftId rope = world.add_rope({.points = points, .linear_density = float(density)});
    BodyDef def = point_body(1.0, {1, 1, 1}, points.front());
    def.gravity_scale = 0.0f;
    const BodyId hook = world.add_body(def);
    const JointId wall = world.add_joint(FixedDef{.b = hook, .anchor = points.front()});
    world.attach(rope, 0, hook), world.pin(rope, 100);
    add_brake(world, 6.0);
    run(world, 6.0);
    double low = 0.0;
    const SoftVertices v = world.vertices(rope);
    for (std::size_t i = 0; i < v.size(); ++i) low = std::fmin(low, v.y[i]);
    EXPECT_TRUE(relative_row("S-45 sag of a catenary", -low, c.sag, 5e-3, 1e-3)) << c.length;
    EXPECT_TRUE(relative_row("S-45 tension at its end, N", double(length(world.joint_state(wall).force)),
                             c.tension * density * kG, 5e-3, 1e-3))
        << c.length;
  }
}

// Returns true if a rope of 10 g/m around a fixed post slips. A weight of 1 kg hangs on one end. The load of the other end has `ratio` kilograms; after
// a whole turn it falls upwards.
bool slips(double friction, int half_turns, double ratio) {
  World world = make_world({.sleeping = false});
  BodyDef post{.type = BodyType::fixed, .pose = {{}, {0.70710678f, 0, 0, 0.70710678f}}};
  world.add_body(post, ShapeDef{.geometry = Cylinder{0.5f, 0.5f}, .material = surface(float(friction))});
  const float radius = 0.01f;
  const double r = 0.5 + double(radius);
  const double side = half_turns == 1 ? r : -r, down = half_turns == 1 ? -1.0 : 1.0;
  RopeDef def{.points = line({-r, -1, 0}, {-r, -0.1, 0}, 9), .radius = radius, .linear_density = 0.01f};
  for (int i = 0; i <= 32 * half_turns; ++i) {
    const double angle = kPiDouble * i / 32;
    def.points.push_back({-r * std::cos(angle), r * std::sin(angle), 0});
  }
  for (int i = 1; i <= 10; ++i) def.points.push_back({side, 0.1 * i * down, 0});
  def.settings.static_friction = def.settings.dynamic_friction = float(friction);
  const SoftId rope = world.add_rope(def);
  const BodyId light = world.add_body(point_body(1.0, {0.01f, 0.01f, 0.01f}, def.points.front()));
  BodyDef load = point_body(ratio, {0.01f, 0.01f, 0.01f}, def.points.back());
  load.gravity_scale = half_turns == 1 ? 1.0f : -1.0f;
  const BodyId heavy = world.add_body(load);
  world.attach(rope, 0, light), world.attach(rope, int(def.points.size()) - 1, heavy);
  run(world, 0.5);
  return double(world.linear_velocity(heavy).y) * down > 0.02;
}
TEST(RopeRest, CapstansHoldByTheirTurnsAndFriction) {
  struct Case {
    double friction;
    int half_turns;
  };
  for (const Case c : {Case{0.3, 2}, Case{0.2, 2}, Case{0.5, 1}}) {
    const double exact = std::exp(c.friction * kPiDouble * c.half_turns);
    double low = 0.8 * exact, high = 1.2 * exact;
    for (int n = 0; n < 5; ++n) {
      const double middle = 0.5 * (low + high);
      (slips(c.friction, c.half_turns, middle) ? high : low) = middle;
    }
    EXPECT_TRUE(relative_row("S-46 capstan, ratio of loads", 0.5 * (low + high), exact, 5e-2, 1e-2))
        << c.friction << ' ' << c.half_turns;
  }
}

}  // namespace
}  // namespace gyre::laws::soft_modes_test
