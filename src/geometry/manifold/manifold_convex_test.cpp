// Manifolds of every pair of convex kinds: valid for any input, correct about which shapes touch, equal if shapes are
// swapped, moved together or scaled; and contacts by hand.
#include "geometry/manifold/manifold_convex.h"

#include "geometry/testing/convex_oracle.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace gyre::manifold_convex_test {
namespace {

using namespace oracle;

LocalManifold collide(const Shape& a, const Shape& b, const Transform& t, float max_separation) {
  PairCache cache;
  LocalManifold out;
  collide_convex(a, b, t, max_separation, cache, out);
  return out;
}

// The distance of a point of A's frame outside the surface of a shape.
double outside(const Shape& shape, Vec3 p) {
  const Shape point = make_sphere(0.0f);
  const CoreDistance found = core_distance(CorePair(shape, point, {p, {}}), 1.0e30, {});
  return found.distance - double(core_radius(shape));
}

// Capsules, cylinders, cones, and boxes so round that their cores are flat.
bool may_face_with_a_segment(const Shape& shape) {
  return shape.radius > 0.0f && shape.kind != ShapeKind::sphere;
}

// Invariants of any manifold of any two shapes.
void expect_sane(const Shape& a, const Shape& b, const Transform& t, float reach, const LocalManifold& m,
                 const std::string& what) {
  const double size = double(size_of(a, b, t));
  const double distance = signed_distance(a, b, t);
  ASSERT_GE(m.count, 0) << what;
  ASSERT_LE(m.count, kMaxManifoldPoints) << what;
  if (distance < -1.0e-5 * size) {
    ASSERT_GT(m.count, 0) << what << " at " << distance;
  }
  if (distance > double(reach) + 1.0e-5 * size) {
    ASSERT_EQ(m.count, 0) << what;
  }
  if (distance > 1.0e-5 * size && distance < double(reach) - 1.0e-5 * size) {
    ASSERT_GT(m.count, 0) << what;
  }
  if (m.count == 0) return;
  // Segments that touch in two points may pass each other by a fraction of their radii.
  const bool beside = may_face_with_a_segment(a) || may_face_with_a_segment(b);
  const double sideways = beside ? 0.06 * double(max(a.radius, b.radius)) + 1.0e-3 * size : 0.0;
  ASSERT_NEAR(length(m.normal), 1.0f, 1.0e-5f) << what;
  for (int i = 0; i < m.count; ++i) {
    const ManifoldPoint& point = m.points[i];
    ASSERT_TRUE(is_finite(point.position) && is_finite(point.separation)) << what;
    ASSERT_LE(point.separation, reach * 1.0001f + 1.0e-6f * float(size)) << what;
    for (int k = 0; k < i; ++k) {
      EXPECT_NE(point.feature, m.points[k].feature) << what << " of " << m.count;
    }
    // The two surfaces lie half the separation to each side. Caps, and faces with more corners than a polygon has room
    // for, are clipped slightly inside.
    const Vec3 on_a = point.position - (0.5f * point.separation) * m.normal;
    const Vec3 on_b = point.position + (0.5f * point.separation) * m.normal;
    const double slack = 1.0e-4 * size + 0.1 * max(-distance, 0.0) + sideways;
    EXPECT_LT(outside(a, on_a), slack) << what << " point " << i;
    EXPECT_LT(outside(b, inverse_times(t, on_b)), slack) << what << " point " << i;
    // Two points of the surfaces are never nearer than the surfaces.
    if (distance > 0.0) {
      EXPECT_GT(double(point.separation), distance - 1.0e-5 * size) << what;
    }
  }
  if (distance < 0.0) {
    // Deeper than the true depth only by the biases of the axis search.
    EXPECT_GT(double(deepest_of(m)), 1.09 * distance - 3.0e-3 * size) << what;
  }
}

void run_pairs(int rounds, unsigned seed) {
  Random random(seed);
  for (int kind_a = 0; kind_a < kKinds; ++kind_a) {
    for (int kind_b = 0; kind_b < kKinds; ++kind_b) {
      Hulls hulls;
      for (int i = 0; i < rounds; ++i) {
        const float scale = i % 3 == 0 ? 1.0f : i % 3 == 1 ? 1.0e-3f : 1.0e3f;
        const Shape a = random_shape(random, hulls, kind_a, scale);
        Shape b = random_shape(random, hulls, kind_b, scale);
        if (kind_a == kind_b && random.below(20) == 0) b = a;
        Transform t = random_pose(random, scale);
        const float reach = 0.02f * scale;
        if (random.below(4) == 0) {
          // Just touching, or just not.
          const double distance = signed_distance(a, b, t);
          if (distance > 0.0 && length(t.position) > 0.0f) {
            t.position -= (float(distance) + reach * random(-0.5f, 1.5f)) * normalized(t.position);
          }
        }
        const LocalManifold m = collide(a, b, t, reach);
        expect_sane(a, b, t, reach, m,
                    std::string(kind_name(kind_a)) + " " + kind_name(kind_b) + " " + std::to_string(i));
        if (::testing::Test::HasFatalFailure()) return;
      }
    }
  }
}

TEST(ManifoldConvex, EveryPairOfKindsIsSane) { run_pairs(400, 51); }
TEST(LongManifoldConvex, EveryPairOfKindsIsSane) { run_pairs(50000, 52); }

TEST(ManifoldConvex, SwappingTheShapesTurnsTheNormal) {
  Random random(53);
  Hulls hulls;
  int compared = 0;
  for (int i = 0; i < 20000; ++i) {
    const int kind_a = random.below(kKinds), kind_b = random.below(kKinds);
    const Shape a = random_shape(random, hulls, kind_a, 1.0f), b = random_shape(random, hulls, kind_b, 1.0f);
    const Transform t{1.2f * random.in_cube(), random.rotation()};
    const LocalManifold one = collide(a, b, t, 0.02f), other = collide(b, a, inverse(t), 0.02f);
    const std::string what =
        std::string(kind_name(kind_a)) + " " + kind_name(kind_b) + " " + std::to_string(i);
    const double distance = signed_distance(a, b, t);
    if (absolute(distance) < 1.0e-4 || absolute(distance - 0.02) < 1.0e-4) continue;
    ASSERT_EQ(one.count > 0, other.count > 0) << what;
    if (one.count == 0) continue;
    // If two directions are nearly equally good, either may be taken. The depth is then equal up to the bias.
    EXPECT_NEAR(deepest_of(one), deepest_of(other), 0.09f * max(-float(distance), 0.0f) + 4.0e-3f) << what;
    const Vec3 turned = -rotate(t.orientation, other.normal);
    if (distance > -0.05 && dot(one.normal, turned) > 0.999f) ++compared;
  }
  EXPECT_GT(compared, 1000);
}

TEST(ManifoldConvex, PowersOfTwoScaleEveryBit) {
  Random random(54);
  for (int i = 0; i < 6000; ++i) {
    Hulls hulls;
    const int kind_a = random.below(kKinds), kind_b = random.below(kKinds);
    const Shape a = random_shape(random, hulls, kind_a, 1.0f), b = random_shape(random, hulls, kind_b, 1.0f);
    const Transform t{0.9f * random.in_cube(), random.rotation()};
    const LocalManifold one = collide(a, b, t, 0.02f);
    for (float scale : {1.0f / 1024.0f, 1024.0f}) {
      const auto scaled = [&](const Shape& shape) {
        if (shape.kind == ShapeKind::hull) return hulls.add_scaled(*shape.hull, scale);
        Shape out = shape;
        out.radius *= scale;
        out.extents *= scale;
        return out;
      };
      const LocalManifold other =
          collide(scaled(a), scaled(b), {scale * t.position, t.orientation}, 0.02f * scale);
      const std::string what =
          std::string(kind_name(kind_a)) + " " + kind_name(kind_b) + " " + std::to_string(i);
      ASSERT_EQ(one.count, other.count) << what;
      if (one.count > 0) {
        EXPECT_EQ(one.normal, other.normal) << what;
      }
      for (int k = 0; k < one.count; ++k) {
        EXPECT_EQ(scale * one.points[k].position, other.points[k].position) << what;
        EXPECT_EQ(scale * one.points[k].separation, other.points[k].separation) << what;
        EXPECT_EQ(one.points[k].feature, other.points[k].feature) << what;
      }
    }
  }
}

TEST(ManifoldConvex, MovingBothFarAwayChangesNothingMuch) {
  Random random(55);
  Hulls hulls;
  for (int i = 0; i < 2000; ++i) {
    const Shape a = random_shape(random, hulls, 1 + random.below(5), 1.0f);
    const Shape b = random_shape(random, hulls, 1 + random.below(5), 1.0f);
    const Transform t{0.9f * random.in_cube(), random.rotation()};
    const Pose world_from_a{{1.0e6, -3.0e5, 2.0e6}, random.rotation()};
    const Pose world_from_b = world_from_a * t;
    const LocalManifold one = collide(a, b, t, 0.02f);
    const LocalManifold other = collide(a, b, inverse_times(world_from_a, world_from_b), 0.02f);
    const double distance = signed_distance(a, b, t);
    if (distance > 0.0199 || absolute(distance) < 1.0e-5) continue;
    ASSERT_GT(one.count, 0);
    ASSERT_GT(other.count, 0);
    EXPECT_NEAR(deepest_of(one), deepest_of(other), 0.09f * max(-float(distance), 0.0f) + 3.0e-3f) << i;
  }
}

TEST(ManifoldConvex, TheCacheChangesNoDecisionAboutTouching) {
  Random random(56);
  Hulls hulls;
  for (int i = 0; i < 2000; ++i) {
    const int kind_a = random.below(kKinds), kind_b = random.below(kKinds);
    const Shape a = random_shape(random, hulls, kind_a, 1.0f), b = random_shape(random, hulls, kind_b, 1.0f);
    PairCache cache;
    Transform t{random.in_cube(1.5f), random.rotation()};
    for (int step = 0; step < 10; ++step) {
      t.position += 0.1f * random.in_cube();
      t.orientation = normalized(t.orientation * from_rotation_vector(0.1f * random.in_cube()));
      LocalManifold m;
      collide_convex(a, b, t, 0.02f, cache, m);
      expect_sane(a, b, t, 0.02f, m,
                  std::string(kind_name(kind_a)) + " " + kind_name(kind_b) + " " + std::to_string(i));
      if (::testing::Test::HasFatalFailure()) return;
    }
    // A cache that belongs to another pair, or is noise, is only a bad guess.
    for (std::uint32_t& word : cache.words) word = std::uint32_t(random.engine());
    LocalManifold m;
    collide_convex(a, b, t, 0.02f, cache, m);
    expect_sane(a, b, t, 0.02f, m, std::string("noise ") + kind_name(kind_a) + " " + kind_name(kind_b));
    if (::testing::Test::HasFatalFailure()) return;
  }
}

TEST(ManifoldConvex, IdenticalShapesInTheSamePlace) {
  Random random(57);
  Hulls hulls;
  for (int kind = 0; kind < kKinds; ++kind) {
    for (int i = 0; i < 50; ++i) {
      const Shape a = random_shape(random, hulls, kind, 1.0f);
      const LocalManifold m = collide(a, a, {}, 0.02f);
      ASSERT_GT(m.count, 0) << kind_name(kind);
      EXPECT_NEAR(length(m.normal), 1.0f, 1.0e-5f);
      EXPECT_LT(deepest_of(m), 0.0f);
      EXPECT_GT(deepest_of(m), -2.5f);
    }
  }
}

TEST(ManifoldConvex, PosesThatAreNotFiniteDoNoHarm) {
  Random random(59);
  Hulls hulls;
  const float nothing = std::numeric_limits<float>::quiet_NaN(),
              endless = std::numeric_limits<float>::infinity();
  for (int kind_a = 0; kind_a < kKinds; ++kind_a) {
    for (int kind_b = 0; kind_b < kKinds; ++kind_b) {
      for (float bad : {nothing, endless, -endless, 1.0e38f}) {
        for (int part = 0; part < 7; ++part) {
          const Shape a = random_shape(random, hulls, kind_a, 1.0f),
                      b = random_shape(random, hulls, kind_b, 1.0f);
          Transform t{0.5f * random.in_cube(), random.rotation()};
          float* parts[7] = {&t.position.x,    &t.position.y,    &t.position.z,   &t.orientation.x,
                             &t.orientation.y, &t.orientation.z, &t.orientation.w};
          *parts[part] = bad;
          const LocalManifold m = collide(a, b, t, 0.02f);
          EXPECT_GE(m.count, 0);
          EXPECT_LE(m.count, kMaxManifoldPoints);
        }
      }
    }
  }
}

// ------------------------------------------------------------------------------------------------------ known contacts

TEST(ManifoldConvex, ACylinderStandsOnFourPointsOfItsRim) {
  const Shape box = make_box({2, 0.5f, 2}), cylinder = make_along_y(ShapeKind::cylinder, 0.4f, 0.6f);
  for (float gap : {-0.01f, -1.0e-5f, 0.01f}) {
    const LocalManifold m = collide(box, cylinder, {{0.3f, 1.1f + gap, -0.2f}, {}}, 0.02f);
    ASSERT_EQ(m.count, 4) << gap;
    EXPECT_LT(length(m.normal - Vec3{0, 1, 0}), 1.0e-5f);
    Vec3 middle;
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(m.points[i].separation, gap, 1.0e-6f);
      EXPECT_NEAR(distance(m.points[i].position, {0.3f, 0.5f + 0.5f * gap, -0.2f}), 0.4f, 1.0e-5f);
      middle += 0.25f * m.points[i].position;
    }
    // The support polygon holds the centre well inside.
    EXPECT_LT(distance(middle, {0.3f, 0.5f + 0.5f * gap, -0.2f}), 0.1f);
  }
}

