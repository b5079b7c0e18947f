// The fill of closed surfaces: quality, volume, cracks, the embedded surface, thin parts, and every refusal.
#include "soft/mesh/tetrahedral_fill.h"

#include "base/hash.h"
#include "geometry/decomposition/surface_field.h"
#include "geometry/distance/closest.h"
#include "random.h"
#include "soft/mesh/tetrahedral_fill_test_meshes.h"
#include "soft/mesh/tetrahedron_quality_test_kit.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <map>
#include <string>

namespace gyre::tetrahedral_fill_test {
namespace {

constexpr Vec3 kHalf{0.5f, 0.5f, 0.5f};

Result<TetrahedralMesh> fill_mesh(const TestMesh& mesh, int resolution) {
  return fill_with_tetrahedra(mesh.vertices, mesh.indices, resolution);
}
std::string refusal_of(const TestMesh& mesh, int resolution) {
  const Result<TetrahedralMesh> filled = fill_mesh(mesh, resolution);
  return filled ? std::string() : filled.error().message;
}
bool has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

DVec3 corner_of(const TetrahedralMesh& mesh, std::size_t tetrahedron, std::size_t i) {
  return DVec3(mesh.vertices[mesh.tetrahedra[4 * tetrahedron + i]]);
}
double side_of(const TestMesh& mesh) {
  Vec3 low = mesh.vertices[0], high = low;
  for (const Vec3& v : mesh.vertices) low = min(low, v), high = max(high, v);
  return double(largest(high - low));
}

TetrahedronQuality quality_of(const TetrahedralMesh& mesh) {
  TetrahedronQuality quality;
  for (std::size_t t = 0; t < mesh.tetrahedra.size() / 4; ++t)
    quality.add({corner_of(mesh, t, 0), corner_of(mesh, t, 1), corner_of(mesh, t, 2), corner_of(mesh, t, 3)});
  return quality;
}

void expect_quality(const TestMesh& surface, const TetrahedralMesh& mesh, int resolution) {
  const TetrahedronQuality quality = quality_of(mesh);
  // Vertices are rounded to float.
  EXPECT_GT(quality.smallest_angle, kMinDihedral - 0.01);
  EXPECT_LT(quality.largest_angle, kMaxDihedral + 0.01);
  const double cell = side_of(surface) / resolution;
  EXPECT_GT(quality.smallest_volume, 0.99 * kMinVolumeShare * cell * cell * cell / 12.0);
  EXPECT_NEAR(mesh.surface_volume, absolute(surface.volume()), 1.0e-5 * mesh.surface_volume);
  EXPECT_NEAR(quality.whole_volume, mesh.filled_volume, 1.0e-9 * mesh.filled_volume);
  EXPECT_LT(absolute(mesh.filled_volume / mesh.surface_volume - 1.0), kFillVolumeShare);
}

// A face with the corners in ascending order, and which way it is wound.
using Face = std::array<std::uint32_t, 3>;
std::map<Face, std::array<int, 2>> faces_of(const TetrahedralMesh& mesh) {
  constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  std::map<Face, std::array<int, 2>> faces;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); t += 4) {
    for (const auto& [a, b, c] : kFaces) {
      Face face{mesh.tetrahedra[t + std::size_t(a)], mesh.tetrahedra[t + std::size_t(b)],
                mesh.tetrahedra[t + std::size_t(c)]};
      int odd = 0;
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = i + 1; j < 3; ++j) odd ^= face[i] > face[j] ? 1 : 0;
      std::sort(face.begin(), face.end());
      ++faces[face][std::size_t(odd)];
    }
  }
  return faces;
}

// Every face has at most one tetrahedron on either side; those with one alone close, and lie on the surface.
void expect_no_cracks(const TestMesh& surface, const TetrahedralMesh& mesh) {
  std::map<std::array<std::uint32_t, 2>, int> edges;
  std::vector<bool> outer(mesh.vertices.size(), false);
  for (const auto& [face, count] : faces_of(mesh)) {
    ASSERT_LE(count[0], 1);
    ASSERT_LE(count[1], 1);
    if (count[0] + count[1] == 2) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      outer[face[i]] = true;
      for (std::size_t j = i + 1; j < 3; ++j) ++edges[{face[i], face[j]}];
    }
  }
  for (const auto& [edge, count] : edges) ASSERT_EQ(count % 2, 0);
  std::vector<DVec3> scaled;
  for (const Vec3& v : surface.vertices) scaled.push_back(DVec3(v) / 8.0 + DVec3{0.5, 0.5, 0.5});
  const SurfaceField field(scaled, surface.indices);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const DVec3 p = DVec3(mesh.vertices[i]) / 8.0 + DVec3{0.5, 0.5, 0.5};
    if (outer[i]) {
      EXPECT_LT(field.distance(p, 1.0), 1.0e-6);
    } else {
      EXPECT_GT(field.winding(p), 0.9);
    }
  }
}

