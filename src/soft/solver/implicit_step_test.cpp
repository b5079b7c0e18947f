// Cloths against exact answers, and what must not change a bit.
#include "soft/solver/implicit_step.h"

#include "random.h"
#include "soft/elements/cloth.h"
#include "soft/solver/soft_pass.h"
#include "soft/solver/soft_test_kit.h"

#include <gtest/gtest.h>
#include <gyre/memory.h>

namespace gyre::implicit_step_test {
namespace {

using soft_test::Bench;
constexpr Vec3 kGravity{0.0f, -9.81f, 0.0f};

// In the x-y plane, hanging from its upper edge, which is particles 0 to cells.
SoftBody hanging_sheet(int cells, const ClothMaterial& material) {
  const Pose upright{{0, 0, 0}, from_rotation_vector({0.5f * kPi, 0, 0})};
  SoftBody sheet = grid_cloth({1.0f, 1.0f}, {cells, cells}, upright, material);
  return sheet;
}

// Without shear links, since the formula is for a strip that may contract: docs/decisions/soft-solver.md, Limits.
TEST(ClothSprings, HangsFromAnEdgeWithTheStrainOfItsWeight) {
  for (const int cells : {8, 20}) {
    ClothMaterial material;
    material.stretch_stiffness = 500.0f;
    material.shear_stiffness = 0.0f;
    material.area_density = 2.0f;
    material.bend_stiffness = 0.0f;
    SoftBody sheet = hanging_sheet(cells, material);
    const double top = sheet.particles.y[0];
    ASSERT_NEAR(absolute(top), 0.5, 1.0e-6);
    const Vec3 down{0.0f, top > 0.0 ? -9.81f : 9.81f, 0.0f};
    for (int i = 0; i <= cells; ++i) hold(sheet, i, sheet.particles.place(i));
    Bench bench;
    bench.settle(sheet, down, 0.5f, 40);
    const double strain = 2.0 * 9.81 * 1.0 / (2.0 * 500.0);
    double mean = 0.0;
    for (int i = 0; i <= cells; ++i) {
      mean += (absolute(sheet.particles.y[i + cells * (cells + 1)] - top) - 1.0) / (cells + 1);
    }
    EXPECT_NEAR(mean, strain, 0.002 * strain) << cells;
    // The strain grows evenly from the lower edge up.
    const double half = absolute(sheet.particles.y[cells / 2 * (cells + 1)] - top) - 0.5;
    EXPECT_NEAR(half / strain, 0.75, 0.005) << cells;
  }
}

// Long cells too: a strip of 0.5 m x 1 m whose cells are 0.3 to 8 times as long as wide.
TEST(ClothSprings, LongCellsHaveTheStiffnessOfTheMaterial) {
  const int kCells[4][2] = {{10, 20}, {20, 20}, {20, 12}, {40, 5}};
  for (const auto& cells : kCells) {
    ClothMaterial material;
    material.area_density = 2.0f;
    material.bend_stiffness = 1.0e-6f;
    const Pose upright{{0, 0, 0}, from_rotation_vector({0.5f * kPi, 0, 0})};
    SoftBody sheet = grid_cloth({0.5f, 1.0f}, cells, upright, material);
    const double top = sheet.particles.y[0];
    const Vec3 down{0.0f, top > 0.0 ? -9.81f : 9.81f, 0.0f};
    for (int i = 0; i <= cells[0]; ++i) hold(sheet, i, sheet.particles.place(i));
    Bench bench;
    bench.settle(sheet, down, 0.5f, 40);
    double mean = 0.0;
    for (int i = 0; i <= cells[0]; ++i)
      mean += (absolute(sheet.particles.y[i + cells[1] * (cells[0] + 1)] - top) - 1.0) / (cells[0] + 1);
    const double strain = 2.0 * 9.81 / (2.0 * 1000.0);
    EXPECT_NEAR(mean, strain, 0.02 * strain) << cells[0] << ' ' << cells[1];
  }
}

TEST(ClothSprings, MeanStretchDoesNotDependOnTheCells) {
  double first = 0.0;
  for (const int cells : {12, 24, 48}) {
    ClothMaterial material;
    material.stretch_stiffness = 1000.0f;
    material.bend_stiffness = 0.0f;
    SoftBody sheet = hanging_sheet(cells, material);
    hold(sheet, 0, sheet.particles.place(0));
    hold(sheet, cells, sheet.particles.place(cells));
    const Vec3 down{0.0f, sheet.particles.y[0] > 0.0 ? -9.81f : 9.81f, 0.0f};
    Bench bench;
    bench.settle(sheet, down, 0.2f, 60);
    double mean = 0.0;  // stretch of the lines of the grid
    for (int j = 0; j <= cells; ++j) {
      for (int i = 0; i < cells; ++i) {
        const int across = i + j * (cells + 1), along = j + i * (cells + 1);
        mean +=
            absolute(length(sheet.particles.place(across + 1) - sheet.particles.place(across)) * cells - 1.0);
        mean += absolute(
            length(sheet.particles.place(along + cells + 1) - sheet.particles.place(along)) * cells - 1.0);
      }
    }
    mean /= 2.0 * cells * (cells + 1);
    if (first == 0.0) first = mean;
    EXPECT_NEAR(mean / first, 1.0, 0.05) << cells;
  }
}

TEST(ClothSprings, AHangingStripIsACatenary) {
  ClothMaterial material;
  material.stretch_stiffness = 2.0e4f;
  material.shear_stiffness = 0.0f;
  material.bend_stiffness = 0.0f;
  SoftBody strip = grid_cloth({1.2f, 0.1f}, {48, 1}, Pose{}, material);
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i <= 48; ++i) {  // a V of the same length
      const double x = i / 48.0, deep = 0.5 * std::sqrt(1.2 * 1.2 - 1.0);
      strip.particles.set_place(i + 49 * j, {x - 0.5, -2.0 * deep * min(x, 1.0 - x), 0.1 * j - 0.05});
    }
    for (const int i : {0, 48}) hold(strip, i + 49 * j, strip.particles.place(i + 49 * j));
  }
  Bench bench;
  bench.settle(strip, kGravity, 0.1f, 100);
  EXPECT_NEAR(-strip.particles.y[24], 0.292344, 0.01 * 0.292344);
}

