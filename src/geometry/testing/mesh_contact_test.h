// The contacts of a shape on a surface, for the tests of meshes and height fields.
#pragma once

#include "geometry/manifold/manifold.h"
#include "geometry/shape/support.h"
#include "geometry/testing/mesh_test_scenes.h"

#include <gtest/gtest.h>

namespace gyre::test {

constexpr Vec3 kUp{0, 1, 0};
constexpr float kMargin = 0.02f;

struct Manifolds {
  int count = 0;
  LocalManifold all[kMaxMeshManifolds];

  float deepest() const {
    float found = 1.0e9f;
    for (int i = 0; i < count; ++i) {
      for (int k = 0; k < all[i].count; ++k) found = min(found, all[i].points[k].separation);
    }
    return found;
  }
  int points() const {
    int total = 0;
    for (int i = 0; i < count; ++i) total += all[i].count;
    return total;
  }
  // The manifold whose normal is within a degree or so of `normal`, or null.
  const LocalManifold* along(Vec3 normal, float tolerance = 0.02f) const {
    for (int i = 0; i < count; ++i) {
      if (length(all[i].normal - normal) < tolerance) return &all[i];
    }
    return nullptr;
  }
};

inline Manifolds collide(const Geometry& ground, const AnyShape& shape, const Transform& pose,
                         float margin = kMargin) {
  Manifolds out;
  out.count = collide_mesh(make_shape(ground), make_shape(shape), pose, margin, out.all);
  EXPECT_LE(out.count, kMaxMeshManifolds);
  for (int i = 0; i < out.count; ++i) {
    const LocalManifold& m = out.all[i];
    EXPECT_NEAR(length(m.normal), 1.0f, 1.0e-5f);
    EXPECT_GE(m.count, 1);
    EXPECT_LE(m.count, kMaxManifoldPoints);
    for (int k = 0; k < m.count; ++k) {
      EXPECT_TRUE(is_finite(m.points[k].position));
      EXPECT_LE(m.points[k].separation, margin);
      for (int j = 0; j < k; ++j) EXPECT_NE(m.points[k].feature, m.points[j].feature);
    }
  }
  return out;
}

// Height of the lowest point of the shape in the mesh's frame.
inline float lowest_point(const AnyShape& any, const Transform& pose) {
  const Shape shape = make_shape(any);
  const Vec3 p = support(shape, rotate_inverse(pose.orientation, -kUp));
  return dot(kUp, pose * p) - core_radius(shape);
}

inline Geometry random_hull(Random& random, int count, Vec3 size) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) points.push_back(multiply_each(size, random.direction()));
  Result<Geometry> made = cook_hull(points);
  EXPECT_TRUE(made.has_value());
  return made ? *made : Geometry();
}

inline std::vector<AnyShape> all_kinds(Random& random) {
  return {Sphere{0.5f},
          Box{{0.5f, 0.4f, 0.3f}},
          Box{{0.5f, 0.5f, 0.5f}, 0.1f},
          Box{{0.5f, 0.05f, 0.5f}},
          Capsule{0.3f, 0.5f},
          Cylinder{0.4f, 0.5f},
          Cone{0.5f, 0.5f},
          random_hull(random, 8, {0.5f, 0.5f, 0.5f}),
          random_hull(random, 60, {0.6f, 0.3f, 0.5f})};
}

}  // namespace gyre::test