DVec3 place_of(const EmbeddedPoint& point, const Array<Vec3>& vertices) {
  DVec3 sum{};
  for (int i = 0; i < 4; ++i) sum += double(point.weight[i]) * DVec3(vertices[point.corner[i]]);
  return sum;
}

// Weights sum to one and give the vertex, also after an affine motion; no tetrahedron is nearer than the one chosen.
void expect_embedded(const TestMesh& surface, TetrahedralMesh mesh) {
  ASSERT_EQ(mesh.surface.points.size(), surface.vertices.size());
  const double side = side_of(surface);
  for (std::size_t i = 0; i < mesh.surface.points.size(); ++i) {
    const EmbeddedPoint& point = mesh.surface.points[i];
    double sum = 0.0;
    for (const float w : point.weight) sum += double(w);
    EXPECT_NEAR(sum, 1.0, 1.0e-6);
    const DVec3 p(surface.vertices[i]);
    EXPECT_LT(length(place_of(point, mesh.vertices) - p), 1.0e-6 * side);
    if (i % 97 != 0) continue;
    const auto distance_to = [&](DVec3 a, DVec3 b, DVec3 c, DVec3 d) {
      return length(closest_on_tetrahedron(p, a, b, c, d).point - p);
    };
    DVec3 corner[4];
    for (int k = 0; k < 4; ++k) corner[k] = DVec3(mesh.vertices[point.corner[k]]);
    double best = 1.0e300;
    for (std::size_t t = 0; t < mesh.tetrahedra.size() / 4; ++t)
      best = std::min(best, distance_to(corner_of(mesh, t, 0), corner_of(mesh, t, 1), corner_of(mesh, t, 2),
                                        corner_of(mesh, t, 3)));
    EXPECT_NEAR(distance_to(corner[0], corner[1], corner[2], corner[3]), best, 1.0e-12);
  }
  const auto moved = [](Vec3 v) {
    return Vec3{1.2f * v.x + 0.3f * v.y, 0.8f * v.y - 0.2f * v.z, v.z + 0.4f * v.x} + Vec3{1, 2, 3};
  };
  for (Vec3& v : mesh.vertices) v = moved(v);
  for (std::size_t i = 0; i < mesh.surface.points.size(); ++i)
    EXPECT_LT(length(place_of(mesh.surface.points[i], mesh.vertices) - DVec3(moved(surface.vertices[i]))),
              1.0e-5 * side);
}

void expect_good(const TestMesh& surface, int resolution) {
  SCOPED_TRACE(resolution);
  const Result<TetrahedralMesh> mesh = fill_mesh(surface, resolution);
  ASSERT_TRUE(mesh) << mesh.error().message;
  expect_quality(surface, *mesh, resolution);
  expect_no_cracks(surface, *mesh);
  expect_embedded(surface, *mesh);
}

TestMesh turned_box(Vec3 half) {
  return moved(box_mesh({}, half), {{0.1f, 0.2f, 0.3f}, normalized(Quat{1, 2, 3, 5})});
}

TEST(TetrahedralFill, FillsASphere) { expect_good(ball_mesh(4), 10); }
TEST(TetrahedralFill, FillsATorus) { expect_good(torus_mesh(1.0f, 0.4f), 16); }
TEST(TetrahedralFill, FillsATurnedBox) { expect_good(turned_box({0.5f, 0.3f, 0.2f}), 13); }
TEST(TetrahedralFill, FillsAnLShape) { expect_good(beam_mesh(), 12); }
TEST(TetrahedralFill, FillsABunny) { expect_good(bunny_mesh(4), 14); }
TEST(TetrahedralFill, FillsAGear) { expect_good(gear_mesh(9), 12); }

TEST(TetrahedralFill, FillsAThinPlate) {
  expect_good(turned_box({0.5f, 0.5f, 0.04f}), 26);
  expect_good(box_mesh({}, {0.5f, 0.5f, 0.04f}), 8);
}

TEST(TetrahedralFill, FillsAShellWithoutItsCavity) {
  TestMesh shell = ball_mesh(3), cavity = moved(ball_mesh(3), {}, 0.6f);
  cavity.flip();
  shell.add(cavity);
  expect_good(shell, 16);
}

