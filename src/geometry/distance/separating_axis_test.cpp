// The pruned axis search against all axes by brute force, and the box written out as a polytope.
#include "geometry/distance/separating_axis.h"

#include "geometry/testing/convex_oracle.h"

#include <gtest/gtest.h>

#include <map>

namespace gyre::separating_axis_test {
namespace {

using namespace oracle;

// The largest separation over all face normals and all cross products of edges, each by full projection.
double all_axes(const Shape& a, const Shape& b, const CorePair& pair) {
  double best = -1.0e300;
  const auto look = [&](DVec3 n) {
    const double s = length(n);
    if (s < 1.0e-5) return;
    best = max(best, max(separation(a, b, pair, n / s), separation(a, b, pair, n / -s)));
  };
  for (const HullPlane& plane : a.hull->planes) look(DVec3(plane.normal));
  for (const HullPlane& plane : b.hull->planes) look(pair.from_b(DVec3(plane.normal)));
  const auto direction = [](const Hull& hull, const HullEdge& edge) {
    const DVec3 d = DVec3(hull.vertices[edge.to]) - DVec3(hull.vertices[edge.from]);
    return d / length(d);
  };
  for (const HullEdge& ea : a.hull->edges) {
    const DVec3 da = direction(*a.hull, ea);
    for (const HullEdge& eb : b.hull->edges) look(cross(da, pair.from_b(direction(*b.hull, eb))));
  }
  return best;
}

TEST(SeparatingAxis, EqualsBruteForceOverAllAxes) {
  Random random(41);
  int overlapping = 0, by_edges = 0;
  for (int i = 0; i < 1500; ++i) {
    Hulls hulls;
    const float scale = i % 3 == 0 ? 1.0f : i % 3 == 1 ? 1.0e-3f : 1.0e3f;
    const Shape a = hulls.add_random(random, scale), b = hulls.add_random(random, scale);
    const Transform t{scale * random.in_cube(0.8f), random.rotation()};
    const CorePair pair(a, b, t);
    const double best = all_axes(a, b, pair);
    const Polytope pa = make_polytope(*a.hull), pb = make_polytope(*b.hull);
    const PolytopeAxis axis = separating_axis(pa, pb, t, 1.0e30f, {});
    // Edges are culled by distance, so a face may replace them on separated shapes. On overlapping shapes the result is
    // exact up to the biases towards faces and towards A's.
    const double bias = 0.085 * absolute(best) + 1.5e-3 * double(min(pa.inner_radius, pb.inner_radius)) +
                        2.0e-6 * double(scale);
    EXPECT_LE(double(axis.separation), best + 2.0e-6 * double(scale)) << i;
    EXPECT_NEAR(length(axis.normal), 1.0f, 1.0e-5f);
    EXPECT_NEAR(separation(a, b, pair, DVec3(axis.normal)), double(axis.separation), 1.0e-5 * double(scale))
        << i;
    if (best > 0.0) continue;
    // Overlapping: the same axis if only near edges are tested.
    const PolytopeAxis pruned = separating_axis(pa, pb, t, 0.0f, {});
    EXPECT_EQ(pruned.kind, axis.kind) << i;
    EXPECT_EQ(pruned.separation, axis.separation) << i;
    // Then again with that axis as the favoured one.
    PolytopeAxis favoured = axis;
    separation_along(pa, pb, t, favoured);
    const PolytopeAxis again = separating_axis(pa, pb, t, 0.0f, favoured);
    EXPECT_EQ(encode_axis(again), encode_axis(axis)) << i;
    EXPECT_NEAR(double(again.separation), double(axis.separation), 2.0e-6 * double(scale)) << i;
    ++overlapping;
    if (axis.kind == AxisKind::edges) ++by_edges;
    EXPECT_GE(double(axis.separation), best - bias) << i;
  }
  EXPECT_GT(overlapping, 300);
  EXPECT_GT(by_edges, 20);
}

TEST(SeparatingAxis, StopsOnlyAtTrueSeparation) {
  Random random(42);
  int stopped = 0;
  for (int i = 0; i < 1500; ++i) {
    Hulls hulls;
    const Shape a = hulls.add_random(random, 1.0f), b = hulls.add_random(random, 1.0f);
    const Transform t{1.5f * random.in_cube(), random.rotation()};
    const CorePair pair(a, b, t);
    const PolytopeAxis axis = separating_axis(make_polytope(*a.hull), make_polytope(*b.hull), t, 0.05f, {});
    const CoreDistance distance = core_distance(pair, 1.0e30, {});
    if (axis.separation > 0.05f) {
      ++stopped;
      EXPECT_GT(distance.distance, 0.05 - 1.0e-6);
    }
    EXPECT_TRUE(!distance.overlap || axis.separation <= 1.0e-5f);
  }
  EXPECT_GT(stopped, 100);
}

// A blade-thin plate in the middle of a box was reported half a metre apart from it: the two normals beside its edge
// were nearly opposite, and so was the direction that they gave.
TEST(SeparatingAxis, ABladeInABoxIsNotApart) {
  Hulls hulls;
  const Shape blade = hulls.add({{-0.399887264f, -2.17296765e-05f, -0.325181812f},
                                 {-0.0628757924f, -3.40793777e-05f, -0.100432485f},
                                 {0.23933576f, 2.39250276e-05f, 0.426628321f},
                                 {0.0386715978f, 3.23241657e-05f, -0.242452294f}});
  ASSERT_EQ(blade.kind, ShapeKind::hull);
  const BoxPolytope box({0.920598924f, 0.58331269f, 0.593902528f});
  const PolytopeAxis axis = separating_axis(make_polytope(*blade.hull), box.view(), {}, 0.02f, {});
  EXPECT_NEAR(axis.separation, -0.5834f, 2.0e-3f);
}

TEST(SeparatingAxis, NamesComeBackAndStrangeOnesDoNot) {
  const BoxPolytope box({1, 1, 1});
  const Polytope view = box.view();
  PolytopeAxis axis;
  axis.kind = AxisKind::edges;
  axis.index_a = 11;
  axis.index_b = 3;
  const PolytopeAxis back = decode_axis(encode_axis(axis), view, view);
  EXPECT_EQ(back.kind, AxisKind::edges);
  EXPECT_EQ(back.index_a, 11);
  EXPECT_EQ(back.index_b, 3);
  EXPECT_EQ(decode_axis(0, view, view).kind, AxisKind::none);
  EXPECT_EQ(decode_axis(0xffffffffu, view, view).kind, AxisKind::none);
  axis.index_a = 12;
  EXPECT_EQ(decode_axis(encode_axis(axis), view, view).kind, AxisKind::none);
}

TEST(SeparatingAxis, TheFavouredAxisStaysWhenNearlyEqual) {
  // Two cubes face to face: A's top or B's bottom, whichever was there.
  const BoxPolytope box({0.5f, 0.5f, 0.5f});
  const Polytope view = box.view();
  const Transform t{{0, 0.99f, 0}, normalized(Quat{1.0e-5f, 0, -1.0e-5f, 1})};
  PolytopeAxis favoured;
  favoured.kind = AxisKind::face_b;
  favoured.index_b = 2;
  EXPECT_EQ(separating_axis(view, view, t, 0.1f, {}).kind, AxisKind::face_a);
  separation_along(view, view, t, favoured);
  EXPECT_EQ(separating_axis(view, view, t, 0.1f, favoured).kind, AxisKind::face_b);
}

TEST(Polytope, TheBoxIsAClosedConvexPolyhedron) {
  const Vec3 h{1, 2, 3};
  const BoxPolytope box(h);
  const Polytope view = box.view();
  std::map<std::pair<int, int>, int> left_of;
  for (int f = 0; f < view.face_count; ++f) {
    FacePolygon face;
    face_polygon(view, f, face);
    ASSERT_EQ(face.count, 4);
    const Vec3 turn = cross(face.vertices[1] - face.vertices[0], face.vertices[2] - face.vertices[1]);
    EXPECT_GT(dot(turn, face.normal), 0.0f);
    for (int i = 0; i < 4; ++i) {
      EXPECT_FLOAT_EQ(dot(face.vertices[i], face.normal), view.planes[f].offset);
      left_of[{face.ids[i], face.ids[(i + 1) % 4]}] = f;
    }
    // The same face, corners and names as in all other code.
    FacePolygon other;
    support_face(make_box(h), face.normal, other);
    EXPECT_EQ(other.feature, face.feature);
    for (int i = 0; i < 4; ++i) EXPECT_EQ(view.vertices[other.ids[i]], other.vertices[i]);
  }
  ASSERT_EQ(view.edge_count, 12);
  for (int e = 0; e < view.edge_count; ++e) {
    const HullEdge& edge = view.edges[e];
    EXPECT_EQ((left_of[{edge.from, edge.to}]), int(edge.left)) << e;
    EXPECT_EQ((left_of[{edge.to, edge.from}]), int(edge.right)) << e;
  }
}

TEST(Polytope, LowestAndHighestAlongEqualAPlainSearch) {
  Random random(43);
  Hulls hulls;
  for (int i = 0; i < 500; ++i) {
    const Shape a = hulls.add_random(random, 1.0f);
    const Polytope view = make_polytope(*a.hull);
    const Vec3 d = random.direction();
    float low = 1.0e30f, high = -1.0e30f;
    for (const Vec3& v : a.hull->vertices) low = min(low, dot(v, d)), high = max(high, dot(v, d));
    EXPECT_EQ(lowest_along(view, d), low);
    EXPECT_EQ(highest_along(view, d), high);
    EXPECT_EQ(dot(view.vertices[lowest_vertex(view, d).vertex], d), low);
  }
}

}  // namespace
}  // namespace gyre::separating_axis_test