SoftBody thrown_cloth(int cells, float speed) {
  ClothMaterial material;
  material.damping = 0.01f;
  SoftBody cloth = grid_cloth({1.0f, 1.0f}, {cells, cells}, Pose{{1000.0, 5.0, -300.0}, {}}, material);
  testing_random::Random random;
  for (int i = 0; i < cloth.particles.count; ++i) {
    const Vec3 arm = to_float(cloth.particles.place(i) - DVec3{1000.0, 5.0, -300.0});
    cloth.particles.set_velocity(
        i, cross(Vec3{1.0f, 2.0f, 0.5f}, arm) + Vec3{3, 1, 2} + random.vector(-speed, speed));
  }
  return cloth;
}

TEST(ClothMomentum, IsKeptAtAnyNumberOfIterations) {
  for (const int iterations : {1, 3, 100}) {
    SoftBody cloth = thrown_cloth(20, 0.5f);
    const DVec3 linear = soft_test::momentum(cloth), angular = soft_test::angular_momentum(cloth);
    Bench bench;
    ImplicitSettings settings;
    settings.step = 1.0f / 240.0f;
    settings.least_iterations = settings.most_iterations = iterations;
    const double start = soft_test::kinetic_energy(cloth) + elastic_energy(cloth);
    for (int i = 0; i < 240; ++i) bench.step(cloth, settings);
    // One iteration alone gains energy slowly; three, the least by default, do not.
    const double energy = soft_test::kinetic_energy(cloth) + elastic_energy(cloth);
    EXPECT_LT(energy, (iterations == 1 ? 1.2 : 1.0) * start) << iterations;
    EXPECT_LT(length(soft_test::momentum(cloth) - linear), 1.0e-5 * length(linear)) << iterations;
    EXPECT_LT(length(soft_test::angular_momentum(cloth) - angular), 1.0e-4 * length(angular)) << iterations;
  }
}

TEST(ClothMomentum, FallsFreelyAndDampingDoesNotBrakeIt) {
  SoftBody cloth = thrown_cloth(10, 0.0f);
  const double spin = length(soft_test::angular_momentum(cloth));
  const DVec3 start = soft_test::center_of(cloth);
  Bench bench;
  ImplicitSettings settings;
  settings.step = 1.0f / 240.0f;
  settings.gravity = kGravity;
  settings.most_iterations = 4;
  for (int i = 0; i < 240; ++i) bench.step(cloth, settings);
  // Backward Euler falls by g h^2 n (n + 1) / 2.
  const DVec3 way = soft_test::center_of(cloth) - start;
  EXPECT_NEAR(way.y, 1.0 - 0.5 * 9.81 * (1.0 + 1.0 / 240.0), 2.0e-4);
  EXPECT_NEAR(way.x, 3.0, 1.0e-4);
  EXPECT_NEAR(length(soft_test::angular_momentum(cloth)), spin, 1.0e-4 * spin);
}