TEST(ManifoldConvex, ACylinderRollsOnTwoPointsThatDoNotJump) {
  const Shape box = make_box({2, 0.5f, 2}), cylinder = make_along_y(ShapeKind::cylinder, 0.4f, 0.6f);
  const Quat lying = from_axis_angle({0, 0, 1}, 0.5f * kPi);
  for (float gap : {-0.005f, 0.005f}) {
    PairCache cache;
    for (int step = 0; step < 200; ++step) {
      const Quat q = from_axis_angle({1, 0, 0}, 0.05f * float(step)) * lying;
      const float z = -1.0f + 0.01f * float(step);
      LocalManifold m;
      collide_convex(box, cylinder, {{0, 0.9f + gap, z}, q}, 0.02f, cache, m);
      ASSERT_EQ(m.count, 2) << step;
      EXPECT_LT(length(m.normal - Vec3{0, 1, 0}), 5.0e-4f) << step;
      for (int i = 0; i < 2; ++i) {
        EXPECT_NEAR(m.points[i].separation, gap, 1.0e-5f) << step;
        EXPECT_NEAR(absolute(m.points[i].position.x), 0.6f, 1.0e-3f) << step;
        EXPECT_NEAR(m.points[i].position.z, z, 1.0e-3f) << step;
      }
      EXPECT_NE(m.points[0].feature, m.points[1].feature);
    }
  }
}

