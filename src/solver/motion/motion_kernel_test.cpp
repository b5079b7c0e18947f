// The motion kernels against plain rotations in double, and every width against width 1.
#include "random.h"
#include "solver/kernels/solver_kernels.h"
#include "solver/motion/motion_block.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "math/rotation.h"

namespace gyre::motion_kernel_test {
namespace {

struct Random : testing_random::MixedSingles {
  Random() : MixedSingles{{0x94d049bb133111ebu}} {}
};

// Bodies, and the motion blocks of one width.
struct Crowd {
  std::vector<MovedBody> bodies;
  std::vector<BodyMotion> motion;
  std::vector<BodyInertia> inertia;
  std::vector<Quat> orientations;
  std::vector<Vec3> rotations;
  std::vector<std::max_align_t> memory;
  const MotionKernels* kernels = nullptr;
  int blocks = 0;

  MovedBody& add(Vec3 moments, Quat orientation) {
    const auto index = std::int32_t(bodies.size());
    MovedBody body;
    body.body = index;
    body.inertia = {.xx = moments.x, .yy = moments.y, .zz = moments.z};
    body.inverse_inertia = {.xx = 1.0f / moments.x, .yy = 1.0f / moments.y, .zz = 1.0f / moments.z};
    body.isotropic = moments.x == moments.y && moments.y == moments.z;
    body.orientation = orientation;
    bodies.push_back(body);
    BodyMotion record;
    record.inverse_mass = 1.0f;
    motion.push_back(record);
    BodyInertia world;
    world.inverse = rotate_inertia(to_matrix(orientation), body.inverse_inertia);
    world.inverse_mass = 1.0f;
    inertia.push_back(world);
    orientations.push_back(orientation);
    rotations.push_back({});
    return bodies.back();
  }

