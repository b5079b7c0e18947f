// Ropes, cloth and solids at rest and in free flight, against exact solutions: tip loads, rows of the elastica, catenaries, capstans, own
// weight in cells of any shape, uniaxial tension, momentum, attachments, explicit schemes.
// Sources: K. Mattiasson, "Numerical Results from Large Deflection Beam and Frame Problems Analysed by Means of Elliptic Integrals", 1981;
// F. T. Peirce, "The Handle of Cloth as a Measurable Quantity", 1930; D. Bernoulli, 1733 (hanging chain); L. Euler, 1769 (capstan).
#include "laws/soft_kit.h"

#include <array>

namespace gyre::laws::soft_statics_test {
namespace {

constexpr double kG = kGravity;

TEST(RopeRest, TipLoadsBendItToTheElastica) {
  struct Case {
    double load, drop;
  };
  for (const Case c : {Case{0.5, 0.16214}, Case{2, 0.49346}, Case{10, 0.81061}}) {
    World world = make_world();
    constexpr int kSegments = 40;
    const double mass = c.load / kG;  // EI = 1 N m^2, L = 1 m
    RopeDef def{.points = line({-1.0 / kSegments, 0, 0}, {1, 0, 0}, kSegments + 1),
                .linear_density = float(1.0e-3 * mass),
                .bend_stiffness = 1.0f};
    const SoftId rope = world.add_rope(def);
    world.pin(rope, 0), world.pin(rope, 1);
    const BodyId load = world.add_body(
        point_body(mass, {float(1.0e-4 * mass), float(1.0e-4 * mass), float(1.0e-4 * mass)}, {1, 0, 0}));
    world.attach(rope, kSegments + 1, load);
    add_brake(world, 6.0);
    run(world, 8.0);
    EXPECT_TRUE(relative_row("S-11 elastica under a load at its end", -world.vertices(rope).y[kSegments + 1],
                             c.drop, 2e-2, 5e-3));
  }
}

TEST(RopeRest, CatenariesOfOtherLengths) {
  struct Case {
    double span, length, sag;
  };
  for (const Case c : {Case{0.01, 1.1, 0.200301}, Case{100.0, 1.5, 0.502633}}) {
    World world = make_world();
    const double depth = 0.5 * c.span * std::sqrt(c.length * c.length - 1.0), half = 0.5 * c.span;
    std::vector<DVec3> points = line({-half, 0, 0}, {0, -depth, 0}, 50);
    for (const DVec3 p : line({0, -depth, 0}, {half, 0, 0}, 50))
      if (p.x > 1e-6 * c.span) points.push_back(p);
    const SoftId rope = world.add_rope({.points = points, .radius = float(1e-3 * c.span)});
    world.pin(rope, 0), world.pin(rope, 100);
    const double time = std::sqrt(c.span / kG);
    add_brake(world, 2.0 / time);
    run(world, std::fmax(20.0 * time, 0.5));
    double low = 0.0;
    const SoftVertices v = world.vertices(rope);
    for (std::size_t i = 0; i < v.size(); ++i) low = std::fmin(low, v.y[i]);
    EXPECT_TRUE(
        relative_row("S-12 catenaries of 1 cm and 100 m, sag over span", -low / c.span, c.sag, 5e-3, 1e-3));
  }
}

TEST(RopeMotion, HigherModesOfAHangingChain) {
  for (const double mode : {2.76004, 4.32686}) {
    World world = make_world({.sleeping = false});
    const double frequency = mode * std::sqrt(kG);  // rad/s, of a chain of 1 m
    RopeDef def{.points = line({0, 1, 0}, {0, 0, 0}, 60)};
    def.settings.integrator = SoftIntegrator::sdirk2;
    for (const DVec3 p : def.points)
      def.settings.positions.push_back(
          {0.002 * std::cyl_bessel_j(0.0, 2.0 * frequency * std::sqrt(p.y / kG)), p.y, 0});
    const SoftId rope = world.add_rope(def);
    world.pin(rope, 0);
    ZeroCrossings through;
    for (int i = 0; i < 300 && through.count() < 4; ++i) {
      through.add(double(i) * double(kStep), world.vertices(rope).x[60]);
      world.step(kStep);
    }
    ASSERT_GE(through.count(), 3);
    EXPECT_TRUE(relative_row("S-13 periods of the second and third mode of a chain", through.mean_period(),
                             2.0 * kPiDouble / frequency, 2e-2, 5e-3));
  }
}

TEST(RopeRest, TenTonnesOnAKilogram) {
  World world = make_world({.sleeping = false});
  const SoftId rope = world.add_rope({.points = line({0, 10, 0}, {0, 0, 0}, 100), .linear_density = 0.1f});
  world.pin(rope, 0);
  const BodyId load = world.add_body(point_body(1.0e4, {1000, 1000, 1000}));
  world.attach(rope, 100, load);
  double most = 0.0;
  for (int i = 0; i < 180; ++i) {
    world.step(kStep);
    most = std::fmax(most, std::fabs(world.pose(load).position.y));
  }
  EXPECT_TRUE(limit_row("S-14 ten tonnes on a rope of 1 kg: stretch, share", most / 10.0, 1e-3, 1e-4));
}

// The strain of a sheet that hangs from its upper edge; z of the grid points down.
double hanging_strain(std::array<int, 2> cells, ClothLinks links, float shear) {
  World world = make_world();
  ClothDef def{.grid = ClothGrid{{0.5f, 1.0f}, cells},
               .links = links,
               .stretch_stiffness = 1000.0f,
               .shear_stiffness = shear,
               .bend_stiffness = 1.0e-6f,
               .thickness = 0.0f,
               .self_collision = false};
  def.pose.orientation = {0.70710678f, 0, 0, 0.70710678f};
  const SoftId cloth = world.add_cloth(def);
  for (int i = 0; i <= cells[0]; ++i) world.pin(cloth, i);
  add_brake(world, 100.0);
  run(world, 2.0);
  const SoftVertices v = world.vertices(cloth);
  double mean = 0.0;
  for (int i = 0; i <= cells[0]; ++i)
    mean += (v.y[0] - v.y[v.size() - 1 - std::size_t(i)] - 1.0) / double(cells[0] + 1);
  return mean;
}
TEST(ClothRest, LongCellsHangByTheStiffnessOfTheMaterial) {
  const double exact = 0.2 * kG / (2.0 * 1000.0);
  const char* const kName = "S-15 sheet by its weight, in cells of any shape";
  for (const std::array<int, 2> cells : {std::array{10, 20}, {20, 20}, {20, 12}, {40, 5}})
    EXPECT_TRUE(relative_row(kName, hanging_strain(cells, ClothLinks::springs, 200.0f), exact, 2e-2, 1e-2))
        << cells[0];
  EXPECT_TRUE(relative_row(kName, hanging_strain({20, 12}, ClothLinks::membrane, 200.0f), exact, 2e-2, 1e-2));
}

// Two thirds of the middle of a long bar of the neo-Hookean law under a weight, against the law itself: mu s + (lambda + mu) (J - a) J / s = 0 across.
TEST(SolidRest, UniaxialTensionFollowsTheLaw) {
  const double young = 1.0e5, ratio = 0.3, mu = young / (2.0 * (1.0 + ratio));
  const double stiff = young * ratio / ((1.0 + ratio) * (1.0 - 2.0 * ratio)) + mu, a = 1.0 + mu / stiff;
  for (const double stretch : {1.5, 3.0}) {
    // mu t + stiff (stretch t^2 - a) stretch t = 0
    const double across = std::sqrt((a - mu / (stiff * stretch)) / stretch);
    const double stress = mu * stretch + stiff * (stretch * across * across - a) * across * across;
    World world = make_world({.sleeping = false});
    SolidDef def{.box = SolidBox{{0.05f, 0.5f, 0.05f}, {2, 20, 2}},
                 .density = 1.0f,
                 .young_modulus = float(young),
                 .poisson_ratio = float(ratio),
                 .settings = {.damping = 0.05f}};
    const SoftId bar = world.add_solid(def);
    BodyDef weight = point_body(stress * 0.01 / kG, {1, 1, 1}, {0, -0.55, 0});
    weight.locked = LockedAxes{{false, false, false}, {true, true, true}};
    const BodyId load = world.add_body(weight);
    const auto vertex = [](int i, int j, int k) { return i + 3 * (j + 21 * k); };
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 3; ++i) world.pin(bar, vertex(i, 20, k)), world.attach(bar, vertex(i, 0, k), load);
    }
    add_brake(world, 3.0);
    run(world, 7.0);
    const SoftVertices v = world.vertices(bar);
    const double found =
        (v.y[std::size_t(vertex(1, 14, 1))] - v.y[std::size_t(vertex(1, 6, 1))]) / (8.0 * 0.05);
    EXPECT_TRUE(relative_row("S-16 stretch of a neo-Hookean bar", found, stretch, 1e-2, 1e-3));
    const double width = v.x[std::size_t(vertex(2, 10, 1))] - v.x[std::size_t(vertex(0, 10, 1))];
    EXPECT_TRUE(relative_row("S-16 its width", width / 0.1, across, 1e-2, 1e-3));
  }
}

