// For tests of the narrow phase: properties of two convex shapes by definition. A point is in a shape or not, and a
// direction separates two shapes or not. With these, results are proven independently of the method.
#pragma once

#include "geometry/testing/degenerate_pairs.h"

namespace gyre::oracle {

// The distance of a point (in the shape's frame) outside the surface: exact inside, at most the distance outside.
inline double outside_surface(const Shape& shape, DVec3 p) {
  const DVec3 e(shape.extents);
  const double r = double(shape.radius), h = e.y;
  const double radial = std::sqrt(p.x * p.x + p.z * p.z);
  switch (shape.kind) {
    case ShapeKind::box: {
      const DVec3 q{absolute(p.x) - e.x, absolute(p.y) - e.y, absolute(p.z) - e.z};
      const double inner = max(q.x, max(q.y, q.z));
      if (inner <= 0.0) return inner - r;
      return length(DVec3{max(q.x, 0.0), max(q.y, 0.0), max(q.z, 0.0)}) - r;
    }
    case ShapeKind::capsule:
      return length(DVec3{p.x, p.y - clamp(p.y, -h, h), p.z}) - r;
    case ShapeKind::cylinder:
      return max(radial - r, absolute(p.y) - h);
    case ShapeKind::cone:
      return max(-h - p.y, (2.0 * h * radial - r * (h - p.y)) / std::sqrt(4.0 * h * h + r * r));
    case ShapeKind::hull: {
      double worst = -1.0e300;
      for (const HullPlane& plane : shape.hull->planes)
        worst = max(worst, dot(DVec3(plane.normal), p) - double(plane.offset));
      return worst;
    }
    case ShapeKind::plane:
      return dot(e, p) - double(shape.offset);
    default:
      return length(p) - r;
  }
}

// The separation of two surfaces along a unit direction from A to B. Never more than their distance; if they overlap,
// never more than minus their depth.
inline double surface_separation(const Shape& a, const Shape& b, const CorePair& pair, DVec3 n) {
  return separation(a, b, pair, n) - double(core_radius(a)) - double(core_radius(b));
}

// Half of the largest diameter of the shape, and a lower bound of half its smallest width.
inline double long_side(const Shape& shape) { return double(outer_radius(shape, {})); }
inline double thin_side(const Shape& shape) { return double(inner_radius(shape)); }

// Climbs from `n` to the direction of largest separation, by steps of decreasing size over the sphere.
inline double climb_separation(const Shape& a, const Shape& b, const CorePair& pair, DVec3& n, double step,
                               double min_step) {
  double best = surface_separation(a, b, pair, n);
  for (; step > min_step; step *= 0.5) {
    int rounds = 0;
    for (bool better = true; better && rounds < 30; ++rounds) {
      better = false;
      const DVec3 u = absolute(n.x) < 0.6 ? DVec3{1, 0, 0} : DVec3{0, 1, 0};
      DVec3 s = cross(n, u);
      s = s / length(s);
      const DVec3 t = cross(n, s);
      for (int k = 0; k < 8; ++k) {
        constexpr double kDirections[8][2] = {{1, 0},     {-1, 0},     {0, 1},      {0, -1},
                                              {0.7, 0.7}, {0.7, -0.7}, {-0.7, 0.7}, {-0.7, -0.7}};
        DVec3 trial = n + step * kDirections[k][0] * s + step * kDirections[k][1] * t;
        trial = trial / length(trial);
        const double found = surface_separation(a, b, pair, trial);
        if (found > best + 1.0e-12 * absolute(best)) {
          best = found;
          n = trial;
          better = true;
        }
      }
    }
  }
  return best;
}

// The largest separation in a search of all directions, refined around the best: a lower bound of the signed distance.
inline double searched_separation(const Shape& a, const Shape& b, const CorePair& pair, Random& random,
                                  int samples) {
  DVec3 at{0, 1, 0};
  double best = -1.0e300;
  const auto test = [&](DVec3 n) {
    const double found = surface_separation(a, b, pair, n);
    if (found > best) best = found, at = n;
  };
  if (length(pair.center_of_b()) > 0.0) test(pair.center_of_b() / length(pair.center_of_b()));
  const DVec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const DVec3& axis : axes) {
    test(axis), test(-axis);
    test(pair.from_b(axis)), test(-pair.from_b(axis));
  }
  for (int i = 0; i < samples; ++i) test(DVec3(random.direction()));
  return max(best, climb_separation(a, b, pair, at, 0.2, 1.0e-6));
}

}  // namespace gyre::oracle