// Faces on the planes of the lattice stay exact, edges and corners too.
TEST(TetrahedralFill, KeepsABoxAlongTheAxes) {
  for (const int resolution : {2, 3, 8}) {
    const Result<TetrahedralMesh> mesh = fill_mesh(box_mesh({1, 2, 3}, {0.5f, 0.5f, 0.5f}), resolution);
    ASSERT_TRUE(mesh);
    EXPECT_NEAR(mesh->filled_volume, 1.0, 1.0e-6);
    EXPECT_EQ(mesh->tetrahedra.size() / 4, std::size_t(12 * resolution * resolution * (resolution + 1)));
  }
}

// A smooth surface is missed by the square of the cell, a sharp edge too: a part of a cell around it.
TEST(TetrahedralFill, TheVolumeConvergesWithTheSquareOfTheCells) {
  for (const TestMesh& surface :
       {ball_mesh(5), torus_mesh(1.0f, 0.4f, 48, 24), turned_box({0.5f, 0.4f, 0.3f})}) {
    double missing[2];
    for (int i = 0; i < 2; ++i) {
      const Result<TetrahedralMesh> mesh = fill_mesh(surface, 12 << i);
      ASSERT_TRUE(mesh);
      missing[i] = 1.0 - mesh->filled_volume / mesh->surface_volume;
    }
    EXPECT_GT(missing[1], 0.0);
    EXPECT_NEAR(std::log2(missing[0] / missing[1]), 2.0, 0.25);
  }
}

TEST(TetrahedralFill, KeepsItsBoundsInAnyTurn) {
  testing_random::Random random;
  for (int i = 0; i < 24; ++i) {
    const Transform pose{random.vector(-3.0f, 3.0f), random.turn(3.0f)};
    const float scale = random.real(0.01f, 20.0f);
    const TestMesh surface = moved(i % 2 == 0 ? bunny_mesh(3) : gear_mesh(5), pose, scale);
    const int resolution = 9 + int(random.next(9));
    const Result<TetrahedralMesh> mesh = fill_mesh(surface, resolution);
    ASSERT_TRUE(mesh) << i << ' ' << mesh.error().message;
    expect_quality(surface, *mesh, resolution);
    for (std::size_t k = 0; k < surface.vertices.size(); ++k) {
      EXPECT_LT(length(place_of(mesh->surface.points[k], mesh->vertices) - DVec3(surface.vertices[k])),
                3.0e-6 * side_of(surface) + 1.0e-6);
    }
  }
}

std::uint64_t hash_of(const TetrahedralMesh& mesh) {
  std::uint64_t hash = hash_bytes(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3));
  hash = hash_bytes(mesh.tetrahedra.data(), mesh.tetrahedra.size() * sizeof(std::uint32_t), hash);
  return hash_bytes(mesh.surface.points.data(), mesh.surface.points.size() * sizeof(EmbeddedPoint), hash);
}

TEST(TetrahedralFill, HasTheSameBitsEverywhere) {
  const Result<TetrahedralMesh> mesh = fill_mesh(bunny_mesh(4), 12), again = fill_mesh(bunny_mesh(4), 12);
  ASSERT_TRUE(mesh && again);
  EXPECT_EQ(hash_of(*mesh), hash_of(*again));
  EXPECT_EQ(hash_of(*mesh), 14476920132039837394u) << "of another compiler or processor";
}

TEST(TetrahedralFill, ReversesASurfaceThatIsInsideOut) {
  TestMesh surface = bunny_mesh(3);
  const Result<TetrahedralMesh> mesh = fill_mesh(surface, 12);
  surface.flip();
  const Result<TetrahedralMesh> turned = fill_mesh(surface, 12);
  ASSERT_TRUE(mesh && turned);
  EXPECT_EQ(hash_of(*mesh), hash_of(*turned));
  EXPECT_GT(turned->surface_volume, 0.0);
  EXPECT_EQ(turned->surface.triangles[1], mesh->surface.triangles[1]);
}

TEST(TetrahedralFill, AcceptsVerticesThatSeveralTrianglesRepeat) {
  const TestMesh welded = ball_mesh(3);
  TestMesh soup;
  for (const std::uint32_t i : welded.indices) {
    soup.indices.push_back(std::uint32_t(soup.vertices.size()));
    soup.vertices.push_back(welded.vertices[i]);
  }
  const Result<TetrahedralMesh> mesh = fill_mesh(welded, 8), same = fill_mesh(soup, 8);
  ASSERT_TRUE(mesh && same) << same.error().message;
  EXPECT_EQ(mesh->vertices, same->vertices);
  EXPECT_EQ(mesh->tetrahedra, same->tetrahedra);
}

