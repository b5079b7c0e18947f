// Cooked meshes: refused input, dropped triangles, and the kinds of edges and corners.
#include "geometry/shape/mesh.h"

#include "geometry/shape/cooked.h"
#include "geometry/testing/mesh_test_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace gyre::mesh_test {
namespace {

using test::Random;
using test::Triangles;

const Mesh& mesh_of(const Geometry& geometry) { return *geometry.data()->mesh; }

Error refusal(const Triangles& triangles) {
  const Result<Geometry> made = cook_mesh({.vertices = triangles.vertices, .indices = triangles.indices});
  EXPECT_FALSE(made.has_value());
  return made.error();
}

// Counts half-edges of a kind.
int count_edges(const Mesh& mesh, EdgeKind kind) {
  int count = 0;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    for (int i = 0; i < 3; ++i) count += edge_kind(mesh.flags[t], i) == kind;
  }
  return count;
}

Triangles one_triangle() {
  Triangles out;
  out.triangle(out.vertex({0, 0, 0}), out.vertex({0, 0, 1}), out.vertex({1, 0, 0}));
  return out;
}

TEST(CookMesh, RefusesAnIndexOutOfRangeAndNamesTheTriangle) {
  Triangles bad = test::flat_grid(2.0f, 1.0f);
  bad.indices[3 * 5 + 1] = 1000;
  const Error error = refusal(bad);
  EXPECT_EQ(error.code, ErrorCode::invalid_geometry);
  EXPECT_NE(std::strstr(error.message, "triangle 5"), nullptr) << error.message;
  EXPECT_NE(std::strstr(error.message, "1000"), nullptr) << error.message;
}

TEST(CookMesh, RefusesNonFiniteVerticesAndNamesThem) {
  for (const float value : {std::nanf(""), HUGE_VALF, -HUGE_VALF, 3.0e9f}) {
    Triangles bad = test::flat_grid(2.0f, 1.0f);
    bad.vertices[7].y = value;
    const Error error = refusal(bad);
    EXPECT_EQ(error.code, ErrorCode::invalid_geometry);
    EXPECT_NE(std::strstr(error.message, "vertex 7"), nullptr) << error.message;
  }
}

TEST(CookMesh, RefusesWhatHasNoTriangleLeft) {
  EXPECT_EQ(refusal(Triangles()).code, ErrorCode::invalid_geometry);
  Triangles sliver;
  sliver.triangle(sliver.vertex({0, 0, 0}), sliver.vertex({1, 0, 0}), sliver.vertex({2, 0, 0}));
  sliver.triangle(0, 0, 1);
  const Error error = refusal(sliver);
  EXPECT_NE(std::strstr(error.message, "2 triangles"), nullptr) << error.message;
  Triangles part = one_triangle();
  part.indices.pop_back();
  EXPECT_EQ(refusal(part).code, ErrorCode::invalid_geometry);
}

TEST(CookMesh, TakesASingleTriangle) {
  const Geometry geometry = one_triangle().cook();
  ASSERT_TRUE(geometry);
  const Mesh& mesh = mesh_of(geometry);
  ASSERT_EQ(mesh.triangle_count(), 1u);
  EXPECT_EQ(mesh.normals[0], (Vec3{0, 1, 0}));
  EXPECT_EQ(count_edges(mesh, EdgeKind::open), 3);
  EXPECT_EQ(view_mesh(geometry).indices.size(), 3u);
}

TEST(CookMesh, LeavesOutEmptyTrianglesAndDoubles) {
  Triangles triangles = test::flat_grid(2.0f, 1.0f);
  const std::uint32_t count = std::uint32_t(triangles.indices.size() / 3);
  // The same triangle from another corner, one without area, and one that faces the other way; the last one stays.
  const std::vector<std::uint32_t> i = triangles.indices;
  triangles.triangle(i[1], i[2], i[0]);
  triangles.triangle(i[0], i[1], i[1]);
  triangles.triangle(i[3], i[5], i[4]);
  const Geometry geometry = triangles.cook();
  const Mesh& mesh = mesh_of(geometry);
  EXPECT_EQ(mesh.triangle_count(), count + 1);
  EXPECT_EQ(std::count(mesh.source.begin(), mesh.source.end(), count + 2), 1);
  EXPECT_EQ(std::count(mesh.source.begin(), mesh.source.end(), count), 0);
  // The floor's own edges are paired with each other, not with the back.
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    if (mesh.source[t] == count + 2) continue;
    for (std::uint32_t edge = 0; edge < 3; ++edge) {
      const std::uint32_t twin = mesh.twins[3 * t + edge];
      if (twin == Mesh::kNoTwin) continue;
      EXPECT_EQ(mesh.normals[twin / 3], (Vec3{0, 1, 0}));
    }
  }
}

