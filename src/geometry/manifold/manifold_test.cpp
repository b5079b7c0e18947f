// Planes against every convex kind, and the dispatch for any two shapes.
#include "geometry/manifold/manifold.h"

#include "geometry/testing/convex_oracle.h"

#include <gtest/gtest.h>

namespace gyre::manifold_test {
namespace {

using namespace oracle;

LocalManifold on_plane(const Shape& plane, const Shape& shape, const Transform& t, float max_separation) {
  LocalManifold out;
  collide_plane(plane, shape, t, max_separation, out);
  return out;
}

TEST(CollidePlane, TheDeepestPointIsExactForEveryKind) {
  Random random(81);
  Hulls hulls;
  for (int i = 0; i < 20000; ++i) {
    const float scale = i % 3 == 0 ? 1.0f : i % 3 == 1 ? 1.0e-3f : 1.0e3f;
    const int kind = random.below(kKinds);
    const Shape shape = random_shape(random, hulls, kind, scale);
    const Shape plane = make_plane(random.direction(), scale * random(-0.5f, 0.5f));
    const Transform t = random_pose(random, scale);
    const CorePair pair(plane, shape, t);
    const DVec3 n(plane.extents);
    const double lowest = dot(pair.center_of_b(), n) - extent(shape, pair.to_b(-n)) - double(plane.offset) -
                          double(core_radius(shape));
    const float reach = 0.05f * scale;
    const LocalManifold m = on_plane(plane, shape, t, reach);
    // A cap that leans less than a milliradian stands on its fixed corners.
    const bool capped = kind == 3 || kind == 4;
    const double noise = (capped ? 1.0e-4 : 2.0e-6) * double(size_of(plane, shape, t));
    if (absolute(lowest - double(reach)) < noise) continue;
    ASSERT_EQ(m.count > 0, lowest < double(reach)) << kind_name(kind) << " " << i;
    if (m.count == 0) continue;
    EXPECT_EQ(m.normal, plane.extents);
    float deepest = kUnbounded;
    for (int k = 0; k < m.count; ++k) {
      deepest = min(deepest, m.points[k].separation);
      // Midway between the plane and the shape.
      EXPECT_NEAR(dot(m.points[k].position, plane.extents) - plane.offset, 0.5f * m.points[k].separation,
                  4.0e-6f * (scale + size_of(plane, shape, t)));
    }
    const double slop = 1.0e-3 * double(scale);  // equally deep ones are chosen among by name
    EXPECT_NEAR(double(deepest), lowest, noise + slop) << kind_name(kind) << " " << i;
  }
}

TEST(CollidePlane, CountsAtRest) {
  const Shape plane = make_plane({0, 2, 0}, 0.0f);
  Hulls hulls;
  EXPECT_EQ(on_plane(plane, make_sphere(0.5f), {{0, 0.5f, 0}, {}}, 0.01f).count, 1);
  EXPECT_EQ(on_plane(plane, make_box({0.5f, 0.5f, 0.5f}), {{0, 0.5f, 0}, {}}, 0.01f).count, 4);
  EXPECT_EQ(on_plane(plane, make_box({0.5f, 0.5f, 0.5f}, 0.1f), {{0, 0.5f, 0}, {}}, 0.01f).count, 4);
  EXPECT_EQ(on_plane(plane, hulls.add_box({0.5f, 0.5f, 0.5f}), {{0, 0.5f, 0}, {}}, 0.01f).count, 4);
  EXPECT_EQ(on_plane(plane, make_along_y(ShapeKind::cylinder, 0.5f, 0.5f), {{0, 0.5f, 0}, {}}, 0.01f).count,
            4);
  EXPECT_EQ(on_plane(plane, make_along_y(ShapeKind::cone, 0.5f, 0.5f), {{0, 0.5f, 0}, {}}, 0.01f).count, 4);
  const Quat lying = from_axis_angle({0, 0, 1}, 0.5f * kPi);
  EXPECT_EQ(
      on_plane(plane, make_along_y(ShapeKind::cylinder, 0.5f, 0.5f), {{0, 0.5f, 0}, lying}, 0.01f).count, 2);
  EXPECT_EQ(on_plane(plane, make_along_y(ShapeKind::capsule, 0.5f, 0.5f), {{0, 0.5f, 0}, lying}, 0.01f).count,
            2);
  EXPECT_EQ(on_plane(plane, make_along_y(ShapeKind::capsule, 0.5f, 0.5f), {{0, 1.0f, 0}, {}}, 0.01f).count,
            1);
  EXPECT_EQ(on_plane(plane, make_sphere(0.5f), {{0, 0.6f, 0}, {}}, 0.01f).count, 0);
}

TEST(CollidePlane, ManyCornersKeepTheLowest) {
  // A round hull deep in the plane has too many candidates.
  Random random(82);
  Hulls hulls;
  std::vector<Vec3> points;
  for (int i = 0; i < 250; ++i) points.push_back(random.direction());
  const Shape hull = hulls.add(points);
  ASSERT_EQ(hull.kind, ShapeKind::hull);
  ASSERT_GT(hull.hull->vertex_count(), 128);
  float lowest = 1.0f;
  for (const Vec3& v : hull.hull->vertices) lowest = min(lowest, v.y);
  const LocalManifold m = on_plane(make_plane({0, 1, 0}, 0.5f), hull, {}, 0.1f);
  ASSERT_EQ(m.count, 4);
  float deepest = 1.0f;
  for (int i = 0; i < 4; ++i) deepest = min(deepest, m.points[i].separation);
  EXPECT_NEAR(deepest, lowest - 0.5f, 2.0e-3f);
}

TEST(CollideShapes, SwapsAndFlips) {
  const Shape plane = make_plane({0, 1, 0}, 0.25f), box = make_box({0.5f, 0.5f, 0.5f});
  PairCache cache;
  LocalManifold one[kMaxMeshManifolds], other[kMaxMeshManifolds];
  const Transform t{{0.3f, 0.74f, -0.2f}, from_axis_angle({0, 1, 0}, 0.4f)};
  ASSERT_EQ(collide_shapes(plane, box, t, 0.02f, cache, one), 1);
  ASSERT_EQ(collide_shapes(box, plane, inverse(t), 0.02f, cache, other), 1);
  EXPECT_LT(distance(rotate(t.orientation, other[0].normal), -one[0].normal), 1.0e-6f);
  ASSERT_EQ(one[0].count, other[0].count);
  for (int i = 0; i < one[0].count; ++i) {
    EXPECT_LT(distance(t * other[0].points[i].position, one[0].points[i].position), 1.0e-6f);
    EXPECT_NEAR(other[0].points[i].separation, one[0].points[i].separation, 1.0e-6f);
    EXPECT_EQ(other[0].points[i].feature, one[0].points[i].feature);
  }
  EXPECT_EQ(collide_shapes(plane, plane, t, 0.02f, cache, one), 0);
  ASSERT_EQ(collide_shapes(box, box, {{0, 0.9f, 0}, {}}, 0.02f, cache, one), 1);
  EXPECT_EQ(collide_shapes(box, box, {{0, 1.9f, 0}, {}}, 0.02f, cache, one), 0);
}

}  // namespace
}  // namespace gyre::manifold_test
