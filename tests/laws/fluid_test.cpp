// Gases and liquids against closed forms and tables: decaying vortices, flow between plates, a driven cavity, a duct, a vortex ring, smoke, a
// tank at rest, waves, floats, a hole in a tank, connected vessels, a bucket that turns, a block that tips.
// Sources: G. I. Taylor, A. E. Green, 1937; J. L. M. Poiseuille, 1840; U. Ghia, K. N. Ghia, C. T. Shin, "High-Re Solutions for Incompressible
// Flow Using the Navier-Stokes Equations and a Multigrid Method", 1982; H. Lamb, "Hydrodynamics" (waves in a tank); Archimedes;
// E. Torricelli, 1644; L. Rosenhead, "The Spread of Vorticity in the Wake Behind a Cylinder", 1930.
#include "laws/kit.h"

namespace gyre::laws::fluid_test {
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
  double most = 0.0;
  for (const double y : {0.0, 0.01, 0.03, 0.1, 0.25, 0.8, 0.98, 1.0}) {
    const double exact = 0.8 * y * (1.0 - y) / (2.0 * 0.5);
    most = std::max(most, std::fabs(double(world.probe(gas, {0.1, y, 0.0}).velocity.x) - exact));
  }
  EXPECT_TRUE(limit_row("F-41 largest error between plates and on them over the speed midway", most / 0.2,
                        1e-2, 5e-3));
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
  const FluidId pool = world.add_liquid(tank({0.8, 0.8, 0.2}, 0.5, 0.05f));
  run(world, 10.0);
  double most = 0.0;
  for (const double y : {0.0, 0.01, 0.1, 0.22, 0.4}) {
    const double exact = 1000.0 * kG * (0.5 - y);
    most = std::max(most, std::fabs(double(world.probe(pool, {0.4, y, 0.1}).pressure) / exact - 1.0));
  }
  EXPECT_TRUE(limit_row("F-4 pressure from 0.1 m to the floor 0.5 m deep, largest error over the exact one",
                        most, 1e-2, 5e-3));
  EXPECT_TRUE(relative_row("F-5 volume of a tank at rest for 10 s", world.fluid_info(pool).volume,
                           0.8 * 0.2 * 0.5, 1e-3, 2e-4));
}

// The period of a wave of a tank with this many half waves, in a plane flow.
double wave_period(double length, double depth, int cells, int half_waves, double seconds) {
  World world = make_world();
  const double edge = length / cells, k = half_waves * kPiDouble / length;
  // Steps of columns form the wave.
  LiquidDef def = tank({length, 1.6 * depth, edge}, depth, float(edge));
  def.fill.clear();
  for (int i = 0; i < cells; ++i) {
    const double top = depth + 0.03 * depth * std::cos(k * (i + 0.5) * edge);
    def.fill.push_back({{i * edge, 0, 0}, {(i + 1) * edge, top, edge}});
  }
  const FluidId pool = world.add_liquid(def);
  // Where the first wave is half of a period ahead of that at the left side, its level has the opposite sign.
  const double right = half_waves == 1 ? length - 2.5 * edge : length / half_waves;
  ZeroCrossings through;
  const int steps = int(seconds * 120);
  for (int i = 0; i < steps; ++i) {
    const double at_left = double(world.probe(pool, {2.5 * edge, 0.5 * depth, 0.01}).surface);
    const double at_right = double(world.probe(pool, {right, 0.5 * depth, 0.01}).surface);
    through.add(i / 120.0, at_left - at_right);
    world.step(1.0f / 120);
  }
  return through.count() >= 3 ? through.mean_period() : 0.0;
}