// The table of docs/decisions/tetrahedral-fill.md.
TEST(LongTetrahedralFill, PrintsItsFigures) {
  struct Row {
    const char* name;
    TestMesh mesh;
  };
  const Row rows[] = {
      {"sphere", ball_mesh(5)}, {"torus", torus_mesh(1.0f, 0.4f, 128, 32)}, {"bunny", bunny_mesh(5)}};
  for (const Row& row : rows) {
    for (const int resolution : {8, 16, 32, 48}) {
      double best = 1.0e300;
      Result<TetrahedralMesh> mesh = fill_mesh(row.mesh, resolution);
      for (int i = 0; i < 5; ++i) {
        const auto start = std::chrono::steady_clock::now();
        mesh = fill_mesh(row.mesh, resolution);
        best =
            std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
      }
      ASSERT_TRUE(mesh) << mesh.error().message;
      expect_quality(row.mesh, *mesh, resolution);
      const TetrahedronQuality quality = quality_of(*mesh);
      const double count = double(mesh->tetrahedra.size()) / 4.0, cell = side_of(row.mesh) / resolution;
      std::printf("| %s | %d | %.0f | %.1f | %.1f | %.1f to %.1f | %.3f | %.2f |\n", row.name, resolution,
                  count, 1.0e3 * best, 1.0e7 * best / count, quality.smallest_angle, quality.largest_angle,
                  quality.smallest_volume * 12.0 / (cell * cell * cell),
                  100.0 * (1.0 - mesh->filled_volume / mesh->surface_volume));
    }
  }
}

// ------------------------------------------------------------------------------------------------------------ thin parts

// The resolution that the message names; 0 if it names none.
int advised(const std::string& message) {
  const std::size_t at = message.rfind("use resolution ");
  return at == std::string::npos ? 0 : std::stoi(message.substr(at + 15));
}

void expect_advice(const TestMesh& surface, int resolution, const char* part) {
  const std::string message = refusal_of(surface, resolution);
  EXPECT_TRUE(has(message, part)) << message;
  ASSERT_GT(advised(message), resolution) << message;
  const Result<TetrahedralMesh> mesh = fill_mesh(surface, advised(message));
  EXPECT_TRUE(mesh) << mesh.error().message;
}

TEST(TetrahedralFillThinParts, APlateBelowTheCellIsRefusedWithAResolution) {
  expect_advice(box_mesh({}, {0.5f, 0.5f, 0.02f}), 4, "has no tetrahedron; use resolution");
  expect_advice(turned_box({0.5f, 0.5f, 0.05f}), 6, "use resolution");
}
TEST(TetrahedralFillThinParts, AMissingVolumeIsRefusedWithAResolution) {
  expect_advice(turned_box({0.5f, 0.3f, 0.2f}), 4, "% of its volume; allowed are 85 to 115 %");
}
TEST(TetrahedralFillThinParts, ASmallPartIsRefusedWithAResolution) {
  TestMesh surface = ball_mesh(3);
  surface.add(moved(ball_mesh(1), {{1.5f, 0, 0}, {}}, 0.1f));
  expect_advice(surface, 7, "has no tetrahedron; use resolution");
}
TEST(TetrahedralFillThinParts, ASpikeIsRefusedWithAResolution) {
  expect_advice(bumpy_mesh(4, {{{0.3f, 1, 0.2f}, 2.0f, 0.03f}}), 6, "is too thin for resolution 6");
}
TEST(TetrahedralFillThinParts, ABarThatBreaksIsRefusedWithAResolution) {
  // Two blocks and a bar between them in one surface: an outline without kinks between the vertices that would show the loss.
  const TestMesh surface = revolved(
      {{0, -1}, {0.5f, -1}, {0.5f, -0.4f}, {0.1f, -0.4f}, {0.1f, 0.4f}, {0.5f, 0.4f}, {0.5f, 1}, {0, 1}}, 16,
      false);
  expect_advice(moved(surface, {{}, normalized(Quat{1, 2, 3, 9})}), 10,
                "has 1 connected components and would have 2 at resolution 10");
}
TEST(TetrahedralFillThinParts, PartsCloserThanACellAreRefusedWithAResolution) {
  TestMesh surface = box_mesh({-0.52f, 0, 0}, {0.5f, 0.5f, 0.5f});
  surface.add(box_mesh({0.52f, 0, 0}, {0.5f, 0.5f, 0.5f}));
  expect_advice(surface, 8, "has 2 connected components and would have 1 at resolution 8");
}
TEST(TetrahedralFillThinParts, APartTooThinForAnyResolutionSaysSo) {
  const std::string message = refusal_of(box_mesh({}, {0.5f, 0.5f, 1.0e-4f}), 90);
  EXPECT_TRUE(has(message, "no resolution within the limits keeps it")) << message;
}

