// Ropes, cloth and solids against closed forms: catenary, hanging chain, capstan, elastica, bars and strips under their own weight.
// Sources: J. P. Den Hartog, "Mechanics" (catenary, capstan); D. Bernoulli, 1733 (chain); the elastica's own differential equation,
// solved by shooting, for a cantilever under its own weight; S. Timoshenko, J. Goodier, "Theory of Elasticity" (bars).
#include "laws/soft_kit.h"

namespace gyre::laws::soft_test {
namespace {

constexpr double kG = kGravity;

TEST(Rope, HangsAsACatenary) {
  struct Case {
    double length, sag;
  };
  for (const Case c : {Case{1.05, 0.139304}, Case{1.2, 0.292344}, Case{2.0, 0.796388}}) {
    World world = make_world();
    // A tent of the right length, ends 1 m apart.
    const double depth = std::sqrt(0.25 * c.length * c.length - 0.25);
    std::vector<DVec3> points = line({-0.5, 0, 0}, {0, -depth, 0}, 50);
    for (const DVec3 p : line({0, -depth, 0}, {0.5, 0, 0}, 50))
      if (p.x > 1e-9) points.push_back(p);
    const SoftId rope = world.add_rope({.points = points});
    world.pin(rope, 0), world.pin(rope, 100);
    add_brake(world, 6.0f);
    run(world, 6.0);
    double low = 0.0;
    const SoftVertices v = world.vertices(rope);
    for (std::size_t i = 0; i < v.size(); ++i) low = std::fmin(low, v.y[i]);
    EXPECT_TRUE(relative_row("S-1 sag of a catenary", -low, c.sag, 5e-3, 1e-3));
  }
}

TEST(Rope, SwingsAsAHangingChain) {
  World world = make_world({.sleeping = false});
  std::vector<DVec3> points;
  const double frequency = 1.20241 * std::sqrt(kG);  // of a chain of 1 m
  // The first mode is J0(2 w sqrt(z / g)), z from the free end.
  for (int i = 0; i <= 60; ++i) {
    const double z = 1.0 - i / 60.0;
    points.push_back({0.01 * std::cyl_bessel_j(0.0, 2.0 * frequency * std::sqrt(z / kG)), z, 0});
  }
  const SoftId rope = world.add_rope({.points = points});
  world.pin(rope, 0);
  ZeroCrossings through;
  for (int i = 0; i < 600 && through.count() < 4; ++i) {
    through.add(double(i) * double(kStep), world.vertices(rope).x[60]);
    world.step(kStep);
  }
  ASSERT_GE(through.count(), 3);
  EXPECT_TRUE(relative_row("S-2 period of a hanging chain", through.mean_period(),
                           2.0 * kPiDouble / frequency, 2e-2, 5e-3));
}

// The first mode of a hanging chain of rods, whose amplitude after ten periods the factor of the scheme tells: backward Euler keeps
// (1 + (w h)^2)^(-1/2) of it in each sub-step, sdirk2 nearly all.
double share_after_ten_periods(SoftIntegrator integrator) {
  World world = make_world({.sleeping = false});
  const double frequency = 1.20241 * std::sqrt(kG);
  RopeDef def;
  for (int i = 0; i <= 60; ++i) {
    const double z = 1.0 - i / 60.0;
    def.points.push_back({0.01 * std::cyl_bessel_j(0.0, 2.0 * frequency * std::sqrt(z / kG)), z, 0});
  }
  def.settings.integrator = integrator;
  const SoftId rope = world.add_rope(def);
  world.pin(rope, 0);
  double first = 0.0, last = 0.0;
  const int period = int(2.0 * kPiDouble / frequency * 60.0);
  for (int i = 0; i < 10 * period; ++i) {
    world.step(kStep);
    const double off = std::fabs(world.vertices(rope).x[60]);
    if (i < period) first = std::fmax(first, off);
    if (i >= 9 * period) last = std::fmax(last, off);
  }
  return last / first;
}
TEST(Rope, SwingsOnWithTheSchemeOfTwoStages) {
  const double wh = 1.20241 * std::sqrt(kG) / 240.0, steps = 9.0 * 2.0 * kPiDouble / wh;
  EXPECT_TRUE(relative_row("S-9 backward Euler, amplitude after 9 periods",
                           share_after_ten_periods(SoftIntegrator::implicit),
                           std::pow(1.0 + wh * wh, -0.5 * steps), 5e-2, 1e-2));
  EXPECT_TRUE(relative_row("S-10 sdirk2, amplitude after 9 periods",
                           share_after_ten_periods(SoftIntegrator::sdirk2), 1.0, 2e-2, 5e-3));
}

// Where the corner of a swinging sheet, or the end of a rope of springs, is after 0.4 s, with this many sub-steps.
DVec3 swung(SoftIntegrator integrator, bool is_cloth, int substeps) {
  World world = make_world({.stepping = {.substeps = substeps}, .sleeping = false});
  SoftId soft;
  if (is_cloth) {
    ClothDef def;
    def.grid = ClothGrid{{0.5f, 1.0f}, {3, 6}};
    def.stretch_stiffness = 15.0f, def.shear_stiffness = 5.0f, def.bend_stiffness = 0.0f,
    def.self_collision = false;
    def.settings.integrator = integrator;
    soft = world.add_cloth(def);
    for (int i = 0; i <= 3; ++i) world.pin(soft, i);
  } else {
    RopeDef def{
        .points = line({0, 0, 0}, {1, 0, 0}, 6), .links = RopeLinks::springs, .stretch_stiffness = 10.0f};
    def.settings.integrator = integrator;
    soft = world.add_rope(def);
    world.pin(soft, 0);
  }
  run(world, 0.4);
  const SoftVertices v = world.vertices(soft);
  return v.position(v.size() - 1);
}
// Errors fall with the square of the sub-step, until at 1e-5 m the tolerance of the solver and the rounding of velocities show; those of backward Euler with the sub-step.
TEST(Soft, TheSchemeOfTwoStagesIsOfSecondOrder) {
  for (const bool is_cloth : {false, true}) {
    const DVec3 exact = swung(SoftIntegrator::sdirk2, is_cloth, 64);
    const auto order = [&](SoftIntegrator integrator) {
      const double coarse = length(swung(integrator, is_cloth, 1) - exact),
                   fine = length(swung(integrator, is_cloth, 2) - exact);
      return std::log2(coarse / fine);
    };
    EXPECT_NEAR(order(SoftIntegrator::sdirk2), 2.0, 0.3) << is_cloth;
    EXPECT_NEAR(order(SoftIntegrator::implicit), 1.0, 0.2) << is_cloth;
    EXPECT_LT(length(swung(SoftIntegrator::sdirk2, is_cloth, 2) - exact),
              0.1 * length(swung(SoftIntegrator::implicit, is_cloth, 2) - exact));
  }
}

// A rope over a fixed cylinder holds loads up to a ratio of exp(mu phi).
TEST(Rope, HoldsOnACapstan) {
  const auto slips = [](double ratio) {
    World world = make_world({.sleeping = false});
    BodyDef post;
    post.type = BodyType::fixed;
    post.pose.orientation = {0.70710678f, 0, 0, 0.70710678f};
    world.add_body(post, ShapeDef{.geometry = Cylinder{0.5f, 0.5f}, .material = surface(0.3f)});
    const float radius = 0.01f;
    const double r = 0.5 + double(radius);
    std::vector<DVec3> points;
    for (int i = 0; i < 10; ++i) points.push_back({-r, -1.0 + 0.1 * i, 0});
    for (int i = 0; i <= 32; ++i)
      points.push_back({-r * std::cos(kPiDouble * i / 32), r * std::sin(kPiDouble * i / 32), 0});
    for (int i = 1; i <= 10; ++i) points.push_back({r, -0.1 * i, 0});
    RopeDef def{.points = points, .radius = radius, .linear_density = 0.01f};
    def.settings.static_friction = def.settings.dynamic_friction = 0.3f;
    const SoftId rope = world.add_rope(def);
    const int last = int(points.size()) - 1;
    const BodyId light = world.add_body(point_body(1.0, {0.01f, 0.01f, 0.01f}, points.front()));
    const BodyId heavy = world.add_body(point_body(ratio, {0.01f, 0.01f, 0.01f}, points.back()));
    world.attach(rope, 0, light), world.attach(rope, last, heavy);
    run(world, 0.5);
    return world.linear_velocity(heavy).y < -0.02f;
  };
  double low = 2.0, high = 3.2;
  for (int n = 0; n < 5; ++n) {
    const double middle = 0.5 * (low + high);
    (slips(middle) ? high : low) = middle;
  }
  EXPECT_TRUE(relative_row("S-3 capstan, half a turn, mu 0.3", 0.5 * (low + high), 2.5663, 5e-2, 1e-2));
}

// A rope with bending stiffness, clamped and level, bends under its own weight: w L^3 / EI = 1, 5, 10.
TEST(Rope, BendsAsTheElastica) {
  struct Case {
    double load, drop;
  };
  for (const Case c : {Case{1, 0.12347}, Case{5, 0.49591}, Case{10, 0.70020}}) {
    World world = make_world();
    constexpr int kSegments = 40;
    const float density = 0.1f;
    RopeDef def{.points = line({-1.0 / kSegments, 0, 0}, {1, 0, 0}, kSegments + 1),
                .linear_density = density,
                .bend_stiffness = float(double(density) * kG / c.load)};
    const SoftId rope = world.add_rope(def);
    world.pin(rope, 0), world.pin(rope, 1);
    add_brake(world, 8.0f);
    run(world, 4.0);
    EXPECT_TRUE(relative_row("S-4 elastica under its own weight", -world.vertices(rope).y[kSegments + 1],
                             c.drop, 2e-2, 5e-3));
  }
}

// A strip of cloth hangs longer by rho g L^2 / (2 k), whatever its cells and links.
TEST(Cloth, AStripHangsLongerByItsWeight) {
  for (const ClothLinks links : {ClothLinks::springs, ClothLinks::membrane}) {
    for (const int cells : {10, 30}) {
      World world = make_world();
      ClothDef def{.grid = ClothGrid{{0.2f, 1.0f}, {cells / 5, cells}},
                   .links = links,
                   .stretch_stiffness = 100.0f,
                   .shear_stiffness = 20.0f,
                   .thickness = 0.0f};
      def.pose.orientation = {0.70710678f, 0, 0, 0.70710678f};  // z of the grid points down
      const SoftId cloth = world.add_cloth(def);
      const int columns = cells / 5 + 1;
      for (int i = 0; i < columns; ++i) world.pin(cloth, i);
      const auto span = [&] {
        const SoftVertices v = world.vertices(cloth);
        return length(v.position(v.size() - 1) - v.position(std::size_t(columns) - 1));
      };
      const double before = span();
      add_brake(world, 20.0f);
      run(world, 2.0);
      const double expected = 0.2 * kG / (2.0 * 100.0);
      EXPECT_TRUE(
          relative_row(links == ClothLinks::springs ? "S-5 strip of springs" : "S-5 strip of membrane",
                       span() - before, expected, 2e-2, 1e-2));
    }
  }
}

// A sheet on a slope slides with g (sin a - mu cos a), and stops and stays where mu is above tan a.
TEST(Cloth, SlidesAndStopsByCoulombsLaw) {
  const auto slide = [](double slope, float speed, double seconds, double after) {
    World world = make_world({.sleeping = false});
    const double angle = std::atan(slope);
    BodyDef ground;
    ground.type = BodyType::fixed;
    ground.pose.orientation = {0, 0, float(-std::sin(0.5 * angle)), float(std::cos(0.5 * angle))};
    world.add_body(ground, {.geometry = Plane{}, .material = surface(0.4f)});
    ClothDef def{.grid = ClothGrid{{0.4f, 0.4f}, {6, 6}}, .links = ClothLinks::membrane, .thickness = 0.01f};
    def.pose.orientation = ground.pose.orientation;
    def.pose.position = {0.005 * std::sin(angle), 0.005 * std::cos(angle), 0};
    const Vec3 down{float(std::cos(angle)), float(-std::sin(angle)), 0};
    def.settings.velocities.assign(49, speed * down);
    const SoftId cloth = world.add_cloth(def);
    run(world, seconds);
    const DVec3 before = world.vertices(cloth).position(24);
    run(world, after);
    return dot(world.vertices(cloth).position(24) - before, wide(down));
  };
  const double slope = 0.6, angle = std::atan(slope), a = kG * (std::sin(angle) - 0.4 * std::cos(angle));
  EXPECT_TRUE(relative_row("S-8 sheet slides down a slope of 0.6", slide(slope, 0.0f, 0.5, 0.5),
                           0.5 * a * (1.0 - 0.25), 2e-2, 1e-2));
  EXPECT_TRUE(limit_row("S-8 sheet that has stopped on a slope of 0.3, m",
                        std::fabs(slide(0.3, 1.0f, 1.5, 2.0)), 1e-5, 1e-9));
}

TEST(Solid, ABarHangsLongerByItsWeight) {
  for (const SolidModel model : {SolidModel::linear, SolidModel::corotated, SolidModel::neo_hookean}) {
    World world = make_world();
    SolidDef def{.box = SolidBox{{0.05f, 0.5f, 0.05f}, {1, 10, 1}},
                 .model = model,
                 .young_modulus = 1.0e6f,
                 .poisson_ratio = 0.0f};
    const SoftId bar = world.add_solid(def);
    for (const int k : {0, 1})
      for (const int i : {0, 1}) world.pin(bar, i + 2 * (10 + 11 * k));
    const auto end = [&] {
      const SoftVertices v = world.vertices(bar);
      return 0.25 * (v.y[0] + v.y[1] + v.y[22] + v.y[23]);
    };
    const double before = end();
    add_brake(world, 20.0f);
    run(world, 1.0);
    EXPECT_TRUE(relative_row("S-6 bar under its own weight", before - end(), 1000.0 * kG / (2.0 * 1.0e6),
                             1e-2, 5e-3));
  }
}

// The first oscillation of a bar of solid, and how fast backward Euler damps it: 1 / sqrt(1 + (w h)^2) a sub-step.
// A beam clamped at one end swings under its own weight. Its material takes w^2 beta / 2 from an amplitude in a second and backward Euler
// w^2 h / 2; a solver that stops too early keeps it swinging, and lets an overdamped one never rest.
TEST(Solid, AFineBeamSwingsOutAndRests) {
  const auto swing = [](float damping, double seconds, double last) {
    World world = make_world({.sleeping = false});
    const std::array<int, 3> cells{24, 6, 6};
    const SoftId beam = world.add_solid({.box = SolidBox{{0.5f, 4.0f / 30.0f, 4.0f / 30.0f}, cells},
                                         .model = SolidModel::corotated,
                                         .young_modulus = 1.0e6f,
                                         .poisson_ratio = 0.3f,
                                         .settings = {.damping = damping}});
    const std::uint32_t columns = std::uint32_t(cells[0]) + 1;
    for (std::uint32_t v = 0; v < std::uint32_t(world.soft_info(beam).vertices); v += columns)
      world.pin(beam, v);
    double first = 0.0, end = 0.0;
    for (double t = 0.0; t < seconds; t += double(kStep)) {
      world.step(kStep);
      const double kinetic = world.soft_info(beam).kinetic_energy;
      if (t < 0.8) first = std::max(first, kinetic);
      if (t > seconds - last) end = std::max(end, kinetic);
    }
    return end / first;
  };
  // w = 8.5 rad/s: e^(-1.74 t) of the energy is left, 0.3 % after 3.3 s; what the tolerance of the solver leaves is more.
  EXPECT_TRUE(limit_row("beam with damping 0.02 s: energy left after 3.2 s (share)", swing(0.02f, 4.0, 0.8),
                        0.05, 0.01));
  EXPECT_TRUE(limit_row("overdamped beam: energy left after 2 s (share)", swing(0.2f, 2.2, 0.2), 1e-3, 1e-6));
}

TEST(Solid, ABarRingsAndDies) {
  World world = make_world({.gravity = {}, .sleeping = false});
  SolidDef def{.box = SolidBox{{0.05f, 0.5f, 0.05f}, {1, 20, 1}},
               .model = SolidModel::corotated,
               .young_modulus = 4.0e3f,
               .poisson_ratio = 0.0f};
  const SoftId bar = world.add_solid(def);
  std::vector<DVec3> positions;
  const SoftVertices start = world.vertices(bar);
  for (std::size_t i = 0; i < start.size(); ++i) {
    DVec3 p = start.position(i);
    p.y -= 0.005 * std::sin(0.5 * kPiDouble * (0.5 - p.y));
    positions.push_back(p);
  }
  for (const int k : {0, 1})
    for (const int i : {0, 1}) world.pin(bar, i + 2 * (20 + 21 * k));
  world.set_vertices(bar, positions, {});
  const double w = 0.5 * kPiDouble * std::sqrt(4.0e3 / 1000.0);  // of the first mode, rad/s
  const double rest = -0.5;
  ZeroCrossings through;
  double first = 0.0, last = 0.0, peak = 0.0, before = 0.0;
  for (int i = 0; i < 700 && through.count() < 4; ++i) {
    const double now = rest - world.vertices(bar).y[0];
    through.add(double(i) * double(kStep), now);
    if (before >= 0.0 && now < 0.0) {
      if (through.count() == 1) first = peak;
      last = peak, peak = 0.0;
    }
    peak = std::fmax(peak, now);
    before = now;
    world.step(kStep);
  }
  ASSERT_GE(through.count(), 3);
  EXPECT_TRUE(relative_row("S-7 period of a bar", through.mean_period(), 2.0 * kPiDouble / w, 3e-2, 1e-2));
  const double h = double(kStep) / 4.0, periods = double(through.count() - 2);
  const double expected = -periods * (2.0 * kPiDouble / w / h) * 0.5 * std::log(1.0 + w * h * w * h);
  EXPECT_TRUE(relative_row("S-7 loss of its amplitude, log", std::log(last / first), expected, 0.1, 0.05));
}

}  // namespace
}  // namespace gyre::laws::soft_test