TEST(CookMesh, WeldsEqualAndNearVertices) {
  // Every triangle with corners of its own, moved a little below the tolerance.
  const Triangles joined = test::flat_grid(5.0f, 1.0f);
  Random random{3};
  for (const float shift : {0.0f, 2.0e-6f}) {
    Triangles soup;
    for (const std::uint32_t i : joined.indices) {
      const Vec3 wobble = shift * random.direction();
      soup.indices.push_back(soup.vertex(joined.vertices[i] + wobble));
    }
    const Geometry geometry = soup.cook();
    const Mesh& mesh = mesh_of(geometry);
    EXPECT_EQ(mesh.vertices.size(), joined.vertices.size());
    EXPECT_EQ(count_edges(mesh, EdgeKind::open), 40);
  }
  // Ten times the tolerance apart: pieces.
  Triangles apart;
  for (const std::uint32_t i : joined.indices) {
    apart.indices.push_back(apart.vertex(joined.vertices[i] + 1.0e-3f * random.direction()));
  }
  EXPECT_GT(mesh_of(apart.cook()).vertices.size(), 4 * joined.vertices.size());
}

TEST(CookMesh, WeldingKeepsSmallTrianglesOfALargeMesh) {
  // 2 km of ground and on it a chip of a millimetre: welding at a millionth of 2 km would make it vanish.
  Triangles triangles;
  triangles.quad({-1000, 0, -1000}, {-1000, 0, 1000}, {1000, 0, 1000}, {1000, 0, -1000});
  triangles.triangle(triangles.vertex({0, 1, 0}), triangles.vertex({0, 1, 0.001f}),
                     triangles.vertex({0.001f, 1, 0}));
  EXPECT_EQ(mesh_of(triangles.cook()).triangle_count(), 3u);
}

TEST(CookMesh, WeldsManyEqualVertices) {
  Triangles fan;
  for (int i = 0; i < 100000; ++i) {
    const auto rim = [](int k) {
      const float angle = 6.0e-5f * float(k);
      return Vec3{1000.0f * std::sin(angle), 0.0f, 1000.0f * std::cos(angle)};
    };
    fan.triangle(fan.vertex({0, 0, 0}), fan.vertex(rim(i)), fan.vertex(rim(i + 1)));
  }
  EXPECT_EQ(mesh_of(fan.cook()).vertices.size(), 100002u);
}

TEST(CookMesh, KnowsFlatConvexAndConcaveEdges) {
  // A flat floor: nothing but its border is an edge.
  const Geometry floor = test::flat_grid(3.0f, 1.0f).cook();
  EXPECT_EQ(count_edges(mesh_of(floor), EdgeKind::open), 24);
  EXPECT_EQ(count_edges(mesh_of(floor), EdgeKind::convex), 0);
  EXPECT_EQ(count_edges(mesh_of(floor), EdgeKind::concave), 0);
  // A roof, and the same upside down.
  const Geometry roof = test::grid(2.0f, 1.0f, [](float x, float) { return -std::fabs(x); }).cook();
  EXPECT_EQ(count_edges(mesh_of(roof), EdgeKind::convex), 8);
  const Geometry valley = test::grid(2.0f, 1.0f, [](float x, float) { return std::fabs(x); }).cook();
  EXPECT_EQ(count_edges(mesh_of(valley), EdgeKind::concave), 8);
  // A box: its twelve edges, and the diagonals are flat.
  Triangles box;
  test::add_box(box, {-1, -2, -3}, {1, 2, 3});
  const Geometry closed = box.cook();
  EXPECT_EQ(mesh_of(closed).vertices.size(), 8u);
  EXPECT_EQ(count_edges(mesh_of(closed), EdgeKind::convex), 24);
  EXPECT_EQ(count_edges(mesh_of(closed), EdgeKind::flat), 12);
}

