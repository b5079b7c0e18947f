// Pendula, hinges, chains and the forces in joints, against closed forms.
// Sources: elliptic integrals by the arithmetic-geometric mean; H. Goldstein, "Classical Mechanics".
#include "laws/any_joint.h"
#include "laws/kit.h"

namespace gyre::laws::pendulum_test {
namespace {

// The period of a pendulum of reduced length 1 m swinging to `angle` on either side.
double exact_period(double angle) {
  double a = 1.0, g = std::cos(0.5 * angle);
  for (int i = 0; i < 40; ++i) {
    const double mean = 0.5 * (a + g);
    g = std::sqrt(a * g);
    a = mean;
  }
  return 2.0 * kPiDouble / std::sqrt(kGravity) / a;
}

struct Swing {
  World world;
  BodyId bob;
  JointId rod;
};
// A bob released at rest, `degrees` from hanging, 1 m from the origin.
Swing release(double degrees, JointKind kind = JointKind::distance, float radius = 0.0f) {
  Swing s{make_world({.sleeping = false}), {}, {}};
  const double angle = degrees * kPiDouble / 180.0;
  const float moment = 0.4f * radius * radius;
  BodyDef def = point_body(1.0, radius > 0.0f ? Vec3{moment, moment, moment} : Vec3{1e-4f, 1e-4f, 1e-4f},
                           {std::sin(angle), -std::cos(angle), 0});
  s.bob = s.world.add_body(def);
  s.rod = s.world.add_joint(definition_of({.kind = kind, .b = s.bob, .anchor = {0, 0, 0}}));
  return s;
}

double measured_period(Swing& s, int swings) {
  ZeroCrossings through;
  Unwrapped angle;
  for (int i = 0; i < 60 * 80 && through.count() <= swings; ++i) {
    const DVec3 p = s.world.pose(s.bob).position;
    through.add(double(i) * double(kStep), std::atan2(p.x, -p.y) / 3.0);
    s.world.step(kStep);
  }
  return through.mean_period();
}

TEST(Pendulum, PeriodAtEveryAmplitude) {
  for (const double degrees : {5.0, 30.0, 60.0, 90.0}) {
    Swing s = release(degrees);
    EXPECT_TRUE(relative_row("A-30 period up to 90 degrees", measured_period(s, 10),
                             exact_period(degrees * kPiDouble / 180.0), 1e-3, 5e-5));
  }
  for (const double degrees : {120.0, 150.0}) {
    Swing s = release(degrees);
    EXPECT_TRUE(relative_row("A-30 period up to 150 degrees", measured_period(s, 10),
                             exact_period(degrees * kPiDouble / 180.0), 1e-2, 5e-4));
  }
}

TEST(Pendulum, KeepsItsEnergyForTwoMinutes) {
  Swing s = release(90.0);
  double low = 0.0, high = 0.0;
  for (int i = 0; i < 7200; ++i) {
    s.world.step(kStep);
    const Energy e = s.world.energy();
    const double change = (e.kinetic + e.potential) / kGravity;  // of m g L, from the height of release
    low = std::min(low, change), high = std::max(high, change);
  }
  EXPECT_TRUE(limit_row("A-31 energy lost", -low, 2e-2, 5e-4));
  EXPECT_TRUE(limit_row("A-31 energy gained", high, 2e-2, 5e-4));
}

TEST(Pendulum, RodDoesNotStretch) {
  Swing s = release(150.0);
  double stretch = 0.0;
  for (int i = 0; i < 1200; ++i) {
    s.world.step(kStep);
    stretch = std::max(stretch, std::fabs(length(s.world.pose(s.bob).position) - 1.0));
  }
  EXPECT_TRUE(limit_row("A-32 stretch (m)", stretch, 2e-3, 1e-4));
}

TEST(CompoundPendulum, SmallSwings) {
  const double moments[] = {1.0 / 12.0, 1.04 / 12.0};
  const double periods[] = {1.63795, 1.64612};
  for (int k = 0; k < 2; ++k) {
    World world = make_world({.sleeping = false});
    const float m = float(moments[k]);
    BodyDef def = point_body(1.0, {m, m, m}, {0.5 * std::sin(0.02), -0.5 * std::cos(0.02), 0});
    def.pose.orientation = from_axis_angle({0, 0, 1}, 0.02f);
    const BodyId rod = world.add_body(def);
    world.add_joint(HingeDef{.b = rod, .anchor = {0, 0, 0}, .axis = {0, 0, 1}});
    ZeroCrossings through;
    for (int i = 0; i < 1200; ++i) {
      through.add(double(i) * double(kStep), world.pose(rod).position.x);
      world.step(kStep);
    }
    EXPECT_TRUE(relative_row("A-33 period", through.mean_period(), periods[k], 2e-3, 1e-4));
  }
}

// A rod of 1 m, all but upright on its hinge, as it falls past the horizontal.
TEST(FallingRod, PassesTheHorizontalAtItsRateWithItsForces) {
  World world = make_world({.sleeping = false});
  const double direction = 0.01;
  BodyDef def = point_body(1.0, {1.0f / 12, 1e-4f, 1.0f / 12},
                           {0.5 * std::sin(direction), 0.5 * std::cos(direction), 0});
  def.pose.orientation = from_axis_angle({0, 0, 1}, float(-direction));
  const BodyId rod = world.add_body(def);
  const JointId hinge = world.add_joint(HingeDef{.b = rod, .axis = {0, 0, 1}});
  double before = 0.0, rate_before = 0.0;
  Vec3 force_before;
  for (int i = 0; i < 600; ++i) {
    world.step(kStep);
    const DVec3 p = world.pose(rod).position;
    const double angle = std::atan2(p.x, p.y), rate = -double(world.angular_velocity(rod).z);
    const Vec3 force = world.joint_state(hinge).force;
    if (angle >= 0.5 * kPiDouble) {
      // The rate at the crossing; the force is the mean over a step, so that of its middle.
      const double part = (0.5 * kPiDouble - before) / (angle - before);
      const double crossing = rate_before + part * (rate - rate_before);
      world.step(kStep);
      const Vec3 after = world.joint_state(hinge).force;
      const float s = float(part) + 0.5f;
      const Vec3 at =
          s < 1.0f ? force_before + s * (force - force_before) : force + (s - 1.0f) * (after - force);
      EXPECT_TRUE(relative_row("A-34 rate at the horizontal", crossing, 5.42494, 5e-3, 2e-4));
      EXPECT_TRUE(relative_row("A-34 force up (m g)", double(at.y) / kGravity, 0.25, 3e-2, 5e-3));
      EXPECT_TRUE(relative_row("A-34 force to the hinge (m g)", -double(at.x) / kGravity, 1.5, 3e-2, 5e-3));
      return;
    }
    before = angle, rate_before = rate, force_before = force;
  }
  FAIL() << "it did not fall";
}

TEST(ConicalPendulum, TurnsAtItsRateWithItsTension) {
  World world = make_world({.sleeping = false});
  BodyDef def = point_body(1.0, {1e-3f, 1e-3f, 1e-3f}, {0.5, -std::sqrt(0.75), 0});
  def.linear_velocity = {0, 0, 0.5f * 3.36565f};
  const BodyId bob = world.add_body(def);
  const JointId rod = world.add_joint(DistanceDef{.b = bob, .anchor = {0, 0, 0}});
  Unwrapped angle;
  double force = 0.0;
  for (int i = 0; i <= 600; ++i) {
    if (i > 0) {
      world.step(kStep);
      force += double(length(world.joint_state(rod).force)) / 600.0;
    }
    const DVec3 p = world.pose(bob).position;
    angle.add(std::atan2(p.z, p.x));
  }
  EXPECT_TRUE(relative_row("A-35 rate", angle.turned() / (600.0 * double(kStep)), 3.36565, 5e-3, 2e-4));
  EXPECT_TRUE(relative_row("A-35 tension (m g)", force / kGravity, 1.1547, 5e-3, 2e-4));
}

TEST(BallJoint, SwingsLikeARodWithTheBobsOwnInertia) {
  Swing point = release(20.0, JointKind::distance, 0.2f);
  Swing rigid = release(20.0, JointKind::ball, 0.2f);
  const double ratio = measured_period(rigid, 10) / measured_period(point, 10);
  EXPECT_TRUE(relative_row("A-37 ratio of periods", ratio, std::sqrt(1.0 + 0.4 * 0.04), 1e-3, 1e-5));
}

TEST(FixedJoint, CarriesForceAndMomentOfACantilever) {
  World world = make_world();
  const BodyId box = world.add_body({.pose = {.position = {1, 0, 0}}, .mass = 1.0f},
                                    {.geometry = Box{.half_extents = {0.1f, 0.1f, 0.1f}}});
  const JointId weld = world.add_joint(FixedDef{.b = box, .anchor = {0, 0, 0}});
  run(world, 1.0);
  const JointState r = world.joint_state(weld);
  EXPECT_TRUE(relative_row("A-39 force (N)", double(r.force.y), 9.81, 1e-2, 5e-4));
  EXPECT_TRUE(relative_row("A-39 moment (N m)", double(length(r.torque)), 9.81, 1e-2, 5e-4));
  row("A-39 sag (m)", world.pose(box).position.y, 0.0, 1e-2, 1e-4);
}

}  // namespace
}  // namespace gyre::laws::pendulum_test
