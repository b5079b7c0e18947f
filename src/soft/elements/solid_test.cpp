// Solids against exact answers: patches, rotations, bars, beams; and that they come back from any state.
#include "soft/elements/solid.h"

#include "random.h"
#include "soft/solver/explicit_step.h"
#include "soft/solver/soft_pass.h"
#include "soft/solver/soft_test_kit.h"

#include <gtest/gtest.h>

namespace gyre::solid_test {
namespace {

using soft_test::Bench;
using testing_random::Mixed;
constexpr ElementModel kModels[] = {ElementModel::linear, ElementModel::corotated, ElementModel::neo_hookean};

SoftBody block(const SolidMaterial& material, int cells = 3) {
  return box_solid({0.5f, 0.5f, 0.5f}, {cells, cells, cells}, Pose{}, material);
}

SoftPass forces_of(SoftBody& body, Bench& bench, int width = 0) {
  SoftPass pass = begin_pass(body, bench.arena);
  find_forces(pass, body, select_soft_kernels(width), bench.tasks);
  return pass;
}

TEST(SolidForces, AreTheGradientOfTheEnergy) {
  for (const ElementModel model : kModels) {
    SolidMaterial material;
    material.model = model;
    material.poisson_ratio = 0.3f;
    SoftBody body = block(material, 2);
    Mixed random{7};
    for (int i = 0; i < body.particles.count; ++i) {
      const DVec3 off{random.between(-0.1, 0.1), random.between(-0.1, 0.1), random.between(-0.1, 0.1)};
      body.particles.set_place(i, body.particles.place(i) + off);
    }
    Bench bench;
    const SoftPass pass = forces_of(body, bench);
    double largest = 0.0;
    for (int i = 0; i < body.particles.count; ++i) largest = max(largest, absolute(double(pass.force.x[i])));
    for (const int i : {0, 5, 13, 26}) {
      const DVec3 place = body.particles.place(i);
      const double wanted[3] = {double(pass.force.x[i]), double(pass.force.y[i]), double(pass.force.z[i])};
      for (int axis = 0; axis < 3; ++axis) {
        double energy[2];
        for (int side = 0; side < 2; ++side) {
          const double off = side == 0 ? -1.0e-5 : 1.0e-5;
          body.particles.set_place(
              i, place + DVec3{axis == 0 ? off : 0, axis == 1 ? off : 0, axis == 2 ? off : 0});
          energy[side] = elastic_energy(body);
        }
        EXPECT_NEAR((energy[0] - energy[1]) / 2.0e-5, wanted[axis], 4.0e-6 * largest)
            << int(model) << ' ' << i << ' ' << axis;
      }
      body.particles.set_place(i, place);
    }
  }
}

TEST(SolidForces, ARotationGivesNone) {
  for (const ElementModel model : {ElementModel::corotated, ElementModel::neo_hookean}) {
    SolidMaterial material;
    material.model = model;
    SoftBody body = block(material);
    const DQuat turn = exponential_map(DVec3{1.2, -1.7, 1.1});  // 137 degrees
    for (int i = 0; i < body.particles.count; ++i) {
      body.particles.set_place(i, DVec3{100.0, -50.0, 2000.0} + rotate(turn, body.particles.place(i)));
    }
    Bench bench;
    const SoftPass pass = forces_of(body, bench);
    for (int i = 0; i < body.particles.count; ++i) {
      // Of the force that a strain of one would be.
      EXPECT_LT(length(Vec3{pass.force.x[i], pass.force.y[i], pass.force.z[i]}),
                2.0e-6f * material.young_modulus / 9.0f);
    }
  }
}

// The inner particles of an irregular block whose surface is moved by an affine map land where the map says.
TEST(SolidStatics, PatchTest) {
  for (const ElementModel model : kModels) {
    SolidMaterial material;
    material.model = model;
    material.poisson_ratio = 0.3f;
    SoftBody even = block(material, 4);
    Mixed random{11};
    Array<DVec3> places;
    Array<std::uint32_t> corners;
    const auto inside = [&](int i) {
      const DVec3 p = even.particles.place(i);
      return absolute(p.x) < 0.49 && absolute(p.y) < 0.49 && absolute(p.z) < 0.49;
    };
    for (int i = 0; i < even.particles.count; ++i) {
      const DVec3 off{random.between(-0.05, 0.05), random.between(-0.05, 0.05), random.between(-0.05, 0.05)};
      places.push_back(even.particles.place(i) + (inside(i) ? 1.0 : 0.0) * off);
    }
    for (const TetBlock& one : even.continuum.tetrahedra) {
      for (int lane = 0; lane < kTetLanes; ++lane) {
        if (one.volume[lane] == 0.0f) continue;
        for (const auto& corner : one.corner) corners.push_back(std::uint32_t(corner[lane]));
      }
    }
    SoftBody body = tetrahedral_solid(places, corners, material);
    const auto moved = [](DVec3 p) {
      return p +
             DVec3{1.0e-3 * p.x + 4.0e-4 * p.y, -3.0e-4 * p.y + 2.0e-4 * p.z, 5.0e-4 * p.z - 6.0e-4 * p.x};
    };
    for (int i = 0; i < body.particles.count; ++i) {
      if (!inside(i)) hold(body, i, moved(places[i]));
    }
    Bench bench;
    ImplicitSettings settings;
    settings.step = 1.0f;
    settings.tolerance = 1.0e-7f;
    settings.most_iterations = 500;
    for (int step = 0; step < 30; ++step) bench.step(body, settings);
    for (int i = 0; i < body.particles.count; ++i) {
      EXPECT_LT(length(body.particles.place(i) - moved(places[i])), 1.0e-5 * 1.0e-3 + 2.0e-8)
          << int(model) << ' ' << i;
    }
  }
}

// The mean of y over the particles that begin at this height. (A box is cut along one diagonal, so its corners move unlike each other.)
double mean_height(const SoftBody& body, const SoftBody& start, double height) {
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < body.particles.count; ++i) {
    if (absolute(start.particles.y[i] - height) > 1.0e-3) continue;
    sum += body.particles.y[i];
    ++count;
  }
  return sum / count;
}

TEST(SolidStatics, ABarStretchesUnderItsOwnWeight) {
  for (const ElementModel model : kModels) {
    SolidMaterial material;
    material.model = model;
    material.young_modulus = 1.0e6f;
    material.poisson_ratio = 0.0f;
    SoftBody bar = box_solid({0.1f, 0.5f, 0.1f}, {2, 10, 2}, Pose{}, material);
    for (int i = 0; i < bar.particles.count; ++i) {
      if (bar.particles.y[i] > 0.499) hold(bar, i, bar.particles.place(i));
    }
    const SoftBody start = bar;
    Bench bench;
    bench.settle(bar, {0, -9.81f, 0}, 0.5f, 30);
    const double whole = 9.81 * 1000.0 / (2.0 * 1.0e6);
    EXPECT_NEAR(-0.5 - mean_height(bar, start, -0.5), whole, 0.01 * whole);
    // u is quadratic: three quarters at half the height
    EXPECT_NEAR(-mean_height(bar, start, 0.0), 0.75 * whole, 0.01 * whole);
  }
}

// The tip of a beam of 1 m x 0.1 m x 0.1 m with `across` cells through its depth, under its own weight times 1/100.
double tip_of(ElementModel model, int across, float ratio = 0.3f) {
  SolidMaterial material;
  material.model = model;
  material.young_modulus = 1.0e6f;
  material.poisson_ratio = ratio;
  SoftBody beam = box_solid({0.5f, 0.05f, 0.05f}, {10 * across, across, across}, Pose{}, material);
  for (int i = 0; i < beam.particles.count; ++i) {
    if (beam.particles.x[i] < -0.499) hold(beam, i, beam.particles.place(i));
  }
  Bench bench;
  bench.settle(beam, {0, -0.0981f, 0}, 1.0f, 12);
  double tip = 0.0;
  int corners = 0;
  for (int i = 0; i < beam.particles.count; ++i) {
    if (beam.particles.x[i] < 0.499) continue;
    tip -= beam.particles.y[i];
    ++corners;
  }
  return tip / corners;
}

TEST(SolidStatics, ACantileverConvergesWithTheSquareOfTheCells) {
  const double exact = 0.014715 + 0.000153;
  const double coarse = tip_of(ElementModel::corotated, 2), fine = tip_of(ElementModel::corotated, 4);
  const double extrapolated = 1.0 / (1.0 / fine + (1.0 / fine - 1.0 / coarse) / 3.0);
  EXPECT_NEAR(extrapolated, exact, 0.05 * exact);
  EXPECT_LT(fine, exact);
  EXPECT_GT(fine, 0.77 * exact);  // four cells through the depth: docs/decisions/soft-solver.md, Limits
  EXPECT_NEAR(tip_of(ElementModel::neo_hookean, 2), coarse, 0.02 * coarse);
  EXPECT_NEAR(tip_of(ElementModel::linear, 2), coarse, 0.02 * coarse);
}

// A cantilever swings at the frequency that goes with its bending: f = 3.51602 / (2 pi) sqrt(EI / m L^4), and the tip under its own weight is
// w L^4 / 8 EI, so f = 3.51602 / (2 pi) sqrt(g / 8 tip).
TEST(SolidDynamics, ACantileverSwingsAtItsFrequency) {
  SolidMaterial material;
  material.model = ElementModel::corotated;
  material.young_modulus = 1.0e6f;
  material.poisson_ratio = 0.3f;
  SoftBody beam = box_solid({0.5f, 0.05f, 0.05f}, {20, 2, 2}, Pose{}, material);
  for (int i = 0; i < beam.particles.count; ++i) {
    if (beam.particles.x[i] < -0.499) hold(beam, i, beam.particles.place(i));
  }
  const double tip = tip_of(ElementModel::corotated, 2);
  const double wanted = 3.51602 / (2.0 * double(kPi)) * std::sqrt(0.0981 / (8.0 * tip));
  Bench bench;
  ImplicitSettings settings;
  settings.step = 1.0f / 120.0f;
  settings.scheme = ImplicitScheme::midpoint;
  settings.gravity = {0, -0.0981f, 0};
  settings.tolerance = 1.0e-3f;
  settings.most_iterations = 200;
  // Let go from straight, it swings about the bent shape.
  const int probe = beam.particles.count - 1;
  const double start = beam.particles.y[probe];
  double before = 0.0, found[2] = {};
  int crossings = 0;
  for (int step = 1; step < 400 && crossings < 2; ++step) {
    bench.step(beam, settings);
    const double now = beam.particles.y[probe] - start + tip;
    if (step > 1 && before * now < 0.0) found[crossings++] = (step - 1 + before / (before - now)) / 120.0;
    before = now;
  }
  ASSERT_EQ(crossings, 2);
  EXPECT_NEAR(0.5 / (found[1] - found[0]), wanted, 0.03 * wanted);
}

TEST(SolidRobustness, ComesBackFromAnyState) {
  for (const ElementModel model : {ElementModel::corotated, ElementModel::neo_hookean}) {
    for (int kind = 0; kind < 3; ++kind) {
      // A point is a minimum of the neo-Hookean energy, and it stays one: docs/decisions/soft-solver.md, Limits.
      if (kind == 2 && model == ElementModel::neo_hookean) continue;
      SolidMaterial material;
      material.model = model;
      material.poisson_ratio = 0.3f;
      material.young_modulus = 1.0e5f;
      material.damping = 0.05f;
      SoftBody body = block(material, 3);
      const SoftBody rest = block(material, 3);
      Mixed random{3};
      for (int i = 0; i < body.particles.count; ++i) {
        const DVec3 p = body.particles.place(i);
        const DVec3 somewhere{random.between(-0.5, 0.5), random.between(-0.5, 0.5),
                              random.between(-0.5, 0.5)};
        // Anywhere in a box; flat; all but a point.
        body.particles.set_place(i, kind == 0   ? somewhere
                                    : kind == 1 ? DVec3{p.x, 0, p.z}
                                                : 1.0e-4 * somewhere);
      }
      Bench bench;
      ImplicitSettings settings;
      settings.step = 1.0f / 240.0f;
      for (int step = 0; step < 720; ++step) bench.step(body, settings);
      double worst = 0.0;
      for (int i = 1; i < body.particles.count; ++i) {
        const double wanted = length(rest.particles.place(i) - rest.particles.place(0));
        worst = max(worst, absolute(length(body.particles.place(i) - body.particles.place(0)) - wanted));
      }
      EXPECT_LT(worst, 0.02) << int(model) << ' ' << kind;
    }
  }
}

TEST(SolidRobustness, EveryScaleIsTheSame) {
  double first = 0.0;
  for (const float scale : {0.01f, 1.0f, 100.0f}) {
    SolidMaterial material;
    material.young_modulus = 1.0e5f * scale;  // what keeps the strain under its own weight
    material.poisson_ratio = 0.3f;
    SoftBody body = box_solid({0.5f * scale, 0.5f * scale, 0.5f * scale}, {3, 3, 3}, Pose{}, material);
    for (int i = 0; i < body.particles.count; ++i) {
      if (body.particles.y[i] > 0.499 * double(scale)) hold(body, i, body.particles.place(i));
    }
    Bench bench;
    bench.settle(body, {0, -9.81f, 0}, 0.5f * std::sqrt(scale), 20);
    const double strain = (-0.5 * double(scale) - body.particles.y[0]) / double(scale);
    if (first == 0.0) first = strain;
    EXPECT_NEAR(strain, first, 1.0e-3 * first) << scale;
  }
}

TEST(SolidDeterminism, WidthsAndThreadsGiveTheSameBits) {
  for (const ElementModel model : kModels) {
    double first = 0.0;
    for (const int width : {1, 4, 8, 16}) {
      for (const int threads : {1, 2}) {
        SolidMaterial material;
        material.model = model;
        SoftBody body = box_solid({1.0f, 0.5f, 0.5f}, {16, 8, 8}, Pose{}, material);
        for (int i = 0; i < 81; ++i) hold(body, 17 * i, body.particles.place(17 * i));
        Arena arena;
        TaskSystem tasks(threads);
        ImplicitSettings settings;
        settings.step = 1.0f / 240.0f;
        settings.gravity = {0, -9.81f, 0};
        for (int i = 0; i < 5; ++i) step_implicit(body, settings, select_soft_kernels(width), arena, tasks);
        double digest = 0.0;
        for (int i = 0; i < body.particles.count; ++i)
          digest += body.particles.y[i] * (1.0 + i) + body.particles.x[i];
        if (first == 0.0) first = digest;
        EXPECT_EQ(digest, first) << width << " lanes, " << threads << " threads";
      }
    }
  }
}

}  // namespace
}  // namespace gyre::solid_test