// Waves of a tank: w^2 = g k tanh(k h), k = n pi / L.
TEST(Liquid, SloshesAtItsPeriod) {
  EXPECT_TRUE(relative_row("F-6 period of sloshing", wave_period(1.0, 0.5, 64, 1, 4.0), 1.18182, 3e-2, 1e-2));
  EXPECT_TRUE(
      relative_row("F-42 period of the second wave", wave_period(1.0, 0.5, 64, 2, 3.0), 0.80180, 3e-2, 1e-2));
  EXPECT_TRUE(
      relative_row("F-42 period of the third wave", wave_period(1.0, 0.5, 64, 3, 3.0), 0.65350, 3e-2, 1e-2));
  EXPECT_TRUE(relative_row("F-42 period of the first wave, half as deep", wave_period(1.0, 0.25, 64, 1, 4.0),
                           1.39761, 3e-2, 1e-2));
  EXPECT_TRUE(relative_row("F-42 period of the first wave, twice as long", wave_period(2.0, 0.5, 64, 1, 6.0),
                           1.97652, 3e-2, 1e-2));
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
  double mean = 0.0, lift = 0.0, wet = 0.0;
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    mean += world.pose(box).position.y / 60.0;
    const FluidLoad load = world.fluid_load(box);
    lift += double(load.force.y) / 60.0, wet += load.wet_volume / 60.0;
  }
  const double level = double(world.probe(pool, {0.06, 0.3, 0.06}).surface);
  const double draft = (level - mean + 0.5 * double(kHeight)) / double(kHeight);
  const double mass = double(world.mass_properties(box).mass);
  EXPECT_TRUE(
      relative_row("F-19 mean lift of a floating box over its weight", lift / (mass * kG), 1.0, 5e-2, 1e-2));
  EXPECT_TRUE(relative_row("F-20 mean wet volume by the density of the liquid over the mass",
                           1000.0 * wet / mass, 1.0, 5e-2, 3e-2));
  EXPECT_TRUE(relative_row("F-7 draft of a box of 600 kg/m^3", draft, double(kRatio), 5e-2, 3e-2));
}

// A square duct of side a: 0.0736714 G a^2 / mu in its middle.
TEST(Gas, FlowsInASquareDuct) {
  constexpr int kCells = 24;
  World world = make_world({.gravity = {1.0f, 0, 0}});
  GasDef def;
  def.lower = {}, def.upper = {2.0 / kCells, 1, 1};
  def.cells = {2, kCells, kCells};
  def.density = 1.0f, def.viscosity = 0.5f;
  def.sides = {FluidBoundary::periodic, FluidBoundary::periodic, FluidBoundary::no_slip,
               FluidBoundary::no_slip,  FluidBoundary::no_slip,  FluidBoundary::no_slip};
  const FluidId gas = world.add_gas(def);
  run(world, 1.5);
  const double speed = double(world.probe(gas, {0.03, 0.5, 0.5}).velocity.x);
  EXPECT_TRUE(relative_row("F-8 speed in the middle of a square duct", speed, 0.0736714 / 0.5, 2e-2, 1e-2));
}

// The impulse of a flow along x over its density, m^4/s: half of the sum of r x vorticity (H. Lamb, "Hydrodynamics").
double impulse_of(const World& world, FluidId gas) {
  const GasDef def = world.gas_def(gas);
  const GasFields& fields = *def.fields;
  const int nx = def.cells[0], ny = def.cells[1], nz = def.cells[2];
  const double h = (def.upper.x - def.lower.x) / nx;
  const auto v = [&](int i, int j, int k) {
    return double(fields.velocity_y[std::size_t(i + nx * (j + (ny + 1) * k))]);
  };
  const auto w = [&](int i, int j, int k) {
    return double(fields.velocity_z[std::size_t(i + nx * (j + ny * k))]);
  };
  const auto u = [&](int i, int j, int k) {
    return double(fields.velocity_x[std::size_t(i + (nx + 1) * (j + ny * k))]);
  };
  double sum = 0.0;
  for (int k = 1; k < nz; ++k) {
    for (int j = 1; j < ny; ++j) {
      for (int i = 1; i < nx; ++i) {
        const double about_z = (v(i, j, k) - v(i - 1, j, k)) - (u(i, j, k) - u(i, j - 1, k));
        const double about_y = (u(i, j, k) - u(i, j, k - 1)) - (w(i, j, k) - w(i - 1, j, k));
        sum += (def.lower.y + h * j) * about_z - (def.lower.z + h * k) * about_y;
      }
    }
  }
  return 0.5 * h * h * sum;
}