TEST(ManifoldConvex, ACapsuleLiesOnABoxWithTwoPoints) {
  const Shape box = make_box({2, 0.5f, 2}), capsule = make_along_y(ShapeKind::capsule, 0.25f, 0.5f);
  for (float tilt : {0.0f, 0.01f, -0.01f}) {
    const Quat lying = from_axis_angle({0, 0, 1}, 0.5f * kPi + tilt);
    const LocalManifold m = collide(box, capsule, {{0.1f, 0.75f, 0.2f}, lying}, 0.02f);
    ASSERT_EQ(m.count, 2);
    EXPECT_LT(length(m.normal - Vec3{0, 1, 0}), 1.0e-5f);
    for (int i = 0; i < 2; ++i) {
      const float x = m.points[i].position.x - 0.1f;
      EXPECT_NEAR(absolute(x), 0.5f, 1.0e-3f);
      EXPECT_NEAR(m.points[i].separation, x * tilt, 1.0e-4f);
    }
  }
}

TEST(ManifoldConvex, ACapsuleOrCylinderAlongAnEdgeTouchesTwice) {
  // A box on its edge. It rests on two points even while it leans a little.
  const Shape box = make_box({0.5f, 0.5f, 2}), capsule = make_along_y(ShapeKind::capsule, 0.25f, 0.5f);
  const Shape cylinder = make_along_y(ShapeKind::cylinder, 0.25f, 0.5f);
  const Quat a = from_axis_angle({0, 0, 1}, 0.25f * kPi);
  for (const Shape& round : {capsule, cylinder}) {
    for (float lean : {0.0f, 0.01f}) {
      const Quat b = from_axis_angle({1, 0, 0}, 0.5f * kPi + lean);
      const Pose world_from_a{{}, a}, world_from_b{{0, double(std::sqrt(0.5f)) + 0.25, 0.3}, b};
      const LocalManifold m = collide(box, round, inverse_times(world_from_a, world_from_b), 0.02f);
      ASSERT_EQ(m.count, 2);
      EXPECT_LT(length(rotate(a, m.normal) - Vec3{0, 1, 0}), 0.011f);
      for (int i = 0; i < 2; ++i) {
        const DVec3 p = world_from_a * m.points[i].position;
        EXPECT_NEAR(absolute(p.z - 0.3), 0.5, 5.0e-3);
        EXPECT_NEAR(double(m.points[i].separation), -double(lean) * (p.z - 0.3), 5.0e-4);
      }
      EXPECT_NE(m.points[0].feature, m.points[1].feature);
    }
  }
}

