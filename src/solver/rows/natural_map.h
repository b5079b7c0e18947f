// The natural map of a row and its derivative, for the semi-smooth Newton methods.
//
// The residual of a row is its impulse minus the nearest allowed impulse to (impulse - w / rate)
// (solver/rows/complementarity.h). Its derivative depends on the active limit: a row at rest wants w = 0, a
// row at a bound stays there, and an impulse on the rim of Coulomb's disc rotates with it. Each becomes an
// equation
//
// own dx + speed dw + load dL = right,
//
// of the change of its impulse, of its speed w, and of the sum L of the impulses that bound it.
//
// Sources: P. Alart, A. Curnier, 1991; S. Hueeber, B. Wohlmuth, 2005 (solver/rows/newton_search.h has the
// titles).
#pragma once

#include "solver/rows/row.h"

#include <cmath>

namespace gyre {

// Two equations for a cone; other rows use only the first.
struct MapEquations {
  double own[2][2] = {}, speed[2][2] = {};
  double load[2] = {};
  double right[2] = {};
};

// The state of a row in the search.
struct MapPoint {
  double x[2], w[2];  // of the two rows of a cone
  double rate;        // the diagonal, of a cone the larger of its two
  double load;        // the load that bounds it
  double damping;     // share of the rate by which a row at rest is regularised: it separates redundant
                      // rows
};

namespace natural_map {

// x = value, which grows by `per_load` with the load.
inline void fix_impulse(MapEquations& e, int i, double x, double value, double per_load) {
  e.own[i][i] = 1.0;
  e.load[i] = -per_load;
  e.right[i] = value - x;
}
// w = 0.
inline void fix_speed(MapEquations& e, int i, const MapPoint& at) {
  e.own[i][i] = at.damping;
  e.speed[i][i] = 1.0 / at.rate;
  e.right[i] = -at.w[i] / at.rate;
}
// The same along a direction, as equation i of a cone.
inline void fix_impulse_along(MapEquations& e, int i, const double (&direction)[2], const MapPoint& at,
                              double value, double per_load) {
  e.own[i][0] = direction[0], e.own[i][1] = direction[1];
  e.load[i] = -per_load;
  e.right[i] = value - (direction[0] * at.x[0] + direction[1] * at.x[1]);
}
inline void fix_speed_along(MapEquations& e, int i, const double (&direction)[2], const MapPoint& at) {
  for (int k = 0; k < 2; ++k) e.own[i][k] = at.damping * direction[k], e.speed[i][k] = direction[k] / at.rate;
  e.right[i] = -(direction[0] * at.w[0] + direction[1] * at.w[1]) / at.rate;
}

}  // namespace natural_map

inline MapEquations scalar_equation(const RowLimits& limits, const MapPoint& at) {
  MapEquations e;
  double low = limits.low, high = limits.high, share = 0.0;
  if (limits.kind == RowKind::load) {
    share = at.load > 0.0 ? limits.friction : 0.0;
    high = share * at.load;
    low = -high;
  }
  const double p = at.rate > 0.0 ? at.x[0] - at.w[0] / at.rate : 0.0;
  if (!(at.rate > 0.0)) {
    natural_map::fix_impulse(e, 0, at.x[0], 0.0, 0.0);
  } else if (p <= low) {
    natural_map::fix_impulse(e, 0, at.x[0], low, -share);
  } else if (p >= high) {
    natural_map::fix_impulse(e, 0, at.x[0], high, share);
  } else {
    natural_map::fix_speed(e, 0, at);
  }
  return e;
}

inline MapEquations cone_equations(const RowLimits& limits, const FrictionSet& set, const MapPoint& at) {
  MapEquations e;
  const double radius = limits.friction * at.load;
  if (!(radius > 0.0) || !(at.rate > 0.0)) {
    natural_map::fix_impulse(e, 0, at.x[0], 0.0, 0.0);
    natural_map::fix_impulse(e, 1, at.x[1], 0.0, 0.0);
    return e;
  }
  const double px = at.x[0] - at.w[0] / at.rate, py = at.x[1] - at.w[1] / at.rate;
  const FrictionPoint nearest = nearest_friction(set, radius, px, py);
  switch (nearest.region) {
    case FrictionRegion::inside:
      natural_map::fix_speed(e, 0, at);
      natural_map::fix_speed(e, 1, at);
      break;
    case FrictionRegion::corner: {
      const double(&corner)[2] = set.corner[nearest.index];
      natural_map::fix_impulse(e, 0, at.x[0], nearest.x, limits.friction * corner[0]);
      natural_map::fix_impulse(e, 1, at.x[1], nearest.y, limits.friction * corner[1]);
      break;
    }
    case FrictionRegion::side: {
      const double(&out)[2] = set.side[nearest.index];
      natural_map::fix_impulse_along(e, 0, out, at, set.inner * radius, set.inner * limits.friction);
      natural_map::fix_speed_along(e, 1, {-out[1], out[0]}, at);
      break;
    }
    case FrictionRegion::rim: {
      const double size = std::sqrt(px * px + py * py), share = radius / size;
      const double out[2] = {px / size, py / size}, along[2] = {-out[1], out[0]};
      natural_map::fix_impulse_along(e, 0, out, at, radius, limits.friction);
      // Across the direction: p rotates with it.
      for (int k = 0; k < 2; ++k) {
        e.own[1][k] = (1.0 - share + at.damping) * along[k];
        e.speed[1][k] = share / at.rate * along[k];
      }
      e.right[1] = -(along[0] * at.x[0] + along[1] * at.x[1]);
      break;
    }
  }
  return e;
}

}  // namespace gyre
