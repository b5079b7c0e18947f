// Torque-free rotation and tops: the exact solutions of Euler's equations.
// Sources: L. Landau, E. Lifshitz, "Mechanics", sections 33-37; the reference integrator is RK4 in double with tiny steps.
#include "laws/kit.h"

namespace gyre::laws::rotation_test {
namespace {

// Body-frame angular velocity after `seconds`, by Runge-Kutta 4 at 20 kHz.
struct EulerReference {
  DVec3 moments;
  DVec3 w;
  DVec3 rate(DVec3 o) const {
    return {(moments.y - moments.z) / moments.x * o.y * o.z, (moments.z - moments.x) / moments.y * o.z * o.x,
            (moments.x - moments.y) / moments.z * o.x * o.y};
  }
  void advance(double seconds) {
    const int n = int(std::ceil(seconds * 20000.0));
    const double h = seconds / n;
    for (int i = 0; i < n; ++i) {
      const DVec3 k1 = rate(w), k2 = rate(w + 0.5 * h * k1), k3 = rate(w + 0.5 * h * k2),
                  k4 = rate(w + h * k3);
      w += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
  }
};

DVec3 body_rates(const World& world, BodyId body) {
  return turned_back(world.pose(body).orientation, wide(world.angular_velocity(body)));
}

// Dzhanibekov's flips: moments 1.3, 1, 0.5, a spin about the middle axis and a hundredth of it beside. They come every 2.3419 s
// from 1.1709 s on, the same for all time, and between them the rates follow Euler's equations.
TEST(MiddleAxis, FlipsInTime) {
  World world = weightless();
  BodyDef def = point_body(1.0, {1.3f, 1.0f, 0.5f});
  def.angular_velocity = {0.1f, 10, 0};
  const BodyId body = world.add_body(def);
  EulerReference exact{{1.3, 1.0, 0.5}, {double(0.1f), 10, 0}};
  std::vector<double> flips;
  double last = 10.0, away = 0.0;
  for (int i = 1; i <= 720; ++i) {
    world.step(kStep);
    const DVec3 before = exact.w;
    exact.advance(double(kStep));
    const DVec3 w = body_rates(world, body);
    away = std::max(away, length(w - exact.w));
    if (w.y * last < 0.0) {
      // Where the rate passes zero within the step: as far as the exact one does from the rates that were measured.
      EulerReference clamp_length{exact.moments, before + (w - exact.w)};
      double t = double(i - 1) * double(kStep);
      const double side = clamp_length.w.y;
      while (clamp_length.w.y * side > 0.0) clamp_length.advance(1e-5), t += 1e-5;
      flips.push_back(t);
    }
    last = w.y;
  }
  ASSERT_GE(flips.size(), 5u);
  EXPECT_TRUE(relative_row("A-12 first flip (s)", flips[0], 1.1709, 2e-2, 1e-3));
  EXPECT_TRUE(relative_row("A-12 second flip (s)", flips[1], 3.5128, 2e-2, 1e-3));
  EXPECT_TRUE(relative_row("A-12 third flip (s)", flips[2], 5.8547, 2e-2, 1e-3));
  EXPECT_TRUE(relative_row("A-12 between flips (s)", (flips[4] - flips[0]) / 4.0, 2.3419, 2e-2, 1e-3));
  EXPECT_TRUE(limit_row("A-12 rates off Euler's equations in 12 s (rad/s)", away, 0.2, 0.01));
}

TEST(Precession, OfASymmetricBodyIsExact) {
  World world = weightless();
  BodyDef def;
  def.mass = 1.0f;
  def.angular_velocity = {2, 10, 0};
  const BodyId disc = world.add_body(def, {.geometry = Cylinder{.radius = 0.5f, .half_height = 0.1f}});
  const Sym3 inertia = world.mass_properties(disc).inertia;
  EXPECT_NEAR(double(inertia.yy), 0.125, 1e-6);
  EXPECT_NEAR(double(inertia.xx), 0.0658333, 1e-6);
  const DVec3 l = world.momentum().angular;
  const DVec3 along = l / length(l);
  const DVec3 e1 = DVec3{along.y, -along.x, 0} / std::sqrt(along.x * along.x + along.y * along.y);
  const DVec3 e2 = cross(along, e1);
  Unwrapped body_phase, space_phase;
  double cone_low = 10.0, cone_high = 0.0;
  for (int i = 0; i <= 600; ++i) {
    if (i > 0) world.step(kStep);
    const DVec3 w = body_rates(world, disc);
    body_phase.add(std::atan2(w.z, w.x));
    const DVec3 axis = turned(world.pose(disc).orientation, {0, 1, 0});
    space_phase.add(std::atan2(dot(axis, e2), dot(axis, e1)));
    const double cone = std::acos(std::min(1.0, dot(axis, along)));
    cone_low = std::min(cone_low, cone), cone_high = std::max(cone_high, cone);
  }
  const double seconds = 600.0 * double(kStep);
  EXPECT_TRUE(relative_row("A-15 precession in the body", std::fabs(body_phase.turned()) / seconds, 8.98734,
                           1e-2, 1e-4));
  EXPECT_TRUE(relative_row("A-15 precession in space", std::fabs(space_phase.turned()) / seconds, 19.0924,
                           1e-2, 1e-4));
  // asin(I1 w1 / L)
  EXPECT_TRUE(relative_row("A-15 smallest cone", cone_low / double(kDegree), 6.013, 1e-2, 1e-4));
  EXPECT_TRUE(relative_row("A-15 largest cone", cone_high / double(kDegree), 6.013, 1e-2, 1e-4));
}

// Bodies of revolution go another way than those that are so but for a hundred-thousandth: after a second they differ by about as much.
TEST(Precession, OfBodiesOfRevolutionAboutAnyAxis) {
  const Vec3 moments[] = {{0.3f, 1, 1}, {1, 0.3f, 1}, {1, 1, 0.3f}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}};
  for (const Vec3 exact : moments) {
    SCOPED_TRACE(testing::Message() << exact.x << " " << exact.y << " " << exact.z);
    constexpr float kOff = 1.0e-5f;
    const Vec3 nearly{exact.x * (1.0f + kOff), exact.y, exact.z * (1.0f - kOff)};
    Quat ends[2];
    Vec3 speeds[2];
    for (const bool is_exact : {false, true}) {
      World world = weightless();
      BodyDef def = point_body(1.0, is_exact ? exact : nearly);
      def.pose.orientation = from_axis_angle({0.6f, 0, 0.8f}, 1.0f);
      def.angular_velocity = {20, -7, 11};
      const BodyId body = world.add_body(def);
      const double energy = world.energy().kinetic;
      run(world, 1.0);
      ends[is_exact] = world.pose(body).orientation;
      speeds[is_exact] = world.angular_velocity(body);
      EXPECT_NEAR(world.energy().kinetic, energy, 1.0e-5 * energy);
    }
    // The phase of 24 rad/s over a second, by moments that are off by up to 2e-5.
    EXPECT_LT(length(to_rotation_vector(ends[0] * conjugate(ends[1]))), 24.0f * 4.0f * kOff);
    EXPECT_LT(length(speeds[0] - speeds[1]), 24.0f * 24.0f * 4.0f * kOff);
  }
}

TEST(FastSpin, IsNeitherClampedNorAliased) {
  for (const bool rod : {false, true}) {
    World world = weightless();
    BodyDef def;
    def.angular_velocity = {0, 500, 0};
    const BodyId body = rod ? world.add_body(def, {.geometry = Box{.half_extents = {1, 0.05f, 0.05f}}})
                            : world.add_body(def, {.geometry = Sphere{}});
    run(world, 60.0);
    EXPECT_TRUE(relative_row(rod ? "A-16 speed of a rod" : "A-16 speed of a sphere",
                             double(length(world.angular_velocity(body))), 500.0, 1e-3, 1e-6));
    const DVec3 x = turned(world.pose(body).orientation, {1, 0, 0});
    const double turns = 500.0 * 3600.0 * double(kStep) / (2.0 * kPiDouble);
    double phase = std::atan2(-x.z, x.x) / (2.0 * kPiDouble) - turns;
    phase -= std::round(phase);
    EXPECT_TRUE(row(rod ? "A-16 phase of a rod (turns)" : "A-16 phase of a sphere (turns)", phase, 0.0,
                    1e-3 * turns / 1000.0, 1e-4 * turns / 1000.0));
  }
}

TEST(FreeRotation, OfAThinRodGainsNoEnergy) {
  World world = weightless();
  BodyDef def = point_body(1.0, {0.01f, 1, 1});
  def.angular_velocity = {5, 1, 1};
  world.add_body(def);
  const double start = world.energy().kinetic;
  double most = start;
  for (int i = 0; i < 3600; ++i) {
    world.step(kStep);
    most = std::max(most, world.energy().kinetic);
  }
  EXPECT_TRUE(limit_row("A-17 gain of energy", most / start - 1.0, 1e-2, 1e-4));
}

// A heavy top on a ball joint, in steady precession: m g l = I3 (spin + W cos) W - I1 W^2 cos.
TEST(HeavyTop, PrecessesAtTheSlowRootAndKeepsItsTilt) {
  const double spins[] = {15, 30, 60, 120};
  const double rates[] = {1.03526, 0.52179, 0.26142, 0.13078};
  for (int k = 0; k < 4; ++k) {
    World world = make_world();
    const float tilt = 30.0f * kDegree, arm = 0.2f;
    const Quat q = from_axis_angle({0, 0, 1}, -tilt);
    const Vec3 axis = rotate(q, {0, 1, 0});
    BodyDef def;
    def.pose.orientation = q;
    def.mass = 1.0f;
    def.center_of_mass = Vec3{0, arm, 0};
    def.inertia = Sym3{0.0625f, 0.125f, 0.0625f, 0, 0, 0};
    def.angular_velocity = float(spins[k]) * axis + Vec3{0, float(rates[k]), 0};
    def.linear_velocity = cross(def.angular_velocity, arm * axis);
    const BodyId top = world.add_body(def);
    ASSERT_TRUE(world.add_joint(BallDef{.b = top, .anchor = {0, 0, 0}}));
    Unwrapped azimuth;
    double drift = 0.0;
    for (int i = 0; i <= 300; ++i) {
      if (i > 0) world.step(kStep);
      const DVec3 a = turned(world.pose(top).orientation, {0, 1, 0});
      azimuth.add(std::atan2(-a.z, a.x));
      drift = std::max(drift, std::fabs(std::acos(std::min(1.0, a.y)) / double(kDegree) - 30.0));
    }
    EXPECT_TRUE(
        relative_row("A-20 precession", azimuth.turned() / (300.0 * double(kStep)), rates[k], 1e-2, 5e-4));
    EXPECT_TRUE(limit_row("A-20 drift of the tilt (degrees)", drift, 1.0, 0.05));
  }
}

}  // namespace
}  // namespace gyre::laws::rotation_test
