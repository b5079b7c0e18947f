// For tests of the narrow phase: reproducible random convex shapes, and slow and obvious versions of its queries.
#pragma once

#include "geometry/distance/gjk.h"
#include "geometry/distance/penetration.h"
#include "geometry/manifold/manifold.h"
#include "geometry/shape/hull.h"
#include "geometry/shape/hull_builder.h"
#include "geometry/shape/support.h"

#include <deque>
#include <random>
#include <vector>

namespace gyre::oracle {

// Own number generator, so that the shapes are the same on every platform.
struct Random {
  std::mt19937 engine;

  explicit Random(unsigned seed) : engine(seed) {}
  float operator()(float low, float high) {
    return low + (high - low) * (float(engine() >> 8) / 16777216.0f);
  }
  int below(int n) { return int(engine() % unsigned(n)); }
  Vec3 in_cube(float half = 1.0f) {
    const float x = (*this)(-half, half), y = (*this)(-half, half), z = (*this)(-half, half);
    return {x, y, z};
  }
  Vec3 direction() {
    for (;;) {
      const Vec3 p = in_cube();
      if (length_squared(p) > 0.01f && length_squared(p) < 1.0f) return normalized(p);
    }
  }
  Quat rotation() {
    for (;;) {
      const float x = (*this)(-1, 1), y = (*this)(-1, 1), z = (*this)(-1, 1), w = (*this)(-1, 1);
      const Quat q{x, y, z, w};
      if (dot(q, q) > 0.01f && dot(q, q) < 1.0f) return normalized(q);
    }
  }
};

inline Shape make_sphere(float radius) {
  Shape shape;
  shape.kind = ShapeKind::sphere;
  shape.radius = radius;
  return shape;
}
inline Shape make_box(Vec3 half_extents, float rounding = 0.0f) {
  Shape shape;
  shape.kind = ShapeKind::box;
  shape.radius = rounding;
  shape.extents = half_extents - Vec3{rounding, rounding, rounding};
  return shape;
}
inline Shape make_along_y(ShapeKind kind, float radius, float half_height) {
  Shape shape;
  shape.kind = kind;
  shape.radius = radius;
  shape.extents = {0.0f, half_height, 0.0f};
  return shape;
}
inline Shape make_plane(Vec3 normal, float offset) {
  Shape shape;
  shape.kind = ShapeKind::plane;
  shape.extents = normalized(normal);
  shape.offset = offset;
  return shape;
}

// Storage of hulls that shapes point to; a deque, so that they never move.
class Hulls {
 public:
  // The shape of a cooked hull; kind sphere with radius 0 if the points make none.
  Shape add(const std::vector<Vec3>& points) {
    Shape shape;
    Result<Hull> hull = build_hull(points);
    if (!hull) return shape;
    hulls_.push_back(std::move(*hull));
    shape.kind = ShapeKind::hull;
    shape.hull = &hulls_.back();
    return shape;
  }
  Shape add_random(Random& random, float size) {
    for (;;) {
      std::vector<Vec3> points;
      const int count = 4 + random.below(20);
      const Vec3 scale{random(0.2f, 1.0f), random(0.2f, 1.0f), random(0.2f, 1.0f)};
      for (int i = 0; i < count; ++i) points.push_back(size * multiply_each(random.direction(), scale));
      const Shape shape = add(points);
      if (shape.kind == ShapeKind::hull) return shape;
    }
  }
  Shape add_box(Vec3 h) {
    std::vector<Vec3> points;
    for (int i = 0; i < 8; ++i)
      points.push_back({i & 1 ? h.x : -h.x, i & 2 ? h.y : -h.y, i & 4 ? h.z : -h.z});
    return add(points);
  }
  // The same hull, larger: vertices and offsets times `scale`.
  Shape add_scaled(const Hull& hull, float scale) {
    hulls_.push_back(hull);
    Hull& copy = hulls_.back();
    for (Vec3& v : copy.vertices) v = scale * v;
    for (HullPlane& plane : copy.planes) plane.offset = scale * plane.offset;
    copy.centroid = scale * copy.centroid;
    copy.inner_radius = scale * copy.inner_radius;
    complete_hull(copy);
    Shape shape;
    shape.kind = ShapeKind::hull;
    shape.hull = &copy;
    return shape;
  }

