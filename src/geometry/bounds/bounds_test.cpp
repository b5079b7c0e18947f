// Bounding volumes: every point is inside for any cloud; the smallest volumes against plain search and known solids;
// overlaps against GJK and dense sampling; merges contain both volumes.
#include <gyre/bounds.h>

#include "geometry/distance/gjk.h"
#include "geometry/shape/shape.h"
#include "random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace gyre::bounds_test {
namespace {

using testing_random::Random;

// A rotation, all alike probable.
Quat any_turn(Random& random) {
  for (;;) {
    const Vec3 v = random.vector(-1, 1);
    const Quat q{v.x, v.y, v.z, random.real(-1, 1)};
    if (dot(q, q) > 0.05f && dot(q, q) < 1.0f) return normalized(q);
  }
}

using Cloud = std::vector<Vec3>;

Cloud cloud_in_box(Random& random, int count, Vec3 half) {
  Cloud points;
  for (int i = 0; i < count; ++i) points.push_back(multiply_each(half, random.vector(-1, 1)));
  return points;
}
void turn(Cloud& points, Quat q) {
  for (Vec3& p : points) p = rotate(q, p);
}

// Round and long, flat and needle-like, near and far, tiny and huge clouds, and the degenerate ones.
std::vector<std::pair<std::string, Cloud>> clouds() {
  Random random;
  std::vector<std::pair<std::string, Cloud>> all;
  const auto add = [&](const char* name, Cloud points, Vec3 middle = {}, float scale = 1.0f) {
    turn(points, any_turn(random));
    for (Vec3& p : points) p = scale * p + middle;
    all.emplace_back(name, points);
  };
  for (const int count : {2, 3, 4, 5, 8, 20, 300}) add("random", cloud_in_box(random, count, {1, 1, 1}));
  add("long", cloud_in_box(random, 60, {10, 1, 0.5f}), {3, 2, 1});
  add("flat", cloud_in_box(random, 60, {3, 2, 1.0e-4f}));
  add("needle", cloud_in_box(random, 60, {5, 1.0e-4f, 1.0e-4f}));
  add("plane", cloud_in_box(random, 40, {3, 2, 0}));
  add("line", cloud_in_box(random, 40, {3, 0, 0}));
  add("far", cloud_in_box(random, 40, {1, 2, 3}), {1.0e6f, -3.0e6f, 2.0e5f});
  add("tiny", cloud_in_box(random, 40, {1, 2, 3}), {}, 1.0e-6f);
  add("huge", cloud_in_box(random, 40, {1, 2, 3}), {}, 1.0e8f);
  Cloud shell;
  for (int i = 0; i < 400; ++i) shell.push_back(normalized(random.vector(-1, 1)));
  add("shell", shell, {5, 5, 5});
  Cloud corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f});
  all.emplace_back("cube along the axes", corners);
  all.emplace_back("square along the axes", Cloud{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
  all.emplace_back("line along an axis", Cloud{{0, -1, 0}, {0, 5, 0}, {0, 2, 0}});
  all.emplace_back("one point", Cloud{{3.3f, -2.1f, 7.7f}});
  all.emplace_back("one place", Cloud(12, {0.1f, 0.2f, -0.3f}));
  all.emplace_back("two places", Cloud{{1, 1, 1}, {1, 1, 1}, {2, 1, 1}, {2, 1, 1}});
  return all;
}

TEST(Bounds, HoldEveryPoint) {
  for (const auto& [name, points] : clouds()) {
    const auto sphere_fast = fit_sphere_fast(points), sphere = fit_sphere(points);
    const auto box = fit_box(points);
    const auto turned_fast = fit_oriented_box_fast(points), turned = fit_oriented_box(points);
    const auto capsule = fit_capsule(points);
    ASSERT_TRUE(sphere_fast && sphere && box && turned_fast && turned && capsule) << name;
    for (const Vec3& p : points) {
      EXPECT_TRUE(contains(*sphere_fast, p)) << name;
      EXPECT_TRUE(contains(*sphere, p)) << name;
      EXPECT_TRUE(contains(*box, p)) << name;
      EXPECT_TRUE(contains(*turned_fast, p)) << name;
      EXPECT_TRUE(contains(*turned, p)) << name;
      EXPECT_TRUE(contains(*capsule, p)) << name;
      for (const KDopKind kind : {KDopKind::k14, KDopKind::k18, KDopKind::k26})
        EXPECT_TRUE(contains(*fit_k_dop(points, kind), p)) << name;
    }
    // The smaller ones are smaller, and none is smaller than the hull.
    EXPECT_LE(sphere->radius, sphere_fast->radius * 1.0001f) << name;
    EXPECT_LE(sphere_fast->radius, sphere->radius * 1.25f + 1.0e-30f) << name;
    const double box_volume = volume(*turned);
    const double slack = 1.0e-6 * volume(*sphere);  // of flat ones, rounding makes some
    EXPECT_LE(box_volume, volume(*turned_fast) + slack) << name;
    EXPECT_LE(box_volume, volume(*box) + slack) << name;
    const Result<Geometry> hull = cook_hull(points);
    if (!hull) continue;
    for (int kind = 0; kind < kBoundKindCount; ++kind) {
      const Result<BoundCost> cost = bound_cost(points, BoundKind(kind));
      ASSERT_TRUE(cost) << name;
      EXPECT_GE(cost->volume * (1.0 + 1.0e-5) + slack, hull_volume(*hull))
          << name << ", " << to_string(BoundKind(kind));
      EXPECT_GE(cost->surface_area * (1.0 + 1.0e-3), hull_surface_area(*hull))
          << name << ", " << to_string(BoundKind(kind));
    }
  }
}

TEST(Bounds, RefuseWhatIsNoCloud) {
  const auto message = [](const Cloud& points) { return std::string(fit_sphere(points).error().message); };
  EXPECT_NE(message({}).find("no points"), std::string::npos);
  EXPECT_NE(
      message({{0, 0, 0}, {0, std::numeric_limits<float>::quiet_NaN(), 0}}).find("point 1 is (0, nan, 0)"),
      std::string::npos);
  EXPECT_NE(message({{2.0e9f, 0, 0}}).find("point 0"), std::string::npos);
  for (int kind = 0; kind < kBoundKindCount; ++kind) {
    EXPECT_FALSE(bound_cost({}, BoundKind(kind))) << to_string(BoundKind(kind));
    const Vec3 infinite[4] = {{std::numeric_limits<float>::infinity(), 0, 0}};
    EXPECT_FALSE(bound_cost(infinite, BoundKind(kind))) << to_string(BoundKind(kind));
  }
  EXPECT_FALSE(bound_cost({}, BoundKind(99)));
}

// ------------------------------------------------------------------------------------------------------------ spheres

struct TestBall {
  DVec3 center;
  double radius;
};

// Through two, three or four points, by the formulas of textbooks (a, b, c measured from the first).
TestBall ball_through(const std::vector<DVec3>& p) {
  const DVec3 a = p.size() > 1 ? p[1] - p[0] : DVec3();
  DVec3 way;
  if (p.size() == 2) way = 0.5 * a;
  if (p.size() == 3) {
    const DVec3 b = p[2] - p[0], n = cross(a, b);
    way = (0.5 / dot(n, n)) * (dot(a, a) * cross(b, n) + dot(b, b) * cross(n, a));
  }
  if (p.size() == 4) {
    const DVec3 b = p[2] - p[0], c = p[3] - p[0];
    way = (0.5 / dot(a, cross(b, c))) *
          (dot(a, a) * cross(b, c) + dot(b, b) * cross(c, a) + dot(c, c) * cross(a, b));
  }
  return {p[0] + way, length(way)};
}

// The smallest of all balls through up to four points that hold all.
double smallest_radius(const Cloud& points) {
  double best = std::numeric_limits<double>::infinity();
  const unsigned count = unsigned(points.size());
  for (unsigned subset = 1; subset < 1u << count; ++subset) {
    if (__builtin_popcount(subset) > 4) continue;
    std::vector<DVec3> some;
    for (unsigned i = 0; i < count; ++i) {
      if (subset >> i & 1) some.emplace_back(points[i]);
    }
    const TestBall ball = ball_through(some);
    if (!(ball.radius < best)) continue;
    bool holds = true;
    for (const Vec3& p : points)
      holds = holds && length(DVec3(p) - ball.center) <= ball.radius * (1.0 + 1.0e-9) + 1e-12;
    if (holds) best = ball.radius;
  }
  return best;
}

TEST(Bounds, SmallestSphereEqualsAllSupportSets) {
  Random random;
  for (int round = 0; round < 400; ++round) {
    Cloud points;
    const int count = 1 + int(random.next(10));
    // Every fourth on a grid: many on one sphere, in one plane, in one place.
    for (int i = 0; i < count; ++i) {
      Vec3 p = random.vector(-1, 1);
      if (round % 4 == 0) p = {float(random.next(3)), float(random.next(3)), float(random.next(2))};
      if (round % 4 == 1) p = normalized(p);
      points.push_back(p);
    }
    const auto sphere = fit_sphere(points);
    ASSERT_TRUE(sphere);
    ASSERT_NEAR(double(sphere->radius), smallest_radius(points), 1.0e-6) << round;
  }
}

TEST(Bounds, SmallestSphereOfKnownSolids) {
  const float s = 1.0f / std::sqrt(3.0f);
  const Cloud tetrahedron{{s, s, s}, {s, -s, -s}, {-s, s, -s}, {-s, -s, s}};
  EXPECT_NEAR(fit_sphere(tetrahedron)->radius, 1.0f, 1e-6f);
  Random random;
  Cloud shell;
  for (int i = 0; i < 20000; ++i) shell.push_back(normalized(random.vector(-1, 1)) + Vec3{7, 8, 9});
  const auto sphere = fit_sphere(shell);
  EXPECT_NEAR(sphere->radius, 1.0f, 1e-5f);
  EXPECT_LT(length(sphere->center - Vec3{7, 8, 9}), 1e-4f);
}

// -------------------------------------------------------------------------------------------------------------- boxes

TEST(Bounds, SmallestBoxOfKnownSolids) {
  Random random;
  for (int round = 0; round < 20; ++round) {
    const Vec3 half = random.vector(0.2f, 3.0f);
    Cloud corners;
    for (int i = 0; i < 8; ++i)
      corners.push_back(
          multiply_each(half, {i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f}));
    turn(corners, any_turn(random));
    const double exact = 8.0 * double(half.x) * double(half.y) * double(half.z);
    ASSERT_NEAR(volume(*fit_oriented_box(corners)) / exact, 1.0, 2.0e-5);
    // The same with points strewn inside, and the principal axes of a box with unlike sides.
    for (int i = 0; i < 200; ++i)
      corners.push_back(0.25f * (corners[0] + corners[std::size_t(1 + i % 7)]) + 0.5f * corners[0]);
    ASSERT_NEAR(volume(*fit_oriented_box(corners)) / exact, 1.0, 2.0e-5);
    // Four corners of a cube make a regular tetrahedron: the cube is its smallest box, with no side on a face of it.
    Cloud tetrahedron{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    turn(tetrahedron, any_turn(random));
    ASSERT_NEAR(volume(*fit_oriented_box(tetrahedron)), 8.0, 1.0e-4);
    // A rectangle has no volume, and no box of it should reach beyond its plane.
    Cloud rectangle{{1, 2, 0}, {-1, 2, 0}, {1, -2, 0}, {-1, -2, 0}};
    turn(rectangle, any_turn(random));
    ASSERT_NEAR(surface_area(*fit_oriented_box(rectangle)), 16.0, 1.0e-3);
  }
}

TEST(Bounds, NoSampledRotationHasASmallerBox) {
  Random random;
  for (int round = 0; round < 12; ++round) {
    const int count = 4 + int(random.next(40));
    Cloud points = cloud_in_box(random, count, random.vector(0.3f, 2.0f));
    const double smallest = volume(*fit_oriented_box(points));
    double sampled = std::numeric_limits<double>::infinity();
    Quat best{};
    const auto try_rotation = [&](Quat q) {
      Cloud seen = points;
      turn(seen, q);
      const double each = volume(*fit_box(seen));
      if (each < sampled) {
        sampled = each;
        best = q;
      }
    };
    for (int i = 0; i < 6000; ++i) try_rotation(any_turn(random));
    // Then around the best of them, in ever smaller steps.
    for (float angle = 0.2f; angle > 1.0e-4f; angle *= 0.7f) {
      for (int i = 0; i < 40; ++i)
        try_rotation(normalized(from_rotation_vector(random.vector(-angle, angle)) * best));
    }
    EXPECT_LE(smallest, sampled * 1.0001) << round;
  }
}

OrientedBox random_box(Random& random) {
  return {random.vector(-2, 2), random.vector(0.05f, 1.5f), any_turn(random)};
}

TEST(Bounds, TurnedBoxesOverlapAsTheirDistanceSays) {
  Random random;
  int overlapping = 0, apart = 0;
  for (int round = 0; round < 4000; ++round) {
    OrientedBox a = random_box(random), b = random_box(random);
    if (round % 5 == 0) b.orientation = a.orientation;  // parallel axes
    if (round % 7 == 0) a.orientation = {};
    const Shape shape_a = make_shape(Box{a.half_extents}), shape_b = make_shape(Box{b.half_extents});
    const Transform a_from_b =
        inverse_times(Transform{a.center, a.orientation}, Transform{b.center, b.orientation});
    const CoreDistance distance = core_distance(CorePair(shape_a, shape_b, a_from_b), 1.0e9, {});
    if (!distance.overlap && distance.distance < 1.0e-5) continue;
    ASSERT_EQ(overlap(a, b), distance.overlap) << round;
    ASSERT_EQ(overlap(b, a), distance.overlap) << round;
    ++(distance.overlap ? overlapping : apart);
    // The hulls of their corners agree.
    if (round % 10 != 0) continue;
    Cloud corners[2];
    for (int i = 0; i < 8; ++i) {
      const Vec3 signs{i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f};
      corners[0].push_back(a.center + rotate(a.orientation, multiply_each(signs, a.half_extents)));
      corners[1].push_back(b.center + rotate(b.orientation, multiply_each(signs, b.half_extents)));
    }
    const auto hull_a = cook_hull(corners[0]), hull_b = cook_hull(corners[1]);
    ASSERT_TRUE(hull_a && hull_b);
    ASSERT_EQ(hulls_overlap(*hull_a, *hull_b), distance.overlap) << round;
    // No k-DOP misses an overlap.
    for (const KDopKind kind : {KDopKind::k14, KDopKind::k18, KDopKind::k26}) {
      if (distance.overlap) {
        ASSERT_TRUE(overlap(*fit_k_dop(corners[0], kind), *fit_k_dop(corners[1], kind)));
      }
    }
  }
  EXPECT_GT(overlapping, 300);
  EXPECT_GT(apart, 300);
}

TEST(Bounds, CapsulesAndSpheresOverlapAsSampled) {
  Random random;
  for (int round = 0; round < 500; ++round) {
    const BoundingCapsule a{random.vector(-2, 2), random.vector(-2, 2), random.real(0, 1)};
    BoundingCapsule b{random.vector(-2, 2), random.vector(-2, 2), random.real(0, 1)};
    if (round % 6 == 0) b.b = b.a + (a.b - a.a);  // parallel
    if (round % 9 == 0) b.b = b.a;                // a ball
    double nearest = 1e9;
    for (int i = 0; i <= 150; ++i) {
      for (int k = 0; k <= 150; ++k)
        nearest = std::min(nearest,
                           double(distance(lerp(a.a, a.b, float(i) / 150), lerp(b.a, b.b, float(k) / 150))));
    }
    const double reach = double(a.radius) + double(b.radius);
    // Samples lie within 1/150 of the largest extent of the closest points.
    if (nearest <= reach) {
      ASSERT_TRUE(overlap(a, b)) << round;
    } else if (nearest > reach + 0.05) {
      ASSERT_FALSE(overlap(a, b)) << round;
    }
    const BoundingSphere sphere_a{a.a, a.radius}, sphere_b{b.a, b.radius};
    const double way = length(DVec3(a.a) - DVec3(b.a));
    if (absolute(way - reach) > 1e-6) {
      ASSERT_EQ(overlap(sphere_a, sphere_b), way < reach);
    }
  }
}

// ------------------------------------------------------------------------------------------------------------- merges

TEST(Bounds, MergesHoldBoth) {
  Random random;
  for (int round = 0; round < 60; ++round) {
    const float far = round % 3 == 0 ? 0.3f : 4.0f;
    Cloud one = cloud_in_box(random, 30, random.vector(0.1f, 2.0f)),
          other = cloud_in_box(random, 30, random.vector(0.1f, 1.0f));
    turn(one, any_turn(random));
    turn(other, any_turn(random));
    const Vec3 away = random.vector(-far, far);
    for (Vec3& p : other) p += away;
    Cloud both = one;
    both.insert(both.end(), other.begin(), other.end());
    const BoundingSphere sphere = merge(*fit_sphere(one), *fit_sphere(other));
    const OrientedBox box = merge(*fit_oriented_box(one), *fit_oriented_box(other));
    const BoundingCapsule capsule = merge(*fit_capsule(one), *fit_capsule(other));
    const Geometry hull = *merge_hulls(*cook_hull(one), *cook_hull(other));
    for (const Vec3& p : both) {
      ASSERT_TRUE(contains(sphere, p));
      ASSERT_TRUE(contains(box, p));
      ASSERT_TRUE(contains(capsule, p));
    }
    for (const KDopKind kind : {KDopKind::k14, KDopKind::k18, KDopKind::k26}) {
      const KDop merged = merge(*fit_k_dop(one, kind), *fit_k_dop(other, kind)),
                 fitted = *fit_k_dop(both, kind);
      for (int i = 0; i < k_dop_directions(kind); ++i) {
        ASSERT_EQ(merged.low[i], fitted.low[i]);
        ASSERT_EQ(merged.high[i], fitted.high[i]);
      }
    }
    ASSERT_NEAR(hull_volume(hull) / hull_volume(*cook_hull(both)), 1.0, 1.0e-5);
    // The result contains the merged volumes, not only their points.
    BoundingCapsule grown = capsule;
    grown.radius *= 1.00001f;
    OrientedBox wider = box;
    wider.half_extents *= 1.00001f;
    for (const Cloud* cloud : {&one, &other}) {
      const BoundingSphere s = *fit_sphere(*cloud);
      const BoundingCapsule c = *fit_capsule(*cloud);
      const OrientedBox o = *fit_oriented_box(*cloud);
      for (int i = 0; i < 300; ++i) {
        const Vec3 direction = normalized(random.vector(-1, 1));
        ASSERT_LE(length(s.center + s.radius * direction - sphere.center), sphere.radius * 1.00001f);
        ASSERT_TRUE(contains(grown, lerp(c.a, c.b, random.real(0, 1)) + c.radius * direction));
        const Vec3 signs{i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f};
        ASSERT_TRUE(contains(wider, o.center + rotate(o.orientation, multiply_each(signs, o.half_extents))));
      }
    }
    // Two that have no smaller sphere around them: the ends of the line through both centres lie on it.
    const BoundingSphere a = *fit_sphere(one), b = *fit_sphere(other);
    const float least =
        std::max({a.radius, b.radius, 0.5f * (a.radius + b.radius + distance(a.center, b.center))});
    ASSERT_NEAR(sphere.radius, least, 1e-5f);
  }
}

TEST(Bounds, MergeWithWhatIsInsideChangesNothing) {
  const BoundingSphere large{{1, 2, 3}, 4}, small{{1, 3, 3}, 1};
  EXPECT_EQ(merge(large, small).radius, 4.0f);
  EXPECT_EQ(merge(small, large).radius, 4.0f);
  const BoundingCapsule tube{{0, 0, 0}, {5, 0, 0}, 2}, thin{{1, 1, 0}, {3, -1, 0}, 0.5f};
  EXPECT_EQ(volume(merge(tube, thin)), volume(tube));
  EXPECT_EQ(volume(merge(thin, tube)), volume(tube));
  const OrientedBox box{{1, 1, 1}, {2, 3, 4}, {}},
      inner{{1, 1, 1}, {0.5f, 0.5f, 0.5f}, from_axis_angle({1, 2, 3}, 1)};
  EXPECT_NEAR(volume(merge(box, inner)), volume(box), 1e-3);
}

// -------------------------------------------------------------------------------------------------------------- costs

TEST(Bounds, CostsOfKnownVolumes) {
  EXPECT_NEAR(volume(BoundingSphere{{}, 2}), 33.510321638, 1e-6);
  EXPECT_NEAR(surface_area(BoundingSphere{{}, 2}), 50.265482457, 1e-6);
  EXPECT_NEAR(volume(BoundingCapsule{{0, 0, 0}, {0, 3, 0}, 1}), 4.188790205 + 9.424777961, 1e-6);
  EXPECT_NEAR(surface_area(BoundingCapsule{{0, 0, 0}, {0, 3, 0}, 1}), 12.566370614 + 18.849555922, 1e-6);
  EXPECT_NEAR(volume(OrientedBox{{}, {1, 2, 3}, from_axis_angle({1, 1, 0}, 1)}), 48.0, 1e-6);
  EXPECT_NEAR(surface_area(Aabb{{0, 0, 0}, {1, 2, 3}}), 22.0, 1e-6);
  // An octahedron is its own 14-DOP; a cube is all of its k-DOPs.
  const Cloud octahedron{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const KDop dop = *fit_k_dop(octahedron, KDopKind::k14);
  EXPECT_NEAR(volume(dop), 4.0 / 3.0, 1e-9);
  EXPECT_NEAR(surface_area(dop), 4.0 * std::sqrt(3.0), 1e-9);
  Cloud cube;
  for (int i = 0; i < 8; ++i) cube.push_back({i & 1 ? 2.0f : 0.0f, i & 2 ? 2.0f : 0.0f, i & 4 ? 2.0f : 0.0f});
  for (const KDopKind kind : {KDopKind::k14, KDopKind::k18, KDopKind::k26}) {
    EXPECT_NEAR(volume(*fit_k_dop(cube, kind)), 8.0, 1e-9);
    EXPECT_NEAR(surface_area(*fit_k_dop(cube, kind)), 24.0, 1e-9);
  }
  // The rhombic dodecahedron's twelve faces are the planes of the 18-DOP: 16 cubic metres around this cube of side 2.
  const Cloud rhombic{{1, 1, 1},    {1, 1, -1}, {1, -1, 1}, {1, -1, -1}, {-1, 1, 1}, {-1, 1, -1}, {-1, -1, 1},
                      {-1, -1, -1}, {2, 0, 0},  {-2, 0, 0}, {0, 2, 0},   {0, -2, 0}, {0, 0, 2},   {0, 0, -2}};
  EXPECT_NEAR(volume(*fit_k_dop(rhombic, KDopKind::k18)), 16.0, 1e-9);
  EXPECT_NEAR(hull_volume(*cook_hull(rhombic)), 16.0, 1e-5);
}

TEST(Bounds, CostsAgreeWithCounting) {
  Random random;
  for (int round = 0; round < 6; ++round) {
    Cloud points = cloud_in_box(random, 40, {1, 0.8f, 1.3f});
    turn(points, any_turn(random));
    const Aabb box = *fit_box(points);
    for (const KDopKind kind : {KDopKind::k14, KDopKind::k18, KDopKind::k26}) {
      const KDop dop = *fit_k_dop(points, kind);
      int inside = 0;
      constexpr int kSamples = 40000;
      for (int i = 0; i < kSamples; ++i) {
        const Vec3 u = random.vector(0, 1);
        inside += contains(dop, box.low + multiply_each(u, box.high - box.low));
      }
      // Four standard deviations of counting.
      EXPECT_NEAR(volume(dop) / volume(box), double(inside) / kSamples, 0.01);
    }
    const Geometry hull = *cook_hull(points);
    EXPECT_NEAR(hull_volume(hull), double(mass_properties(hull, 1.0f)->mass), 1e-4 * hull_volume(hull));
  }
}

TEST(Bounds, MoreDirectionsAreTighter) {
  Random random;
  for (int round = 0; round < 20; ++round) {
    Cloud points = cloud_in_box(random, 100, {1, 2, 0.5f});
    turn(points, any_turn(random));
    const double box = volume(*fit_box(points)), k14 = volume(*fit_k_dop(points, KDopKind::k14)),
                 k18 = volume(*fit_k_dop(points, KDopKind::k18)),
                 k26 = volume(*fit_k_dop(points, KDopKind::k26));
    EXPECT_LE(k14, box * 1.000001);
    EXPECT_LE(k18, box * 1.000001);
    EXPECT_LE(k26, std::min(k14, k18) * 1.000001);
    EXPECT_GE(k26 * 1.000001, hull_volume(*cook_hull(points)));
  }
}

}  // namespace
}  // namespace gyre::bounds_test