TEST(CookMesh, ATiltedFloorIsOnePatchWithOneNormal) {
  const Geometry ramp =
      test::grid(4.0f, 0.25f, [](float x, float z) { return 0.37f * x - 0.21f * z; }).cook();
  const Mesh& mesh = mesh_of(ramp);
  EXPECT_EQ(count_edges(mesh, EdgeKind::convex) + count_edges(mesh, EdgeKind::concave), 0);
  const Vec3 up = normalized(Vec3{-0.37f, 1.0f, 0.21f});
  for (const Vec3 n : mesh.normals) {
    EXPECT_EQ(n, mesh.normals[0]);
    EXPECT_LT(length(n - up), 1.0e-6f);
  }
  int inside = 0;
  for (const std::uint16_t flags : mesh.flags) inside += (flags & kInsidePatch) != 0;
  EXPECT_EQ(inside, 2 * 30 * 30);
}

TEST(CookMesh, AFinelyCutCurveIsNotFlat) {
  // A cylinder of 10 m in cells of 1 cm: each edge bends by 1e-3 only, but the whole is round.
  const Geometry curve =
      test::grid(1.0f, 0.01f, [](float x, float) { return std::sqrt(100.0f - x * x) - 10.0f; }).cook();
  const Mesh& mesh = mesh_of(curve);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    const Aabb box = triangle_box(mesh, t);
    const float x = 0.5f * (box.low.x + box.high.x);
    const Vec3 up = normalized(Vec3{x / std::sqrt(100.0f - x * x), 1.0f, 0.0f});
    EXPECT_LT(length(mesh.normals[t] - up), 2.5e-3f);
  }
  EXPECT_GT(count_edges(mesh, EdgeKind::convex), 100);
}

TEST(CookMesh, SharedEdgesPairTheFlattestFaces) {
  // A floor of two halves, and a wall that stands on the edge between them.
  Triangles triangles;
  triangles.quad({-1, 0, -1}, {-1, 0, 1}, {0, 0, 1}, {0, 0, -1});
  triangles.quad({0, 0, -1}, {0, 0, 1}, {1, 0, 1}, {1, 0, -1});
  triangles.quad({0, 0, -1}, {0, 0, 1}, {0, 1, 1}, {0, 1, -1});
  const Geometry geometry = triangles.cook();
  const Mesh& mesh = mesh_of(geometry);
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    const TriangleView view = view_triangle(mesh, t);
    for (int i = 0; i < 3; ++i) {
      const bool middle = view.v[i].x == 0 && view.v[next_corner(i)].x == 0 && view.v[i].y == 0 &&
                          view.v[next_corner(i)].y == 0;
      if (!middle) continue;
      EXPECT_EQ(view.edge[i], view.normal.y > 0.5f ? EdgeKind::flat : EdgeKind::open);
    }
  }
}

TEST(CookMesh, TakesInvertedNeighboursAndCrowdedEdges) {
  Triangles triangles;
  triangles.quad({-1, 0, -1}, {-1, 0, 1}, {0, 0, 1}, {0, 0, -1});
  triangles.quad({1, 0, -1}, {1, 0, 1}, {0, 0, 1}, {0, 0, -1});  // seen from behind
  const Geometry inverted = triangles.cook();
  EXPECT_EQ(count_edges(mesh_of(inverted), EdgeKind::open), 8);
  // Forty sheets on one edge.
  Triangles book;
  const std::uint32_t a = book.vertex({0, 0, -1}), b = book.vertex({0, 0, 1});
  for (int i = 0; i < 40; ++i) book.triangle(a, b, book.vertex({std::cos(float(i)), std::sin(float(i)), 0}));
  EXPECT_EQ(mesh_of(book.cook()).triangle_count(), 40u);
}

