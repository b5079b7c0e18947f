// Decomposition: the invariants of every result against slow and plain measures, on meshes by formula and on bad
// meshes.
#include "geometry/decomposition/decomposition_test_meshes.h"
#include "geometry/distance/closest.h"
#include "geometry/shape/cooked.h"
#include "geometry/shape/mesh.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace gyre::decomposition_test {
namespace {

struct Random {
  std::mt19937 engine{7};
  float operator()(float low = -1.0f, float high = 1.0f) {
    return low + (high - low) * (float(engine() >> 8) / 16777216.0f);
  }
  std::uint32_t index(std::uint32_t count) { return std::uint32_t(engine()) % count; }
  Vec3 vector() {
    const float x = (*this)(), y = (*this)(), z = (*this)();
    return {x, y, z};
  }
  Quat turn() {
    for (;;) {
      const Quat q{(*this)(), (*this)(), (*this)(), (*this)()};
      if (dot(q, q) > 0.01f && dot(q, q) < 1.0f) return normalized(q);
    }
  }
};

Decomposition made(const DecompositionDef& def) {
  Result<Decomposition> result = decompose(def);
  EXPECT_TRUE(result) << result.error().message;
  return result ? *std::move(result) : Decomposition{};
}

// The height of the point above the planes of the hull; negative inside.
double above(const Geometry& hull, Vec3 p) {
  const HullView view = view_hull(hull);
  double most = -1.0e300;
  for (std::size_t f = 0; f + 1 < view.face_offsets.size(); ++f) {
    const std::size_t begin = view.face_offsets[f], count = view.face_offsets[f + 1] - begin;
    const DVec3 first(view.vertices[view.face_indices[begin]]);
    DVec3 normal;
    for (std::size_t i = 1; i + 1 < count; ++i) {
      normal += cross(DVec3(view.vertices[view.face_indices[begin + i]]) - first,
                      DVec3(view.vertices[view.face_indices[begin + i + 1]]) - first);
    }
    most = std::max(most, dot(normal, DVec3(p) - first) / length(normal));
  }
  return most;
}
bool in_any(const Decomposition& d, Vec3 p) {
  for (const Geometry& hull : d.hulls) {
    if (above(hull, p) < 0.0) return true;
  }
  return false;
}

// Signed distance by loops over all triangles: closest point, and the sum of solid angles.
double outside(const TestMesh& mesh, Vec3 at) {
  const DVec3 p(at);
  double nearest = 1.0e300, angles = 0.0;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const DVec3 a = DVec3(mesh.vertices[mesh.indices[i]]), b = DVec3(mesh.vertices[mesh.indices[i + 1]]),
                c = DVec3(mesh.vertices[mesh.indices[i + 2]]);
    nearest = std::min(nearest, length(closest_on_triangle(p, a, b, c).point - p));
    const DVec3 u = a - p, v = b - p, w = c - p;
    const double lu = length(u), lv = length(v), lw = length(w);
    angles += 2.0 * std::atan2(dot(u, cross(v, w)),
                               lu * lv * lw + dot(u, v) * lw + dot(v, w) * lu + dot(w, u) * lv);
  }
  return angles > 2.0 * kPiDouble ? -nearest : nearest;
}