// An impulse that comes after the solve spreads as a force that was there before it.
TEST(ClothImpulses, SpreadAsForcesDo) {
  SoftBody pushed = thrown_cloth(12, 0.1f), forced = thrown_cloth(12, 0.1f);
  for (SoftBody* const cloth : {&pushed, &forced}) hold(*cloth, 0, cloth->particles.place(0));
  Bench bench;
  ImplicitSettings settings;
  settings.step = 1.0f / 240.0f;
  settings.tolerance = 1.0e-6f;
  settings.most_iterations = 1000;
  const Vec3 impulse{0.001f, -0.004f, 0.002f};
  const int at = 40;
  forced.particles.fx[at] = impulse.x / settings.step;
  forced.particles.fy[at] = impulse.y / settings.step;
  forced.particles.fz[at] = impulse.z / settings.step;
  bench.step(forced, settings);
  const ImplicitStep step = begin_implicit(pushed, settings, bench.kernels, bench.arena, bench.tasks);
  const Vec3 before = pushed.particles.velocity(at);
  const VectorRows rows = make_vectors(bench.arena, pushed.particles.x.size());
  for (std::size_t i = 0; i < pushed.particles.x.size(); ++i) rows.x[i] = rows.y[i] = rows.z[i] = 0.0f;
  rows.x[at] = impulse.x, rows.y[at] = impulse.y, rows.z[at] = impulse.z;
  const VectorRows change = make_vectors(bench.arena, pushed.particles.x.size());
  soft_test::find_response(bench, pushed, step, rows, change);
  for (int i = 0; i < pushed.particles.count; ++i)
    pushed.particles.set_velocity(i,
                                  pushed.particles.velocity(i) + Vec3{change.x[i], change.y[i], change.z[i]});
  finish_implicit(pushed, step, bench.kernels, bench.tasks);
  const float answer = length(pushed.particles.velocity(at) - before);
  for (int i = 0; i < pushed.particles.count; ++i) {
    EXPECT_LT(length(pushed.particles.velocity(i) - forced.particles.velocity(i)), 1.0e-3f * answer) << i;
  }
  EXPECT_GT(answer,
            length(inverse_mass(step, at) * impulse) * 0.99f);  // neighbours that give way make it softer
}

TEST(ClothEnergy, IsNeverGained) {
  SoftBody cloth = thrown_cloth(16, 1.0f);
  Bench bench;
  ImplicitSettings settings;
  settings.step = 1.0f / 240.0f;
  double before = soft_test::kinetic_energy(cloth) + elastic_energy(cloth);
  const double start = before;
  for (int i = 0; i < 240; ++i) {
    bench.step(cloth, settings);
    const double now = soft_test::kinetic_energy(cloth) + elastic_energy(cloth);
    EXPECT_LT(now, before + 1.0e-4 * start) << i;
    before = now;
  }
}

std::uint64_t digest(const SoftBody& body) {
  std::uint64_t hash = 1469598103934665603u;
  for (int i = 0; i < body.particles.count; ++i) {
    for (const double part : {body.particles.x[i], body.particles.y[i], body.particles.z[i]}) {
      hash = (hash ^ __builtin_bit_cast(std::uint64_t, part)) * 1099511628211u;
    }
  }
  return hash;
}

TEST(SoftDeterminism, WidthsAndThreadsGiveTheSameBits) {
  std::uint64_t first = 0;
  for (const int width : {1, 4, 8, 16}) {
    for (const int threads : {1, 2}) {
      SoftBody cloth = thrown_cloth(50, 1.0f);  // more than one block of slices
      hold(cloth, 7, cloth.particles.place(7));
      Arena arena;
      TaskSystem tasks(threads);
      ImplicitSettings settings;
      settings.step = 1.0f / 240.0f;
      settings.gravity = kGravity;
      for (int i = 0; i < 10; ++i) step_implicit(cloth, settings, select_soft_kernels(width), arena, tasks);
      const std::uint64_t hash = digest(cloth);
      if (first == 0) first = hash;
      EXPECT_EQ(hash, first) << width << " lanes, " << threads << " threads";
    }
  }
}

TEST(SoftMemory, NothingIsAllocatedOnceWarm) {
  SoftBody cloth = thrown_cloth(20, 1.0f);
  Bench bench;
  ImplicitSettings settings;
  settings.step = 1.0f / 240.0f;
  for (int i = 0; i < 3; ++i) {
    bench.step(cloth, settings);
    bench.arena.reset();
  }
  const std::uint64_t before = allocation_count();
  for (int i = 0; i < 10; ++i) {
    bench.step(cloth, settings);
    bench.arena.reset();
  }
  EXPECT_EQ(allocation_count(), before);
}

}  // namespace
}  // namespace gyre::implicit_step_test
