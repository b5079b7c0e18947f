// A sphere against each of a triangle's seven features, against a dense sampling of the triangle, and as meshes use it.
#include "geometry/distance/sphere_triangle.h"

#include "geometry/testing/convex_oracle.h"
#include "geometry/testing/mesh_contact_test.h"

#include <gtest/gtest.h>

namespace gyre::sphere_triangle_test {
namespace {

// A right triangle in the plane y = 0, its front up.
const DVec3 kA{0, 0, 0}, kB{0, 0, 3}, kC{4, 0, 0};

struct Case {
  TriangleFeature feature;
  DVec3 middle, nearest;
};
// Over, beside and below each feature; the regions' borders are a corner's two planes and an edge's three.
const Case kCases[] = {
    {TriangleFeature::corner_a, {-0.3, 0.4, -0.1}, {0, 0, 0}},
    {TriangleFeature::corner_b, {-0.2, -0.3, 3.6}, {0, 0, 3}},
    {TriangleFeature::corner_c, {4.5, 0.2, -0.2}, {4, 0, 0}},
    {TriangleFeature::edge_ab, {-0.5, 0.3, 1.25}, {0, 0, 1.25}},
    {TriangleFeature::edge_bc, {2 + 0.3 * 0.6, -0.2, 1.5 + 0.3 * 0.8}, {2, 0, 1.5}},
    {TriangleFeature::edge_ca, {2.75, 0.1, -0.4}, {2.75, 0, 0}},
    {TriangleFeature::face, {1.0, 0.45, 0.75}, {1.0, 0, 0.75}},
};

void expect_feature(TriangleFeature feature) {
  const Case& it = kCases[int(feature)];
  ASSERT_EQ(it.feature, feature);
  const SphereTriangle found = sphere_triangle(it.middle, 0.25, kA, kB, kC);
  EXPECT_EQ(found.feature, feature) << to_string(found.feature);
  EXPECT_LT(length(found.on_triangle - it.nearest), 1.0e-12);
  const double distance = length(it.middle - it.nearest);
  EXPECT_NEAR(found.separation, distance - 0.25, 1.0e-12);
  EXPECT_LT(length(found.normal - (it.middle - it.nearest) / distance), 1.0e-12);
}

TEST(SphereTriangle, AtCornerA) { expect_feature(TriangleFeature::corner_a); }
TEST(SphereTriangle, AtCornerB) { expect_feature(TriangleFeature::corner_b); }
TEST(SphereTriangle, AtCornerC) { expect_feature(TriangleFeature::corner_c); }
TEST(SphereTriangle, AtEdgeAb) { expect_feature(TriangleFeature::edge_ab); }
TEST(SphereTriangle, AtEdgeBc) { expect_feature(TriangleFeature::edge_bc); }
TEST(SphereTriangle, AtEdgeCa) { expect_feature(TriangleFeature::edge_ca); }
TEST(SphereTriangle, OverTheFace) { expect_feature(TriangleFeature::face); }

TEST(SphereTriangle, WithItsMiddleOnTheTriangleIsPushedOutOfTheFront) {
  const SphereTriangle found = sphere_triangle({1, 0, 1}, 0.5, kA, kB, kC);
  EXPECT_EQ(found.separation, -0.5);
  EXPECT_EQ(found.normal, (DVec3{0, 1, 0}));
}

TEST(SphereTriangle, WithoutAreaAnswersWithAnEdgeOrCorner) {
  EXPECT_NEAR(sphere_triangle({0, 1, 0.5}, 0.25, {0, 0, 0}, {0, 0, 1}, {0, 0, 0.5}).separation, 0.75,
              1.0e-12);
  EXPECT_NEAR(sphere_triangle({0, 1, 0}, 0.25, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}).separation, 0.75, 1.0e-12);
}

// The borders of the regions divide space into seven parts. Each random centre lies in the region whose closest point
// no other point of the triangle beats.
TEST(SphereTriangle, IsNearestOfADenseSampling) {
  oracle::Random random(301);
  int seen[7] = {};
  for (int i = 0; i < 3000; ++i) {
    const DVec3 a(random.in_cube()), b(random.in_cube()), c(random.in_cube());
    const DVec3 middle(random.in_cube(2.0f));
    const SphereTriangle found = sphere_triangle(middle, 0.3, a, b, c);
    ++seen[int(found.feature)];
    constexpr int kSteps = 40;
    double least = 1.0e300;
    for (int u = 0; u <= kSteps; ++u) {
      for (int v = 0; u + v <= kSteps; ++v) {
        const DVec3 p = a + (double(u) / kSteps) * (b - a) + (double(v) / kSteps) * (c - a);
        least = min(least, length(middle - p));
      }
    }
    EXPECT_LE(found.separation, least - 0.3 + 1.0e-12);
    // No point of the triangle is farther than that from one of the grid.
    const double cell = max(length(b - a), max(length(c - a), length(c - b))) / kSteps;
    EXPECT_GE(found.separation, least - 0.3 - cell);
  }
  for (int feature = 0; feature < 7; ++feature)
    EXPECT_GT(seen[feature], 100) << to_string(TriangleFeature(feature));
}

// A triangle alone, both its sides solid: the contact of a mesh is that of the feature.
TEST(SphereTriangle, IsWhatAMeshOfOneTriangleAnswers) {
  test::Triangles one;
  one.triangle(one.vertex(to_float(kA)), one.vertex(to_float(kB)), one.vertex(to_float(kC)));
  const Geometry mesh = one.cook(true);
  for (const Case& it : kCases) {
    const double distance = length(it.middle - it.nearest);
    for (const double over : {-0.01, 0.01}) {
      const float radius = float(distance - over);
      const test::Manifolds found = test::collide(mesh, Sphere{radius}, {to_float(it.middle), {}});
      ASSERT_EQ(found.count, 1) << to_string(it.feature);
      ASSERT_EQ(found.all[0].count, 1) << to_string(it.feature);
      EXPECT_NEAR(double(found.deepest()), over, 1.0e-6) << to_string(it.feature);
      const DVec3 normal = (it.middle - it.nearest) / distance;
      EXPECT_LT(length(DVec3(found.all[0].normal) - normal), 1.0e-5) << to_string(it.feature);
    }
  }
}

}  // namespace
}  // namespace gyre::sphere_triangle_test
