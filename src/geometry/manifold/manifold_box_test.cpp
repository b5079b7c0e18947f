// Boxes: resting contacts to the micrometre, names that stay, and the axis against brute force.
#include "geometry/manifold/manifold_box.h"

#include "geometry/testing/convex_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace gyre::manifold_box_test {
namespace {

using namespace oracle;

LocalManifold collide(const Shape& a, const Shape& b, const Transform& t, float max_separation) {
  PairCache cache;
  LocalManifold out;
  collide_boxes(a, b, t, max_separation, cache, out);
  return out;
}

std::set<std::uint32_t> names_of(const LocalManifold& m) {
  std::set<std::uint32_t> names;
  for (int i = 0; i < m.count; ++i) names.insert(m.points[i].feature);
  return names;
}

TEST(ManifoldBox, ARestingCubeIsExactToTheMicrometre) {
  const Shape floor = make_box({10, 0.5f, 10}), cube = make_box({0.5f, 0.5f, 0.5f});
  for (float gap : {-0.003f, 0.0f, 0.003f}) {
    const Transform t{{3.3f, 1.0f + gap, -4.7f}, from_axis_angle({0, 1, 0}, 0.3f)};
    const LocalManifold m = collide(floor, cube, t, 0.02f);
    ASSERT_EQ(m.count, 4);
    EXPECT_EQ(m.normal, (Vec3{0, 1, 0}));
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(m.points[i].separation, gap, 2.0e-7f);
      EXPECT_NEAR(m.points[i].position.y, 0.5f + 0.5f * gap, 2.0e-7f);
      const Vec3 local = inverse_times(t, m.points[i].position);
      EXPECT_NEAR(absolute(local.x), 0.5f, 1.0e-6f);
      EXPECT_NEAR(absolute(local.z), 0.5f, 1.0e-6f);
    }
    // The same from the cube's side.
    const LocalManifold swapped = collide(cube, floor, inverse(t), 0.02f);
    ASSERT_EQ(swapped.count, 4);
    EXPECT_LT(length(swapped.normal - Vec3{0, -1, 0}), 1.0e-6f);
    for (int i = 0; i < 4; ++i) {
      EXPECT_NEAR(swapped.points[i].separation, gap, 1.0e-6f);
      EXPECT_NEAR(absolute(swapped.points[i].position.x), 0.5f, 1.0e-6f);
      EXPECT_NEAR(absolute(swapped.points[i].position.z), 0.5f, 1.0e-6f);
    }
  }
}

TEST(ManifoldBox, NamesStayWhileItRattles) {
  Random random(61);
  const Shape brick = make_box({0.5f, 0.25f, 0.25f});
  PairCache cache;
  std::set<std::uint32_t> first;
  for (int step = 0; step < 500; ++step) {
    const Transform t{
        Vec3{0.25f, 0.499f, 0.05f} + 1.0e-4f * random.in_cube(),
        normalized(Quat{random(-1e-4f, 1e-4f), random(-1e-4f, 1e-4f), random(-1e-4f, 1e-4f), 1.0f})};
    LocalManifold m;
    collide_boxes(brick, brick, t, 0.02f, cache, m);
    ASSERT_EQ(m.count, 4);
    if (step == 0) first = names_of(m);
    EXPECT_EQ(names_of(m), first) << step;
    EXPECT_GT(m.normal.y, 0.999f);
  }
}

TEST(ManifoldBox, NamesAreTheSameWhicheverBoxIsTheReference) {
  const Shape a = make_box({1, 0.5f, 1}), b = make_box({0.6f, 0.5f, 1.3f});
  const Transform t{{0.2f, 0.99f, 0.1f}, from_axis_angle({0, 1, 0}, 0.2f)};
  PairCache by_a, by_b;
  by_a.words[0] = 1 + 1;      // A's y axis
  by_b.words[0] = 1 + 3 + 1;  // B's y axis
  LocalManifold first, second;
  collide_boxes(a, b, t, 0.02f, by_a, first);
  collide_boxes(a, b, t, 0.02f, by_b, second);
  EXPECT_EQ(by_a.words[0], 2u);
  EXPECT_EQ(by_b.words[0], 5u);
  ASSERT_EQ(first.count, 4);
  ASSERT_EQ(second.count, 4);
  EXPECT_EQ(names_of(first), names_of(second));
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 4; ++k) {
      if (first.points[i].feature != second.points[k].feature) continue;
      EXPECT_LT(distance(first.points[i].position, second.points[k].position), 1.0e-6f);
    }
  }
}

