// Cloths that touch themselves and each other: no crossing, no energy from nothing, momentum kept.
#include "soft/contact/surface_contacts.h"

#include "math/rotation.h"
#include "soft/contact/surface_test_kit.h"

#include <gtest/gtest.h>

namespace gyre::surface_contacts_test {
namespace {

using namespace surface_test;

constexpr float kHalfStep = 1.0f / 480.0f;
constexpr double kEnergyShare =
    1.0e-4;  // of the energy that is exchanged: what may come from rounding and pushouts

Pose at(double x, double y, double z) { return {{x, y, z}, {}}; }

void pin_edge(SoftBody& body, int row, int columns) {
  for (int i = 0; i <= columns; ++i)
    hold(body, i + row * (columns + 1), body.particles.place(i + row * (columns + 1)));
}

// Two sheets fall onto each other and onto a third, which hangs by two edges.
TEST(SurfaceContacts, SheetsThatFallOnAPinnedOneStayApart) {
  SoftScene scene(kHalfStep, {0, -9.81f, 0});
  ClothMaterial material;
  material.damping = 1.0e-3f;
  const int cells = 9;
  for (int k = 0; k < 3; ++k)
    scene.add_sheet(k == 0 ? 1.2f : 0.8f, cells, at(0.013 * k, 0.05 * k, 0.007 * k), material, 0.01f);
  pin_edge(scene.bodies[0], 0, cells);
  pin_edge(scene.bodies[0], cells, cells);
  double most = scene.energy();
  const double exchanged = 9.81 * soft_test::mass_of(scene.bodies[0]) * 0.5;
  int touching = 0;
  for (int n = 0; n < 320; ++n) {
    scene.step();
    touching += scene.contacts.touching > 0;
    ASSERT_EQ(scene.crossings(), 0) << n;
    const double energy = scene.energy();
    EXPECT_LT(energy, most + kEnergyShare * exchanged) << n;
    most = min(most, energy);
  }
  EXPECT_GT(touching, 200);
  // They lie on the pinned sheet.
  EXPECT_GT(soft_test::center_of(scene.bodies[1]).y, soft_test::center_of(scene.bodies[0]).y);
  EXPECT_LT(soft_test::center_of(scene.bodies[2]).y, 0.05);
}

// A strip hung over a line, so that both halves swing against each other.
TEST(SurfaceContacts, AClothFoldedOntoItselfDoesNotCross) {
  SoftScene scene(kHalfStep, {0, -9.81f, 0});
  ClothMaterial material;
  material.damping = 1.0e-3f;
  const int cells = 16;
  SoftBody sheet = grid_cloth({1, 1}, {cells, cells}, {}, material);
  // Folded about its middle, like a V that is nearly closed.
  for (int i = 0; i < sheet.particles.count; ++i) {
    const double x = sheet.particles.x[i], side = std::abs(x);
    sheet.particles.set_place(i, {0.3 * x, -0.95 * side, sheet.particles.z[i]});
  }
  for (int j = 0; j <= cells; ++j)
    hold(sheet, cells / 2 + j * (cells + 1), sheet.particles.place(cells / 2 + j * (cells + 1)));
  // The surface has its radii from the sheet at rest.
  const SoftBody flat = grid_cloth({1, 1}, {cells, cells}, {}, material);
  scene.add(flat, grid_triangles(cells, cells), 0.01f);
  scene.bodies[0] = sheet;
  double most = scene.energy();
  const double exchanged = 9.81 * soft_test::mass_of(scene.bodies[0]) * 0.5;
  int touching = 0;
  for (int n = 0; n < 320; ++n) {
    scene.step();
    touching += scene.contacts.touching > 0;
    ASSERT_EQ(scene.crossings(), 0) << n;
    EXPECT_LT(scene.energy(), most + kEnergyShare * exchanged) << n;
    most = min(most, scene.energy());
  }
  EXPECT_GT(touching, 100);
}

// A strip whose ends turn against each other, three turns in four seconds, until it lies on itself.
TEST(SurfaceContacts, ATwistedStripDoesNotCross) {
  SoftScene scene(kHalfStep, {});
  ClothMaterial material;
  material.damping = 2.0e-3f;
  const int across = 5, along = 20;
  scene.add(grid_cloth({0.4f, 1.2f}, {across, along}, {}, material), grid_triangles(across, along), 0.006f);
  SoftBody& strip = scene.bodies[0];
  pin_edge(strip, 0, across);
  pin_edge(strip, along, across);
  int touching = 0;
  const int turning = 720;
  for (int n = 0; n < turning + 120; ++n) {
    const double angle = 2.0 * 3.0 * 3.14159265358979 * min(n, turning) / turning;
    for (HeldParticle& one : strip.held) {
      const bool far = one.particle > across;
      const int i = one.particle % (across + 1);
      const double x = 0.4 * (double(i) / across - 0.5), turn = far ? angle : 0.0;
      one.place = {x * std::cos(turn), x * std::sin(turn), far ? 0.6 : -0.6};
    }
    scene.step();
    touching += scene.contacts.touching > 0;
    // Held vertices go where they are told: in the last quarter turn before three turns they take room that others need.
    if (scene.report.forced > 0) {
      EXPECT_GT(n, 600);
      break;
    }
    ASSERT_EQ(scene.crossings(), 0) << n;
  }
  EXPECT_GT(touching, 200);
}

// Two free sheets fly at each other, askew.
TEST(SurfaceContacts, AFreePairKeepsItsMomentum) {
  SoftScene scene(kHalfStep, {});
  const int cells = 10;
  ClothMaterial material;
  scene.add_sheet(0.6f, cells, {{0, 0, 0}, from_rotation_vector({0.2f, 0, 0.1f})}, material, 0.008f);
  scene.add_sheet(0.5f, cells, at(0.1, 0.12, 0.05), material, 0.008f);
  for (int i = 0; i < scene.bodies[0].particles.count; ++i)
    scene.bodies[0].particles.set_velocity(i, {0.3f, 1.5f, 0.0f});
  for (int i = 0; i < scene.bodies[1].particles.count; ++i)
    scene.bodies[1].particles.set_velocity(i, {0.0f, -1.0f, 0.4f});
  const DVec3 before = soft_test::momentum(scene.bodies[0]) + soft_test::momentum(scene.bodies[1]);
  const DVec3 own = soft_test::momentum(scene.bodies[0]);
  double most = scene.energy();
  const double exchanged = most;
  for (int n = 0; n < 240; ++n) {
    scene.step();
    ASSERT_EQ(scene.crossings(), 0) << n;
    EXPECT_LT(scene.energy(), most + kEnergyShare * exchanged) << n;
    most = min(most, scene.energy());
  }
  const DVec3 after = soft_test::momentum(scene.bodies[0]) + soft_test::momentum(scene.bodies[1]);
  EXPECT_LT(length(after - before), 1e-5 * length(own));
  EXPECT_GT(length(soft_test::momentum(scene.bodies[0]) - own), 0.2 * length(own));
}

}  // namespace
}  // namespace gyre::surface_contacts_test
