// Contacts solved together with stiff sheets, against the conditions that the solution must meet.
#include "soft/solver/coupled_solve.h"

#include "random.h"
#include "soft/elements/cloth.h"
#include "soft/solver/soft_pass.h"
#include "soft/solver/soft_test_kit.h"

#include <gtest/gtest.h>

namespace gyre::coupled_solve_test {
namespace {

using soft_test::Bench;

constexpr int kCells = 6;
constexpr CoupledSettings kExact{
    .least_stages = 40, .most_stages = 300, .most_iterations = 300, .tolerance = 1.0e-12};

// Two sheets in random motion, a vertex of one against three of the other in each row.
struct TwoSheets {
  Bench bench;
  SoftBody sheets[2];
  ImplicitStep steps[2];
  Array<CoupledBody> bodies;
  Array<Sym3> blocks;
  Array<Vec3> velocities, impulses, change;
  Array<CouplingRow> rows;

  TwoSheets(std::uint64_t seed, float stiffness, bool is_held) {
    testing_random::Mixed random{seed};
    ClothMaterial material;
    material.stretch_stiffness = material.shear_stiffness = stiffness;
    material.area_density = 0.3f;
    std::uint32_t first = 0;
    for (int b = 0; b < 2; ++b) {
      sheets[b] = grid_cloth({1, 1}, {kCells, kCells}, {{0, 0.01 * b, 0}, {}}, material);
      Particles& p = sheets[b].particles;
      for (int i = 0; i < p.count; ++i) {
        const auto some = [&] { return float(random.between(-1.0, 1.0)); };
        p.set_velocity(i, {0.3f * some(), 0.3f * some() - float(b), 0.3f * some()});
      }
      if (is_held && b == 0) hold(sheets[b], 0, p.place(0));
      ImplicitSettings settings;
      settings.step = 1.0f / 240.0f;
      steps[b] = begin_implicit(sheets[b], settings, bench.kernels, bench.arena, bench.tasks);
    }
    for (int b = 0; b < 2; ++b) {
      const Particles& p = sheets[b].particles;
      bodies.push_back({&sheets[b], &steps[b], {}, first});
      for (int i = 0; i < p.count; ++i) {
        blocks.push_back(inverse_mass(steps[b], i));
        velocities.push_back(p.velocity(i));
        impulses.push_back({});
      }
      first += std::uint32_t(p.count);
    }
    change.resize(velocities.size());
    for (std::uint32_t v = kCells + 2; v < first / 2 - 1; v += 2) {
      CouplingRow row;
      const std::uint32_t corners[4] = {first / 2 + v, v, v + 1, v - kCells};
      const float weights[4] = {1.0f, -0.5f, -0.2f, -0.3f};
      for (int k = 0; k < 4; ++k) row.vertex[k] = corners[k], row.weight[k] = weights[k];
      row.normal = normalized(Vec3{float(random.between(-0.3, 0.3)), 1.0f, float(random.between(-0.3, 0.3))});
      row.target = float(random.between(-0.2, 0.0));
      row.friction[0] = row.friction[1] = 0.4f;
      row.allowed = 2.0e-5f;
      rows.push_back(row);
    }
  }
  CoupledReport solve(const CoupledSettings& settings) {
    return solve_coupled(bodies, {}, rows, {blocks, velocities, impulses, change}, settings, bench.kernels,
                         bench.arena, bench.tasks);
  }
  Vec3 velocity_after(const CouplingRow& row) const {
    Vec3 sum{};
    for (int k = 0; k < 4; ++k) sum += row.weight[k] * (velocities[row.vertex[k]] + change[row.vertex[k]]);
    return sum;
  }
};

TEST(CoupledSolve, RowsMeetTheConditionsOfContactAndFriction) {
  for (const float stiffness : {10.0f, 1.0e3f, 1.0e4f}) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      TwoSheets two(seed, stiffness, seed % 2 == 0);
      ASSERT_TRUE(two.solve(kExact).met) << stiffness << " " << seed;
      int pushing = 0, sliding = 0;
      for (const CouplingRow& row : two.rows) {
        const Vec3 u = two.velocity_after(row);
        const float normal = dot(row.normal, row.impulse), missing = dot(row.normal, u) - row.target;
        const Vec3 friction = row.impulse - normal * row.normal, slide = u - dot(row.normal, u) * row.normal;
        EXPECT_GE(normal, -1.0e-7f);
        EXPECT_GE(missing, -4.0e-5f);
        EXPECT_LE(length(friction), 0.4001f * max(normal, 0.0f) + 1.0e-7f);
        if (!(normal > 1.0e-4f)) continue;
        ++pushing;
        EXPECT_NEAR(missing, 0.0f, 1.0e-3f);
        // A row that slides is held back with all of its friction, against its motion.
        if (!(length(slide) > 2.0e-2f)) continue;
        ++sliding;
        EXPECT_GE(length(friction), 0.399f * normal);
        EXPECT_LT(dot(friction, slide), -0.98f * length(friction) * length(slide));
      }
      EXPECT_GT(pushing, 3);
      EXPECT_GT(sliding, 0);
    }
  }
}