// A cloth that flies and turns freely. Backward Euler takes about w^2 h of the angular momentum in a second.
TEST(ClothMotion, FreeFlightKeepsMomentum) {
  World world = make_world({.gravity = {}, .stepping = {.substeps = 16}, .sleeping = false});
  ClothDef def{.grid = ClothGrid{{1, 1}, {10, 10}}, .self_collision = false};
  for (int j = 0; j <= 10; ++j) {
    for (int i = 0; i <= 10; ++i) {
      const DVec3 arm{0.1 * i - 0.5, 0, 0.1 * j - 0.5};
      def.settings.velocities.push_back(Vec3{2, 1, 0} + to_float(cross(DVec3{0, 1, 0}, arm)));
    }
  }
  world.add_cloth(def);
  const Momentum before = world.momentum();
  run(world, 1.0);
  const Momentum after = world.momentum();
  EXPECT_TRUE(limit_row("S-17 free cloth: linear momentum lost in 1 s (share)",
                        length(after.linear - before.linear) / length(before.linear), 1e-5, 1e-6));
  const DVec3 spin{before.angular.x, before.angular.y, before.angular.z};
  EXPECT_TRUE(limit_row("S-17 angular momentum lost in 1 s at 16 sub-steps (share)",
                        length(after.angular - spin) / length(spin), 5e-3, 2e-3));
}