constexpr int kRingCells[3] = {48, 40, 40};
constexpr double kRingCell = 1.0 / 40, kRingRadius = 8 * kRingCell, kRingCore = 2 * kRingCell,
                 kCirculation = 0.1;

// A vortex ring about the x axis, in the middle of the box, with the core of the kernel of L. Rosenhead, 1930.
FluidId add_ring(World& world, FluidBoundary side) {
  GasDef def;
  def.lower = {0, -0.5, -0.5}, def.upper = {kRingCells[0] * kRingCell, 0.5, 0.5};
  def.cells = {kRingCells[0], kRingCells[1], kRingCells[2]};
  def.sides.fill(side);
  GasFields fields;
  std::vector<float>* const velocity[3] = {&fields.velocity_x, &fields.velocity_y, &fields.velocity_z};
  constexpr int kParts = 48;
  for (int axis = 0; axis < 3; ++axis) {
    int count[3];
    for (int a = 0; a < 3; ++a) count[a] = kRingCells[a] + (a == axis ? 1 : 0);
    for (int i = 0; i < count[0] * count[1] * count[2]; ++i) {
      const int index[3] = {i % count[0], i / count[0] % count[1], i / count[0] / count[1]};
      DVec3 at{index[0] * kRingCell, index[1] * kRingCell - 0.5, index[2] * kRingCell - 0.5};
      (axis == 0 ? at.y : at.x) += 0.5 * kRingCell;
      (axis == 2 ? at.y : at.z) += 0.5 * kRingCell;
      DVec3 sum{};
      for (int part = 0; part < kParts; ++part) {
        const double angle = 2 * kPiDouble * part / kParts, c = std::cos(angle), s = std::sin(angle);
        const DVec3 away = at - DVec3{0.4, kRingRadius * c, kRingRadius * s};
        const double far = dot(away, away) + kRingCore * kRingCore;
        sum += (1.0 / (far * std::sqrt(far))) * cross(DVec3{0, -s, c}, away);
      }
      sum = (kCirculation / (4 * kPiDouble) * 2 * kPiDouble * kRingRadius / kParts) * sum;
      velocity[axis]->push_back(float(axis == 0 ? sum.x : axis == 1 ? sum.y : sum.z));
    }
  }
  const std::size_t cells = std::size_t(kRingCells[0] * kRingCells[1] * kRingCells[2]);
  fields.density.resize(cells, 0.0f), fields.pressure.resize(cells, 0.0f);
  fields.temperature.resize(cells, def.ambient_temperature);
  def.fields = fields;
  return world.add_gas(def);
}

// The ring moves with G / (4 pi R) (ln(8 R / d) - 1), G its circulation.
TEST(Gas, CarriesAVortexRing) {
  World world = make_world({.gravity = {}});
  const FluidId gas = add_ring(world, FluidBoundary::open);
  // The ring is where the speed on the axis is greatest.
  const auto place = [&] {
    double best = 0.0, at = 0.0;
    for (int i = 1; i < kRingCells[0] * 4; ++i) {
      const double x = i * 0.25 * kRingCell, speed = double(world.probe(gas, {x, 0, 0}).velocity.x);
      if (speed > best) best = speed, at = x;
    }
    const auto speed = [&](double x) { return double(world.probe(gas, {x, 0, 0}).velocity.x); };
    const double low = speed(at - 2 * kRingCell), high = speed(at + 2 * kRingCell);
    return at + kRingCell * (high - low) / (2 * best - low - high);
  };
  run(world, 0.25);
  const double begin = place();
  constexpr double kTime = 1.5;
  run(world, kTime);
  const double expected =
      kCirculation / (4 * kPiDouble * kRingRadius) * (std::log(8 * kRingRadius / kRingCore) - 1.0);
  EXPECT_TRUE(relative_row("F-9 speed of a vortex ring", (place() - begin) / kTime, expected, 1e-1, 3e-2));
}