  void prepare(int width) {
    const SolverKernels& all = select_kernels(width);  // of fewer lanes on a processor without so many
    kernels = &all.motion;
    blocks = (int(bodies.size()) + all.width - 1) / all.width;
    memory.assign(kernels->block_bytes * std::size_t(blocks) / sizeof(std::max_align_t) + 64, {});
    kernels->prepare(place(), 0, blocks, bodies.data(), int(bodies.size()), inertia.data());
  }
  // Kernels need the alignment of their widest vector.
  void* place() {
    void* at = memory.data();
    std::size_t room = memory.size() * sizeof(std::max_align_t);
    return std::align(64, 1, at, room);
  }
  void integrate_velocities(bool warm) {
    kernels->integrate_velocities(place(), 0, blocks, motion.data(), warm, true);
  }
  void add_contact_change() { kernels->add_contact_change(place(), 0, blocks, motion.data()); }
  void warm_start() { kernels->warm_start(place(), 0, blocks, motion.data()); }
  void integrate_positions(float h) {
    kernels->integrate_positions(place(), 0, blocks, {motion.data(), inertia.data(), orientations.data()}, h,
                                 true);
  }
  void begin_projection() { kernels->begin_projection(place(), 0, blocks, motion.data()); }
  void end_projection() { kernels->end_projection(place(), 0, blocks, motion.data(), rotations.data()); }
};

struct DQuat {
  double x, y, z, w;
};
DQuat product(const DQuat& a, const DQuat& b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
DQuat exponential(Vec3 v) {
  const double angle = std::sqrt(double(v.x) * v.x + double(v.y) * v.y + double(v.z) * v.z);
  const double s = angle > 0 ? std::sin(0.5 * angle) / angle : 0.5;
  return {s * v.x, s * v.y, s * v.z, std::cos(0.5 * angle)};
}
// The angle between two orientations.
double angle_between(const DQuat& a, const DQuat& b) {
  const DQuat d = product(a, {-b.x, -b.y, -b.z, b.w});
  return 2.0 * std::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::fabs(d.w));
}

// Difference between two rotations of `angle`, composed as rotation vectors, and the product of both. (Not
// about perpendicular axes: there the fourth order vanishes.)
double composition_error(float angle) {
  Crowd crowd;
  crowd.add({1, 1, 1}, {});
  crowd.prepare(1);
  crowd.motion[0].angular_velocity = {angle, 0, 0};
  crowd.integrate_positions(1.0f);
  crowd.motion[0].angular_velocity = {0.6f * angle, 0.8f * angle, 0};
  crowd.integrate_positions(1.0f);
  const DQuat exact = product(exponential({0.6f * angle, 0.8f * angle, 0}), exponential({angle, 0, 0}));
  return angle_between(exponential(crowd.motion[0].delta_rotation), exact);
}

TEST(MotionKernel, ComposesRotationsUpToTheFourthOrder) {
  const double coarse = composition_error(0.8f), fine = composition_error(0.4f);
  EXPECT_LT(fine, 0.4 * 0.4 * 0.4 * 0.4 / 24.0);
  EXPECT_NEAR(std::log2(coarse / fine), 4.0, 0.3);
}

TEST(MotionKernel, FreeBodyConservesAngularMomentum) {
  Random random;
  for (int round = 0; round < 50; ++round) {
    const Vec3 moments{random.between(1.0f, 2.0f), random.between(1.0f, 2.0f), random.between(0.1f, 1.0f)};
    const Quat start =
        normalized(Quat{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), 1.5f});
    Crowd crowd;
    crowd.add(moments, start).pose_read = true;
    const Vec3 spin = random.vector(10.0f);
    crowd.motion[0].angular_velocity = spin;
    crowd.prepare(1);
    const Vec3 momentum = rotate_inertia(to_matrix(start), crowd.bodies[0].inertia) * spin;
    for (int i = 0; i < 4; ++i) crowd.integrate_positions(1.0f / 240.0f);
    const Sym3 inertia = rotate_inertia(to_matrix(crowd.orientations[0]), crowd.bodies[0].inertia);
    const Vec3 now = inertia * crowd.motion[0].angular_velocity;
    EXPECT_LT(length(now - momentum), 3e-6f * length(momentum)) << "round " << round;
    // It rotated, and its rotation vector matches its orientation.
    const Quat pose_read = crowd.orientations[0];
    const DQuat turned =
        product(exponential(crowd.motion[0].delta_rotation), {start.x, start.y, start.z, start.w});
    EXPECT_LT(angle_between(turned, {pose_read.x, pose_read.y, pose_read.z, pose_read.w}), 1e-6);
    EXPECT_GT(length(crowd.motion[0].angular_velocity - spin), 1e-4f * length(spin));
  }
}

TEST(MotionKernel, SpeedsAreLimitedWithoutOverflow) {
  const float most = std::numeric_limits<float>::max();
  Crowd crowd;
  crowd.add({1, 1, 1}, {}).velocity_gain = {most, most, 0};
  crowd.bodies[0].torque = {0, 0, -most};
  crowd.add({1, 1, 1}, {}).velocity_gain = {3, 4, 0};
  crowd.prepare(1);
  crowd.integrate_velocities(false);
  const Vec3 v = crowd.motion[0].linear_velocity, w = crowd.motion[0].angular_velocity;
  EXPECT_NEAR(length(v) / kMaxSpeed, 1.0f, 1e-6f);
  EXPECT_EQ(v.x, v.y);
  EXPECT_EQ(w, (Vec3{0, 0, -kMaxSpin}));
  EXPECT_EQ(crowd.motion[1].linear_velocity, (Vec3{3, 4, 0}));
}

TEST(MotionKernel, RepeatsTheEffectOfContacts) {
  Crowd crowd;
  crowd.add({1, 1, 1}, {}).velocity_gain = {0, -1, 0};
  crowd.prepare(1);
  crowd.integrate_velocities(true);
  EXPECT_EQ(crowd.motion[0].linear_velocity, (Vec3{0, -1, 0}));
  // A contact stops it; twice, as iterations do.
  crowd.motion[0].linear_velocity = {0, -0.25f, 0};
  crowd.add_contact_change();
  crowd.motion[0].linear_velocity = {0, 0, 0};
  crowd.motion[0].angular_velocity = {0, 0, 2};
  crowd.integrate_positions(0.25f);
  EXPECT_EQ(crowd.motion[0].delta_rotation, (Vec3{0, 0, 0.5f}));
  crowd.integrate_velocities(true);
  EXPECT_EQ(crowd.motion[0].linear_velocity, (Vec3{0, 0, 0}));
  EXPECT_EQ(crowd.motion[0].angular_velocity, (Vec3{0, 0, 4}));
}

TEST(MotionKernel, LockedAxesStayStill) {
  Crowd crowd;
  crowd.add({1, 1, 1}, {}).velocity_gain = {1, -2, 3};
  crowd.bodies[0].locked = 2;
  crowd.prepare(1);
  crowd.integrate_velocities(false);
  crowd.motion[0].linear_velocity.y = -7;
  crowd.integrate_positions(0.5f);
  EXPECT_EQ(crowd.motion[0].delta_position, (Vec3{0.5f, 0, 1.5f}));
}

TEST(MotionKernel, RoundingAlongALockedAxisIsNoEffectOfContacts) {
  Crowd crowd;
  crowd.add({1, 1, 1}, {}).locked = 1;
  crowd.prepare(1);
  crowd.integrate_velocities(true);
  crowd.motion[0].linear_velocity = {1.0e-9f, 2, 0};
  crowd.add_contact_change();
  crowd.integrate_velocities(true);
  EXPECT_EQ(crowd.motion[0].linear_velocity, (Vec3{0, 4, 0}));
}

TEST(MotionKernel, ProjectionMovesWithoutTouchingVelocities) {
  Crowd crowd;
  crowd.add({1, 1, 1}, {}).bounding_radius = 2.0f;
  crowd.motion[0].linear_velocity = {1, 2, 3};
  crowd.motion[0].angular_velocity = {4, 5, 6};
  crowd.prepare(1);
  crowd.begin_projection();
  EXPECT_EQ(crowd.motion[0].linear_velocity, (Vec3{}));
  crowd.motion[0].linear_velocity = {0, 0.25f, 0};
  crowd.motion[0].angular_velocity = {0, 0, 0.125f};
  crowd.end_projection();
  EXPECT_EQ(crowd.motion[0].linear_velocity, (Vec3{1, 2, 3}));
  EXPECT_EQ(crowd.motion[0].angular_velocity, (Vec3{4, 5, 6}));
  EXPECT_EQ(crowd.motion[0].delta_position, (Vec3{0, 0.25f, 0}));
  EXPECT_EQ(crowd.motion[0].delta_rotation, (Vec3{0, 0, 0.125f}));
  EXPECT_EQ(crowd.motion[0].pushout, 0.5f);  // 0.25 m and 2 m times 0.125 rad
  EXPECT_EQ(crowd.rotations[0], (Vec3{0, 0, 0.125f}));
}

// Bodies of every kind.
Crowd make_crowd(Random& random) {
  Crowd crowd;
  for (int i = 0; i < 37; ++i) {
    const float moment = random.between(0.5f, 2.0f);
    const bool round = i % 3 == 0;
    const Vec3 moments =
        round ? Vec3{moment, moment, moment} : Vec3{moment, random.between(0.5f, 2.0f), 1.0f};
    MovedBody& body = crowd.add(
        moments, normalized(Quat{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), 1.5f}));
    body.velocity_gain = random.vector(1.0f);
    if (i % 4 == 1) body.torque = random.vector(5.0f);
    if (i % 5 == 2) body.linear_loss = 0.01f, body.angular_loss = 0.02f;
    body.locked = i % 7 == 3 ? 5 : 0;
    body.needs_exact_rotation = i % 11 == 4;
    body.pose_read = i % 2 == 0;
    body.bounding_radius = 0.5f;
    crowd.motion[std::size_t(i)].linear_velocity = random.vector(10.0f);
    crowd.motion[std::size_t(i)].angular_velocity = random.vector(20.0f);
  }
  return crowd;
}
// Whole sub-steps in blocks of `width`.
Crowd move_crowd(int width) {
  Random random;
  Crowd crowd = make_crowd(random);
  crowd.prepare(width);
  for (int substep = 0; substep < 4; ++substep) {
    crowd.integrate_velocities(true);
    for (BodyMotion& m : crowd.motion) m.linear_velocity = m.linear_velocity + random.vector(0.1f);
    crowd.integrate_positions(1.0f / 240.0f);
    crowd.warm_start();
    crowd.begin_projection();
    for (BodyMotion& m : crowd.motion) m.angular_velocity = random.vector(0.01f);
    crowd.end_projection();
  }
  return crowd;
}

