// Surfaces of soft matter: smooth where they bend, as thick as they are, closed.
#include "render/soft_mesh.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gyre::soft_mesh_test {
namespace {

// A sheet of n by n cells of 0.1 m, bent about z to the given radius; flat if that is 0. Its upper side is outside.
struct Sheet {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> triangles;
};
Sheet make_sheet(int n, float bend_radius) {
  Sheet sheet;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const float along = 0.1f * float(i), across = 0.1f * float(j);
      const Vec3 flat{along, 0, across};
      const float angle = bend_radius > 0 ? along / bend_radius : 0;
      const Vec3 bent{bend_radius * std::sin(angle), bend_radius * std::cos(angle), across};
      sheet.vertices.push_back(bend_radius > 0 ? bent : flat);
    }
  }
  const auto row = std::uint32_t(n + 1);
  for (std::uint32_t j = 0; j + 1 < row; ++j) {
    for (std::uint32_t i = 0; i + 1 < row; ++i) {
      const std::uint32_t a = j * row + i, b = a + 1, c = a + row, d = c + 1;
      sheet.triangles.insert(sheet.triangles.end(), {a, c, b, b, c, d});
    }
  }
  return sheet;
}

double volume_of(std::initializer_list<const ShapeMesh*> meshes) {
  double sum = 0;
  for (const ShapeMesh* mesh : meshes) {
    for (std::size_t i = 0; i < mesh->indices.size(); i += 3) {
      const Vec3 a = mesh->vertices[mesh->indices[i]].position,
                 b = mesh->vertices[mesh->indices[i + 1]].position,
                 c = mesh->vertices[mesh->indices[i + 2]].position;
      sum += double(dot(a, cross(b, c))) / 6.0;
    }
  }
  return sum;
}

TEST(SoftMesh, AClothHasItsThicknessBetweenTwoSheetsAndARim) {
  const Sheet sheet = make_sheet(6, 0);
  const ClothMesh mesh = cloth_mesh(sheet.vertices, sheet.triangles, 0.01f);
  // Only a closed surface that is wound outward has this volume wherever it lies.
  EXPECT_NEAR(volume_of({&mesh.front, &mesh.back, &mesh.rim}), 0.6 * 0.6 * 0.02, 1e-7);
  EXPECT_EQ(mesh.rim.indices.size(), 6u * 4 * 6);
  for (const MeshVertex& vertex : mesh.front.vertices) EXPECT_EQ(vertex.normal, (Vec3{0, 1, 0}));
  for (const MeshVertex& vertex : mesh.back.vertices) EXPECT_EQ(vertex.normal, (Vec3{0, -1, 0}));
}

TEST(SoftMesh, ABentClothHasTheNormalsOfTheCylinder) {
  const float radius = 0.5f;
  const Sheet sheet = make_sheet(8, radius);
  const ClothMesh mesh = cloth_mesh(sheet.vertices, sheet.triangles, 0.002f);
  for (std::size_t i = 0; i < sheet.vertices.size(); ++i) {
    const Vec3 v = sheet.vertices[i];
    const Vec3 exact = normalized(Vec3{v.x, v.y, 0});
    // A vertex inside has triangles to both sides; one at the edge only to one, and is off by up to half a cell.
    const bool inside = i % 9 != 0 && i % 9 != 8;
    EXPECT_GT(dot(mesh.front.vertices[i].normal, exact), inside ? 0.999f : 0.99f) << i;
    EXPECT_EQ(mesh.back.vertices[i].normal, -mesh.front.vertices[i].normal);
  }
}

TEST(SoftMesh, AFoldedClothIsFinite) {
  // Two triangles on each other, and one that is a line.
  const Vec3 vertices[] = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 1}, {2, 0, 0}};
  const std::uint32_t triangles[] = {0, 2, 1, 0, 1, 3, 0, 1, 4};
  const ClothMesh mesh = cloth_mesh(vertices, triangles, 0.01f);
  for (const ShapeMesh* part : {&mesh.front, &mesh.back, &mesh.rim}) {
    for (const MeshVertex& vertex : part->vertices) {
      EXPECT_TRUE(is_finite(vertex.position));
      EXPECT_NEAR(length(vertex.normal), 1.0f, 1e-5f);
    }
  }
}

TEST(SoftMesh, ARopePassesThroughItsVerticesWithoutCorners) {
  const std::vector<Vec3> vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}};
  const std::vector<Vec3> line = smooth_line(vertices, 16);
  ASSERT_EQ(line.size(), 49u);
  for (std::size_t i = 0; i < vertices.size(); ++i) EXPECT_EQ(line[16 * i], vertices[i]);
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const float cosine = dot(normalized(line[i] - line[i - 1]), normalized(line[i + 1] - line[i]));
    EXPECT_GT(cosine, 0.95f) << i;  // of the vertices it is 0
  }
  // A straight one stays straight and evenly spaced.
  const std::vector<Vec3> straight = smooth_line(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, 4);
  for (std::size_t i = 0; i < straight.size(); ++i) EXPECT_NEAR(straight[i].x, 0.25f * float(i), 1e-6f);
  EXPECT_EQ(smooth_line({}, 4).size(), 0u);
}

TEST(SoftMesh, ATubeIsACapsule) {
  constexpr int kSides = 32;
  const std::vector<TubePoint> tube = capped_tube({{0, 0, 0}, {0, 1, 0}}, 0.25f, kSides);
  ASSERT_EQ(tube.size() % (kSides + 1), 0u);
  ShapeMesh mesh;
  for (const TubePoint& point : tube) {
    mesh.vertices.push_back({point.position, point.normal});
    const Vec3 nearest{0, clamp(point.position.y, 0.0f, 1.0f), 0};
    EXPECT_NEAR(distance(point.position, nearest), 0.25f, 1e-6f);
    EXPECT_NEAR(dot(point.normal, normalized(point.position - nearest)), 1.0f, 1e-5f);
  }
  for (std::uint32_t ring = 0; ring + 1 < tube.size() / (kSides + 1); ++ring) {
    for (std::uint32_t k = 0; k < kSides; ++k) {
      const std::uint32_t a = ring * (kSides + 1) + k, b = a + 1, c = b + kSides + 1, d = a + kSides + 1;
      mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
    }
  }
  const double exact = 3.14159265358979 * (0.25 * 0.25 + 4.0 / 3.0 * 0.25 * 0.25 * 0.25);
  EXPECT_NEAR(volume_of({&mesh}), exact, 0.05 * exact);
}

TEST(SoftMesh, ASolidKeepsItsSharpEdges) {
  const Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::uint32_t triangles[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  const ShapeMesh mesh = solid_mesh(corners, triangles);
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const MeshVertex &a = mesh.vertices[mesh.indices[i]], &b = mesh.vertices[mesh.indices[i + 1]],
                     &c = mesh.vertices[mesh.indices[i + 2]];
    const Vec3 normal = normalized(cross(b.position - a.position, c.position - a.position));
    for (const MeshVertex* corner : {&a, &b, &c}) EXPECT_GT(dot(corner->normal, normal), 0.9999f);
  }
}

}  // namespace
}  // namespace gyre::soft_mesh_test