// The report is true, and its values are within the settings.
void expect_honest(const TestMesh& mesh, const DecompositionDef& def, const Decomposition& d) {
  const DecompositionStats& report = d.stats;
  ASSERT_FALSE(d.hulls.empty());
  EXPECT_LE(d.hulls.size(), std::size_t(def.max_hulls));
  EXPECT_TRUE(report.within_concavity);
  const double tolerance = double(def.concavity) * double(report.size);
  EXPECT_LE(double(report.overhang), 1.06 * tolerance);
  EXPECT_LE(double(report.depth), 1.06 * tolerance);
  EXPECT_LE(report.overhang, report.overhang_bound);
  // Points inside hulls: none is farther from the solid than the bound.
  Random random;
  for (const Geometry& hull : d.hulls) {
    const HullView view = view_hull(hull);
    EXPECT_LE(view.vertices.size(), std::size_t(def.max_hull_vertices));
    for (int i = 0; i < 40; ++i) {
      Vec3 p;
      float sum = 0.0f;
      for (const Vec3& v : view.vertices) {
        const float weight = random(0.0f, 1.0f) > 0.8f ? random(0.0f, 1.0f) : 0.0f;
        p = p + weight * v;
        sum += weight;
      }
      if (!(sum > 0.0f)) continue;
      EXPECT_LE(outside(mesh, (1.0f / sum) * p),
                double(report.overhang_bound) + 1.0e-5 * double(report.size));
    }
  }
  // Every triangle is covered at its centre, up to the distance between samples.
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const Vec3 middle = (1.0f / 3.0f) * (mesh.vertices[mesh.indices[i]] + mesh.vertices[mesh.indices[i + 1]] +
                                         mesh.vertices[mesh.indices[i + 2]]);
    double least = 1.0e300;
    for (const Geometry& hull : d.hulls) least = std::min(least, above(hull, middle));
    EXPECT_LE(least, double(report.uncovered) + double(report.sample_spacing)) << i / 3;
  }
  // Volumes: lines against integrals (if no surfaces cross). The excess lies in a layer over the surface. A layer of
  // thickness h over a surface of area A has about A h, and more by its curvature: at most half more for these.
  EXPECT_NEAR(report.hull_volume - report.excess_volume, report.solid_volume - report.missing_volume,
              1.0e-9 * report.hull_volume);
  EXPECT_LE(report.excess_volume, 1.5 * mesh.area() * double(report.overhang_bound));
  EXPECT_LE(report.missing_volume, mesh.area() * (double(report.uncovered) + double(report.sample_spacing)));
}

TEST(Decomposition, ConvexMeshesAreOneHull) {
  const TestMesh round = revolved({{0, -1}, {0.7f, -0.7f}, {1, 0}, {0.7f, 0.7f}, {0, 1}}, 16);
  for (const TestMesh& mesh : {box_mesh({1, 2, 3}, {0.5f, 1, 2}), round,
                               prism_mesh({{0, 0}, {1, 0}, {0, 1}}, {0.3f, 0.3f}, 0.01f)}) {
    const Decomposition d = made(mesh.def());
    ASSERT_EQ(d.hulls.size(), 1u);
    EXPECT_LT(d.stats.overhang, 1.0e-6f * d.stats.size);
    EXPECT_LT(d.stats.depth, 1.0e-5f * d.stats.size);
    EXPECT_NEAR(double(mass_properties(d.hulls[0], 1.0f)->mass), mesh.volume(), 1.0e-3 * mesh.volume());
    // Lines resolve a round body in steps: 100 of them across.
    EXPECT_NEAR(d.stats.solid_volume, mesh.volume(), 0.01 * mesh.volume());
    expect_honest(mesh, mesh.def(), d);
  }
}

TEST(Decomposition, ClosedPlatesAndGratesOfAnyCellsAreSolidsOfTheirVolume) {
  Random random;
  for (int trial = 0; trial < 8; ++trial) {
    const bool grate = trial % 2 == 1;
    const int cells = 2 * (3 + int(random.index(4))) + 1;
    std::vector<float> lines{0.0f};
    const float bar = random(0.1f, 0.9f);
    for (int i = 0; i < cells; ++i) lines.push_back(lines.back() + (grate && i % 2 == 1 ? 1.0f : bar));
    const float thickness = std::exp(random(-5.0f, 0.0f)) * (grate ? 0.3f : 1.0f);
    const TestMesh mesh =
        moved(cell_plate(lines, thickness, [&](int i, int j) { return grate && i % 2 == 1 && j % 2 == 1; }),
              {random.vector(), random.turn()});
    DecompositionDef def = mesh.def();
    def.max_hulls = grate ? 4 : 32;
    def.concavity = grate ? 0.3f : 0.02f;
    const Decomposition d = made(def);
    EXPECT_FALSE(d.stats.mesh.shell) << trial << ": " << cells << " cells, " << thickness << " m thick";
    EXPECT_EQ(d.stats.mesh.openness, 0.0f);
    EXPECT_NEAR(d.stats.solid_volume, mesh.volume(), 1.0e-5 * mesh.volume());
    if (!grate) {
      ASSERT_EQ(d.hulls.size(), 1u);
      EXPECT_NEAR(double(mass_properties(d.hulls[0], 1.0f)->mass), mesh.volume(), 2.0e-3 * mesh.volume());
    }
  }
}

