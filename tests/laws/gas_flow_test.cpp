// Gases without walls: vortices whose error falls with the cells, a stream past nothing, a box that turns with its gas, a plume over a source of heat.
// Sources: G. I. Taylor, A. E. Green, "Mechanism of the Production of Small Eddies from Large Ones", 1937; B. Morton, G. Taylor, J. Turner,
// "Turbulent Gravitational Convection from Maintained and Instantaneous Sources", 1956.
#include "laws/kit.h"

namespace gyre::laws::gas_flow_test {
namespace {

// A periodic plane of Taylor and Green's vortices, 2 pi wide.
GasDef vortices(int cells, float viscosity) {
  GasDef def;
  const double side = 2.0 * kPiDouble;
  def.lower = {}, def.upper = {side, side, side / cells};
  def.cells = {cells, cells, 1};
  def.density = 1.0f, def.viscosity = viscosity;
  def.sides.fill(FluidBoundary::periodic);
  def.sides[4] = def.sides[5] = FluidBoundary::closed;
  def.vortices = TaylorGreen{1.0f, {1.0f, 1.0f}};
  return def;
}

// The root of the mean square error of the speed along x after 1 s, with steps so short that cells alone matter.
double vortex_error(int cells) {
  World world = make_world({.gravity = {}});
  const FluidId gas = world.add_gas(vortices(cells, 0.1f));
  run(world, 1.0, 1.0f / 240);
  double sum = 0.0;
  const double side = 2.0 * kPiDouble, loss = std::exp(-0.2);
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const double x = side * i / cells, y = side * (j + 0.5) / cells;
      const double error =
          double(world.probe(gas, {x, y, 0.0}).velocity.x) - loss * std::sin(x) * std::cos(y);
      sum += error * error / double(cells * cells);
    }
  }
  return std::sqrt(sum);
}

TEST(Gas, ConvergesAtSecondOrder) {
  const double order = std::log2(vortex_error(16) / vortex_error(32));
  EXPECT_TRUE(row("F-32 order of the error of decaying vortices", order, 2.0, 0.2, 0.1));
  World world = make_world({.gravity = {}});
  const FluidId gas = world.add_gas(vortices(48, 0.0f));
  const double before = world.fluid_info(gas).kinetic_energy;
  run(world, 2.0 * kPiDouble);
  EXPECT_TRUE(limit_row("F-33 energy that vortices without viscosity lose in a turn",
                        1.0 - world.fluid_info(gas).kinetic_energy / before, 0.02, 0.002));
}

TEST(Gas, LeavesAFreeStreamAsItIs) {
  World world = make_world({.gravity = {}});
  GasDef def;
  def.cells = {12, 16, 8};
  def.sides.fill(FluidBoundary::periodic);
  def.initial_velocity = {1.5f, 0.25f, -0.75f};
  const FluidId gas = world.add_gas(def);
  run(world, 1.0);
  const GasFields fields = *world.gas_def(gas).fields;
  const std::vector<float>* const velocity[3] = {&fields.velocity_x, &fields.velocity_y, &fields.velocity_z};
  const float given[3] = {1.5f, 0.25f, -0.75f};
  double most = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    for (const float one : *velocity[axis]) most = std::max(most, std::fabs(double(one - given[axis])));
  EXPECT_TRUE(limit_row("F-34 change of a free stream in 1 s, m/s", most, 1e-6, 0.0));
}

// Gas that turns with its box rests in the axes of the box: the pressure bears the centrifugal acceleration.
TEST(Gas, TurnsWithItsBox) {
  World world = make_world({.gravity = {}});
  GasDef def;
  def.cells = {16, 16, 16};
  def.sides.fill(FluidBoundary::closed);
  def.angular_velocity = {0.5f, 3.0f, -1.0f};
  const FluidId gas = world.add_gas(def);
  run(world, 2.0);
  const double spin = double(length(def.angular_velocity));
  EXPECT_TRUE(limit_row(
      "F-35 speed of a gas in a box that turns, over that of the corner",
      std::sqrt(2 * world.fluid_info(gas).kinetic_energy / (1.2 * 8)) / (spin * std::sqrt(3.0)), 1e-3, 1e-5));
}

// The slope of y over x, and where its line passes zero.
struct Line {
  double slope = 0.0, zero = 0.0;