TEST(ManifoldBox, CrossedEdgesTouchInOnePoint) {
  // One cube turned by 45 degrees about x, the other about z: their edges cross at a right angle above the origin.
  const Shape cube = make_box({0.5f, 0.5f, 0.5f});
  const Quat qa = from_axis_angle({1, 0, 0}, 0.25f * kPi), qb = from_axis_angle({0, 0, 1}, 0.25f * kPi);
  const float s = std::sqrt(0.5f);
  for (float gap : {-0.01f, 0.01f}) {
    const Pose a{{}, qa}, b{{0.0, 2.0 * double(s) + double(gap), 0.0}, qb};
    const LocalManifold m = collide(cube, cube, inverse_times(a, b), 0.02f);
    ASSERT_EQ(m.count, 1);
    EXPECT_NEAR(m.points[0].separation, gap, 1.0e-6f);
    const Vec3 world = to_float(a * m.points[0].position), normal = rotate(qa, m.normal);
    EXPECT_LT(distance(world, {0, s + 0.5f * gap, 0}), 1.0e-6f);
    EXPECT_LT(distance(normal, {0, 1, 0}), 1.0e-6f);
  }
}

TEST(ManifoldBox, PointsHaveExactHeightsWhenTilted) {
  Random random(62);
  const Shape floor = make_box({5, 0.5f, 5}), cube = make_box({0.5f, 0.4f, 0.3f});
  for (int i = 0; i < 500; ++i) {
    const Quat q =
        normalized(from_axis_angle({0, 1, 0}, random(0, 6)) * from_rotation_vector(0.03f * random.in_cube()));
    const Transform t{{random(-3, 3), 0.9f, random(-3, 3)}, q};
    const LocalManifold m = collide(floor, cube, t, 0.5f);
    ASSERT_EQ(m.count, 4);
    for (int k = 0; k < 4; ++k) {
      // Each corner of the lower face, from the definition.
      const Vec3 on_b = m.points[k].position + (0.5f * m.points[k].separation) * m.normal;
      const Vec3 local = inverse_times(t, on_b);
      EXPECT_LT(distance(absolute(local), cube.extents), 2.0e-6f);
      EXPECT_NEAR(m.points[k].separation,
                  (t * Vec3{std::copysign(0.5f, local.x), -0.4f, std::copysign(0.3f, local.z)}).y - 0.5f,
                  1.0e-6f);
    }
  }
}

TEST(ManifoldBox, DepthEqualsBruteForceOverFifteenAxes) {
  Random random(63);
  for (int i = 0; i < 30000; ++i) {
    const float scale = i % 3 == 0 ? 1.0f : i % 3 == 1 ? 1.0e-3f : 1.0e3f;
    const auto half = [&] { return scale * (random.below(10) == 0 ? 0.01f : random(0.1f, 1.0f)); };
    const Vec3 ha{half(), half(), half()}, hb{half(), half(), half()};
    const Shape a = make_box(ha), b = make_box(hb);
    const Transform t = random_pose(random, scale);
    const CorePair pair(a, b, t);
    const DVec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double best = -1.0e300;
    std::vector<std::pair<DVec3, double>> looked;
    const auto look = [&](DVec3 n) {
      const double s = length(n);
      if (!(s > 1.0e-4)) return;
      for (const DVec3& axis : {n / s, n / -s}) {
        looked.push_back({axis, separation(a, b, pair, axis)});
        best = max(best, looked.back().second);
      }
    };
    for (const DVec3& axis : axes) {
      look(axis);
      look(pair.from_b(axis));
      for (const DVec3& other : axes) look(cross(axis, pair.from_b(other)));
    }
    const LocalManifold m = collide(a, b, t, 0.0f);
    const double noise = 3.0e-6 * pair.size();
    if (best > noise) {
      EXPECT_EQ(m.count, 0) << i;
    }
    if (best > -noise) continue;
    ASSERT_GT(m.count, 0) << i << " " << best;
    // The normal is the best axis, or one within the biases of it, or that of a face close to crossing edges.
    const double along = separation(a, b, pair, DVec3(m.normal));
    const double thin = double(min(smallest(ha), smallest(hb)));
    EXPECT_LE(along, best + noise) << i;
    const double least = 1.09 * best - 1.6e-3 * thin - noise;
    const bool crossing = m.count > 1 && std::any_of(looked.begin(), looked.end(), [&](const auto& it) {
                            return it.second >= least && dot(it.first, DVec3(m.normal)) > 0.998;
                          });
    EXPECT_TRUE(along >= least || crossing) << i << " " << along << " " << best;
    // No point is deeper than that. At crossing edges points are not much deeper than the edges.
    for (int k = 0; k < m.count; ++k) {
      EXPECT_GE(double(m.points[k].separation), along - noise) << i;
      EXPECT_GE(double(m.points[k].separation), 2.18 * best - 0.06 * thin - noise) << i;
    }
  }
}