TEST(CookMesh, TwinsLeadBackAndEdgesAgree) {
  Random random{17};
  const Geometry bumpy =
      test::grid(4.0f, 0.5f, [&](float, float) { return random.between(0.0f, 0.4f); }).cook();
  const Mesh& mesh = mesh_of(bumpy);
  for (std::uint32_t h = 0; h < mesh.twins.size(); ++h) {
    const std::uint32_t twin = mesh.twins[h];
    if (twin == Mesh::kNoTwin) continue;
    EXPECT_EQ(mesh.twins[twin], h);
    EXPECT_EQ(mesh.indices[h], mesh.indices[twin / 3 * 3 + (twin + 1) % 3]);
    EXPECT_EQ(edge_kind(mesh.flags[h / 3], int(h % 3)), edge_kind(mesh.flags[twin / 3], int(twin % 3)));
    // Convex: the other triangle's far corner lies below this one's plane.
    const Vec3 far_corner = mesh.vertices[mesh.indices[twin / 3 * 3 + (twin + 2) % 3]];
    const float height = dot(mesh.normals[h / 3], far_corner - mesh.vertices[mesh.indices[h]]);
    const EdgeKind kind = edge_kind(mesh.flags[h / 3], int(h % 3));
    EXPECT_FALSE(kind == EdgeKind::convex && height > 1.0e-6f);
    EXPECT_FALSE(kind == EdgeKind::concave && height < -1.0e-6f);
    const TriangleView view = view_triangle(mesh, h / 3), beyond = view_triangle(mesh, twin / 3);
    EXPECT_EQ(view.edge_id[h % 3], beyond.edge_id[twin % 3]);
    EXPECT_EQ(view.neighbor_normal[h % 3], beyond.normal);
  }
}

TEST(CookMesh, NormalConesEqualBruteForce) {
  Random random{23};
  const Geometry bumpy =
      test::grid(2.0f, 0.5f, [&](float, float) { return random.between(0.0f, 0.4f); }).cook();
  const Mesh& mesh = mesh_of(bumpy);
  int inside = 0;
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
    for (int corner = 0; corner < 3; ++corner) {
      const std::uint32_t apex = mesh.indices[3 * t + std::uint32_t(corner)];
      const Vec3 d = normalized(Vec3{random.between(-0.5f, 0.5f), 1.0f, random.between(-0.5f, 0.5f)});
      bool want = true;
      for (std::uint32_t h = 0; h < mesh.indices.size(); ++h) {
        const std::uint32_t next = h / 3 * 3 + (h + 1) % 3;
        if (mesh.indices[h] != apex && mesh.indices[next] != apex) continue;
        const Vec3 other = mesh.vertices[mesh.indices[h] == apex ? mesh.indices[next] : mesh.indices[h]];
        want = want && dot(d, other - mesh.vertices[apex]) <= 1.0e-3f * length(other - mesh.vertices[apex]);
      }
      EXPECT_EQ(in_normal_cone(mesh, t, corner, d, 1.0e-3f), want);
      inside += want;
    }
  }
  EXPECT_GT(inside, 10);
}

TEST(CookMesh, HashesTellMeshesApart) {
  const std::uint64_t one = test::flat_grid(2.0f, 1.0f).cook().content_hash();
  EXPECT_EQ(one, test::flat_grid(2.0f, 1.0f).cook().content_hash());
  EXPECT_NE(one, test::flat_grid(2.0f, 1.0f).cook(true).content_hash());
  Triangles other = test::flat_grid(2.0f, 1.0f);
  other.vertices[3].y = 1.0e-3f;
  EXPECT_NE(one, other.cook().content_hash());
}

TEST(Triangle, SeenFromBehindTwiceIsItself) {
  const Geometry roof =
      test::grid(2.0f, 1.0f, [](float x, float z) { return -std::fabs(x) + 0.1f * z * z; }).cook();
  for (std::uint32_t t = 0; t < mesh_of(roof).triangle_count(); ++t) {
    const TriangleView front = view_triangle(mesh_of(roof), t), back = back_view(front);
    const TriangleView again = back_view(back);
    EXPECT_EQ(triangle_normal(back.v[0], back.v[1], back.v[2]),
              -triangle_normal(front.v[0], front.v[1], front.v[2]));
    EXPECT_EQ(again.normal, front.normal);
    EXPECT_EQ(again.flat_corners, front.flat_corners);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(again.v[i], front.v[i]);
      EXPECT_EQ(again.edge[i], front.edge[i]);
      EXPECT_EQ(again.edge_id[i], front.edge_id[i]);
      EXPECT_EQ(again.corner_id[i], front.corner_id[i]);
      // An edge of the back joins the same corners as the edge of the front with its name.
      for (int k = 0; k < 3; ++k) {
        if (back.edge_id[i] != front.edge_id[k]) continue;
        EXPECT_EQ(back.v[i], front.v[next_corner(k)]);
        EXPECT_EQ(back.v[next_corner(i)], front.v[k]);
      }
    }
  }
}

}  // namespace
}  // namespace gyre::mesh_test
