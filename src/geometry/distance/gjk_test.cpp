// GJK against its own proof (the witness points give an upper bound of the distance, the normal a lower one; if they
// are equal, the answer is right), against closed forms and against dense sampling, at every scale.
#include "geometry/distance/gjk.h"

#include "geometry/distance/closest.h"
#include "geometry/testing/convex_oracle.h"

#include <gtest/gtest.h>

#include <string>

namespace gyre::gjk_test {
namespace {

using namespace oracle;

// The distance of a point outside a core by the definition of its kind: the worst of many directions.
double outside_core(const Shape& shape, DVec3 p, Random& random) {
  double worst = -1.0e300;
  for (int i = 0; i < 40; ++i) {
    const DVec3 d(random.direction());
    worst = max(worst, dot(p, d) - extent(shape, d));
  }
  return worst;
}

TEST(Gjk, UpperAndLowerBoundMeetForAllKinds) {
  Random random(11);
  Hulls hulls;
  int apart = 0, touching = 0;
  for (float scale : {1.0f, 1.0e-3f, 1.0e3f}) {
    for (int i = 0; i < 12000; ++i) {
      const int kind_a = random.below(kKinds), kind_b = random.below(kKinds);
      const Shape a = random_shape(random, hulls, kind_a, scale),
                  b = random_shape(random, hulls, kind_b, scale);
      const Transform t = random_pose(random, scale);
      const CorePair pair(a, b, t);
      const CoreDistance found = core_distance(pair, 1.0e30, {});
      const std::string what =
          std::string(kind_name(kind_a)) + " " + kind_name(kind_b) + " " + std::to_string(i);
      const double size = pair.size();
      ASSERT_NEAR(length(found.normal), 1.0, 1.0e-9) << what;
      ASSERT_LT(found.iterations, 64) << what;
      if (found.overlap) {
        ++touching;
        // No direction separates them.
        EXPECT_LE(sampled_separation(a, b, pair, random, 60), 1.0e-6 * size) << what;
        continue;
      }
      ++apart;
      EXPECT_NEAR(separation(a, b, pair, found.normal), found.distance, 1.0e-6 * size) << what;
      EXPECT_NEAR(length(found.on_b - found.on_a), found.distance, 1.0e-9 * size) << what;
      EXPECT_LT(outside_core(a, found.on_a, random), 1.0e-6 * size) << what;
      EXPECT_LT(outside_core(b, pair.to_b(found.on_b - pair.center_of_b()), random), 1.0e-6 * size) << what;
    }
  }
  EXPECT_GT(apart, 5000);
  EXPECT_GT(touching, 5000);
}

TEST(Gjk, NearDistancesKeepTheirDirection) {
  // A cylinder lying over a box, down to a billionth of its size.
  const Shape box = make_box({1, 1, 1}), cylinder = make_along_y(ShapeKind::cylinder, 0.5f, 0.7f);
  const Quat lying = from_axis_angle({1, 0, 0}, 0.5f * kPi);
  for (float gap : {0.1f, 1.0e-3f, 1.0e-5f, 1.0e-6f}) {
    const Transform t{{0.1f, 1.5f + gap, -0.2f}, lying};
    const double expected = double(t.position.y) - 1.5;
    const CoreDistance found = core_distance(CorePair(box, cylinder, t), 1.0, {});
    ASSERT_FALSE(found.overlap) << gap;
    EXPECT_NEAR(found.distance, expected, 1.0e-7 * expected + 1.0e-9);
    EXPECT_LT(length(found.normal - DVec3{0, 1, 0}), 2.0e-4) << gap;
  }
}

TEST(Gjk, ClosedForms) {
  Random random(12);
  for (int i = 0; i < 3000; ++i) {
    // Point against box: clamping. Segment against segment: closest_of_segments.
    const Shape point = make_sphere(0.5f),
                box = make_box({random(0.1f, 1), random(0.1f, 1), random(0.1f, 1)});
    const Transform t = random_pose(random, 1.5f);
    const Vec3 p = t.position, h = box.extents;
    const double expected = length(DVec3(p) - DVec3(max(min(p, h), -h)));
    const CoreDistance to_box = core_distance(CorePair(box, point, t), 1.0e30, {});
    EXPECT_NEAR(to_box.distance, expected, 1.0e-9) << i;

    const Shape a = make_along_y(ShapeKind::capsule, 0.1f, random(0.1f, 1)),
                b = make_along_y(ShapeKind::capsule, 0.1f, 0.5f);
    const CorePair pair(a, b, t);
    const DVec3 up{0, double(a.extents.y), 0}, along = pair.from_b({0, 0.5, 0}), c = pair.center_of_b();
    const SegmentPair near = closest_of_segments(-up, up, c - along, c + along);
    const CoreDistance found = core_distance(pair, 1.0e30, {});
    EXPECT_NEAR(found.distance, length(near.on_b - near.on_a), 1.0e-8) << i;
  }
}

TEST(Gjk, WhatStandsOverAFaceOfABoxNeedsNoSearch) {
  Random random(17);
  const Shape box = make_box({60, 1, 60});
  int beside = 0;
  for (int i = 0; i < 2000; ++i) {
    const Shape capsule = make_along_y(ShapeKind::capsule, 0.1f, random(0.1f, 1));
    const Transform t{{random(-61, 61), random(1.9f, 3), random(-61, 61)}, random.rotation()};
    const DQuat back = conjugate(normalized(to_double(t.orientation)));
    const CorePair pair(box, capsule, t), other_way(capsule, box, -rotate(back, DVec3(t.position)), back);
    const DVec3 along = pair.from_b({0, double(capsule.extents.y), 0}), c = pair.center_of_b();
    const DVec3 low = c - (along.y < 0.0 ? -1.0 : 1.0) * along;
    const bool over = absolute(low.x) <= 60.0 && absolute(low.z) <= 60.0;
    if (low.y <= 1.0) continue;
    const CoreDistance found = core_distance(pair, 1.0e30, {}), turned = core_distance(other_way, 1.0e30, {});
    EXPECT_EQ(found.iterations == 0, over) << i;
    beside += over ? 0 : 1;
    if (!over) continue;
    EXPECT_DOUBLE_EQ(found.distance, low.y - 1.0) << i;
    EXPECT_EQ(found.normal, (DVec3{0, 1, 0})) << i;
    EXPECT_LT(length(found.on_b - low) + length(found.on_a - DVec3{low.x, 1.0, low.z}), 1.0e-12) << i;
    EXPECT_NEAR(turned.distance, found.distance, 1.0e-12) << i;
    EXPECT_LT(length(other_way.to_b(turned.normal) + found.normal), 1.0e-12) << i;
    // No point is closer than the lowest point, so a distance above the maximum needs no face below it.
    EXPECT_TRUE(core_distance(pair, 0.9 * found.distance, {}).beyond) << i;
  }
  EXPECT_GT(beside, 10);
}

TEST(Gjk, DenseSamplingNeverComesNearer) {
  Random random(13);
  const Shape cylinder = make_along_y(ShapeKind::cylinder, 0.6f, 0.4f),
              cone = make_along_y(ShapeKind::cone, 0.5f, 0.5f);
  for (int i = 0; i < 40; ++i) {
    Transform t{2.0f * random.direction(), random.rotation()};
    const CorePair pair(cylinder, cone, t);
    const CoreDistance found = core_distance(pair, 1.0e30, {});
    ASSERT_FALSE(found.overlap);
    double best = 1.0e30;
    std::vector<DVec3> rim, mantle;
    for (int k = 0; k < 200; ++k) {
      const SinCos s = sin_cos(2.0f * kPi * float(k) / 200.0f);
      for (int m = 0; m <= 10; ++m) {
        rim.push_back({0.6 * double(s.cos), -0.4 + 0.08 * m, 0.6 * double(s.sin)});
        rim.push_back({0.06 * m * double(s.cos), m % 2 ? 0.4 : -0.4, 0.06 * m * double(s.sin)});
        mantle.push_back({0.05 * m * double(s.cos), 0.5 - 0.1 * m, 0.05 * m * double(s.sin)});
      }
    }
    for (DVec3& p : mantle) p = pair.from_b(p) + pair.center_of_b();
    for (std::size_t k = 0; k < rim.size(); k += 3) {
      for (std::size_t m = 0; m < mantle.size(); m += 2) best = min(best, length(rim[k] - mantle[m]));
    }
    EXPECT_LE(found.distance, best + 1.0e-9);
    EXPECT_GT(found.distance, best - 0.2);
  }
}

TEST(Gjk, GivesUpEarlyOnlyWhenTrulyBeyond) {
  Random random(14);
  Hulls hulls;
  for (int i = 0; i < 4000; ++i) {
    const Shape a = random_shape(random, hulls, random.below(kKinds), 1.0f);
    const Shape b = random_shape(random, hulls, random.below(kKinds), 1.0f);
    const Transform t{2.0f * random.in_cube(), random.rotation()};
    const CorePair pair(a, b, t);
    const CoreDistance whole = core_distance(pair, 1.0e30, {});
    const CoreDistance cut = core_distance(pair, 0.1, random.direction());
    if (cut.beyond) {
      EXPECT_GT(whole.distance, 0.1 - 1.0e-9);
      EXPECT_LE(cut.distance, whole.distance + 1.0e-9);
    } else {
      EXPECT_NEAR(cut.distance, whole.distance, 1.0e-7);
    }
  }
}

TEST(Gjk, AGoodGuessSavesWork) {
  Random random(15);
  Hulls hulls;
  int cold = 0, warm = 0;
  for (int i = 0; i < 500; ++i) {
    const Shape a = hulls.add_random(random, 1.0f), b = hulls.add_random(random, 1.0f);
    const Transform t{3.0f * random.direction(), random.rotation()};
    const CorePair pair(a, b, t);
    const CoreDistance first = core_distance(pair, 1.0e30, {});
    const CoreDistance second = core_distance(pair, 1.0e30, to_float(first.normal));
    cold += first.iterations;
    warm += second.iterations;
    EXPECT_NEAR(first.distance, second.distance, 1.0e-6);
  }
  EXPECT_LT(warm, cold);
}

TEST(Gjk, ScalingByPowersOfTwoScalesEveryBit) {
  Random random(16);
  for (int i = 0; i < 1000; ++i) {
    const float radius = random(0.2f, 1), half = random(0.2f, 1);
    const Shape a = make_along_y(ShapeKind::cylinder, radius, half);
    const Shape b = make_box({random(0.2f, 1), random(0.2f, 1), random(0.2f, 1)});
    const Transform t{1.7f * random.direction(), random.rotation()};
    const CoreDistance one = core_distance(CorePair(a, b, t), 1.0e30, {});
    for (float scale : {1.0f / 1024.0f, 1024.0f}) {
      Shape sa = a, sb = b;
      sa.radius *= scale, sa.extents *= scale, sb.extents *= scale;
      const CoreDistance other =
          core_distance(CorePair(sa, sb, {scale * t.position, t.orientation}), 1.0e30, {});
      EXPECT_EQ(other.distance, double(scale) * one.distance);
      EXPECT_EQ(other.normal, one.normal);
      EXPECT_EQ(other.overlap, one.overlap);
    }
  }
}

}  // namespace
}  // namespace gyre::gjk_test