TEST(SoftAttachments, DoNotLagBehindTheirBody) {
  for (const BodyType type : {BodyType::kinematic, BodyType::dynamic}) {
    World world = make_world({.sleeping = false});
    BodyDef def = point_body(10.0, {1, 1, 1}, {0, 5, 0});
    def.type = type, def.gravity_scale = 0.0f, def.linear_velocity = {20, 0, 0};
    const BodyId body = world.add_body(def);
    ClothDef flag{.grid = ClothGrid{{1, 1}, {10, 10}}, .pose = {{0.5, 5, 0.5}}, .self_collision = false};
    flag.settings.velocities.assign(121, {20, 0, 0});
    const SoftId cloth = world.add_cloth(flag);
    world.attach(cloth, 0, body), world.attach(cloth, 5, body);
    double most = 0.0;
    for (int i = 0; i < 60; ++i) {
      world.step(kStep);
      const SoftVertices v = world.vertices(cloth);
      const Pose pose = world.pose(body);
      most = std::fmax(most, length(v.position(0) - pose.position - turned(pose.orientation, {0, 0, 0})));
      most = std::fmax(most, length(v.position(5) - pose.position - turned(pose.orientation, {0.5, 0, 0})));
    }
    EXPECT_TRUE(limit_row("S-18 attachment to a body at 20 m/s: lag, m", most, 1e-3, 1e-6));
  }
}

// One spring, held at one end: w = sqrt(k / m), m that of the free end. True if its stretch stays below ten times that at the start.
bool is_stable(SoftIntegrator integrator, double wh) {
  World world = make_world({.gravity = {}, .stepping = {.substeps = 1}, .sleeping = false});
  const double h = double(kStep), mass = 0.05, w = wh / h;
  RopeDef def{.points = {{0, 0, 0}, {1, 0, 0}},
              .links = RopeLinks::springs,
              .linear_density = 0.1f,
              .stretch_stiffness = float(w * w * mass)};
  def.settings.positions = {{0, 0, 0}, {1.001, 0, 0}};
  def.settings.integrator = integrator;
  const SoftId rope = world.add_rope(def);
  world.pin(rope, 0);
  for (int i = 0; i < 300; ++i) {
    if (!world.step(kStep)) return false;
    if (!(std::fabs(world.vertices(rope).x[1] - 1.0) < 0.01)) return false;
  }
  return true;
}
// The greatest w h that is stable, by bisection.
double stable_until(SoftIntegrator integrator) {
  double low = 0.05, high = 6.0;
  for (int n = 0; n < 10; ++n) {
    const double middle = 0.5 * (low + high);
    (is_stable(integrator, middle) ? low : high) = middle;
  }
  return low;
}
TEST(SoftSchemes, AreStableAsFarAsTheirFormulasSay) {
  EXPECT_TRUE(
      limit_row("S-19 explicit Euler: stable w h", stable_until(SoftIntegrator::explicit_euler), 0.15, 0.1));
  EXPECT_TRUE(row("S-19 semi-implicit Euler: stable w h", stable_until(SoftIntegrator::semi_implicit_euler),
                  2.0, 0.04, 0.02));
  EXPECT_TRUE(row("S-19 Verlet: stable w h", stable_until(SoftIntegrator::verlet), 2.0, 0.04, 0.02));
  EXPECT_TRUE(row("S-19 Runge-Kutta 4: stable w h", stable_until(SoftIntegrator::rk4), 2.828, 0.06, 0.03));
  EXPECT_TRUE(is_stable(SoftIntegrator::implicit, 1.0e4));
  EXPECT_TRUE(is_stable(SoftIntegrator::sdirk2, 1.0e4));
}

}  // namespace
}  // namespace gyre::laws::soft_statics_test