TEST(CoupledSolve, BodiesAnswerTheImpulsesThatRowsGave) {
  for (const bool is_held : {false, true}) {
    TwoSheets two(7, 1.0e3f, is_held);
    ASSERT_TRUE(two.solve(kExact).met);
    for (int b = 0; b < 2; ++b) {
      const Particles& p = two.sheets[b].particles;
      const std::uint32_t first = two.bodies[b].first;
      const VectorRows given = make_vectors(two.bench.arena, p.x.size()),
                       found = make_vectors(two.bench.arena, p.x.size());
      for (std::size_t i = 0; i < p.x.size(); ++i) {
        const bool is_loose = int(i) < p.count && p.loose[i] != 0.0f;
        const Vec3 one = is_loose ? two.impulses[first + i] : Vec3{};
        given.x[i] = one.x, given.y[i] = one.y, given.z[i] = one.z;
      }
      soft_test::find_response(two.bench, two.sheets[b], two.steps[b], given, found);
      for (int i = 0; i < p.count; ++i) {
        EXPECT_NEAR(found.x[i], two.change[first + std::uint32_t(i)].x, 1.0e-4f);
        EXPECT_NEAR(found.y[i], two.change[first + std::uint32_t(i)].y, 1.0e-4f);
        EXPECT_NEAR(found.z[i], two.change[first + std::uint32_t(i)].z, 1.0e-4f);
      }
    }
  }
}

// A body of one kilogram turns and falls on a sheet of some 0.3 kg: its points meet the same conditions with the velocity that its impulses give it, and what is locked of it stays.
TEST(CoupledSolve, ARigidBodyMeetsTheConditionsToo) {
  for (const bool is_locked : {false, true}) {
    TwoSheets two(3, 1.0e3f, true);
    RigidInertia body{{1, 1, 1}, {20, 30, 40, 1, 2, 3}};
    if (is_locked) body = {{1, 1, 0}, {}};
    const Vec3 falls{0.1f, -2.0f, 0.3f}, spins{0.5f, 1.0f, -1.0f};
    const std::size_t among_sheets = two.rows.size();
    for (int k = 0; k < 5; ++k) {
      CouplingRow row;
      row.vertex[0] = std::uint32_t(49 + 16 + k);
      row.weight[0] = 1.0f;
      row.body = 0;
      row.arm = {0.05f * float(k - 2), -0.1f, 0.02f};
      row.passing = falls + cross(spins, row.arm);
      row.normal = {0, -1, 0};
      row.friction[0] = row.friction[1] = 0.3f;
      two.rows.push_back(row);
    }
    for (CouplingRow& row : two.rows) row.allowed = 1.0e-3f;
    const RigidInertia bodies[] = {body};
    const CoupledReport report =
        solve_coupled(two.bodies, bodies, two.rows, {two.blocks, two.velocities, two.impulses, two.change},
                      kExact, two.bench.kernels, two.bench.arena, two.bench.tasks);
    ASSERT_TRUE(report.met);
    Vec3 linear{}, angular{};
    for (std::size_t r = among_sheets; r < two.rows.size(); ++r) {
      linear -= two.rows[r].impulse, angular -= cross(two.rows[r].arm, two.rows[r].impulse);
    }
    const Vec3 faster{body.inverse_mass.x * linear.x, body.inverse_mass.y * linear.y,
                      body.inverse_mass.z * linear.z},
        turns = body.inverse_inertia * angular;
    int pushing = 0;
    for (std::size_t r = among_sheets; r < two.rows.size(); ++r) {
      const CouplingRow& row = two.rows[r];
      const Vec3 u = two.velocity_after(row) - row.passing - faster - cross(turns, row.arm);
      const float normal = dot(row.normal, row.impulse), missing = dot(row.normal, u);
      EXPECT_GE(normal, -1.0e-7f);
      EXPECT_GE(missing, -1.1e-3f);
      if (!(normal > 1.0e-4f)) continue;
      ++pushing;
      EXPECT_NEAR(missing, 0.0f, 2.0e-3f);
      EXPECT_LE(length(row.impulse - normal * row.normal), 0.301f * normal);
    }
    EXPECT_GT(pushing, 1);
  }
}

// An early end is no worse than none: the kinetic energy of the sheets, and what their stiffness takes up, never rise.
TEST(CoupledSolve, AnEarlyEndAddsNoEnergyAndKeepsMomentum) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    for (const int iterations : {1, 2, 5}) {
      TwoSheets two(seed, 1.0e4f, false);
      two.solve({.least_stages = 1, .most_stages = 1, .most_iterations = iterations});
      DVec3 momentum{};
      double change = 0.0;
      for (int b = 0; b < 2; ++b) {
        const Particles& p = two.sheets[b].particles;
        for (int i = 0; i < p.count; ++i) {
          const std::size_t v = two.bodies[b].first + std::size_t(i);
          const DVec3 was(two.velocities[v]), now = was + DVec3(two.change[v]);
          momentum += double(p.mass[i]) * DVec3(two.change[v]);
          change += 0.5 * double(p.mass[i]) * (dot(now, now) - dot(was, was));
        }
      }
      EXPECT_LT(change, 1.0e-6) << seed << " " << iterations;
      EXPECT_LT(length(momentum), 1.0e-6) << seed << " " << iterations;
    }
  }
}

}  // namespace
}  // namespace gyre::coupled_solve_test
