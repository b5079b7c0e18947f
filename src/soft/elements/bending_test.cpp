// Bending against exact answers: cylinders for any triangles, and the elastica of rods and strips.
#include "random.h"
#include "soft/elements/cloth.h"
#include "soft/elements/rope.h"
#include "soft/solver/rope_step.h"
#include "soft/solver/soft_pass.h"
#include "soft/solver/soft_test_kit.h"

#include <gtest/gtest.h>

namespace gyre::bending_test {
namespace {

using soft_test::Bench;

struct Mesh {
  Array<DVec3> places;
  Array<std::uint32_t> triangles;
};

// A sheet of 1 m x 1 m in rows of triangles: right ones, or nearly equilateral ones, or with its inner corners moved about.
Mesh make_mesh(int cells, bool shifted, double scatter) {
  Mesh mesh;
  testing_random::Mixed random{5};
  const double d = 1.0 / cells;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const bool inner = i > 0 && j > 0 && i < cells && j < cells;
      const double shift = shifted && j % 2 == 1 && i > 0 && i < cells ? 0.5 * d : 0.0;
      const double u = random.between(-scatter, scatter), v = random.between(-scatter, scatter);
      mesh.places.push_back({i * d + shift + (inner ? u * d : 0.0), 0.0, j * d + (inner ? v * d : 0.0)});
    }
  }
  const auto at = [&](int i, int j) { return std::uint32_t(i + j * (cells + 1)); };
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const bool other = shifted && j % 2 == 1;
      const std::uint32_t a[6] = {at(i, j), at(i + 1, j),     at(i + 1, j + 1),
                                  at(i, j), at(i + 1, j + 1), at(i, j + 1)};
      const std::uint32_t b[6] = {at(i, j),     at(i + 1, j),     at(i, j + 1),
                                  at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
      mesh.triangles.append(shifted && !other ? b : a);
    }
  }
  return mesh;
}

// The energy of the sheet bent to curvature 0.1 / m along an angle, over 1/2 B k^2 A.
double cylinder_energy(SoftBody sheet, double angle, double stiffness) {
  const double c = std::cos(angle), s = std::sin(angle), k = 0.1;
  sheet.continuum = {};
  for (float& spring : sheet.springs.stiffness) spring = 0.0f;
  for (int i = 0; i < sheet.particles.count; ++i) {
    const double along = c * sheet.particles.x[i] + s * sheet.particles.z[i];
    sheet.particles.y[i] = 0.5 * k * along * along;
  }
  return elastic_energy(sheet) / (0.5 * stiffness * k * k);
}

TEST(Bending, ACylinderHasItsEnergyWhateverTheTrianglesAndTheDirection) {
  constexpr int kCells = 20;
  ClothMaterial material;
  material.bend_stiffness = 2.0e-3f;
  const double border = 1.0 - 1.0 / kCells;  // what bends along the border is not seen by differences
  constexpr double kAngles[] = {0.0, 0.4, 0.785398, 1.570796, 2.3};
  const SoftBody grid = grid_cloth({1.0f, 1.0f}, {kCells, kCells}, Pose{}, material);
  for (const double angle : kAngles) EXPECT_NEAR(cylinder_energy(grid, angle, 2.0e-3), border, 0.03) << angle;
  for (const bool shifted : {false, true}) {
    for (const double scatter : {0.0, 0.2}) {
      const Mesh mesh = make_mesh(kCells, shifted, scatter);
      const SoftBody sheet = mesh_cloth(mesh.places, mesh.triangles, material);
      const double tolerance = scatter == 0.0 ? 0.08 : shifted ? 0.12 : 0.25;
      for (const double angle : kAngles) {
        // Right triangles moved about are up to a quarter too stiff: docs/decisions/soft-solver.md, Limits.
        EXPECT_NEAR(cylinder_energy(sheet, angle, 2.0e-3), border, tolerance)
            << angle << ' ' << shifted << ' ' << scatter;
      }
    }
  }
}