void expect_same_bits(const Crowd& a, const Crowd& b, int width) {
  EXPECT_EQ(std::memcmp(a.motion.data(), b.motion.data(), b.motion.size() * sizeof(BodyMotion)), 0) << width;
  EXPECT_EQ(std::memcmp(a.inertia.data(), b.inertia.data(), b.inertia.size() * sizeof(BodyInertia)), 0)
      << width;
  EXPECT_EQ(a.orientations, b.orientations) << width;
  EXPECT_EQ(a.rotations, b.rotations) << width;
}

TEST(MotionKernel, EveryWidthHasTheBitsOfWidthOne) {
  const Crowd narrow = move_crowd(1);
  for (const int width : {4, 8, 16}) expect_same_bits(move_crowd(width), narrow, width);
}

// Lanes with a gap of one vector between blocks; the effect of contacts comes from the records.
class Lanes {
 public:
  Lanes(Crowd& crowd, int width)
      : crowd_(crowd),
        width_(width),
        floats_(std::size_t((7 * crowd.blocks + 1) * width)),
        velocities_(make()) {}

  const LaneVelocities& velocities() const { return velocities_; }
  void store() const {
    for (std::size_t i = 0; i < crowd_.motion.size(); ++i) {
      const float* const from = velocities_.of(int(i) / width_) + int(i) % width_;
      float* const to = &crowd_.motion[i].linear_velocity.x;
      for (int component = 0; component < 6; ++component) to[component] = from[component * width_];
    }
  }