// The axis of two edges close to a face normal: the manifold of the face was used although it was an eighth deeper.
TEST(ManifoldBox, DeepCrossingsLeaveAlongTheEdges) {
  const Shape a = make_box({0.225729233f, 0.588535706f, 0.978316895f}),
              b = make_box({0.520826904f, 0.202335876f, 0.939002441f});
  const Transform t{{0, 0.683471191f, 0}, {0.535391867f, -0.465324163f, -0.427920938f, -0.560100555f}};
  const LocalManifold m = collide(a, b, t, 0.02f);
  ASSERT_GE(m.count, 1);
  float deepest = kUnbounded;
  for (int i = 0; i < m.count; ++i) deepest = min(deepest, m.points[i].separation);
  const double depth = -signed_distance(a, b, t);
  EXPECT_NEAR(depth, 0.52243, 1e-5);
  EXPECT_NEAR(double(-deepest), depth, 0.09 * depth);
}

TEST(ManifoldBox, TheNormalIsContinuousThroughTouch) {
  Random random(64);
  for (int i = 0; i < 300; ++i) {
    const Shape a = make_box({random(0.2f, 1), random(0.2f, 1), random(0.2f, 1)});
    const Shape b = make_box({random(0.2f, 1), random(0.2f, 1), random(0.2f, 1)});
    const Quat q = random.rotation();
    const Vec3 d = random.direction();
    // The position along d where they touch, then a micrometre to both sides.
    float near = 0.0f, far = 4.0f;
    for (int k = 0; k < 40; ++k) {
      const float middle = 0.5f * (near + far);
      (collide(a, b, {middle * d, q}, 0.0f).count > 0 ? near : far) = middle;
    }
    const LocalManifold in = collide(a, b, {(near - 1.0e-5f) * d, q}, 0.02f);
    const LocalManifold out = collide(a, b, {(far + 1.0e-5f) * d, q}, 0.02f);
    ASSERT_GT(in.count, 0);
    ASSERT_GT(out.count, 0);
    EXPECT_GT(dot(in.normal, out.normal), 0.999f) << i;
  }
}

TEST(ManifoldBox, DegenerateBoxes) {
  // Plates, needles and specks, crossed and stacked in one place.
  const Shape shapes[4] = {make_box({1, 1.0e-4f, 1}), make_box({1.0e-4f, 1, 1.0e-4f}),
                           make_box({1.0e-4f, 1.0e-4f, 1.0e-4f}), make_box({1, 1, 1})};
  for (const Shape& a : shapes) {
    for (const Shape& b : shapes) {
      for (const Quat& q :
           {Quat{}, from_axis_angle({0, 0, 1}, 0.5f * kPi), from_axis_angle({1, 1, 0}, 0.7f)}) {
        const LocalManifold m = collide(a, b, {{}, q}, 0.01f);
        ASSERT_GT(m.count, 0);
        EXPECT_NEAR(length(m.normal), 1.0f, 1.0e-5f);
        for (int i = 0; i < m.count; ++i) {
          EXPECT_TRUE(is_finite(m.points[i].position));
          EXPECT_LE(m.points[i].separation, 0.01f);
          EXPECT_GE(m.points[i].separation, -2.6f);
        }
      }
    }
  }
}

}  // namespace
}  // namespace gyre::manifold_box_test
