// Gases and liquids against closed forms and tables: decaying vortices, flow between plates, a driven cavity, a tank at rest, waves, floats.
// Sources: G. I. Taylor, A. E. Green, 1937; J. L. M. Poiseuille, 1840; U. Ghia, K. N. Ghia, C. T. Shin, "High-Re Solutions for Incompressible
// Flow Using the Navier-Stokes Equations and a Multigrid Method", 1982; H. Lamb, "Hydrodynamics" (waves in a tank); Archimedes.
#include "laws/kit.h"

namespace gyre::laws {
namespace {

constexpr double kG = kGravity;

// A plane flow in x and y, `cells` in y, as many squares in x as fit.
GasDef plane_flow(double width, double height, int cells) {
  GasDef def;
  const double edge = height / cells;
  def.lower = {}, def.upper = {width, height, edge};
  def.cells = {int(std::lround(width / edge)), cells, 1};
  def.density = 1.0f;
  return def;
}
std::array<FluidBoundary, 6> sides(FluidBoundary x, FluidBoundary y) {
  return {x, x, y, y, FluidBoundary::closed, FluidBoundary::closed};
}

LiquidDef tank(DVec3 size, double depth, float cell) {
  LiquidDef def;
  def.lower = {}, def.upper = size;
  def.cell_size = cell;
  def.fill = {{{}, {size.x, depth, size.z}}};
  return def;
}

// Vortices of Taylor and Green lose their speed as exp(-2 nu k^2 t).
TEST(Gas, VorticesDecayByViscosity) {
  World world = make_world({.gravity = {}});
  const double side = 2.0 * kPiDouble;
  GasDef def = plane_flow(side, side, 48);
  def.viscosity = 0.1f;
  def.sides = sides(FluidBoundary::periodic, FluidBoundary::periodic);
  def.vortices = TaylorGreen{1.0f, {1.0f, 1.0f}};
  const FluidId gas = world.add_gas(def);
  run(world, 1.0);
  const double speed = double(world.probe(gas, {0.5 * kPiDouble, 0.0, 0.0}).velocity.x);
  EXPECT_TRUE(relative_row("F-1 speed of decaying vortices after 1 s", speed, std::exp(-0.2), 5e-3, 1e-3));
}

// Between plates, u = g y (H - y) / (2 nu).
TEST(Gas, FlowsBetweenPlatesAsPoiseuilleSays) {
  World world = make_world({.gravity = {0.8f, 0, 0}});
  GasDef def = plane_flow(0.25, 1.0, 16);
  def.viscosity = 0.5f;
  def.sides = sides(FluidBoundary::periodic, FluidBoundary::no_slip);
  const FluidId gas = world.add_gas(def);
  run(world, 3.0);
  const double speed = double(world.probe(gas, {0.1, 0.5, 0.0}).velocity.x);
  EXPECT_TRUE(relative_row("F-2 speed midway between plates", speed, 0.8 * 0.25 / (2.0 * 0.5), 1e-2, 5e-3));
}

// A box whose lid slides: the speed along the middle line in the table of Ghia et al. at Re 100.
TEST(Gas, TurnsInADrivenCavity) {
  World world = make_world({.gravity = {}});
  GasDef def = plane_flow(1.0, 1.0, 32);
  def.viscosity = 0.01f;
  def.sides = sides(FluidBoundary::no_slip, FluidBoundary::no_slip);
  def.wall_velocities[3] = {1, 0, 0};
  const FluidId gas = world.add_gas(def);
  run(world, 20.0);
  struct Row {
    double y, u;
  };
  double sum = 0.0;
  const Row rows[] = {{0.9531, 0.68717},  {0.8516, 0.23151},  {0.7344, 0.00332},  {0.6172, -0.13641},
                      {0.5, -0.20581},    {0.4531, -0.21090}, {0.2813, -0.15662}, {0.1719, -0.10150},
                      {0.1016, -0.06434}, {0.0625, -0.04192}};
  for (const Row row : rows) {
    const double error = double(world.probe(gas, {0.5, row.y, 0.0}).velocity.x) - row.u;
    sum += error * error / 10.0;
  }
  EXPECT_TRUE(limit_row("F-3 driven cavity, Re 100, root of the mean square", std::sqrt(sum), 0.02, 0.005));
}

TEST(Liquid, PressesByItsDepth) {
  World world = make_world();
  const FluidId pool = world.add_liquid(tank({0.8, 0.8, 0.4}, 0.5, 0.05f));
  run(world, 2.0);
  EXPECT_TRUE(relative_row("F-4 pressure 0.4 m deep", double(world.probe(pool, {0.4, 0.1, 0.2}).pressure),
                           1000.0 * kG * 0.4, 1e-2, 5e-3));
  EXPECT_TRUE(relative_row("F-5 volume of a tank at rest", world.fluid_info(pool).volume, 0.8 * 0.4 * 0.5,
                           1e-2, 1e-3));
}

// The first wave of a tank: w^2 = g k tanh(k h), k = pi / L.
TEST(Liquid, SloshesAtItsPeriod) {
  World world = make_world();
  // Steps of a column form a slope: the first wave, as good as it matters.
  LiquidDef def = tank({1.0, 0.8, 1.0 / 32}, 0.5, 1.0f / 32);
  def.fill.clear();
  for (int i = 0; i < 32; ++i) {
    const double x = (i + 0.5) / 32.0;
    def.fill.push_back({{i / 32.0, 0, 0}, {(i + 1) / 32.0, 0.5 + 0.03 * std::cos(kPiDouble * x), 1.0 / 32}});
  }
  const FluidId pool = world.add_liquid(def);
  ZeroCrossings through;
  for (int i = 0; i < 240; ++i) {
    const double left = double(world.probe(pool, {0.08, 0.3, 0.01}).surface);
    const double right = double(world.probe(pool, {0.92, 0.3, 0.01}).surface);
    through.add(double(i) * double(kStep), left - right);
    world.step(kStep);
  }
  ASSERT_GE(through.count(), 3);
  EXPECT_TRUE(relative_row("F-6 period of sloshing", through.mean_period(), 1.18182, 3e-2, 1e-2));
}

// A box floats as deep as its density says.
TEST(Liquid, CarriesWhatItDisplaces) {
  World world = make_world();
  add_ground(world);
  constexpr float kRatio = 0.6f, kHeight = 0.24f;
  BodyDef body;
  body.pose.position = {0.42, 0.36 + double(kHeight) * (0.5 - double(kRatio)), 0.42};
  const BodyId box = world.add_body(
      body, ShapeDef{.geometry = Box{{0.24f, 0.5f * kHeight, 0.24f}}, .density = 1000.0f * kRatio});
  const FluidId pool = world.add_liquid(tank({0.84, 0.6, 0.84}, 0.36, 0.04f));
  run(world, 1.5);
  double mean = 0.0;
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    mean += world.pose(box).position.y / 60.0;
  }
  const double level = double(world.probe(pool, {0.06, 0.3, 0.06}).surface);
  const double draft = (level - mean + 0.5 * double(kHeight)) / double(kHeight);
  EXPECT_TRUE(relative_row("F-7 draft of a box of 600 kg/m^3", draft, double(kRatio), 5e-2, 3e-2));
}

}  // namespace
}  // namespace gyre::laws