TEST(Decomposition, PlatesKeepAllTheirCornersDownToAThousandth) {
  Random random;
  for (int trial = 0; trial < 6; ++trial) {
    const float thickness = trial == 0 ? 0.0005f : 0.0005f * std::exp(random(0.0f, 4.0f));
    const TestMesh mesh =
        moved(box_mesh({}, {0.5f, thickness, random(0.3f, 0.5f)}), {random.vector(), random.turn()});
    DecompositionDef def = mesh.def();
    def.concavity = trial % 2 == 0 ? 0.02f : 0.1f;
    const Decomposition d = made(def);
    ASSERT_EQ(d.hulls.size(), 1u);
    EXPECT_EQ(view_hull(d.hulls[0]).vertices.size(), 8u) << thickness;
    EXPECT_NEAR(double(mass_properties(d.hulls[0], 1.0f)->mass), mesh.volume(), 2.0e-3 * mesh.volume());
  }
}

TEST(Decomposition, CornersInLineDoNotOpenAClosedMesh) {
  // One face of a box is a fan from a corner over a side with corners in line: flat triangles that close the mesh.
  Random random;
  for (int trial = 0; trial < 20; ++trial) {
    TestMesh mesh = box_mesh({}, {1, 1, 1});
    mesh.indices.erase(mesh.indices.begin() + 6, mesh.indices.begin() + 9);  // 4 5 7 of the face at z = 1
    const int count = 1 + int(random.index(6));
    std::uint32_t before = 5;
    for (int i = 1; i <= count; ++i) {
      const float x = 1.0f - 2.0f * (float(i) - random(0.0f, 0.5f)) / float(count + 1);
      // Onto the side from 5 to 4, with the flat triangles against the face at y = -1.
      mesh.vertices.push_back({x, -1, 1});
      const std::uint32_t here = std::uint32_t(mesh.vertices.size() - 1);
      mesh.add(here, before, 7);
      mesh.add(5, before, here);
      before = here;
    }
    mesh.add(4, before, 7);
    mesh.add(5, before, 4);
    const TestMesh turned = moved(mesh, trial % 2 == 0 ? Transform{} : Transform{{}, random.turn()});
    const Decomposition d = made(turned.def());
    EXPECT_EQ(d.stats.mesh.open_edges, 0u) << count;
    EXPECT_FALSE(d.stats.mesh.shell);
    ASSERT_EQ(d.hulls.size(), 1u);
    EXPECT_NEAR(d.stats.solid_volume, 8.0, 1.0e-4);
    // A cooked mesh has a neighbour across each edge.
    const Result<Geometry> cooked = cook_mesh({.vertices = turned.vertices, .indices = turned.indices});
    ASSERT_TRUE(cooked);
    for (const std::uint32_t twin : cooked->data()->mesh->twins) EXPECT_NE(twin, Mesh::kNoTwin);
  }
}

TEST(Decomposition, SeparateBoxesAreTheirOwnHulls) {
  TestMesh mesh = box_mesh({-1, 0, 0}, {0.5f, 0.5f, 0.5f});
  mesh.add(box_mesh({1, 0.2f, 0}, {0.3f, 0.3f, 0.3f}));
  const Decomposition d = made(mesh.def());
  ASSERT_EQ(d.hulls.size(), 2u);
  EXPECT_NEAR(double(mass_properties(d.hulls[0], 1.0f)->mass), 1.0, 1.0e-5);
  EXPECT_NEAR(double(mass_properties(d.hulls[1], 1.0f)->mass), 0.216, 1.0e-5);
}

TEST(Decomposition, BoxesThatTouchFaceToFaceAreOneHull) {
  TestMesh mesh = box_mesh({-0.5f, 0, 0}, {0.5f, 0.5f, 0.5f});
  mesh.add(box_mesh({0.5f, 0, 0}, {0.5f, 0.5f, 0.5f}));
  EXPECT_EQ(made(mesh.def()).hulls.size(), 1u);
}

TEST(Decomposition, CrossingBoxesAreTwoHulls) {
  TestMesh mesh = box_mesh({0, 0, 0}, {1, 0.2f, 0.2f});
  mesh.add(box_mesh({0, 0, 0}, {0.2f, 1, 0.2f}));
  const Decomposition d = made(mesh.def());
  EXPECT_EQ(d.hulls.size(), 2u);
  EXPECT_LT(d.stats.excess_volume, 1.0e-3);
  expect_honest(mesh, mesh.def(), d);
}