// -------------------------------------------------------------------------------------------------------------- refusals

TEST(TetrahedralFillRefusals, ResolutionsOutOfRange) {
  for (const int resolution : {-1, 0, 1, 129}) {
    const std::string message = refusal_of(ball_mesh(2), resolution);
    EXPECT_EQ(message, "resolution: " + std::to_string(resolution) + "; allowed are 2 to 128");
  }
}
TEST(TetrahedralFillRefusals, AnOpenSurface) {
  TestMesh surface = box_mesh({}, kHalf);
  surface.indices.resize(surface.indices.size() - 3);
  const std::string message = refusal_of(surface, 8);
  EXPECT_TRUE(has(message, "edge from vertex")) << message;
  EXPECT_TRUE(has(message, "is open (triangles with it: 1)")) << message;
  surface.add(0, 1, 3);  // one triangle twice, one never
  EXPECT_TRUE(has(refusal_of(surface, 8), "(triangles with it: 3)")) << refusal_of(surface, 8);
}
TEST(TetrahedralFillRefusals, TrianglesWoundUnlikeTheirNeighbours) {
  TestMesh surface = ball_mesh(2);
  std::swap(surface.indices[0], surface.indices[1]);
  EXPECT_TRUE(has(refusal_of(surface, 8), "is run the same way by another triangle"));
}
TEST(TetrahedralFillRefusals, IndicesOutOfRange) {
  TestMesh surface = ball_mesh(1);
  surface.indices[4] = 1000;
  EXPECT_TRUE(has(refusal_of(surface, 8), "triangle 1 uses vertex 1000"));
  surface.indices.pop_back();
  EXPECT_TRUE(has(refusal_of(surface, 8), "allowed are 3 for each"));
  EXPECT_TRUE(has(refusal_of(TestMesh(), 8), "0 indices"));
}
TEST(TetrahedralFillRefusals, VerticesThatAreNotFinite) {
  TestMesh surface = ball_mesh(1);
  surface.vertices[7].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(has(refusal_of(surface, 8), "vertex 7 is"));
  surface.vertices[7].y = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(has(refusal_of(surface, 8), "vertex 7 is"));
}
TEST(TetrahedralFillRefusals, ATriangleWithoutArea) {
  TestMesh surface = ball_mesh(1);
  surface.add(0, 6, 6);
  const std::string message = refusal_of(surface, 8);
  EXPECT_TRUE(has(message, "triangle 32 (vertices 0, 6, 6) has no area")) << message;
}
TEST(TetrahedralFillRefusals, ASurfaceWithoutVolume) {
  TestMesh surface;
  surface.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  surface.add(0, 1, 2);
  surface.add(0, 2, 1);
  EXPECT_TRUE(has(refusal_of(surface, 8), "allowed are surfaces that enclose a volume"));
}
TEST(TetrahedralFillRefusals, ASurfaceThatCrossesItself) {
  TestMesh surface = box_mesh({}, kHalf);
  surface.add(box_mesh({0.4f, 0.3f, 0.2f}, kHalf));
  EXPECT_TRUE(has(refusal_of(surface, 8), "cross each other"));
  TestMesh part = box_mesh({3, 0, 0}, {0.2f, 0.2f, 0.2f});
  part.flip();
  surface = box_mesh({}, kHalf);
  surface.add(part);
  EXPECT_TRUE(has(refusal_of(surface, 8), "parts must not overlap, holes must be wound inwards"))
      << refusal_of(surface, 8);
}
TEST(TetrahedralFillRefusals, TooManyTetrahedra) {
  const std::string message = refusal_of(box_mesh({}, kHalf), 64);
  EXPECT_TRUE(has(message, "resolution: 64 needs more than 2000000 tetrahedra for this surface; use 5"))
      << message;
}
TEST(TetrahedralFillRefusals, CoordinatesThatRoundingSpoils) {
  const TestMesh surface = moved(ball_mesh(3), {{3.0e5f, 0, 0}, {}}, 1.0f);
  EXPECT_FALSE(fill_mesh(surface, 32));
}

}  // namespace
}  // namespace gyre::tetrahedral_fill_test