// In a closed box, since air that enters an open side comes from rest and takes 4 % of the impulse.
TEST(Gas, KeepsTheImpulseOfAVortexRing) {
  World world = make_world({.gravity = {}});
  const FluidId gas = add_ring(world, FluidBoundary::closed);
  run(world, 0.25);
  const double before = impulse_of(world, gas);
  run(world, 0.75);
  EXPECT_TRUE(
      relative_row("F-36 impulse of a vortex ring after 0.75 s", impulse_of(world, gas), before, 2e-2, 5e-3));
}

// In a closed box smoke is kept, however it is stirred; a body that moves leaves no cell with more than a little divergence.
TEST(Gas, KeepsItsSmoke) {
  World world = make_world();
  GasDef def;
  def.cells = {24, 24, 24};
  def.sides.fill(FluidBoundary::closed);
  def.emitters = {{.position = {0, 0.5, 0}, .radius = 0.3f, .temperature = 350.0f, .end = 0.01}};
  def.vortices = TaylorGreen{1.0f, {3.14159f, 3.14159f}};
  const FluidId gas = world.add_gas(def);
  world.step(kStep);
  const double before = world.fluid_info(gas).smoke_mass;
  run(world, 2.0);
  EXPECT_TRUE(relative_row("F-10 smoke in a closed box after 2 s", world.fluid_info(gas).smoke_mass, before,
                           5e-3, 1e-4));
}

// A bar that turns in the smoke covers cells and leaves others.
TEST(Gas, KeepsItsSmokeAboutAStirrer) {
  World world = make_world();
  BodyDef bar{.type = BodyType::kinematic, .angular_velocity = {0, 3, 0}};
  bar.pose.position = {0.5, 0.5, 0.5};
  world.add_body(bar, {.geometry = Box{{0.3f, 0.05f, 0.05f}}});
  GasDef def;
  def.lower = {}, def.upper = {1, 1, 1}, def.cells = {20, 20, 20};
  def.sides.fill(FluidBoundary::closed);
  def.emitters = {{.position = {0.5, 0.2, 0.5}, .radius = 0.15f, .temperature = 330.0f, .end = 1e-3}};
  const FluidId gas = world.add_gas(def);
  world.step(kStep);
  const double before = world.fluid_info(gas).smoke_mass;
  run(world, 2.0);
  EXPECT_TRUE(relative_row("F-46 smoke in a closed box with a bar that turns, after 2 s",
                           world.fluid_info(gas).smoke_mass, before, 5e-2, 3e-2));
}