TEST(ManifoldConvex, ARoundedEdgeAlongAnEdgeTouchesTwiceHoweverItLeans) {
  // A hand over the edge of a stair: the normal goes all the way from one face of the edge to the other, and no end may be left free.
  const Shape stair = make_box({0.5f, 0.5f, 2}), hand = make_box({0.094f, 0.04f, 0.018f}, 0.015f);
  const Vec3 edge{0.5f, 0.5f, 0};
  for (int degrees = 5; degrees <= 85; degrees += 5) {
    const float angle = float(degrees) * kPi / 180.0f;
    const Vec3 normal{std::cos(angle), std::sin(angle), 0};
    for (float lean : {0.0f, 0.02f, -0.02f}) {
      // A part of the hand lies over the face towards which it leans.
      if (lean != 0.0f && (degrees < 15 || degrees > 75)) continue;
      // Its edge at -x and -z lies along the stair's, one end lower by the lean.
      const Vec3 across{-normal.y, normal.x, 0};
      const Quat turn = from_axis_angle(across, lean) * from_axis_angle({0, 0, 1}, angle + 0.25f * kPi) *
                        from_axis_angle({1, 0, 0}, 0.5f * kPi);
      const Vec3 middle = edge + 0.014f * normal;
      const Transform at{middle - rotate(turn, {-0.079f, 0, -0.003f}), turn};
      const LocalManifold m = collide(stair, hand, at, 0.02f);
      ASSERT_GE(m.count, 2) << degrees << " leans " << lean;
      EXPECT_GT(dot(m.normal, normal), 0.999f) << degrees;
      float low = kUnbounded, high = -kUnbounded;
      for (int i = 0; i < m.count; ++i) {
        if (m.points[i].separation > 0.0f) continue;  // the rest of the hand, beside a face
        low = min(low, m.points[i].position.z), high = max(high, m.points[i].position.z);
        EXPECT_NEAR(m.points[i].separation, -0.001f, 0.6e-3f) << degrees;
      }
      EXPECT_NEAR(low, -0.025f, 1.0e-3f) << degrees;
      EXPECT_NEAR(high, 0.025f, 1.0e-3f) << degrees;
    }
  }
}