// Exact elastica of a clamped rod (design: H. W. Mattiasson, 1981, for the tip load): k = P L^2 / EI or w L^3 / EI, height and what is missing of
// the length, over L.
struct Elastica {
  double k, y, x;
};

SoftBody clamped_rod(int segments, double stiffness, double density) {
  const DVec3 points[2] = {{-1.0 / segments, 0, 0}, {1, 0, 0}};
  RopeMaterial material;
  material.bend_stiffness = float(stiffness);
  material.linear_density = float(density);
  SoftBody rod = rope_along(points, segments + 1, material);
  hold(rod, 0, rod.particles.place(0));
  hold(rod, 1, rod.particles.place(1));
  return rod;
}

class TipLoad : public testing::TestWithParam<Elastica> {};

TEST_P(TipLoad, BendsARodToTheElastica) {
  const Elastica& wanted = GetParam();
  SoftBody rod = clamped_rod(50, 1.0, 0.1);
  const int tip = rod.particles.count - 1;
  rod.particles.fy[tip] = float(-wanted.k);
  Arena arena;
  for (int step = 0; step < 120; ++step) step_rope(rod, {0.05f, {}, 10}, arena);
  EXPECT_NEAR(-rod.particles.y[tip], wanted.y, 0.01 * wanted.y);
  EXPECT_NEAR(1.0 - rod.particles.x[tip], wanted.x, 0.01 * wanted.x + 1.0e-4);
}
INSTANTIATE_TEST_SUITE_P(Bending, TipLoad,
                         testing::Values(Elastica{0.2, 0.06636, 0.00265}, Elastica{1, 0.30172, 0.05643},
                                         Elastica{3, 0.60325, 0.25442}, Elastica{10, 0.81061, 0.55500}));

class OwnWeight : public testing::TestWithParam<Elastica> {};

TEST_P(OwnWeight, BendsARodToTheElastica) {
  const Elastica& wanted = GetParam();
  SoftBody rod = clamped_rod(50, 1.0, wanted.k / 9.81);
  const int tip = rod.particles.count - 1;
  Arena arena;
  for (int step = 0; step < 120; ++step) step_rope(rod, {0.2f, {0, -9.81f, 0}, 10}, arena);
  EXPECT_NEAR(-rod.particles.y[tip], wanted.y, 0.01 * wanted.y);
  EXPECT_NEAR(1.0 - rod.particles.x[tip], wanted.x, 0.01 * wanted.x + 1.0e-4);
}

INSTANTIATE_TEST_SUITE_P(Bending, OwnWeight,
                         testing::Values(Elastica{1, 0.12347, 0.00875}, Elastica{5, 0.49591, 0.15334},
                                         Elastica{10, 0.70020, 0.34365}, Elastica{50, 0.90792, 0.75499}));

class OwnWeightOfAStrip : public testing::TestWithParam<Elastica> {};

TEST_P(OwnWeightOfAStrip, BendsItToTheElastica) {
  const Elastica& wanted = GetParam();
  constexpr int kCells = 30;
  // Bending is seen from the middle of the clamped cells on.
  const double cell = 1.0 / (kCells - 0.5);
  ClothMaterial material;
  material.area_density = 0.1f;
  material.bend_stiffness = float(0.1 * 9.81 / wanted.k);
  material.stretch_stiffness = 2.0e3f;
  material.shear_stiffness = 1.0e3f;
  SoftBody strip = grid_cloth({float(kCells * cell), float(2 * cell)}, {kCells, 2}, Pose{}, material);
  const int columns = kCells + 1;
  const double clamp = 0.5 * (strip.particles.x[0] + strip.particles.x[1]);
  for (int j = 0; j < 3; ++j) {
    for (const int i : {0, 1}) hold(strip, i + columns * j, strip.particles.place(i + columns * j));
  }
  Bench bench;
  bench.settle(strip, {0, -9.81f, 0}, 0.1f, 80);
  const int tip = kCells + columns;
  EXPECT_NEAR(-strip.particles.y[tip], wanted.y, 0.01 * wanted.y);
  EXPECT_NEAR(1.0 - (strip.particles.x[tip] - clamp), wanted.x, 0.01 * wanted.x);
}
INSTANTIATE_TEST_SUITE_P(Bending, OwnWeightOfAStrip,
                         testing::Values(Elastica{1, 0.12347, 0.00875}, Elastica{5, 0.49591, 0.15334},
                                         Elastica{10, 0.70020, 0.34365}));