// In gas at rest the heat that is released is what the gas gains and what the burned fuel held; fuel falls as exp(-k t), and cold fuel stays.
TEST(Gas, BurnsItsFuelToItsHeat) {
  World world = make_world({.gravity = {}});
  GasDef def;
  def.lower = {}, def.upper = {1, 1, 1}, def.cells = {8, 8, 8};
  def.sides.fill(FluidBoundary::closed);
  def.combustion = Combustion{.ignition_temperature = 500.0f, .burn_rate = 3.0f, .smoke_yield = 0.25f};
  GasFields fields;
  fields.velocity_x.assign(9 * 64, 0.0f), fields.velocity_y.assign(9 * 64, 0.0f),
      fields.velocity_z.assign(9 * 64, 0.0f);
  fields.density.assign(512, 0.0f), fields.pressure.assign(512, 0.0f);
  double hot = 0.0, cold = 0.0;
  for (int i = 0; i < 512; ++i) {
    const bool burns = i % 3 != 0;
    fields.temperature.push_back(burns ? 700.0f : 300.0f);
    fields.fuel.push_back(0.001f * float(1 + i % 7));
    (burns ? hot : cold) += double(fields.fuel.back()) / 512.0;
  }
  def.fields = fields;
  const FluidId gas = world.add_gas(def);
  const auto heat = [&] {
    std::vector<float> cells(512);
    world.fluid_field(gas, FluidField::temperature, cells);
    double sum = 0.0;
    for (const float one : cells)
      sum += double(one) * double(def.density) * double(def.combustion->heat_capacity) / 512.0;
    return sum;
  };
  const double before = heat();
  double released = 0.0;
  for (int i = 0; i < 30; ++i) {
    world.step(kStep);
    released += world.fluid_info(gas).heat_rate * double(kStep);
  }
  const double left = world.fluid_info(gas).fuel_mass, burned = hot + cold - left;
  EXPECT_TRUE(relative_row("F-11 heat of combustion over that of the burned fuel",
                           released / (4.6e7 * burned), 1.0, 1e-5, 1e-6));
  EXPECT_TRUE(relative_row("F-11 heat that the gas gained over that released", (heat() - before) / released,
                           1.0, 1e-5, 1e-6));
  EXPECT_TRUE(
      relative_row("F-11 hot fuel after half a second", left - cold, hot * std::exp(-1.5), 1e-5, 1e-6));
  EXPECT_TRUE(relative_row("F-11 smoke from the burned fuel", world.fluid_info(gas).smoke_mass, 0.25 * burned,
                           1e-5, 1e-6));
}

// A flame that stirs the gas in a closed box: what burned is what the box has lost of its fuel.
TEST(Gas, KeepsItsFuelUntilItBurns) {
  World world = make_world();
  GasDef def;
  def.cells = {16, 16, 16};
  def.sides.fill(FluidBoundary::closed);
  def.combustion = Combustion{};
  def.emitters = {{.position = {0, 0.4, 0},
                   .radius = 0.3f,
                   .density = 0.0f,
                   .temperature = 700.0f,
                   .end = 0.01,
                   .fuel = 0.02f}};
  const FluidId gas = world.add_gas(def);
  world.step(kStep);
  const double before = world.fluid_info(gas).fuel_mass;
  EXPECT_GT(before, 0.0);
  double released = 0.0;
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    released += world.fluid_info(gas).heat_rate * double(kStep);
  }
  const FluidInfo info = world.fluid_info(gas);
  EXPECT_LT(info.fuel_mass, 0.5 * before);
  EXPECT_GT(world.probe(gas, {0, 1.2, 0}).velocity.y, 0.2f);
  EXPECT_TRUE(relative_row("F-12 heat of a flame over that of the fuel the box lost",
                           released / (4.6e7 * (before - info.fuel_mass)), 1.0, 1e-3, 1e-5));
}

TEST(Gas, IsFreeOfDivergenceBesideAFan) {
  World world = make_world();
  const BodyId fan = world.add_body(
      {.type = BodyType::kinematic, .pose = {.position = {0, 1, 0}}, .angular_velocity = {0, 6, 0}},
      {.geometry = Box{{0.5f, 0.15f, 0.15f}}});
  (void)fan;
  GasDef def;
  def.cells = {24, 24, 24};
  const FluidId gas = world.add_gas(def);
  double most = 0.0;
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    most = std::max(most, double(world.fluid_info(gas).divergence));
  }
  EXPECT_TRUE(limit_row("F-21 divergence times the step, beside a fan", most * double(kStep), 1e-3, 1e-4));
}