TEST(ManifoldConvex, ConesStandOnTheirBaseAndLieOnTheirSide) {
  const Shape box = make_box({2, 0.5f, 2}), cone = make_along_y(ShapeKind::cone, 0.4f, 0.5f);
  const LocalManifold standing = collide(box, cone, {{0, 0.995f, 0}, {}}, 0.02f);
  ASSERT_EQ(standing.count, 4);
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(standing.points[i].separation, -0.005f, 1.0e-6f);
  // The mantle leans by atan(0.4 / 1.0) from the axis.
  const float lean = atan2(0.4f, 1.0f);
  const Quat lying = from_axis_angle({0, 0, 1}, -(0.5f * kPi + lean));
  const float lowest = min((rotate(lying, {0, 0.5f, 0})).y, (rotate(lying, {-0.4f, -0.5f, 0})).y);
  const float other = (rotate(lying, {0.4f, -0.5f, 0})).y;
  const float height = 0.5f - min(lowest, other) - 0.004f;
  const LocalManifold side = collide(box, cone, {{0, height, 0}, lying}, 0.02f);
  ASSERT_EQ(side.count, 2);
  EXPECT_LT(length(side.normal - Vec3{0, 1, 0}), 5.0e-4f);
  for (int i = 0; i < 2; ++i) EXPECT_NEAR(side.points[i].separation, -0.004f, 1.0e-4f);
}