// A beam with an L as its section is cut along its notch in any orientation: two hulls without excess.
TEST(Decomposition, AnLIsCutAlongItsNotchHoweverItIsTurned) {
  Random random;
  for (int i = 0; i < 4; ++i) {
    const Transform t{random.vector(), i == 0 ? Quat{} : random.turn()};
    const TestMesh mesh = moved(beam_mesh(), t);
    const Decomposition d = made(mesh.def());
    EXPECT_EQ(d.hulls.size(), 2u) << i;
    double sum = 0.0;
    for (const Geometry& hull : d.hulls) sum += double(mass_properties(hull, 1.0f)->mass);
    EXPECT_NEAR(sum, mesh.volume(), 1.0e-4 * mesh.volume()) << i;
  }
}

TEST(Decomposition, ARingKeepsItsHole) {
  const TestMesh mesh = torus_mesh(0.7f, 0.3f);
  const DecompositionDef def = mesh.def();
  const Decomposition d = made(def);
  expect_honest(mesh, def, d);
  // One hull would fill the hole of radius 0.4. The rest is free up to the overhang.
  const float free = 0.4f - d.stats.overhang_bound;
  ASSERT_GT(free, 0.25f);
  Random random;
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = random.vector();
    if (p.x * p.x + p.z * p.z > 1.0f) continue;
    EXPECT_FALSE(in_any(d, {0.99f * free * p.x, p.y, 0.99f * free * p.z}));
  }
}

TEST(LongDecomposition, WhatItSaysIsTrueOfAllShapes) {
  for (const TestMesh& mesh : {beam_mesh(), gear_mesh(8), beaker_mesh(), mug_mesh()}) {
    const DecompositionDef def = mesh.def();
    expect_honest(mesh, def, made(def));
  }
}

TEST(Decomposition, ABeakerCanBeFilled) {
  const TestMesh mesh = mug_mesh();
  const Decomposition d = made(mesh.def());
  // Between wall and handle, and inside, is room.
  EXPECT_FALSE(in_any(d, {0, 0, 0}));
  EXPECT_FALSE(in_any(d, {0, 0.49f, 0}));
  EXPECT_FALSE(in_any(d, {0.54f, 0, 0}));
  EXPECT_TRUE(in_any(d, {0, -0.46f, 0}));
  EXPECT_TRUE(in_any(d, {0.69f, 0.013f, 0.004f}));
}

TEST(Decomposition, ACavityStaysHollow) {
  TestMesh mesh = box_mesh({0, 0, 0}, {1, 1, 1}), hole = box_mesh({0, 0, 0}, {0.5f, 0.5f, 0.5f});
  hole.flip();
  mesh.add(hole);
  const Decomposition d = made(mesh.def());
  EXPECT_EQ(d.stats.mesh.flipped_triangles, 0u);
  EXPECT_EQ(d.hulls.size(), 6u);
  EXPECT_FALSE(in_any(d, {0.4f, -0.4f, 0.4f}));
  EXPECT_NEAR(d.stats.hull_volume, 7.0, 0.02);
}

// ------------------------------------------------------------------------------------------------- sizes and attitudes

TEST(LongDecomposition, SizeDoesNotMatter) {
  for (const TestMesh& mesh : {torus_mesh(0.7f, 0.3f), gear_mesh(6)}) {
    const std::size_t count = made(mesh.def()).hulls.size();
    for (const float scale : {1.0e-3f, 0.37f, 1.0e3f, 1.0e6f}) {
      const TestMesh other = moved(mesh, {}, scale);
      const Decomposition d = made(other.def());
      EXPECT_EQ(d.hulls.size(), count) << scale;
      expect_honest(other, other.def(), d);
    }
  }
}

TEST(LongDecomposition, TurnedMeshesAreCutAsWell) {
  Random random;
  const TestMesh mesh = torus_mesh(0.7f, 0.3f);
  const std::size_t count = made(mesh.def()).hulls.size();
  for (int i = 0; i < 4; ++i) {
    const TestMesh turned = moved(mesh, {random.vector(), random.turn()});
    const Decomposition d = made(turned.def());
    EXPECT_TRUE(d.stats.within_concavity);
    // Planes fall elsewhere, so a few hulls more or less.
    EXPECT_LE(d.hulls.size(), count + count / 2) << i;
    EXPECT_GE(d.hulls.size(), count - count / 2) << i;
  }
}