  Line(std::span<const double> x, std::span<const double> y) {
    const double n = double(x.size());
    double mean_x = 0.0, mean_y = 0.0, square = 0.0, product = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) mean_x += x[i] / n, mean_y += y[i] / n;
    for (std::size_t i = 0; i < x.size(); ++i)
      square += (x[i] - mean_x) * (x[i] - mean_x), product += (x[i] - mean_x) * (y[i] - mean_y);
    slope = product / square, zero = mean_x - mean_y / slope;
  }
};

// A plume over a source of heat takes in air at its edge. Above its virtual origin z0 its radius is 6/5 alpha (z - z0), its volume flux grows as
// (z - z0)^(5/3) and its momentum flux as (z - z0)^(4/3), while the flux of buoyancy stays. Alpha is about 0.1.
TEST(Gas, RisesAsAPlume) {
  constexpr int kCells = 24;
  constexpr double kWidth = 1.0, kEdge = kWidth / kCells;
  World world = make_world();
  GasDef def;
  def.lower = {-0.5 * kWidth, 0, -0.5 * kWidth}, def.upper = {0.5 * kWidth, 2 * kWidth, 0.5 * kWidth};
  def.cells = {kCells, 2 * kCells, kCells};
  def.sides[2] = FluidBoundary::closed;
  def.vorticity = 0.2f;
  // Beside the axis, so that the plume is not the same on all sides and breaks up.
  def.emitters = {
      {.position = {0.013, 0.1, -0.009}, .radius = 0.08f, .temperature = def.ambient_temperature + 60.0f}};
  const FluidId gas = world.add_gas(def);
  run(world, 4.0);
  std::vector<double> heights;
  for (int j = 9; j <= 39; j += 3) heights.push_back(j * kEdge);
  const std::size_t count = heights.size();
  std::vector<std::vector<double>> mean(count, std::vector<double>(kCells * kCells));
  std::vector<double> momentum(count), buoyancy(count);
  constexpr int kSamples = 120;
  constexpr double kArea = kEdge * kEdge;
  for (int sample = 0; sample < kSamples; ++sample) {
    run(world, 5.0 * double(kStep));
    for (std::size_t h = 0; h < count; ++h) {
      for (int n = 0; n < kCells * kCells; ++n) {
        const double x = (n % kCells + 0.5) * kEdge, z = (n / kCells + 0.5) * kEdge;
        const FluidProbe probe = world.probe(gas, {x - 0.5 * kWidth, heights[h], z - 0.5 * kWidth});
        const double up = double(probe.velocity.y);
        mean[h][std::size_t(n)] += up / kSamples;
        momentum[h] += up * up * kArea / kSamples;
        buoyancy[h] +=
            up * double(probe.temperature / def.ambient_temperature - 1.0f) * kGravity * kArea / kSamples;
      }
    }
  }
  std::vector<double> volume(count), radius(count), above(count);
  for (std::size_t h = 0; h < count; ++h) {
    // The plume is where the mean speed is a tenth of that on its axis or more.
    const double fastest = *std::max_element(mean[h].begin(), mean[h].end());
    for (const double up : mean[h])
      if (up > 0.1 * fastest) volume[h] += up * kArea;
    radius[h] = volume[h] / std::sqrt(kPiDouble * momentum[h]);
  }
  const Line spread(heights, radius);
  EXPECT_TRUE(row("F-37 entrainment of a plume, alpha", spread.slope * 5 / 6, 0.1, 0.03, 0.01));
  const auto exponent = [&](std::span<const double> flux) {
    std::vector<double> logarithm(count);
    for (std::size_t h = 0; h < count; ++h)
      above[h] = std::log(heights[h] - spread.zero), logarithm[h] = std::log(flux[h]);
    return Line(above, logarithm).slope;
  };
  EXPECT_TRUE(
      row("F-38 exponent of the volume flux of a plume over height", exponent(volume), 5.0 / 3, 0.25, 0.05));
  EXPECT_TRUE(row("F-39 exponent of its momentum flux", exponent(momentum), 4.0 / 3, 0.25, 0.05));
  const auto [least, most] = std::minmax_element(buoyancy.begin(), buoyancy.end());
  EXPECT_TRUE(
      limit_row("F-40 change of its flux of buoyancy over the largest", 1.0 - *least / *most, 0.2, 0.05));
}

}  // namespace
}  // namespace gyre::laws::gas_flow_test