 private:
  LaneVelocities make() {
    void* at = floats_.data();
    std::size_t room = floats_.size() * sizeof(float);
    return {static_cast<float*>(std::align(std::size_t(width_) * sizeof(float), 1, at, room)),
            std::size_t(7 * width_), 0};
  }

  Crowd& crowd_;
  int width_;
  std::vector<float> floats_;
  LaneVelocities velocities_;
};

// From contacts to contacts, with velocities in lanes or in records.
Crowd run_half_steps(int width, bool in_lanes) {
  Random random;
  Crowd crowd = make_crowd(random);
  crowd.prepare(width);
  const Lanes lanes(crowd, width);
  const MotionKernels& kernels = *crowd.kernels;
  const MotionArrays arrays{crowd.motion.data(), crowd.inertia.data(), crowd.orientations.data()};
  kernels.start_contact_change(crowd.place(), 0, crowd.blocks, arrays.motion);
  for (int part = 0; part < 5; ++part) {
    const float h = 1.0f / 240.0f;
    for (BodyMotion& m : crowd.motion) m.linear_velocity = m.linear_velocity + random.vector(0.1f);
    if (in_lanes) {
      kernels.add_contact_change_in_lanes(crowd.place(), 0, crowd.blocks, arrays.motion, lanes.velocities());
      kernels.integrate_positions_in_lanes(crowd.place(), 0, crowd.blocks, arrays, lanes.velocities(), h);
      kernels.integrate_velocities_in_lanes(crowd.place(), 0, crowd.blocks, lanes.velocities(), true,
                                            part % 2 == 0);
      if (part % 2 != 0)
        kernels.start_contact_change_in_lanes(crowd.place(), 0, crowd.blocks, lanes.velocities());
      lanes.store();
    } else {
      kernels.add_contact_change(crowd.place(), 0, crowd.blocks, arrays.motion);
      kernels.integrate_positions(crowd.place(), 0, crowd.blocks, arrays, h, false);
      kernels.integrate_velocities(crowd.place(), 0, crowd.blocks, arrays.motion, true, part % 2 == 0);
      if (part % 2 != 0) kernels.start_contact_change(crowd.place(), 0, crowd.blocks, arrays.motion);
    }
  }
  return crowd;
}

TEST(MotionKernel, VelocitiesInLanesHaveTheBitsOfThoseInRecords) {
  if (select_kernels(8).width < 8) GTEST_SKIP() << "this processor has fewer than eight lanes";
  for (const int asked : {8, 16}) {
    const int width = select_kernels(asked).width;
    expect_same_bits(run_half_steps(width, true), run_half_steps(width, false), width);
  }
}

}  // namespace
}  // namespace gyre::motion_kernel_test