// --------------------------------------------------------------------------------------------------------- determinism

bool same(const Decomposition& a, const Decomposition& b) {
  if (a.hulls.size() != b.hulls.size()) return false;
  for (std::size_t i = 0; i < a.hulls.size(); ++i) {
    if (a.hulls[i].content_hash() != b.hulls[i].content_hash()) return false;
  }
  const DecompositionStats &x = a.stats, &y = b.stats;
  return x.overhang == y.overhang && x.overhang_bound == y.overhang_bound && x.depth == y.depth &&
         x.uncovered == y.uncovered && x.solid_volume == y.solid_volume && x.hull_volume == y.hull_volume &&
         x.excess_volume == y.excess_volume && x.missing_volume == y.missing_volume;
}

TEST(Decomposition, NeitherThreadsNorRunsShow) {
  const TestMesh mesh = moved(mug_mesh(), {{0.1f, 0.2f, 0.3f}, normalized(Quat{0.1f, 0.5f, -0.3f, 0.8f})});
  DecompositionDef def = mesh.def();
  const Decomposition once = made(def);
  for (const int threads : {1, 2, 3, 7}) {
    def.threads = threads;
    EXPECT_TRUE(same(once, made(def))) << threads;
  }
}

// ---------------------------------------------------------------------------------------------------------- bad meshes

TEST(Decomposition, AnOpenBowlIsTakenForASheetAndSaysSo) {
  const TestMesh mesh = bowl_sheet();
  DecompositionDef def = mesh.def();
  const Decomposition d = made(def);
  EXPECT_TRUE(d.stats.mesh.shell);
  EXPECT_EQ(d.stats.mesh.open_edges, 24u);
  EXPECT_GT(d.stats.mesh.openness, 0.5f);
  EXPECT_FLOAT_EQ(d.stats.shell_thickness, 0.5f * def.concavity * d.stats.size);
  // A ball can lie in it: everything is free but the sheet and the allowed overhang.
  const float free = 1.0f - 0.5f * d.stats.shell_thickness - d.stats.overhang_bound;
  Random random;
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = random.vector();
    if (!(length_squared(p) < 1.0f)) continue;
    // The facets of the sheet lie a little inside of the sphere.
    EXPECT_FALSE(in_any(d, 0.99f * std::cos(0.165f) * free * p));
  }
  EXPECT_TRUE(in_any(d, {0, -1, 0}));

  def.meaning = SurfaceMeaning::solid;
  const Decomposition filled = made(def);
  EXPECT_EQ(filled.hulls.size(), 1u);
  EXPECT_FALSE(filled.stats.mesh.shell);
  EXPECT_GT(filled.stats.mesh.openness, 0.5f);
  EXPECT_TRUE(in_any(filled, {0, -0.3f, 0}));
}

TEST(Decomposition, ASheetOfTwoSidesIsASheet) {
  TestMesh mesh = bowl_sheet(), inner = mesh;
  inner.flip();
  mesh.add(inner);
  const Decomposition d = made(mesh.def());
  EXPECT_TRUE(d.stats.mesh.shell);
  EXPECT_FALSE(in_any(d, {0, -0.3f, 0}));
}

TEST(Decomposition, AThicknessCanBeAskedFor) {
  TestMesh mesh;
  mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {2, 0, 1}, {0, 0, 1}};
  mesh.add(0, 1, 2);
  mesh.add(0, 2, 3);
  DecompositionDef def = mesh.def();
  def.shell_thickness = 0.1f;
  const Decomposition d = made(def);
  ASSERT_EQ(d.hulls.size(), 1u);
  EXPECT_NEAR(double(mass_properties(d.hulls[0], 1.0f)->mass), 0.2, 1.0e-4);
}