TEST(ManifoldConvex, RoundedBoxesRestOnFourPoints) {
  const Shape floor = make_box({2, 0.5f, 2}), box = make_box({0.5f, 0.5f, 0.5f}, 0.1f);
  for (float gap : {-0.01f, 0.01f}) {
    const LocalManifold m = collide(floor, box, {{0, 1.0f + gap, 0}, {}}, 0.02f);
    ASSERT_EQ(m.count, 4);
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(m.points[i].separation, gap, 1.0e-6f);
      EXPECT_NEAR(m.points[i].position.y, 0.5f + 0.5f * gap, 1.0e-6f);
      EXPECT_NEAR(absolute(m.points[i].position.x), 0.4f, 1.0e-6f);
    }
  }
  // Rounded corner to corner: as two balls.
  const float s = 1.0f / std::sqrt(3.0f);
  const Vec3 along{s, s, s};
  const LocalManifold corner = collide(box, box, {Vec3{0.8f, 0.8f, 0.8f} + 0.19f * along, {}}, 0.02f);
  ASSERT_EQ(corner.count, 1);
  EXPECT_NEAR(corner.points[0].separation, -0.01f, 1.0e-5f);
  EXPECT_LT(length(corner.normal - along), 1.0e-5f);
}

TEST(ManifoldConvex, BoxesAndTheirHullsAgree) {
  Random random(58);
  for (int i = 0; i < 2000; ++i) {
    Hulls hulls;
    const Vec3 ha{random(0.2f, 1), random(0.2f, 1), random(0.2f, 1)},
        hb{random(0.2f, 1), random(0.2f, 1), random(0.2f, 1)};
    const Shape a = make_box(ha), b = make_box(hb), hull_b = hulls.add_box(hb);
    const Transform t{random.in_cube(), random.rotation()};
    const LocalManifold boxes = collide(a, b, t, 0.02f), mixed = collide(a, hull_b, t, 0.02f);
    const double distance = signed_distance(a, b, t);
    if (absolute(distance - 0.02) < 1.0e-4) continue;
    ASSERT_EQ(boxes.count > 0, mixed.count > 0) << i;
    if (boxes.count == 0) continue;
    EXPECT_NEAR(deepest_of(boxes), deepest_of(mixed), 0.09f * max(-float(distance), 0.0f) + 2.0e-3f) << i;
  }
}

TEST(ManifoldConvex, TheMethodTableIsSymmetric) {
  Random random(60);
  Hulls hulls;
  for (int a = 0; a < kKinds; ++a) {
    for (int b = 0; b < kKinds; ++b) {
      const Shape one = random_shape(random, hulls, a, 1.0f), other = random_shape(random, hulls, b, 1.0f);
      EXPECT_EQ(contact_method(one, other), contact_method(other, one));
      EXPECT_EQ(contact_method(one, make_plane({0, 1, 0}, 0)), ContactMethod::plane);
      EXPECT_NE(contact_method(one, other), ContactMethod::none);
    }
  }
}

}  // namespace
}  // namespace gyre::manifold_convex_test
