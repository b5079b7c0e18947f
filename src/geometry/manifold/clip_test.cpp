// Clipping against areas and names worked out by hand, and the reduction to four points against brute force.
#include "geometry/manifold/clip.h"

#include "geometry/testing/convex_oracle.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace gyre::clip_test {
namespace {

using namespace oracle;

FacePolygon square(float half, float height, float turn, bool up) {
  FacePolygon face;
  face.count = 4;
  const Quat q = from_axis_angle({0, 1, 0}, turn);
  // Counter-clockwise seen from above is from x towards -z.
  const Vec3 corners[4] = {
      {half, height, half}, {half, height, -half}, {-half, height, -half}, {-half, height, half}};
  for (int i = 0; i < 4; ++i) {
    face.vertices[i] = rotate(q, corners[up ? i : 3 - i]);
    face.ids[i] = std::uint8_t(up ? i : 3 - i);
  }
  face.normal = {0, up ? 1.0f : -1.0f, 0};
  return face;
}

TEST(Clip, SquareInsideSquareKeepsItsOwnCorners) {
  const FacePolygon a = square(1.0f, 0.0f, 0.0f, true), b = square(0.5f, -0.01f, 0.3f, false);
  const FacePair pair{&a, &b, {0, 1, 0}, 0.0f, 0.0f, 0.1f};
  ManifoldPoint points[kMaxClipPoints];
  for (bool reference_is_a : {true, false}) {
    ASSERT_EQ(clip_faces(pair, reference_is_a, points), 4) << reference_is_a;
    std::set<std::uint32_t> names;
    for (int i = 0; i < 4; ++i) {
      EXPECT_FLOAT_EQ(points[i].separation, -0.01f);
      EXPECT_NEAR(points[i].position.y, -0.005f, 1.0e-7f);
      names.insert(points[i].feature);
    }
    // The same four names for either clipped face.
    EXPECT_EQ(names, (std::set<std::uint32_t>{feature_vertex_b(0), feature_vertex_b(1), feature_vertex_b(2),
                                              feature_vertex_b(3)}));
  }
}

TEST(Clip, TurnedSquaresMakeAnOctagonOfNamedCrossings) {
  const FacePolygon a = square(1.0f, 0.0f, 0.0f, true), b = square(1.0f, 0.02f, 0.25f * kPi, false);
  const FacePair pair{&a, &b, {0, 1, 0}, 0.0f, 0.0f, 0.1f};
  ManifoldPoint first[kMaxClipPoints], second[kMaxClipPoints];
  ASSERT_EQ(clip_faces(pair, true, first), 8);
  ASSERT_EQ(clip_faces(pair, false, second), 8);
  std::set<std::uint32_t> names, others;
  for (int i = 0; i < 8; ++i) {
    EXPECT_NEAR(first[i].separation, 0.02f, 1.0e-7f);
    // Corners of the regular octagon of inner radius 1.
    EXPECT_NEAR(first[i].position.x * first[i].position.x + first[i].position.z * first[i].position.z,
                1.1715729f, 1.0e-5f);
    names.insert(first[i].feature);
    others.insert(second[i].feature);
  }
  EXPECT_EQ(names.size(), 8u);
  EXPECT_EQ(names, others);
}

TEST(Clip, CornersOfTheReferenceAreNamedAsItsVertices) {
  const FacePolygon a = square(0.5f, 0.0f, 0.0f, true), b = square(2.0f, 0.0f, 0.4f, false);
  const FacePair pair{&a, &b, {0, 1, 0}, 0.0f, 0.0f, 0.1f};
  ManifoldPoint points[kMaxClipPoints];
  ASSERT_EQ(clip_faces(pair, true, points), 4);
  std::set<std::uint32_t> names;
  for (int i = 0; i < 4; ++i) names.insert(points[i].feature);
  EXPECT_EQ(names, (std::set<std::uint32_t>{feature_vertex_a(0), feature_vertex_a(1), feature_vertex_a(2),
                                            feature_vertex_a(3)}));
}

TEST(Clip, RadiiAndFarPoints) {
  // Tilted: only the low side is near enough.
  const FacePolygon a = square(1.0f, 0.0f, 0.0f, true);
  FacePolygon b = square(0.5f, 0.0f, 0.0f, false);
  for (Vec3& v : b.vertices) v.y = 0.3f + 0.2f * v.x;
  const FacePair pair{&a, &b, {0, 1, 0}, 0.1f, 0.15f, 0.05f};
  ManifoldPoint points[kMaxClipPoints];
  ASSERT_EQ(clip_faces(pair, true, points), 2);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(points[i].position.x, -0.5f, 1.0e-6f);
    EXPECT_NEAR(points[i].separation, 0.2f - 0.25f, 1.0e-6f);
    // Midway between the surfaces at heights 0.1 and 0.05.
    EXPECT_NEAR(points[i].position.y, 0.075f, 1.0e-6f);
  }
}