TEST(Decomposition, ASmallHoleIsClosedAndCounted) {
  TestMesh mesh = revolved({{0, -1}, {0.7f, -0.7f}, {1, 0}, {0.7f, 0.7f}, {0, 1}}, 32);
  mesh.indices.resize(mesh.indices.size() - 3);
  const Decomposition d = made(mesh.def());
  EXPECT_FALSE(d.stats.mesh.shell);
  EXPECT_EQ(d.stats.mesh.open_edges, 3u);
  EXPECT_GT(d.stats.mesh.openness, 0.0f);
  EXPECT_EQ(d.hulls.size(), 1u);
}

TEST(Decomposition, TrianglesWoundWronglyAreTurnedAndCounted) {
  TestMesh inside_out = beam_mesh();
  inside_out.flip();
  const Decomposition a = made(inside_out.def());
  EXPECT_EQ(a.hulls.size(), 2u);
  EXPECT_EQ(a.stats.mesh.flipped_triangles, inside_out.indices.size() / 3);
  TestMesh mixed = beam_mesh();
  for (std::size_t i = 0; i < mixed.indices.size(); i += 15)
    std::swap(mixed.indices[i], mixed.indices[i + 1]);
  const Decomposition b = made(mixed.def());
  EXPECT_EQ(b.hulls.size(), 2u);
  EXPECT_EQ(b.stats.mesh.flipped_triangles, (mixed.indices.size() + 14) / 15);
  EXPECT_FALSE(b.stats.mesh.shell);
}

TEST(Decomposition, EdgesOfManyTrianglesAreCounted) {
  // Two boxes that share an edge, by its vertices.
  TestMesh mesh = box_mesh({-0.5f, -0.5f, 0}, {0.5f, 0.5f, 0.5f});
  mesh.add(box_mesh({0.5f, 0.5f, 0}, {0.5f, 0.5f, 0.5f}));
  const Decomposition d = made(mesh.def());
  EXPECT_EQ(d.stats.mesh.non_manifold_edges, 1u);
  EXPECT_EQ(d.hulls.size(), 2u);
  EXPECT_LT(d.stats.excess_volume, 1.0e-3);
}

// Rounds of soups that grow by `more` triangles each.
void try_soups(int more) {
  Random random;
  for (int round = 0; round < 6; ++round) {
    TestMesh mesh;
    for (int i = 0; i < 60; ++i) mesh.vertices.push_back(random.vector());
    for (int i = 0; i < 10 + more * round; ++i)
      mesh.add(random.index(60), random.index(60), random.index(60));
    DecompositionDef def = mesh.def();
    def.concavity = 0.1f;
    def.max_hulls = 8;
    def.meaning = SurfaceMeaning(round % 3);
    const Result<Decomposition> d = decompose(def);
    if (!d) continue;
    EXPECT_GE(d->hulls.size(), 1u);
    EXPECT_LE(d->hulls.size(), 8u);
    EXPECT_TRUE(is_finite(d->stats.overhang) && is_finite(d->stats.excess_volume));
  }
}
TEST(Decomposition, SoupsOfTrianglesNeverBreakIt) { try_soups(4); }
TEST(LongDecomposition, DenseSoupsOfTrianglesNeverBreakIt) { try_soups(20); }

// ------------------------------------------------------------------------------------------------------------- limits

TEST(LongDecomposition, FewerHullsThanNeededAreReported) {
  const TestMesh mesh = torus_mesh(0.7f, 0.3f);
  DecompositionDef def = mesh.def();
  def.concavity = 0.02f;
  for (const int most : {1, 3, 6}) {
    def.max_hulls = most;
    const Decomposition d = made(def);
    EXPECT_EQ(d.hulls.size(), std::size_t(most));
    EXPECT_FALSE(d.stats.within_concavity);
    EXPECT_GT(d.stats.overhang, 1.05f * def.concavity * d.stats.size);
  }
}

TEST(Decomposition, VerticesAreLimited) {
  const TestMesh mesh =
      revolved({{0, -1}, {0.5f, -0.87f}, {0.87f, -0.5f}, {1, 0}, {0.87f, 0.5f}, {0.5f, 0.87f}, {0, 1}}, 32);
  DecompositionDef def = mesh.def();
  def.max_hull_vertices = 12;
  const Decomposition d = made(def);
  ASSERT_EQ(d.hulls.size(), 1u);
  EXPECT_LE(view_hull(d.hulls[0]).vertices.size(), 12u);
  // The report says what they lose.
  EXPECT_GT(d.stats.uncovered, 0.05f);
  EXPECT_GT(d.stats.missing_volume, 0.2);
}