// A jet out of a hole is as fast as a body that fell from the level: v^2 = 2 g h.
TEST(Liquid, FlowsOutAsTorricelliSays) {
  World world = make_world();
  constexpr float kCell = 0.02f;
  // Walls of a tank from x = 0 to 1.2, with a hole of ten cells above 0.2 m.
  world.add_body({.type = BodyType::fixed, .pose = {.position = {1.24, 0.1, 0}}},
                 {.geometry = Box{{0.04f, 0.1f, 1}}});
  world.add_body({.type = BodyType::fixed, .pose = {.position = {1.24, 0.9, 0}}},
                 {.geometry = Box{{0.04f, 0.5f, 1}}});
  LiquidDef def = tank({1.8, 1.1, double(kCell)}, 0.9, kCell);
  def.fill[0].upper.x = 1.2;
  def.sides[1] = FluidBoundary::open;
  const FluidId pool = world.add_liquid(def);
  run(world, 0.6);
  double ratio = 0.0;
  for (int i = 0; i < 12; ++i) {
    world.step(kStep);
    const Vec3 v = world.probe(pool, {1.34, 0.27, 0.01}).velocity;
    const double level = double(world.probe(pool, {0.3, 0.5, 0.01}).surface);
    ratio += double(length(v)) / std::sqrt(2 * kG * (level - 0.27)) / 12.0;
  }
  EXPECT_TRUE(row("F-22 speed out of a hole over that of Torricelli", ratio, 1.0, 1e-1, 3e-2));
}

// Vessels that are connected below have one level.
TEST(Liquid, HasOneLevelInConnectedVessels) {
  World world = make_world();
  constexpr float kCell = 0.02f;
  world.add_body({.type = BodyType::fixed, .pose = {.position = {0.5, 0.36, 0}}},
                 {.geometry = Box{{0.04f, 0.26f, 1}}});
  LiquidDef def = tank({1.0, 0.6, double(kCell)}, 0.4, kCell);
  def.fill = {{{0, 0, 0}, {0.46, 0.4, 1}}, {{0.46, 0, 0}, {0.54, 0.1, 1}}, {{0.54, 0, 0}, {1, 0.2, 1}}};
  def.viscosity = 10.0f;
  def.sides[2] = FluidBoundary::no_slip;
  const FluidId pool = world.add_liquid(def);
  run(world, 6.0);
  const auto level = [&](double from) {
    double sum = 0.0;
    for (int i = 0; i < 8; ++i) sum += double(world.probe(pool, {from + 0.05 * i, 0.3, 0.01}).surface) / 8.0;
    return sum;
  };
  EXPECT_TRUE(limit_row("F-13 difference of the levels of connected vessels",
                        std::fabs(level(0.05) - level(0.6)), double(kCell), 0.25 * double(kCell)));
}

