#include "fluid/solver/combustion.h"

namespace gyre {

namespace {

// 1 - exp(-x) of x >= 0: the Taylor series of exp(x / 32) five times squared. Its error is below 1e-9.
double burned_share(double x) {
  constexpr double kAllBurns = 40.0;  // exp(-40) is below the rounding of double
  if (!(x < kAllBurns)) return 1.0;
  const double y = x / 32.0;
  double growth =
      1.0 +
      y * (1.0 +
           y / 2.0 * (1.0 + y / 3.0 * (1.0 + y / 4.0 * (1.0 + y / 5.0 * (1.0 + y / 6.0 * (1.0 + y / 7.0))))));
  for (int n = 0; n < 5; ++n) growth *= growth;
  return 1.0 - 1.0 / growth;
}

}  // namespace

double burn_fuel(const GasPass& pass, const Combustion& combustion, float gas_density) {
  const GridShape& shape = pass.shape();
  const std::uint8_t* const solid = pass.solids.present() ? pass.solids.solid.data() : nullptr;
  float* const fuel = pass.grid.fuel.data();
  float* const temperature = pass.grid.temperature.data();
  float* const smoke = pass.grid.density.data();
  const float share = float(burned_share(double(combustion.burn_rate) * double(pass.step)));
  const float warming = combustion.heat_release / (gas_density * combustion.heat_capacity);
  const double burned = sum_rows(shape, pass.tasks, [&](int c, int, int) {
    double part = 0.0;
    for (int i = c; i < c + shape.cells[0]; ++i) {
      const bool burns = fuel[i] > 0.0f && temperature[i] >= combustion.ignition_temperature &&
                         (solid == nullptr || solid[i] == 0);
      if (!burns) continue;
      const float less = share * fuel[i];
      fuel[i] -= less;
      temperature[i] += warming * less;
      smoke[i] += combustion.smoke_yield * less;
      part += double(less);
    }
    return part;
  });
  const Vec3 h = pass.box().cell;
  return burned * double(h.x) * double(h.y) * double(h.z);
}

}  // namespace gyre
