// Beams and bars of solids in bending and torsion, against theory: S. P. Timoshenko's beam, B. de Saint-Venant's torsion of a square bar
// (J = 0.1406 a^4), the elastica under its own weight (J. T. Holden, "On the Finite Deflections of Thin Beams", 1972), and materials near a
// Poisson's ratio of 1/2.
#include "laws/kit.h"

#include <array>

namespace gyre::laws::soft_beams_test {
namespace {

constexpr double kSide = 0.1, kDensity = 1000.0;  // m, kg/m^3; beams are 1 m long

// So that what swings comes to rest: `rate` in 1/s.
void add_brake(World& world, double rate) {
  FieldDef brake;
  brake.kind = FieldKind::drag;
  brake.drag_coefficient = 0.0f;
  brake.linear_drag = float(rate);
  world.add_field(brake);
}

// A beam along x, held at its left end.
class Beam {
 public:
  Beam(World& world, int across, double young, double ratio)
      : world_(&world), columns_(std::uint32_t(10 * across) + 1) {
    SolidDef def{.box = SolidBox{{0.5f, 0.05f, 0.05f}, {10 * across, across, across}},
                 .model = SolidModel::corotated,
                 .density = float(kDensity),
                 .young_modulus = float(young),
                 .poisson_ratio = float(ratio)};
    id_ = world.add_solid(def);
    for (std::uint32_t v = 0; v < count(); v += columns_) world.pin(id_, v);
  }
  // How far the mean of the right end has gone down.
  double drop() const {
    const SoftVertices v = world_->vertices(id_);
    double sum = 0.0;
    for (std::uint32_t i = columns_ - 1; i < count(); i += columns_) sum -= v.y[i];
    return sum / (count() / columns_);
  }

 private:
  std::uint32_t count() const { return std::uint32_t(world_->soft_info(id_).vertices); }

  World* world_;
  std::uint32_t columns_;
  SoftId id_{};
};

// Small deflections of a beam of 1 MPa by a hundredth of its weight. It would swing with 0.5 Hz.
double small_drop(int across, double ratio) {
  World world = make_world({.gravity = {0, float(-0.01 * kGravity), 0}, .sleeping = false});
  const Beam beam(world, across, 1.0e6, ratio);
  add_brake(world, 6.0);
  run(world, 4.0);
  return beam.drop();
}
double exact_drop(double ratio) {
  const double load = kDensity * kSide * kSide * 0.01 * kGravity, area = kSide * kSide;
  const double bending = 1.0e6 * kSide * kSide * kSide * kSide / 12.0, shear = 1.0e6 / (2.0 * (1.0 + ratio));
  return load / (8.0 * bending) + load / (2.0 * 5.0 / 6.0 * shear * area);
}

TEST(SolidBeams, ACantileverHangsByItsWeight) {
  const double exact = exact_drop(0.3), coarse = small_drop(2, 0.3), fine = small_drop(4, 0.3);
  EXPECT_TRUE(relative_row("S-30 cantilever, 4 cells through its depth", fine, exact, 0.12, 0.03));
  EXPECT_TRUE(
      relative_row("S-30 extrapolated from 2 and 4 cells", fine + (fine - coarse) / 3.0, exact, 0.05, 0.02));
  // An error of 1/4 with twice the cells is one of the second order.
  EXPECT_TRUE(limit_row("S-30 error with 4 cells over that with 2",
                        std::fabs((fine - exact) / (coarse - exact)), 0.5, 0.25));
}

TEST(SolidBeams, TheyBendAlikeAtAnyPoissonRatio) {
  const double fine = small_drop(2, 0.3) / exact_drop(0.3);
  for (const double ratio : {0.45, 0.49})
    EXPECT_TRUE(relative_row("S-31 deflection at 0.45 and 0.49 over that at 0.3, and theory's",
                             small_drop(2, ratio) / exact_drop(ratio) / fine, 1.0, 0.15, 0.05));
}

TEST(SolidBeams, OneThatBendsFarIsAnElastica) {
  struct Case {
    double load, drop;  // w L^3 / EI, in lengths
  };
  for (const Case c : {Case{2, 0.23851}, Case{5, 0.49591}}) {
    World world = make_world({.sleeping = false});
    const double young =
        kDensity * kSide * kSide * kGravity / c.load / (kSide * kSide * kSide * kSide / 12.0);
    const Beam beam(world, 4, young, 0.3);
    add_brake(world, 8.0);
    run(world, 3.0);
    EXPECT_TRUE(
        relative_row("S-32 elastica of tetrahedra by its own weight", beam.drop(), c.drop, 0.05, 0.02));
  }
}

// The twist between two sections, where the ends, which are held in a plane, do not matter.
TEST(SolidBeams, ASquareBarTwists) {
  constexpr double kYoung = 1.0e6, kLength = 0.5, kAngle = 0.05;
  for (const double ratio : {0.3, 0.45}) {
    World world = make_world({.gravity = {}, .sleeping = false});
    constexpr std::uint32_t kAcross = 8, kAlong = 40;
    SolidDef def{.box = SolidBox{{0.25f, 0.05f, 0.05f}, {kAlong, kAcross, kAcross}},
                 .model = SolidModel::corotated,
                 .young_modulus = float(kYoung),
                 .poisson_ratio = float(ratio),
                 .settings = {.damping = 0.02f}};
    const SoftId bar = world.add_solid(def);
    BodyDef end = point_body(2.0, {2e-3f, 2e-3f, 2e-3f}, {0.25, 0, 0});
    end.locked = LockedAxes{{false, true, true}, {false, true, true}};
    const BodyId turning = world.add_body(end);
    const std::uint32_t count = std::uint32_t(world.soft_info(bar).vertices);
    for (std::uint32_t v = 0; v < count; v += kAlong + 1)
      world.pin(bar, v), world.attach(bar, v + kAlong, turning);
    const double shear = kYoung / (2.0 * (1.0 + ratio)), inertia = 0.1406 * kSide * kSide * kSide * kSide;
    const double torque = shear * inertia * kAngle / kLength;
    for (int n = 0; n < 60; ++n) {
      world.add_torque(turning, {float(torque), 0, 0});
      world.step(kStep);
    }
    // The angle of a section, by its lower and its upper side in the middle of their widths.
    const auto angle = [&](std::uint32_t section) {
      const SoftVertices v = world.vertices(bar);
      const std::uint32_t low = section + (kAlong + 1) * (kAcross + 1) * (kAcross / 2),
                          high = low + (kAlong + 1) * kAcross;
      return (v.z[high] - v.z[low]) / (v.y[high] - v.y[low]);
    };
    EXPECT_TRUE(relative_row("S-33 twist of a square bar, rad/m", (angle(30) - angle(10)) / (0.5 * kLength),
                             kAngle / kLength, 0.05, 0.02));
  }
}

}  // namespace
}  // namespace gyre::laws::soft_beams_test
