// A row within a coupled solve (soft/solver/coupled_solve.h): its impulse at its present velocity, and how the work of that impulse changes along a direction.
#pragma once

#include <gyre/math.h>

#include <cmath>
#include <cstdint>
#include <span>

namespace gyre {

// A row in a solve.
struct CoupledRow {
  std::uint32_t at[5] = {};  // its vertices, in the list of those that rows touch
  float weight[5] = {};
  int vertices = 0;
  std::int32_t body = -1;
  Vec3 arm{}, normal{};
  float target = 0.0f, along = 0.0f, across = 0.0f, start_along = 0.0f, start_across = 0.0f;
  // Of the stage: its impulse when it began, and the bound of friction.
  float last_normal = 0.0f, bound = 0.0f;
  Vec3 last_friction{};
  float least = 0.0f;  // N s: the least push, 0 of a contact, and no bound of what holds
  // Now.
  Vec3 velocity{};    // m/s, relative
  float push = 0.0f;  // N s: along the normal
  Vec3 friction{};
  bool sticks = false;

  bool acts() const { return push > least; }
  // The push at a speed along the normal, before it is kept from pulling.
  float push_at(float speed) const { return last_normal + along * (target - speed); }
  // K of a row that pushes.
  Sym3 inertia() const {
    const float c = sticks ? across : 0.0f, a = along - c;
    return {c + a * normal.x * normal.x, c + a * normal.y * normal.y, c + a * normal.z * normal.z,
            a * normal.x * normal.y,     a * normal.x * normal.z,     a * normal.y * normal.z};
  }
};

// How the work of a row's impulse on a direction depends on the share that is gone along it.
struct CoupledRowSlope {
  double push = 0.0, push_rate = 0.0;          // N s, before it is kept from pulling
  double speed = 0.0;                          // m/s: of the direction along the normal
  double size = 0.0, mixed = 0.0, rate = 0.0;  // of friction f + share g, before its bound: f.f, f.g, g.g
  double work = 0.0, work_rate = 0.0;          // f.w, g.w, with w the direction across the normal
  double bound = 0.0, least = 0.0;

  double at(double share) const {
    const double normal = push + share * push_rate;
    if (!(normal > least)) return 0.0;
    const double square = size + share * (2.0 * mixed + share * rate);
    const double kept = square > bound * bound ? bound / std::sqrt(square) : 1.0;
    return normal * speed + kept * (work + share * work_rate);
  }
};

// A line search ends where the slope is this share of the first one, or after so many steps.
inline constexpr double kSlopeLeft = 0.05;
inline constexpr int kSearchSteps = 16;

// The share of a direction at which the slope of the whole is zero: its part without rows is slope - share * curvature. `resistance`: what the rows that push at the start add to the
// curvature. By doubling, then by the secant, and the middle at every third step. 0: the direction leads nowhere.
inline double find_zero_slope(std::span<const CoupledRowSlope> rows, double slope, double curvature,
                              double resistance) {
  if (!(slope > 0.0) || !(curvature + resistance > 0.0)) return 0.0;
  const auto work_at = [&](double share) {
    double sum = 0.0;
    for (const CoupledRowSlope& one : rows) sum += one.at(share);
    return sum;
  };
  const double start = work_at(0.0), enough = kSlopeLeft * slope;
  const auto left_at = [&](double share) { return slope - share * curvature + (work_at(share) - start); };
  double low = 0.0, at_low = slope, high = slope / (curvature + resistance), at_high = left_at(high);
  int steps = 0;
  for (; at_high > enough && steps < kSearchSteps; ++steps) {
    low = high, at_low = at_high;
    high *= 2.0, at_high = left_at(high);
  }
  for (; at_high < -enough && steps < kSearchSteps; ++steps) {
    const double share =
        steps % 3 == 2 ? 0.5 * (low + high) : low + (high - low) * (at_low / (at_low - at_high));
    const double left = left_at(share);
    if (absolute(left) <= enough) return share;
    (left > 0.0 ? low : high) = share;
    (left > 0.0 ? at_low : at_high) = left;
  }
  return absolute(at_high) <= enough ? high : low;
}

}  // namespace gyre