// Liquid that turns as one body has a surface that rises by w^2 r^2 / (2 g).
TEST(Liquid, RisesInARotatingBucket) {
  World world = make_world();
  constexpr double kRadius = 0.2, kSpin = 5.0, kDepth = 0.14;
  constexpr float kCell = 0.02f;
  constexpr int kStaves = 32;
  for (int i = 0; i < kStaves; ++i) {
    const float angle = 2 * kPi * float(i) / kStaves;
    const double far = kRadius + 0.05;
    BodyDef stave{.type = BodyType::fixed};
    stave.pose = {.position = {far * std::cos(double(angle)), 0.2, far * std::sin(double(angle))},
                  .orientation = from_axis_angle({0, 1, 0}, -angle)};
    world.add_body(stave, {.geometry = Box{{0.05f, 0.3f, 0.06f}}});
  }
  LiquidDef def;
  def.lower = {-0.24, 0, -0.24}, def.upper = {0.24, 0.32, 0.24};
  def.cell_size = kCell;
  LiquidParticles particles;
  const double rise = kSpin * kSpin / (2 * kG), middle = kDepth - 0.5 * rise * kRadius * kRadius;
  for (int i = 0; i < 48; ++i) {
    for (int k = 0; k < 48; ++k) {
      const double x = (i - 23.5) * 0.01, z = (k - 23.5) * 0.01, square = x * x + z * z;
      if (square > (kRadius - 0.002) * (kRadius - 0.002)) continue;
      for (int j = 0; 0.01 * (j + 0.5) < middle + rise * square; ++j) {
        particles.positions.push_back({x, 0.01 * (j + 0.5), z});
        particles.velocities.push_back({float(kSpin * z), 0, float(-kSpin * x)});
      }
    }
  }
  def.particles = particles;
  const FluidId pool = world.add_liquid(def);
  run(world, 0.5);
  double measured = 0.0, spin_square = 0.0;
  constexpr int kSteps = 60;
  for (int i = 0; i < kSteps; ++i) {
    world.step(kStep);
    double rim = 0.0, center = 0.0, spin = 0.0;
    for (int n = 0; n < 16; ++n) {
      const double angle = 2 * kPiDouble * n / 16.0;
      rim += double(world.probe(pool, {0.16 * std::cos(angle), 0.1, 0.16 * std::sin(angle)}).surface) / 16.0;
      center +=
          double(world.probe(pool, {0.04 * std::cos(angle), 0.1, 0.04 * std::sin(angle)}).surface) / 16.0;
      const Vec3 v = world.probe(pool, {0.1 * std::cos(angle), 0.05, 0.1 * std::sin(angle)}).velocity;
      spin += (double(v.x) * std::sin(angle) - double(v.z) * std::cos(angle)) / (0.1 * 16.0);
    }
    measured += (rim - center) / kSteps;
    spin_square += spin * spin / kSteps;
  }
  // Cut cells at the wall slow it: the surface is that of the spin there is.
  EXPECT_TRUE(row("F-15 spin of a bucket after 1 s over that at the start", std::sqrt(spin_square) / kSpin,
                  1.0, 0.25, 0.02));
  const double expected = spin_square * (0.16 * 0.16 - 0.04 * 0.04) / (2 * kG);
  EXPECT_TRUE(relative_row("F-14 rise of the surface in a rotating bucket", measured, expected, 5e-2, 2e-2));
}

// The angle of a square block of this density ratio, after some seconds, that began at `angle`, in a plane flow.
double settled_angle(double ratio, float angle, double seconds) {
  World world = make_world();
  constexpr float kCell = 0.025f, kSide = 0.2f;
  BodyDef body;
  body.pose = {.position = {0.5, 0.3 + double(kSide) * (0.5 - ratio), 0.5 * double(kCell)},
               .orientation = from_axis_angle({0, 0, 1}, angle)};
  body.can_sleep = false;
  body.locked = {.linear = {false, false, true}, .angular = {true, true, false}};
  const BodyId block = world.add_body(
      body, {.geometry = Box{{0.5f * kSide, 0.5f * kSide, 0.5f * kCell}}, .density = 1000.0f * float(ratio)});
  LiquidDef def = tank({1.0, 0.5, double(kCell)}, 0.3, kCell);
  world.add_liquid(def);
  double least = 10.0, most = -10.0;
  const int steps = int(seconds * 60);
  for (int i = 0; i < steps; ++i) {
    world.step(kStep);
    const Quat q = world.pose(block).orientation;
    const double now = 2.0 * std::atan2(double(q.z), double(q.w));
    if (i >= steps / 2) least = std::min(least, now), most = std::max(most, now);
  }
  return std::fabs(0.5 * (least + most)) * 180 / kPiDouble;
}

// A square block floats upright only where its density ratio s has s (1 - s) < 1/6: else it tips.
TEST(Liquid, TipsABlockOnlyWhereItMust) {
  EXPECT_TRUE(limit_row("F-16 angle of a floating block of 0.1, degrees",
                        settled_angle(0.1, 4 * kDegree, 4.0), 3.0, 1.0));
  EXPECT_TRUE(limit_row("F-17 angle of a floating block of 0.9, degrees",
                        settled_angle(0.9, 4 * kDegree, 4.0), 3.0, 1.0));
  EXPECT_TRUE(row("F-18 angle of a floating block of 0.5, degrees", settled_angle(0.5, 4 * kDegree, 5.0),
                  45.0, 15.0, 5.0));
}

}  // namespace
}  // namespace gyre::laws::fluid_test