TEST(Clip, NothingInCommon) {
  const FacePolygon a = square(1.0f, 0.0f, 0.0f, true);
  FacePolygon b = square(0.5f, 0.0f, 0.3f, false);
  for (Vec3& v : b.vertices) v.x += 3.0f;
  const FacePair pair{&a, &b, {0, 1, 0}, 0.0f, 0.0f, 0.1f};
  ManifoldPoint points[kMaxClipPoints];
  EXPECT_EQ(clip_faces(pair, true, points), 0);
  EXPECT_EQ(clip_faces(pair, false, points), 0);
}

TEST(Clip, ASegmentKeepsTheStretchOverTheFace) {
  const FacePolygon a = square(1.0f, 0.0f, 0.0f, true);
  FacePolygon b;
  b.count = 2;
  b.vertices[0] = {-3.0f, 0.1f, 0.5f};
  b.vertices[1] = {0.5f, 0.1f, 0.5f};
  b.ids[1] = 1;
  const FacePair pair{&a, &b, {0, 1, 0}, 0.0f, 0.1f, 0.05f};
  ManifoldPoint points[kMaxClipPoints];
  ASSERT_EQ(clip_faces(pair, true, points), 2);
  EXPECT_NEAR(points[0].position.x, -1.0f, 1.0e-6f);
  EXPECT_NEAR(points[1].position.x, 0.5f, 1.0e-6f);
  EXPECT_EQ(points[1].feature, feature_vertex_b(1));
  EXPECT_NEAR(points[0].separation, 0.0f, 1.0e-7f);
}

TEST(Clip, SegmentsSideBySide) {
  FacePolygon a, b;
  a.count = b.count = 2;
  a.ids[1] = b.ids[1] = 1;
  a.vertices[0] = {-1, 0, 0}, a.vertices[1] = {1, 0, 0};
  b.vertices[0] = {3, 1, 0}, b.vertices[1] = {0, 1, 0};
  const FacePair pair{&a, &b, {0, 1, 0}, 0.5f, 0.4f, 0.2f};
  ManifoldPoint points[kMaxClipPoints];
  ASSERT_EQ(clip_segments(pair, points), 2);
  EXPECT_NEAR(points[0].position.x, 0.0f, 1.0e-6f);
  EXPECT_NEAR(points[1].position.x, 1.0f, 1.0e-6f);
  EXPECT_EQ(points[0].feature, feature_vertex_b(1));
  EXPECT_EQ(points[1].feature, feature_vertex_a(1));
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(points[i].separation, 0.1f, 1.0e-6f);
    EXPECT_NEAR(points[i].position.y, 0.55f, 1.0e-6f);
  }
  b.vertices[0].x = 5.0f, b.vertices[1].x = 4.0f;
  EXPECT_EQ(clip_segments(pair, points), 0);
}

TEST(Clip, EveryPointLiesInBothPolygonsAndBetweenThePlanes) {
  Random random(31);
  for (int i = 0; i < 5000; ++i) {
    const FacePolygon a = square(random(0.2f, 1.0f), 0.0f, random(0, 6), true);
    FacePolygon b = square(random(0.2f, 1.0f), 0.0f, random(0, 6), false);
    const Vec3 shift = random.in_cube(), slope = random.in_cube(0.1f);
    for (int k = 0; k < 4; ++k) {
      b.vertices[k] += Vec3{shift.x, 0.0f, shift.z};
      b.vertices[k].y = slope.y + slope.x * b.vertices[k].x + slope.z * b.vertices[k].z;
    }
    b.normal = normalized(Vec3{slope.x, -1.0f, slope.z});
    const FacePair pair{&a, &b, {0, 1, 0}, 0.0f, 0.0f, 1.0f};
    ManifoldPoint points[kMaxClipPoints];
    for (bool reference_is_a : {true, false}) {
      const int count = clip_faces(pair, reference_is_a, points);
      ASSERT_LE(count, 8);
      for (int k = 0; k < count; ++k) {
        const Vec3 p = points[k].position;
        EXPECT_NEAR(points[k].separation, slope.y + slope.x * p.x + slope.z * p.z, 1.0e-5f);
        const FacePolygon* const faces[2] = {&a, &b};
        for (const FacePolygon* face : faces) {
          for (int e = 0; e < 4; ++e) {
            const Vec3 from = face->vertices[e], to = face->vertices[(e + 1) % 4];
            const Vec3 outward = cross(to - from, Vec3{0, face == &a ? 1.0f : -1.0f, 0});
            EXPECT_LT(dot(outward, p - from), 1.0e-5f);
          }
        }
      }
    }
  }
}

