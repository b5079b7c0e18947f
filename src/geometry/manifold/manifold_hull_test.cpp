// Hulls: resting contacts to the micrometre, names that stay, and agreement of boxes with their hulls.
#include "geometry/manifold/manifold_hull.h"

#include "geometry/testing/convex_oracle.h"

#include <gtest/gtest.h>

#include <set>

namespace gyre::manifold_hull_test {
namespace {

using namespace oracle;

LocalManifold collide(const Shape& a, const Shape& b, const Transform& t, float max_separation) {
  PairCache cache;
  LocalManifold out;
  collide_polyhedra(a, b, t, max_separation, cache, out);
  return out;
}

Shape make_prism(Hulls& hulls, int sides, float radius, float half_height) {
  std::vector<Vec3> points;
  for (int i = 0; i < sides; ++i) {
    const SinCos s = sin_cos(2.0f * kPi * float(i) / float(sides));
    points.push_back({radius * s.cos, -half_height, radius * s.sin});
    points.push_back({radius * s.cos, half_height, radius * s.sin});
  }
  return hulls.add(points);
}

TEST(ManifoldHull, PrismsRestOnFourExactPoints) {
  Hulls hulls;
  const Shape floor = hulls.add_box({3, 0.5f, 3}), box = make_box({3, 0.5f, 3});
  for (int sides : {3, 4, 5, 6, 8, 16}) {
    const Shape prism = make_prism(hulls, sides, 0.5f, 0.5f);
    for (float gap : {-0.004f, 0.0f, 0.004f}) {
      const Transform t{{0.7f, 1.0f + gap, -1.2f}, from_axis_angle({0, 1, 0}, 0.3f)};
      for (const Shape& ground : {floor, box}) {
        const LocalManifold m = collide(ground, prism, t, 0.02f);
        ASSERT_EQ(m.count, min(sides, 4)) << sides;
        EXPECT_LT(length(m.normal - Vec3{0, 1, 0}), 1.0e-5f);
        Vec3 low = m.points[0].position, high = low;
        for (int i = 0; i < m.count; ++i) {
          EXPECT_NEAR(m.points[i].separation, gap, 1.0e-6f);
          EXPECT_NEAR(m.points[i].position.y, 0.5f + 0.5f * gap, 1.0e-6f);
          low = min(low, m.points[i].position);
          high = max(high, m.points[i].position);
        }
        // The centre lies well inside the remaining polygon.
        EXPECT_LT(low.x, 0.7f - 0.15f);
        EXPECT_GT(high.x, 0.7f + 0.15f);
        EXPECT_LT(low.z, -1.2f - 0.15f);
        EXPECT_GT(high.z, -1.2f + 0.15f);
      }
    }
  }
}

TEST(ManifoldHull, NamesStayWhileItRattles) {
  Random random(91);
  Hulls hulls;
  const Shape prism = make_prism(hulls, 6, 0.5f, 0.5f);
  PairCache cache;
  std::set<std::uint32_t> first;
  for (int step = 0; step < 300; ++step) {
    const Transform t{
        Vec3{0.13f, 0.999f, 0.07f} + 2.0e-5f * random.in_cube(),
        normalized(from_axis_angle({0, 1, 0}, 0.2f) *
                   Quat{random(-1e-5f, 1e-5f), random(-1e-5f, 1e-5f), random(-1e-5f, 1e-5f), 1.0f})};
    LocalManifold m;
    collide_polyhedra(prism, prism, t, 0.02f, cache, m);
    ASSERT_EQ(m.count, 4);
    std::set<std::uint32_t> names;
    for (int i = 0; i < 4; ++i) names.insert(m.points[i].feature);
    if (step == 0) first = names;
    EXPECT_EQ(names, first) << step;
  }
}

TEST(ManifoldHull, CrossedEdgesTouchInOnePoint) {
  Hulls hulls;
  const Shape cube = hulls.add_box({0.5f, 0.5f, 0.5f});
  const Quat qa = from_axis_angle({1, 0, 0}, 0.25f * kPi), qb = from_axis_angle({0, 0, 1}, 0.25f * kPi);
  const float s = std::sqrt(0.5f);
  for (float gap : {-0.01f, 0.01f}) {
    const Pose a{{}, qa}, b{{0.0, 2.0 * double(s) + double(gap), 0.0}, qb};
    const LocalManifold m = collide(cube, cube, inverse_times(a, b), 0.02f);
    ASSERT_EQ(m.count, 1);
    EXPECT_NEAR(m.points[0].separation, gap, 1.0e-6f);
    EXPECT_LT(distance(to_float(a * m.points[0].position), {0, s + 0.5f * gap, 0}), 1.0e-6f);
    EXPECT_LT(distance(rotate(qa, m.normal), {0, 1, 0}), 1.0e-6f);
  }
}

TEST(ManifoldHull, FacesWithManyCornersAreThinnedInside) {
  // A 60-sided prism has faces of more corners than a polygon holds.
  Hulls hulls;
  const Shape prism = make_prism(hulls, 60, 0.5f, 0.5f), floor = make_box({3, 0.5f, 3});
  const LocalManifold m = collide(floor, prism, {{0, 0.995f, 0}, {}}, 0.02f);
  ASSERT_EQ(m.count, 4);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(m.points[i].separation, -0.005f, 1.0e-6f);
    const Vec3 p = m.points[i].position;
    EXPECT_NEAR(std::sqrt(p.x * p.x + p.z * p.z), 0.5f, 1.0e-5f);
  }
}

TEST(ManifoldHull, TheNormalIsContinuousThroughTouch) {
  Random random(92);
  Hulls hulls;
  int corners = 0;
  for (int i = 0; i < 300; ++i) {
    const Shape a = hulls.add_random(random, 1.0f), b = hulls.add_random(random, 1.0f);
    const Quat q = random.rotation();
    const Vec3 d = random.direction();
    const Vec3 together = a.hull->centroid - rotate(q, b.hull->centroid);
    float near = 0.0f, far = 4.0f;
    for (int k = 0; k < 40; ++k) {
      const float middle = 0.5f * (near + far);
      (collide(a, b, {together + middle * d, q}, 0.0f).count > 0 ? near : far) = middle;
    }
    const LocalManifold in = collide(a, b, {together + (near - 1.0e-5f) * d, q}, 0.02f);
    const LocalManifold out = collide(a, b, {together + (far + 1.0e-5f) * d, q}, 0.02f);
    ASSERT_GT(in.count, 0);
    ASSERT_GT(out.count, 0);
    // If the touching point is close to a corner or an edge of the difference, two axes are equally good.
    if (dot(in.normal, out.normal) < 0.999f) ++corners;
  }
  EXPECT_LE(corners, 6);
}

}  // namespace
}  // namespace gyre::manifold_hull_test
