// Projection side by side against projection one by one by Newton's method on rows: both end with joints and
// limits satisfied and in similar poses; each lane has the same bits whatever stands beside it.
#include "rigid/continuous/ccd_joint_projection_simd.h"

#include "math/rotation.h"
#include "rigid/continuous/ccd_joint_projection_rows.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace gyre::ccd_joint_projection_simd_test {
namespace {

constexpr int kLinks = 5;
constexpr float kHalf = 0.2f, kMaxSwing = 0.1f;

// Chains along x, each 3 m further along z, that move along y and rotate a little: joined by a ball, by a
// cone with a swing of 0.1 rad, by a hinge about z, and by a joint of the test. The third link of each is
// halted.
class ChainsAfterImpact : public ::testing::Test {
 protected:
  void add_chain(JointKind last = JointKind::ball) {
    const int chain = int(stopped_.size());
    for (int i = 0; i < kLinks; ++i) add_link({double(i) * 2.0 * double(kHalf), 0.0, 3.0 * chain});
    const std::int32_t first = chain * kLinks;
    const Quat about_z = from_axis_angle({0, 1, 0}, -0.5f * kPi);
    add_joint(JointKind::ball, first, {});
    add_joint(JointKind::cone, first + 1, {});
    add_joint(JointKind::hinge, first + 2, about_z);
    add_joint(last, first + 3, {});
    const std::uint32_t body = std::uint32_t(first) + 2;
    BodyMotion& motion = world_.bodies.motion[body];
    stopped_.push_back({body, 0.3f, motion.delta_position, motion.delta_rotation});
    motion.delta_position = 0.3f * motion.delta_position;
  }
  std::span<const std::uint8_t> project_batched(std::size_t chains) {
    begin(chains);
    return gyre::project_batched(world_, groups_, bodies_, false, select_kernels(8), tasks_, arena_);
  }
  void project_by_rows() {
    begin(stopped_.size());
    for (const ProjectionGroup& group : groups_)
      ASSERT_TRUE(gyre::project_by_rows(world_, group, bodies_, false, arena_));
  }
  DVec3 place(std::size_t body) const {
    return world_.bodies.poses[body].center + DVec3(bodies_.motion[body].delta_position);
  }
  // The gap of the joint, and the swing of the cone.
  double gap(const JointRecord& joint) const {
    const auto end = [&](std::int32_t body, Vec3 anchor) {
      return place(std::size_t(body)) + DVec3(rotate(bodies_.orientations[std::size_t(body)], anchor));
    };
    return length(end(joint.body_a, joint.local_anchor_a) - end(joint.body_b, joint.local_anchor_b));
  }
  double lean(const JointRecord& joint) const {
    const auto axis = [&](std::int32_t body) {
      return rotate(bodies_.orientations[std::size_t(body)], Vec3{1, 0, 0});
    };
    return std::asin(double(length(cross(axis(joint.body_a), axis(joint.body_b)))));
  }
  void expect_closed() const {
    for (const JointRecord& joint : world_.joints.records) {
      EXPECT_LT(gap(joint), 1.0e-3);
      if (joint.kind != JointKind::cone) continue;
      EXPECT_LT(lean(joint), double(kMaxSwing) + 1.0e-3);
    }
  }

  RigidWorld world_;
  float spread_ = 0.0f;  // difference of the displacement of successive chains, as a share of the first's
  std::vector<HaltedBody> stopped_;
  ProjectionBodies bodies_;
  TaskSystem tasks_{1};
  Arena arena_;

