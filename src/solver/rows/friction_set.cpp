#include "solver/rows/friction_set.h"

#include "math/trig.h"

#include <cmath>

namespace gyre {

namespace {
constexpr double kPiD = 3.14159265358979323846;  // pi
}

FrictionSet make_friction_set(int sides) {
  FrictionSet set;
  set.sides = sides;
  if (sides == 0) return set;
  const double half = kPiD / double(sides);
  const SinCosD own = sin_cos(half);
  set.inner = own.cos;
  set.half_side = own.sin;
  for (int i = 0; i < sides; ++i) {
    const SinCosD corner = sin_cos(half * double(2 * i - 1)), middle = sin_cos(half * double(2 * i));
    set.corner[i][0] = corner.cos, set.corner[i][1] = corner.sin;
    set.side[i][0] = middle.cos, set.side[i][1] = middle.sin;
  }
  return set;
}

FrictionPoint nearest_friction(const FrictionSet& set, double radius, double x, double y) {
  if (!(radius > 0.0)) return {0.0, 0.0, FrictionRegion::corner, 0};
  if (set.sides == 0) {
    const double size = std::sqrt(x * x + y * y);
    if (size <= radius) return {x, y, FrictionRegion::inside, 0};
    return {radius / size * x, radius / size * y, FrictionRegion::rim, 0};
  }
  int far = 0;
  double largest = -1.0;
  for (int i = 0; i < set.sides; ++i) {
    const double out = x * set.side[i][0] + y * set.side[i][1];
    if (out > largest) largest = out, far = i;
  }
  const double inner = set.inner * radius, half = set.half_side * radius;
  if (largest <= inner) return {x, y, FrictionRegion::inside, 0};
  const double along = y * set.side[far][0] - x * set.side[far][1];
  if (along > half || along < -half) {
    const int corner = along > 0.0 ? (far + 1) % set.sides : far;
    return {radius * set.corner[corner][0], radius * set.corner[corner][1], FrictionRegion::corner, corner};
  }
  return {inner * set.side[far][0] - along * set.side[far][1],
          inner * set.side[far][1] + along * set.side[far][0], FrictionRegion::side, far};
}

}  // namespace gyre