struct Watch {
  float last = -1.0f;
  int calls = 0, stop_at = 1 << 30;
  bool falling = false;
};
bool watch(void* user, float done) {
  auto& w = *static_cast<Watch*>(user);
  w.falling = w.falling || done < w.last || done > 1.0f;
  w.last = done;
  return ++w.calls < w.stop_at;
}

TEST(Decomposition, ProgressRisesAndCanStopIt) {
  const TestMesh mesh = torus_mesh(0.7f, 0.3f);
  DecompositionDef def = mesh.def();
  Watch all;
  def.progress = watch;
  def.user = &all;
  EXPECT_TRUE(decompose(def));
  EXPECT_FALSE(all.falling);
  EXPECT_EQ(all.last, 1.0f);
  ASSERT_GT(all.calls, 10);
  for (const int stop_at : {1, 3, all.calls / 2, all.calls}) {
    Watch some;
    some.stop_at = stop_at;
    def.user = &some;
    const Result<Decomposition> d = decompose(def);
    ASSERT_FALSE(d);
    EXPECT_EQ(d.error().code, ErrorCode::cancelled);
    EXPECT_EQ(some.calls, stop_at);
  }
}

TEST(Decomposition, BadInputIsRefusedWithItsReason) {
  const TestMesh box = box_mesh({0, 0, 0}, {1, 1, 1});
  const auto refusal = [&](const TestMesh& mesh, auto&& change) {
    DecompositionDef def = mesh.def();
    change(def);
    const Result<Decomposition> d = decompose(def);
    return d ? std::string() : std::string(d.error().message);
  };
  const auto nothing = [](DecompositionDef&) {};
  const auto says = [](const std::string& message, const char* word) {
    return message.find(word) != std::string::npos;
  };
  EXPECT_TRUE(says(refusal(box, [](DecompositionDef& d) { d.concavity = 0.0f; }), "concavity is 0"));
  EXPECT_TRUE(says(refusal(box, [](DecompositionDef& d) { d.concavity = std::nanf(""); }), "concavity is"));
  EXPECT_TRUE(says(refusal(box, [](DecompositionDef& d) { d.max_hulls = 0; }), "max_hulls is 0"));
  EXPECT_TRUE(
      says(refusal(box, [](DecompositionDef& d) { d.max_hull_vertices = 256; }), "max_hull_vertices is 256"));
  EXPECT_TRUE(says(refusal(box, [](DecompositionDef& d) { d.threads = -1; }), "threads is -1"));
  EXPECT_TRUE(
      says(refusal(box, [](DecompositionDef& d) { d.shell_thickness = -1; }), "shell_thickness is -1"));
  EXPECT_TRUE(says(refusal(box, [](DecompositionDef& d) { d.meaning = SurfaceMeaning(9); }), "meaning is 9"));
  TestMesh mesh = box;
  mesh.indices[4] = 8;
  EXPECT_TRUE(says(refusal(mesh, nothing), "8"));
  mesh = box;
  mesh.indices.pop_back();
  EXPECT_FALSE(refusal(mesh, nothing).empty());
  mesh = box;
  mesh.vertices[3].y = std::nanf("");
  EXPECT_TRUE(says(refusal(mesh, nothing), "vertex 3"));
  mesh = box;
  mesh.vertices[3].y = 2.0e9f;
  EXPECT_TRUE(says(refusal(mesh, nothing), "vertex 3"));
  mesh = box;
  for (Vec3& v : mesh.vertices) v = {1, 1, v.z};
  EXPECT_TRUE(says(refusal(mesh, nothing), "has an area"));
  EXPECT_TRUE(says(refusal(moved(box, {}, 1.0e-8f), nothing), "allowed are"));
  EXPECT_FALSE(refusal(TestMesh{}, nothing).empty());
  // A flat sheet is a sheet unless it must be a solid.
  mesh = {};
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.add(0, 1, 2);
  EXPECT_TRUE(refusal(mesh, nothing).empty());
  EXPECT_TRUE(says(refusal(mesh, [](DecompositionDef& d) { d.meaning = SurfaceMeaning::solid; }), "flat"));
}

}  // namespace
}  // namespace gyre::decomposition_test
