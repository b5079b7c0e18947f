// A rolling body gets contacts of the slope beyond a valley before it lies over it: only there, exact, and only within
// its range.
#include "geometry/distance/closest.h"
#include "geometry/shape/cooked.h"
#include "geometry/shape/mesh.h"
#include "geometry/testing/mesh_contact_test.h"

#include <gtest/gtest.h>

namespace gyre::mesh_valleys_test {
namespace {

using namespace test;

constexpr float kBall = 0.1f;

// A floor that goes on with a slope from x = 0, in cells.
Geometry fold(float slope, float cell = 0.5f) {
  return grid(2.0f, cell, [=](float x, float) { return x > 0.0f ? slope * x : 0.0f; }).cook();
}

TEST(MeshValleys, ABallIsToldOfTheFarSlopeWhereItWillTouch) {
  for (const float slope : {0.05f, 0.1f, 0.2f, 0.4f}) {
    const Geometry ground = fold(slope);
    const Vec3 normal = normalized(Vec3{-slope, 1, 0});
    int told = 0;
    for (float z = -0.6f; z < 0.6f; z += 0.037f) {
      for (float beyond = 0.0005f; beyond < 0.02f; beyond += 0.0013f) {
        SCOPED_TRACE(testing::Message() << "slope " << slope << ", z " << z << ", beyond " << beyond);
        // On the floor, its foot on the slope's plane so far beyond the valley.
        const Vec3 place{-slope * kBall - beyond / normal.y, kBall, z};
        const float separation = dot(normal, place) - kBall;
        if (square(beyond) + square(separation) > square(0.0195f)) continue;  // out of reach
        const Manifolds found = collide(ground, Sphere{kBall}, {place, {}}, 0.02f);
        ASSERT_EQ(found.count, 2);
        const LocalManifold* far = found.along(normal, 1.0e-5f);
        ASSERT_NE(far, nullptr);
        ASSERT_EQ(far->count, 1);
        EXPECT_NEAR(far->points[0].separation, separation, 1.0e-6f);
        const Vec3 middle = place - (kBall + 0.5f * separation) * normal;
        EXPECT_LT(length(far->points[0].position - middle), 1.0e-6f);
        EXPECT_NE(found.along(kUp, 1.0e-5f), nullptr);
        ++told;
      }
    }
    EXPECT_GT(told, 100) << slope;
  }
}

TEST(MeshValleys, WhatIsOutOfReachIsNotTold) {
  const Geometry ground = fold(0.1f);
  // Its foot 3 cm beyond the valley; and 1 cm, but 3 cm above the slope.
  EXPECT_EQ(collide(ground, Sphere{kBall}, {{-0.04f, kBall, 0.1f}, {}}, 0.02f).count, 1);
  EXPECT_EQ(collide(ground, Sphere{kBall}, {{-0.003f, kBall + 0.03f, 0.1f}, {}}, 0.02f).count, 0);
  // Queries, which ask for what touches, have no reach.
  EXPECT_EQ(collide(ground, Sphere{kBall}, {{-0.0105f, kBall - 1.0e-4f, 0.1f}, {}}, 0.0f).count, 1);
}

TEST(MeshValleys, FlatAndConvexEdgesAddNothing) {
  for (const float slope : {0.0f, -0.02f, -0.1f, -0.5f}) {
    const Geometry ground = fold(slope, 0.05f);
    for (float x = -0.3f; x < -0.0005f; x += 0.0037f) {
      const Manifolds found = collide(ground, Sphere{kBall}, {{x, kBall + 1.0e-4f, 0.3f * x}, {}});
      ASSERT_EQ(found.count, 1) << slope << " " << x;
      EXPECT_LT(length(found.all[0].normal - kUp), 1.0e-5f);
      EXPECT_EQ(found.points(), 1);
      EXPECT_NEAR(found.deepest(), 1.0e-4f, 1.0e-6f);
    }
  }
}

TEST(MeshValleys, BothEndsOfACapsuleAreTold) {
  const float slope = 0.1f;
  const Vec3 normal = normalized(Vec3{-slope, 1, 0}), place{-0.02f, kBall, 0.13f};
  const Manifolds found =
      collide(fold(slope), Capsule{kBall, 0.3f}, {place, from_axis_angle({1, 0, 0}, 0.5f * kPi)});
  ASSERT_EQ(found.count, 2);
  const LocalManifold* far = found.along(normal, 1.0e-5f);
  ASSERT_NE(far, nullptr);
  ASSERT_EQ(far->count, 2);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(far->points[k].separation, dot(normal, place) - kBall, 1.0e-6f);
}

// For any displacement of a ball within the margin, its contacts predict at least the depth that it will have: along
// folds in any order, by brute force. Normals that differ by less than two degrees share a manifold; their effect is
// not tested.
TEST(MeshValleys, ContactsForetellWhatIsReached) {
  Random random{31};
  int entered = 0;
  for (int round = 0; round < 40; ++round) {
    const float cell = 0.25f;
    float heights[64];
    for (float& h : heights) h = random.between(0.0f, 0.1f);
    const Geometry ground =
        grid(1.0f, cell, [&](float x, float) { return heights[int((x + 1.0f) / cell + 0.5f)]; }).cook();
    const Mesh& mesh = *ground.data()->mesh;
    const auto distance = [&](Vec3 p) {
      double least = 1.0e9;
      for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
        const TriangleView view = view_triangle(mesh, t);
        const DVec3 near =
            closest_on_triangle(DVec3(p), DVec3(view.v[0]), DVec3(view.v[1]), DVec3(view.v[2])).point;
        least = min(least, length(DVec3(p) - near));
      }
      return float(least);
    };
    for (int i = 0; i < 60; ++i) {
      Vec3 place{random.between(-0.7f, 0.7f), 0.5f, random.between(-0.7f, 0.7f)};
      for (int k = 0; k < 40; ++k) place.y -= distance(place) - kBall;
      place.y += random.between(0.0f, 0.005f);
      const Vec3 way = 0.98f * kMargin * random.direction();
      const float after = distance(place + way) - kBall;
      const Manifolds found = collide(ground, Sphere{kBall}, {place, {}});
      float foretold = kMargin;
      for (int m = 0; m < found.count; ++m) {
        for (int k = 0; k < found.all[m].count; ++k)
          foretold = min(foretold, found.all[m].points[k].separation + dot(found.all[m].normal, way));
      }
      entered += after < 0.0f;
      EXPECT_LT(foretold, after + 3.0e-4f) << "round " << round << ", ball " << i;
    }
  }
  EXPECT_GT(entered, 500);
}

}  // namespace
}  // namespace gyre::mesh_valleys_test
