// Hulls: the invariants of every hull (closed, convex, all points inside), known polyhedra, and bad input (row B-10 of
// the validation table).
#include "geometry/shape/hull_builder.h"

#include "geometry/shape/cooked.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>

namespace gyre::hull_builder_test {
namespace {

using Points = std::vector<Vec3>;

// Own generator of numbers, so that the same points come on every platform.
struct Random {
  std::mt19937 engine{12345};
  float operator()(float low = -1.0f, float high = 1.0f) {
    return low + (high - low) * (float(engine() >> 8) / 16777216.0f);
  }
  Vec3 in_cube() {
    const float x = (*this)(), y = (*this)(), z = (*this)();
    return {x, y, z};
  }
  Vec3 on_sphere() {
    for (;;) {
      const Vec3 p = in_cube();
      if (length_squared(p) > 0.01f && length_squared(p) < 1.0f) return normalized(p);
    }
  }
  Quat turn() {
    for (;;) {
      const Quat q{(*this)(), (*this)(), (*this)(), (*this)()};
      if (dot(q, q) > 0.01f && dot(q, q) < 1.0f) return normalized(q);
    }
  }
};

double extent_of(const Points& points) {
  Vec3 low = points[0], high = points[0];
  for (const Vec3& p : points) {
    low = min(low, p);
    high = max(high, p);
  }
  return double(largest(high - low));
}

double hull_volume(const Hull& hull) {
  double volume = 0.0;
  const DVec3 origin(hull.vertices[0]);
  for (std::size_t f = 0; f < hull.planes.size(); ++f) {
    const std::uint32_t begin = hull.face_offsets[f], end = hull.face_offsets[f + 1];
    const DVec3 a = DVec3(hull.vertices[hull.face_vertices[begin]]) - origin;
    for (std::uint32_t i = begin + 1; i + 1 < end; ++i) {
      const DVec3 b = DVec3(hull.vertices[hull.face_vertices[i]]) - origin;
      const DVec3 c = DVec3(hull.vertices[hull.face_vertices[i + 1]]) - origin;
      volume += dot(a, cross(b, c)) / 6.0;
    }
  }
  return volume;
}

void expect_closed(const Hull& hull) {
  const int faces = hull.face_count();
  ASSERT_GE(hull.vertex_count(), 4);
  ASSERT_LE(hull.vertex_count(), kMaxHullVertices);
  ASSERT_GE(faces, 4);
  ASSERT_LE(faces, kMaxHullFaces);
  ASSERT_EQ(int(hull.face_offsets.size()), faces + 1);
  ASSERT_EQ(hull.face_offsets.back(), hull.face_vertices.size());
  std::map<std::pair<int, int>, int> face_of;
  std::map<int, int> faces_at;
  for (std::size_t f = 0; f < hull.planes.size(); ++f) {
    const std::uint32_t begin = hull.face_offsets[f], end = hull.face_offsets[f + 1];
    ASSERT_GE(end, begin + 3);
    for (std::uint32_t i = begin; i < end; ++i) {
      const int from = hull.face_vertices[i], to = hull.face_vertices[i + 1 < end ? i + 1 : begin];
      ASSERT_LT(from, hull.vertex_count());
      ASSERT_TRUE(face_of.insert({{from, to}, int(f)}).second) << "edge twice";
      ++faces_at[from];
    }
  }
  ASSERT_EQ(int(faces_at.size()), hull.vertex_count());
  for (const auto& [vertex, count] : faces_at) EXPECT_GE(count, 3) << "vertex " << vertex;
  for (const auto& [edge, f] : face_of) ASSERT_TRUE(face_of.count({edge.second, edge.first})) << "open edge";
  EXPECT_EQ(hull.vertex_count() - int(face_of.size()) / 2 + faces, 2);
  ASSERT_EQ(hull.edges.size() * 2, face_of.size());
  for (const HullEdge& e : hull.edges) {
    EXPECT_EQ((face_of[{e.from, e.to}]), e.left);
    EXPECT_EQ((face_of[{e.to, e.from}]), e.right);
  }
}

// Every law of a hull. `loss` is how far points may lie outside, relative to the extent.
void expect_valid(const Points& points, const Hull& hull, double loss = 1.5e-6) {
  expect_closed(hull);
  if (testing::Test::HasFatalFailure()) return;
  const double extent = extent_of(points);
  double reach = 0.0;
  for (const Vec3& p : points) reach = std::max(reach, double(largest(absolute(p))));
  const double rounding = 4.0e-7 * reach;
  std::set<std::tuple<float, float, float>> given;
  for (const Vec3& p : points) given.insert({p.x, p.y, p.z});
  for (const Vec3& v : hull.vertices) EXPECT_TRUE(given.count({v.x, v.y, v.z})) << "vertex that is no point";
  double outside = -1.0, above = -1.0, below = 0.0, inner = 1e300;
  for (std::size_t f = 0; f < hull.planes.size(); ++f) {
    const HullPlane& plane = hull.planes[f];
    EXPECT_NEAR(length(plane.normal), 1.0f, 1e-6f);
    const auto height = [&](Vec3 p) { return dot(DVec3(plane.normal), DVec3(p)) - double(plane.offset); };
    for (const Vec3& p : points) outside = std::max(outside, height(p));
    for (const Vec3& v : hull.vertices) above = std::max(above, height(v));
    for (std::uint32_t i = hull.face_offsets[f]; i < hull.face_offsets[f + 1]; ++i) {
      below = std::min(below, height(hull.vertices[hull.face_vertices[i]]));
    }
    inner = std::min(inner, -height(hull.centroid));
    // Every corner turns left.
    const std::uint32_t first = hull.face_offsets[f], corners = hull.face_offsets[f + 1] - first;
    const auto corner = [&](std::uint32_t i) {
      return DVec3(hull.vertices[hull.face_vertices[first + i % corners]]);
    };
    for (std::uint32_t i = 0; i < corners; ++i) {
      const DVec3 along = corner(i + 2) - corner(i);
      const DVec3 left = cross(DVec3(plane.normal), along) / length(along);
      EXPECT_LT(dot(left, corner(i + 1) - corner(i)), rounding) << "face not convex";
    }
  }
  EXPECT_LE(outside, loss * extent + rounding);
  EXPECT_LE(above, rounding) << "not convex";
  EXPECT_GE(below, -1.0e-5 * extent - 4.0 * rounding) << "face not flat";
  EXPECT_GT(hull_volume(hull), 0.0);
  EXPECT_GE(inner, -rounding);
  EXPECT_NEAR(double(hull.inner_radius), std::max(inner, 0.0), rounding);
  for (std::size_t i = 0; i < hull.x.size(); ++i) {
    const Vec3 v = hull.vertices[std::min(i, hull.vertices.size() - 1)];
    EXPECT_EQ((Vec3{hull.x[i], hull.y[i], hull.z[i]}), v);
  }
  EXPECT_EQ(hull.x.size() % Hull::kPad, 0u);
}

Hull must_build(const Points& points) {
  Result<Hull> hull = build_hull(points);
  EXPECT_TRUE(hull) << hull.error().message;
  return hull ? *hull : Hull{};
}

Points cube_points(float half) {
  Points points;
  for (int i = 0; i < 8; ++i) {
    points.push_back({(i & 1) ? half : -half, (i & 2) ? half : -half, (i & 4) ? half : -half});
  }
  return points;
}

Points turned(Points points, Quat q, Vec3 shift = {}) {
  for (Vec3& p : points) p = rotate(q, p) + shift;
  return points;
}

// Same vertices and faces as wanted; the count of corners of each face, sorted.
void expect_counts(const Hull& hull, int vertices, int faces, int corners_each) {
  EXPECT_EQ(hull.vertex_count(), vertices);
  EXPECT_EQ(hull.face_count(), faces);
  for (std::size_t f = 0; f < hull.planes.size(); ++f) {
    EXPECT_EQ(int(hull.face_offsets[f + 1] - hull.face_offsets[f]), corners_each);
  }
}

TEST(HullBuilder, CubeHasSixSquaresHoweverItIsTurned) {
  Random random;
  for (int round = 0; round < 50; ++round) {
    const Points points =
        turned(cube_points(0.5f), random.turn(), round % 2 ? 3.0f * random.in_cube() : Vec3{});
    const Hull hull = must_build(points);
    expect_valid(points, hull);
    expect_counts(hull, 8, 6, 4);
    EXPECT_NEAR(hull_volume(hull), 1.0, 3e-6);
  }
}

TEST(HullBuilder, PlatonicSolids) {
  const float g = 1.6180340f, i = 0.6180340f;
  const Points octahedron = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const Points icosahedron = {{0, 1, g},  {0, 1, -g},  {0, -1, g}, {0, -1, -g}, {1, g, 0},  {1, -g, 0},
                              {-1, g, 0}, {-1, -g, 0}, {g, 0, 1},  {g, 0, -1},  {-g, 0, 1}, {-g, 0, -1}};
  Points dodecahedron = cube_points(1.0f);
  for (int a = 0; a < 4; ++a) {
    const float s = (a & 1) ? i : -i, t = (a & 2) ? g : -g;
    dodecahedron.insert(dodecahedron.end(), {{0, s, t}, {s, t, 0}, {t, 0, s}});
  }
  Random random;
  for (int round = 0; round < 20; ++round) {
    const Quat q = round == 0 ? Quat{} : random.turn();
    expect_counts(must_build(turned(octahedron, q)), 6, 8, 3);
    expect_counts(must_build(turned(icosahedron, q)), 12, 20, 3);
    const Hull hull = must_build(turned(dodecahedron, q));
    expect_counts(hull, 20, 12, 5);
    expect_valid(turned(dodecahedron, q), hull);
  }
}

TEST(HullBuilder, PointsInsideOnFacesAndEdgesDoNotMatter) {
  Random random;
  for (int round = 0; round < 10; ++round) {
    Points points;
    // A grid over the whole surface and inside, corners last.
    for (int x = 0; x <= 10; ++x) {
      for (int y = 0; y <= 10; ++y) {
        for (int z = 0; z <= 10; ++z)
          points.push_back({0.2f * float(x) - 1, 0.2f * float(y) - 1, 0.2f * float(z) - 1});
      }
    }
    std::shuffle(points.begin(), points.end(), random.engine);
    if (round > 4) points = turned(points, random.turn());
    const Hull hull = must_build(points);
    expect_valid(points, hull);
    expect_counts(hull, 8, 6, 4);
  }
}

TEST(HullBuilder, DuplicatesAndNearDuplicates) {
  Random random;
  for (int round = 0; round < 20; ++round) {
    Points points;
    for (const Vec3& corner : turned(cube_points(0.5f), random.turn())) {
      for (int i = 0; i < 6; ++i) points.push_back(corner + (i < 2 ? 0.0f : 1.0e-7f) * random.in_cube());
    }
    const Hull hull = must_build(points);
    expect_valid(points, hull);
    expect_counts(hull, 8, 6, 4);
  }
}

TEST(HullBuilder, TenThousandNearlyCoplanarPoints) {
  for (const float noise : {0.0f, 1.0e-7f, 1.0e-6f, 1.0e-5f, 1.0e-4f}) {
    Random random;
    Points points;
    const Quat q = random.turn();
    for (int i = 0; i < 10000; ++i) points.push_back({random(), noise * random(), random()});
    points.push_back({0, 1, 0});
    points = turned(points, q);
    const Hull hull = must_build(points);
    // Bumps that are larger than the tolerance take more corners than there are.
    expect_valid(points, hull, noise > 5.0e-6f ? 2.0 * double(noise) + 1.0e-2 : 1.5e-6);
    if (noise < 1.0e-6f) {
      // The square's bottom is one face; the noisy rim of random points gives the corners.
      EXPECT_LT(hull.vertex_count(), 80);
    }
  }
}

TEST(HullBuilder, TenThousandPointsAroundABox) {
  Random random;
  Points points;
  for (int i = 0; i < 10000; ++i) {
    Vec3 p = random.in_cube();
    const int axis = i % 3;
    const float sign = i % 2 ? 1.0f : -1.0f;
    if (axis == 0) p.x = sign;
    if (axis == 1) p.y = sign;
    if (axis == 2) p.z = sign;
    points.push_back(p + 1.0e-7f * random.in_cube());
  }
  const Points corners = cube_points(1.0f);
  points.insert(points.end(), corners.begin(), corners.end());
  const Hull hull = must_build(points);
  expect_valid(points, hull);
  expect_counts(hull, 8, 6, 4);
}

TEST(HullBuilder, RandomClouds) {
  Random random;
  for (int round = 0; round < 200; ++round) {
    Points points;
    const int count = 4 + int(random.engine() % 60);
    const Vec3 stretch{1.0f, random(0.01f, 1.0f), random(0.01f, 1.0f)};
    for (int i = 0; i < count; ++i)
      points.push_back(multiply_each(stretch, round % 2 ? random.in_cube() : random.on_sphere()));
    const Hull hull = must_build(points);
    expect_valid(points, hull);
  }
}

TEST(HullBuilder, CoarseGridsAreFullOfLinesAndPlanes) {
  Random random;
  for (int round = 0; round < 300; ++round) {
    Points points;
    const int count = 4 + int(random.engine() % 40);
    for (int i = 0; i < count; ++i) {
      points.push_back({float(random.engine() % 4), float(random.engine() % 4), float(random.engine() % 3)});
    }
    const Result<Hull> hull = build_hull(points);
    if (hull) expect_valid(points, *hull);
  }
}

TEST(HullBuilder, Slivers) {
  Random random;
  for (int round = 0; round < 200; ++round) {
    // Needles, plates and wedges, down to thicknesses far below the accepted one.
    const float thin = std::pow(10.0f, random(-8.0f, -1.0f)), thick = round % 3 ? 1.0f : thin;
    Points points;
    for (int i = 0; i < 24; ++i) points.push_back(multiply_each({1.0f, thick, thin}, random.in_cube()));
    points = turned(points, random.turn());
    const Result<Hull> hull = build_hull(points);
    if (hull) {
      expect_valid(points, *hull);
    } else {
      EXPECT_LT(thin, 1.0e-5f);
      EXPECT_EQ(hull.error().code, ErrorCode::invalid_geometry);
    }
    // The tip of a needle remains although it is close to every plane.
    if (hull) {
      double farthest = 0.0, kept = 0.0;
      for (const Vec3& p : points) farthest = std::max(farthest, double(length(p - points[0])));
      for (const Vec3& p : hull->vertices) kept = std::max(kept, double(length(p - points[0])));
      EXPECT_NEAR(kept, farthest, 1e-5);
    }
  }
}

// Output of exporters: a slab whose corners come twice, slightly apart, with cut edges; and a sheet folded by less than
// the precision of float.
TEST(HullBuilder, NearlyEqualCornersAndFoldedSheets) {
  Random random;
  for (int round = 0; round < 200; ++round) {
    const float apart = std::pow(10.0f, random(-8.0f, -2.0f));
    Points slab;
    for (const Vec3& corner : cube_points(1.0f)) {
      const Vec3 p = multiply_each({2.0f, 5.0f, 7.0f}, corner);
      slab.push_back(p);
      slab.push_back(p + apart * random.in_cube());
      if (p.x > 0) slab.push_back({p.x - 1.0f, p.y, p.z + (p.z > 0 ? apart : -apart)});
    }
    slab = turned(slab, random.turn(), 10.0f * random.in_cube());
    expect_valid(slab, must_build(slab));
    Points sheet = {{0, 0, 0}, {0, 1, 0}, {0.7f, 0, apart}, {0.7f, 1, 0}, {0.8f, 0.5f, 0}};
    sheet = turned(sheet, random.turn());
    const Result<Hull> folded = build_hull(sheet);
    EXPECT_EQ(bool(folded), apart > 1.5e-5f || (folded && apart > 2.0e-6f)) << apart;
    if (folded) expect_valid(sheet, *folded);
  }
}

TEST(HullBuilder, ABladeKeepsWhatSticksOutOfItsEdge) {
  // The point is 2e-7 above both planes of the blade, but 2e-4 beyond its edge.
  const Points blade = {{0, 1e-3f, 0}, {0, -1e-3f, 0}, {0, 1e-3f, 1},     {0, -1e-3f, 1},
                        {1, 0, 0},     {1, 0, 1},      {1.0002f, 0, 0.4f}};
  const Hull hull = must_build(blade);
  expect_valid(blade, hull);
  EXPECT_EQ(hull.vertex_count(), 7);
  EXPECT_EQ(hull.box.high.x, 1.0002f);
  // Along no axis, so that no extreme point saves it.
  Random random;
  for (int round = 0; round < 20; ++round) {
    EXPECT_EQ(must_build(turned(blade, random.turn())).vertex_count(), 7);
  }
}

TEST(HullBuilder, AnyMixtureOfDegenerateParts) {
  Random random;
  int built = 0;
  for (int round = 0; round < 3000; ++round) {
    Points points;
    const float noise = round % 4 == 0 ? 0.0f : std::pow(10.0f, random(-9.0f, -3.0f));
    const int parts = 1 + int(random.engine() % 5);
    for (int part = 0; part < parts; ++part) {
      const Vec3 middle = round % 3 == 0 ? Vec3{float(random.engine() % 3), float(random.engine() % 3),
                                                float(random.engine() % 3)}
                                         : random.in_cube();
      const Vec3 u = random.in_cube(), v = random.in_cube();
      const int kind = int(random.engine() % 5), count = 1 + int(random.engine() % 40);
      for (int i = 0; i < count; ++i) {
        Vec3 p = middle;
        if (kind == 1) p += random() * u;                                         // a line
        if (kind == 2) p += random() * u + random() * v;                          // a plane
        if (kind == 3) p += 0.5f * random.on_sphere();                            // a ball
        if (kind == 4) p += 0.25f * float(i % 5) * u + 0.25f * float(i / 5) * v;  // a grid
        points.push_back(p + noise * random.in_cube());                           // or all in one place
      }
    }
    const float size = std::pow(10.0f, float(round % 7) - 3.0f);
    for (Vec3& p : points) p *= size;
    const Result<Hull> hull = build_hull(points);
    if (!hull) continue;
    ++built;
    expect_valid(points, *hull, hull->vertex_count() < 120 ? 1.5e-6 : 1.0e-3);
    if (HasFailure()) FAIL() << "round " << round;
  }
  EXPECT_GT(built, 1500);
}

TEST(HullBuilder, AllSizesAlike) {
  Random random;
  Points points;
  for (int i = 0; i < 30; ++i) points.push_back(random.on_sphere());
  const Hull one = must_build(points);
  for (const float size : {1.0f / 1024.0f, 1.0f / 1048576.0f, 1024.0f, 1048576.0f}) {
    Points scaled = points;
    for (Vec3& p : scaled) p *= size;
    const Hull hull = must_build(scaled);
    EXPECT_EQ(hull.face_vertices, one.face_vertices);
    EXPECT_EQ(hull.face_offsets, one.face_offsets);
    EXPECT_EQ(hull.inner_radius, one.inner_radius * size);
  }
}

TEST(HullBuilder, FarFromTheOrigin) {
  // A float at 1 km is 6e-5 m coarse.
  const Points points =
      turned(cube_points(0.5f), normalized(Quat{0.1f, 0.4f, 0.2f, 1.0f}), {1000, 500, -700});
  const Hull hull = must_build(points);
  expect_valid(points, hull);
  expect_counts(hull, 8, 6, 4);
}

TEST(HullBuilder, ManyPointsOnASphereKeepTheShape) {
  Random random;
  Points points;
  for (int i = 0; i < 5000; ++i) points.push_back(random.on_sphere());
  const Hull hull = must_build(points);
  expect_valid(points, hull, 0.02);
  EXPECT_GE(hull.vertex_count(), 125);
  EXPECT_GT(hull_volume(hull), 0.93 * 4.0 / 3.0 * 3.14159265);
  EXPECT_LT(length(hull.centroid), 0.02f);
}

TEST(HullBuilder, PrismOfManySides) {
  for (const int sides : {16, 100, 127, 200, 1000}) {
    Points points;
    for (int i = 0; i < sides; ++i) {
      const float angle = 6.2831853f * float(i) / float(sides);
      for (const float y : {-1.0f, 1.0f}) points.push_back({std::cos(angle), y, std::sin(angle)});
    }
    const Hull hull = must_build(points);
    expect_valid(points, hull, sides > 127 ? 2.0e-3 : 1.5e-6);
    if (sides <= 127) {
      EXPECT_EQ(hull.vertex_count(), 2 * sides);
      EXPECT_EQ(hull.face_count(), sides + 2);
    }
  }
}

TEST(HullBuilder, RefusesWhatSpansNoVolume) {
  const auto message = [](const Points& points) {
    const Result<Hull> hull = build_hull(points);
    EXPECT_FALSE(hull);
    EXPECT_EQ(hull.error().code, ErrorCode::invalid_geometry);
    return std::string(hull.error().message);
  };
  const float nan = std::nanf(""), inf = INFINITY;
  EXPECT_NE(message({}).find("0 points"), std::string::npos);
  EXPECT_NE(message({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).find("3 points"), std::string::npos);
  EXPECT_NE(message({{0, 0, 0}, {1, 0, 0}, {0, nan, 0}, {0, 0, 1}}).find("point 2 is"), std::string::npos);
  EXPECT_NE(message({{0, 0, 0}, {1, 0, inf}, {0, 1, 0}, {0, 0, 1}}).find("point 1 is"), std::string::npos);
  EXPECT_NE(message({{0, 0, 0}, {1e30f, 0, 0}, {0, 1, 0}, {0, 0, 1}}).find("point 1 is"), std::string::npos);
  EXPECT_NE(message(Points(5, {1, 2, 3})).find("coincide"), std::string::npos);
  EXPECT_NE(message({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}).find("on one line"), std::string::npos);
  Random random;
  Points plane, line;
  const Quat q = random.turn();
  for (int i = 0; i < 500; ++i) plane.push_back(rotate(q, {random(), 1.0e-7f * random(), random()}));
  for (int i = 0; i < 500; ++i) line.push_back(rotate(q, {random(), 1.0e-7f * random(), 1.0e-7f * random()}));
  EXPECT_NE(message(plane).find("in one plane"), std::string::npos);
  EXPECT_NE(message(line).find("on one line"), std::string::npos);
}

TEST(HullBuilder, CookedHullsKnowTheirContent) {
  const Points points = cube_points(1.0f);
  const Result<Geometry> a = cook_hull(points), b = cook_hull(points), c = cook_hull(cube_points(2.0f));
  ASSERT_TRUE(a && b && c);
  EXPECT_EQ(a->kind(), ShapeKind::hull);
  EXPECT_EQ(a->content_hash(), b->content_hash());
  EXPECT_NE(a->content_hash(), c->content_hash());
  const HullView view = view_hull(*a);
  EXPECT_EQ(view.vertices.size(), 8u);
  EXPECT_EQ(view.face_offsets.size(), 7u);
  EXPECT_EQ(view.face_indices.size(), 24u);
}

TEST(Hull, SupportIsThatOfAPlainSearch) {
  Random random;
  for (int round = 0; round < 30; ++round) {
    Points points;
    for (int i = 0; i < 4 + round * 3; ++i) points.push_back(random.on_sphere());
    const Hull hull = must_build(points);
    for (int i = 0; i < 50; ++i) {
      const Vec3 d = random.in_cube();
      std::size_t best = 0;
      for (std::size_t v = 1; v < hull.vertices.size(); ++v) {
        if (dot(hull.vertices[v], d) > dot(hull.vertices[best], d)) best = v;
      }
      EXPECT_EQ(support_vertex(hull, d), int(best));
    }
    EXPECT_EQ(support_vertex(hull, {}), 0);
    for (std::size_t f = 0; f < hull.planes.size(); ++f) {
      const Vec3 n = hull.planes[f].normal;
      EXPECT_GT(dot(hull.planes[std::size_t(support_face(hull, n))].normal, n), 1.0f - 1.0e-6f);
    }
  }
}

}  // namespace
}  // namespace gyre::hull_builder_test