TEST(MembraneForces, AreTheGradientOfTheEnergy) {
  const Mesh mesh = make_mesh(4, true, 0.2);
  ClothMaterial material;
  material.links = ClothLinks::membrane;
  material.shear_stiffness = 400.0f;
  SoftBody sheet = mesh_cloth(mesh.places, mesh.triangles, material);
  testing_random::Mixed random{3};
  for (int i = 0; i < sheet.particles.count; ++i) {
    sheet.particles.set_place(
        i, sheet.particles.place(i) +
               DVec3{random.between(-0.03, 0.03), random.between(-0.03, 0.03), random.between(-0.03, 0.03)});
  }
  Bench bench;
  const SoftPass pass = begin_pass(sheet, bench.arena);
  find_forces(pass, sheet, bench.kernels, bench.tasks);
  for (const int i : {0, 7, 12}) {
    const DVec3 place = sheet.particles.place(i);
    const double wanted[3] = {double(pass.force.x[i]), double(pass.force.y[i]), double(pass.force.z[i])};
    for (int axis = 0; axis < 3; ++axis) {
      double energy[2];
      for (int side = 0; side < 2; ++side) {
        const double off = side == 0 ? -1.0e-6 : 1.0e-6;
        sheet.particles.set_place(
            i, place + DVec3{axis == 0 ? off : 0, axis == 1 ? off : 0, axis == 2 ? off : 0});
        energy[side] = elastic_energy(sheet);
      }
      EXPECT_NEAR((energy[0] - energy[1]) / 2.0e-6, wanted[axis], 2.0e-3) << i << ' ' << axis;
    }
    sheet.particles.set_place(i, place);
  }
}

// The strain e of a St Venant-Kirchhoff strip, free across, under this force per width over its stiffness: (1 + e) (e + e^2 / 2) = load.
double strip_strain(double load) {
  double e = load;
  for (int i = 0; i < 20; ++i) e = load / ((1.0 + e) * (1.0 + 0.5 * e));
  return e;
}

TEST(MembraneStatics, AStripStretchesAsItsModulusSays) {
  const Mesh mesh = make_mesh(8, true, 0.2);
  ClothMaterial material;
  material.links = ClothLinks::membrane;
  material.stretch_stiffness = 500.0f;
  material.shear_stiffness = 250.0f;  // no lateral contraction, which the held edge would hinder
  material.area_density = 2.0f;
  material.bend_stiffness = 0.0f;
  SoftBody sheet = mesh_cloth(mesh.places, mesh.triangles, material);
  for (int i = 0; i <= 8; ++i) hold(sheet, i, sheet.particles.place(i));
  Bench bench;
  bench.settle(sheet, {0, 0, 9.81f}, 0.5f, 40);
  double mean = 0.0;
  for (int i = 0; i <= 8; ++i) mean += (sheet.particles.z[72 + i] - 1.0) / 9.0;
  double wanted = 0.0;  // the mean over the height: each part bears what hangs below
  for (int i = 0; i < 100; ++i) wanted += 0.01 * strip_strain((i + 0.5) / 100.0 * 2.0 * 9.81 / 500.0);
  EXPECT_NEAR(mean, wanted, 0.002 * wanted);
}

}  // namespace
}  // namespace gyre::bending_test