// ---------------------------------------------------------------------------------------------------------- reduction

float polygon_area(const std::vector<ManifoldPoint>& points) {
  // Largest quadrilateral or triangle over all choices and orders.
  float best = 0.0f;
  const std::size_t n = points.size();
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = 0; b < n; ++b) {
      for (std::size_t c = 0; c < n; ++c) {
        for (std::size_t d = 0; d < n; ++d) {
          const Vec3 across = points[c].position - points[a].position,
                     other = points[d].position - points[b].position;
          best = max(best, 0.5f * absolute(cross(across, other).y));
        }
      }
    }
  }
  return best;
}

TEST(ReducePoints, KeepsTheDeepestAndAlmostTheLargestArea) {
  Random random(32);
  float worst = 1.0f;
  for (int i = 0; i < 300; ++i) {
    const int count = 5 + random.below(6);
    std::vector<ManifoldPoint> points;
    for (int k = 0; k < count; ++k) {
      const SinCos s = sin_cos(6.2831853f * (float(k) + random(0.0f, 0.8f)) / float(count));
      points.push_back({{s.cos, 0.0f, 0.6f * s.sin}, random(-0.1f, 0.05f), std::uint32_t(k * 7 % 11)});
    }
    const float before = polygon_area(points);
    float deepest = 1.0f;
    for (const ManifoldPoint& p : points) deepest = min(deepest, p.separation);
    std::vector<ManifoldPoint> kept = points;
    const int left = reduce_points(kept.data(), count, {0, 1, 0});
    ASSERT_EQ(left, 4);
    kept.resize(4);
    float kept_deepest = 1.0f;
    for (const ManifoldPoint& p : kept) kept_deepest = min(kept_deepest, p.separation);
    EXPECT_NEAR(kept_deepest, deepest, 2.0e-3f);
    worst = min(worst, polygon_area(kept) / before);
  }
  EXPECT_GT(worst, 0.6f);
}

TEST(ReducePoints, NoiseDoesNotChangeTheChoice) {
  Random random(33);
  for (int i = 0; i < 200; ++i) {
    ManifoldPoint points[8];
    for (int k = 0; k < 8; ++k) {
      const SinCos s = sin_cos(6.2831853f * float(k) / 8.0f);
      points[k] = {{s.cos, 0.0f, s.sin}, -0.01f, std::uint32_t(k)};
    }
    std::set<std::uint32_t> expected;
    ManifoldPoint copy[8];
    for (int round = 0; round < 10; ++round) {
      for (int k = 0; k < 8; ++k) {
        copy[k] = points[k];
        copy[k].separation += random(-1.0e-6f, 1.0e-6f);
        copy[k].position += 1.0e-6f * random.in_cube();
      }
      ASSERT_EQ(reduce_points(copy, 8, {0, 1, 0}), 4);
      std::set<std::uint32_t> names;
      for (int k = 0; k < 4; ++k) names.insert(copy[k].feature);
      if (round == 0) expected = names;
      EXPECT_EQ(names, expected);
    }
  }
}

TEST(ReducePoints, NoPointIsTakenTwice) {
  Random random(34);
  for (int i = 0; i < 20000; ++i) {
    ManifoldPoint points[9];
    const int count = 5 + random.below(5);
    const float flat = random.below(2) == 0 ? 1.0f : 1.0e-3f;
    for (int k = 0; k < count; ++k) {
      points[k] = {{random(-1, 1), 0.0f, flat * random(-1, 1)}, random(-0.1f, 0.0f), std::uint32_t(k)};
      if (k > 2 && random.below(3) == 0) points[k].position = points[0].position;
    }
    const int left = reduce_points(points, count, {0, 1, 0});
    std::set<std::uint32_t> names;
    for (int k = 0; k < left; ++k) names.insert(points[k].feature);
    EXPECT_EQ(int(names.size()), left) << i;
  }
}

TEST(ReducePoints, FewCoincidentAndCollinearPoints) {
  ManifoldPoint points[10];
  for (int k = 0; k < 10; ++k) points[k] = {{1, 2, 3}, -0.1f, std::uint32_t(k)};
  EXPECT_EQ(reduce_points(points, 3, {0, 1, 0}), 3);
  EXPECT_EQ(reduce_points(points, 10, {0, 1, 0}), 1);
  for (int k = 0; k < 10; ++k) points[k] = {{float(k), 2, 3}, -0.1f, std::uint32_t(k)};
  ASSERT_EQ(reduce_points(points, 10, {0, 1, 0}), 2);
  EXPECT_EQ(points[0].position.x, 0.0f);
  EXPECT_EQ(points[1].position.x, 9.0f);
}

}  // namespace
}  // namespace gyre::clip_test