 private:
  void add_link(DVec3 at) {
    BodyStore& store = world_.bodies;
    const std::uint32_t body = add_body_slot(store).index;
    store.flags[body].type = BodyType::dynamic;
    store.flags[body].awake = 1;
    BodyMass mass;
    mass.mass = 1.0f, mass.inverse_mass = 1.0f;
    mass.inertia = {.xx = 0.005f, .yy = 0.015f, .zz = 0.015f, .xy = 0, .xz = 0, .yz = 0};
    mass.inverse_inertia = inverse(mass.inertia);
    mass.bounding_radius = kHalf, mass.size = 0.05f;
    store.masses.set(body, mass);
    store.poses[body] = {at, {}};
    const float share = 1.0f + spread_ * float(body / kLinks);
    store.motion[body].delta_position = share * Vec3{0, 0.1f + 0.002f * float(body % kLinks), 0.01f};
    store.motion[body].delta_rotation = share * Vec3{0.05f, 0, 0};
    store.orientations[body] = from_rotation_vector(store.motion[body].delta_rotation);
  }
  void add_joint(JointKind kind, std::int32_t a, Quat frame) {
    const std::uint32_t slot = std::uint32_t(world_.joints.records.size());
    JointRecord joint;
    joint.kind = kind, joint.body_a = a, joint.body_b = a + 1;
    joint.local_anchor_a = {kHalf, 0, 0}, joint.local_anchor_b = {-kHalf, 0, 0};
    joint.local_frame_a = joint.local_frame_b = frame;
    world_.joints.records.push_back(joint);
    JointDetail detail;
    detail.used = kind == JointKind::cone;
    detail.swing_y = detail.swing_z = kMaxSwing;
    for (const JointAxis axis : {JointAxis::angular_x, JointAxis::angular_y}) {
      detail.axes[int(axis)].motion = AxisMotion::limited;
      detail.axes[int(axis)].limits = {-0.3f, 0.3f};
    }
    detail.has_swing = true;
    world_.joints.details.push_back(detail);
    for (const std::int32_t body : {a, a + 1})
      make_joints_of(world_.bodies, std::uint32_t(body)).push_back(slot);
  }
  void begin(std::size_t chains) {
    const std::size_t count = world_.bodies.motion.size();
    bodies_ = {arena_.make<BodyMotion>(count), arena_.make<BodyInertia>(count), arena_.make<Quat>(count)};
    groups_ = find_projection_groups(world_, std::span(stopped_).first(chains), arena_);
  }

  std::span<ProjectionGroup> groups_;
};

TEST_F(ChainsAfterImpact, SatisfyJointsAndLimitsAsByRows) {
  for (int i = 0; i < 3; ++i) add_chain();
  for (const std::uint8_t led : project_batched(3)) EXPECT_EQ(led, 1);
  expect_closed();
  std::vector<DVec3> places;
  for (std::size_t i = 0; i < world_.bodies.motion.size(); ++i) places.push_back(place(i));
  project_by_rows();
  expect_closed();
  for (std::size_t i = 0; i < places.size(); ++i) EXPECT_LT(length(place(i) - places[i]), 2.0e-3) << i;
  // The ends move on, the halted link hardly.
  EXPECT_GT(places[0].y, 0.08);
  EXPECT_LT(places[2].y, 0.05);
}

TEST_F(ChainsAfterImpact, HaveTheSameBitsInAnyLane) {
  spread_ = 1.0f;  // lanes end one after the other
  for (int i = 0; i < 5; ++i) add_chain();
  project_batched(1);
  const ProjectionBodies alone = bodies_;
  project_batched(5);
  for (std::size_t i = 0; i < kLinks; ++i) {
    EXPECT_EQ(std::memcmp(&alone.motion[i].delta_position, &bodies_.motion[i].delta_position, sizeof(Vec3)),
              0)
        << i;
    EXPECT_EQ(std::memcmp(&alone.orientations[i], &bodies_.orientations[i], sizeof(Quat)), 0) << i;
  }
}

TEST_F(ChainsAfterImpact, WithOtherJointsByRows) {
  add_chain();
  add_chain(JointKind::fixed);
  const std::span<const std::uint8_t> led = project_batched(2);
  EXPECT_EQ(led[0], 1);
  EXPECT_EQ(led[1], 0);
  project_by_rows();
  expect_closed();
}

}  // namespace
}  // namespace gyre::ccd_joint_projection_simd_test
