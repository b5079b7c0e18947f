// For tests of the narrow phase: pairs that are hard: needles, wires, plates and coins, sizes ten thousandfold apart, middles
// that coincide, axes all but parallel, and surfaces that touch, or miss each other by a rounding.
#pragma once

#include "geometry/testing/convex_oracle.h"

namespace gyre::oracle {

inline float one_of(Random& random, std::initializer_list<float> values) {
  return values.begin()[random.below(int(values.size()))];
}

inline Shape thin_hull(Random& random, Hulls& hulls, Vec3 half) {
  for (int tries = 0; tries < 50; ++tries) {
    std::vector<Vec3> points;
    const int count = 4 + random.below(28);
    for (int i = 0; i < count; ++i) points.push_back(multiply_each(random.direction(), half));
    const Shape shape = hulls.add(points);
    if (shape.kind == ShapeKind::hull) return shape;
  }
  return hulls.add_box(half);
}

// A shape about as long as `size`, its radius and height made thin by these factors.
inline Shape degenerate_shape(Random& random, Hulls& hulls, int kind, float size, float thin, float low) {
  const float radius = thin * size * random(0.2f, 1.0f);
  const float half = low * size * random(0.2f, 1.0f);
  const float depth = size * random(0.2f, 1.0f);
  switch (kind) {
    case 0:
      return make_sphere(size);
    case 1:
      return make_box({radius, half, depth});
    case 2:
      return make_along_y(ShapeKind::capsule, radius, half);
    case 3:
      return make_along_y(ShapeKind::cylinder, radius, half);
    case 4:
      return make_along_y(ShapeKind::cone, radius, half);
    case 5:
      return thin_hull(random, hulls, {radius, half, depth});
    default:
      return make_box({radius, half, depth}, min(min(radius, half), depth) * random(0.05f, 1.0f));
  }
}

struct DegeneratePair {
  Shape a, b;
  Transform t;
};

// Two shapes of given kinds; what is odd about them is drawn.
inline DegeneratePair degenerate_pair(Random& random, Hulls& hulls, int kind_a, int kind_b) {
  const int odd = random.below(8);
  float thin_a = 1, thin_b = 1, low_a = 1, low_b = 1, size_b = 1;
  if (odd == 1) {  // needles and wires
    thin_a = one_of(random, {1, 0.02f, 1e-3f, 1e-4f});
    thin_b = one_of(random, {1, 0.02f, 1e-3f, 1e-4f});
    low_a = random.below(2) == 0 ? thin_a : 1.0f;
  } else if (odd == 2) {  // plates and coins
    low_a = one_of(random, {1, 0.02f, 1e-3f, 1e-4f});
    low_b = one_of(random, {1, 0.02f, 1e-3f, 1e-4f});
  } else if (odd == 3) {
    size_b = one_of(random, {1e-4f, 1e-2f, 1e2f, 1e4f});
  }
  DegeneratePair pair;
  pair.a = degenerate_shape(random, hulls, kind_a, 1.0f, thin_a, low_a);
  pair.b = degenerate_shape(random, hulls, kind_b, size_b, thin_b, low_b);
  pair.t = random_pose(random, max(1.0f, size_b));
  if (odd == 4) {  // middles that coincide, every other time of equal shapes
    if (random.below(2) == 0) pair.b = pair.a;
    pair.t.position = {};
    if (random.below(2) == 0) pair.t.orientation = {};
  } else if (odd == 5) {  // all but aligned
    const float x = random(-1e-6f, 1e-6f);
    pair.t = {{0, pair.t.position.y, 0}, normalized(Quat{x, 0, random(-1e-6f, 1e-6f), 1})};
  } else if (odd == 6) {  // moved together until they touch, or nearly
    CoreDistance found = core_distance(CorePair(pair.a, pair.b, pair.t), 1.0e30, {});
    if (found.overlap) {
      pair.t.position = 3.0f * random.direction();
      found = core_distance(CorePair(pair.a, pair.b, pair.t), 1.0e30, {});
    }
    const double left = double(one_of(random, {0, 1e-3f, 1e-5f, 1e-6f, 1e-7f, 1e-8f, -1e-6f, -1e-7f}));
    pair.t.position = pair.t.position - to_float((found.distance - left) * found.normal);
  }
  return pair;
}

}  // namespace gyre::oracle