 private:
  std::deque<Hull> hulls_;
};

constexpr int kKinds = 7;  // the six convex kinds and rounded boxes
inline const char* kind_name(int kind) {
  const char* names[kKinds] = {"sphere", "box", "capsule", "cylinder", "cone", "hull", "rounded box"};
  return names[kind];
}

// A shape of about `size`; one in eight is a needle or a plate.
inline Shape random_shape(Random& random, Hulls& hulls, int kind, float size) {
  const float thin = random.below(8) == 0 ? 0.02f : 1.0f;
  const float thick = random.below(8) == 0 ? 0.02f : 1.0f;
  const float radius = thin * size * random(0.2f, 1.0f), half = thick * size * random(0.2f, 1.0f);
  switch (kind) {
    case 0:
      return make_sphere(size * random(0.2f, 1.0f));
    case 1:
      return make_box({radius, half, size * random(0.2f, 1.0f)});
    case 2:
      return make_along_y(ShapeKind::capsule, radius, half);
    case 3:
      return make_along_y(ShapeKind::cylinder, radius, half);
    case 4:
      return make_along_y(ShapeKind::cone, radius, half);
    case 5:
      return hulls.add_random(random, size);
    default: {
      const Vec3 h{radius, half, size * random(0.2f, 1.0f)};
      return make_box(h, smallest(h) * (random.below(4) == 0 ? 1.0f : random(0.05f, 0.9f)));
    }
  }
}

// A relative pose for two shapes of about `size`: random, or one of several special cases.
inline Transform random_pose(Random& random, float size) {
  Transform t{size * random.in_cube(1.3f), random.rotation()};
  switch (random.below(12)) {
    case 0:
      t.orientation = {};
      break;
    case 1:
      t.position = {};
      break;
    case 2:
      t.position = {0.0f, t.position.y, 0.0f};
      break;
    case 3:
      t = {{0.0f, t.position.y, 0.0f}, {}};
      break;
    case 4:
      t = {};
      break;
    case 5:
      t.orientation = normalized(Quat{0.0f, 0.0f, 0.70710678f, 0.70710678f});
      break;
    case 6:
      t.orientation =
          normalized(Quat{random(-1e-3f, 1e-3f), random(-1e-3f, 1e-3f), random(-1e-3f, 1e-3f), 1.0f});
      break;
    default:
      break;
  }
  return t;
}

// Farthest extent of a core along a direction, from its definition.
inline double extent(const Shape& shape, DVec3 d) {
  const double h = double(shape.extents.y), r = double(shape.radius);
  const double radial = std::sqrt(d.x * d.x + d.z * d.z);
  switch (shape.kind) {
    case ShapeKind::box:
      return double(shape.extents.x) * absolute(d.x) + h * absolute(d.y) +
             double(shape.extents.z) * absolute(d.z);
    case ShapeKind::capsule:
      return h * absolute(d.y);
    case ShapeKind::cylinder:
      return h * absolute(d.y) + r * radial;
    case ShapeKind::cone:
      return max(h * d.y, -h * d.y + r * radial);
    case ShapeKind::hull: {
      double best = -1.0e300;
      for (const Vec3& v : shape.hull->vertices) best = max(best, dot(DVec3(v), d));
      return best;
    }
    default:
      return 0.0;
  }
}

// The separation of two cores along a unit direction from A to B, by definition.
inline double separation(const Shape& a, const Shape& b, const CorePair& pair, DVec3 n) {
  return dot(pair.center_of_b(), n) - extent(a, n) - extent(b, pair.to_b(-n));
}

// The largest separation over many directions and around the best: a lower bound of the signed distance of two cores.
inline double sampled_separation(const Shape& a, const Shape& b, const CorePair& pair, Random& random,
                                 int samples) {
  double best = -1.0e300;
  DVec3 at;
  const auto test = [&](DVec3 n) {
    const double s = separation(a, b, pair, n / length(n));
    if (s > best) {
      best = s;
      at = n / length(n);
    }
  };
  for (int i = 0; i < samples; ++i) test(DVec3(random.direction()));
  for (double step = 0.3; step > 1.0e-5; step *= 0.6) {
    for (int i = 0; i < 12; ++i) test(at + step * DVec3(random.direction()));
  }
  return best;
}

// Signed distance of the surfaces of two shapes by GJK and EPA, which have tests of their own.
inline double signed_distance(const Shape& a, const Shape& b, const Transform& t) {
  const CorePair pair(a, b, t);
  const CoreDistance apart = core_distance(pair, 1.0e30, {});
  const double radii = double(core_radius(a)) + double(core_radius(b));
  if (!apart.overlap) return apart.distance - radii;
  return -core_penetration(pair, apart).depth - radii;
}

// A length of the order of both shapes.
inline float size_of(const Shape& a, const Shape& b, const Transform& t) {
  return float(CorePair(a, b, t).size()) + core_radius(a) + core_radius(b);
}

}  // namespace gyre::oracle
