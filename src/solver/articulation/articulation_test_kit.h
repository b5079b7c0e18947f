// Crowds of articulations for tests of their lanes (solver/articulation/articulation_lanes.h): each copy has
// a state of its own and is solved one by one and side by side.
#pragma once

#include "base/arena/arena.h"
#include "math/rotation.h"
#include "math/trig.h"
#include "solver/articulation/articulation.h"
#include "solver/articulation/articulation_drives.h"
#include "solver/articulation/articulation_limits.h"
#include "solver/articulation/lane_transfer.h"
#include "solver/kernels/solver_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

namespace gyre::articulation_test {

inline constexpr int kBodies = 6, kJoints = 6, kCopies = 7;
inline constexpr float kSubstep = 1.0f / 480.0f;
inline const JointSettings kSettings{kSubstep, {40.0f, 0.96f, 0.04f}, false};

struct Random {
  std::uint32_t state;
  float next() {  // -1 to 1
    state = state * 1664525u + 1013904223u;
    return float(state >> 8) / float(1 << 23) - 1.0f;
  }
  Vec3 vector(float size) { return {size * next(), size * next(), size * next()}; }
};

// The articulation: from the world a hinge with limits, cones with and without limits, a ball, a hinge
// without limits, and a second ball between the same two bodies, which makes a loop.
struct Member {
  JointKind kind;
  std::int32_t a, b;
  bool limits;
};
inline constexpr Member kMembers[kJoints] = {
    {JointKind::hinge, kNoBody, 0, true}, {JointKind::cone, 0, 1, true},  {JointKind::ball, 1, 2, false},
    {JointKind::hinge, 3, 1, false},      {JointKind::cone, 0, 4, false}, {JointKind::ball, 1, 2, false}};

// Drives of most of its joints: iterative ones (drives, motors with a frequency and friction); or motors of
// hinges without a frequency, which are solved with the equations, with no limit near.
enum class Driven : std::uint8_t { no, iterative, motors };

// Several copies of that articulation, each in a state of its own, and the data of a step.
struct Crowd {
  Arena arena;
  std::vector<BodyMotion> motion{std::size_t(kBodies * kCopies)};
  std::vector<BodyInertia> inertia{std::size_t(kBodies * kCopies)};
  std::vector<Quat> orientation{std::size_t(kBodies * kCopies)};
  std::vector<JointRecord> records{std::size_t(kJoints * kCopies)};
  std::vector<JointDetail> details{std::size_t(kJoints * kCopies)};
  std::vector<JointConstraint> work{std::size_t(kJoints * kCopies)};
  std::vector<JointOffsets> offsets{std::size_t(kJoints * kCopies)};
  Driven driven;

  explicit Crowd(float tension, Driven by = Driven::no) : driven(by) {
    Random random{12345};
    for (std::size_t i = 0; i < motion.size(); ++i) {
      motion[i].linear_velocity = random.vector(3.0f);
      motion[i].angular_velocity = random.vector(8.0f);
      motion[i].inverse_mass = inertia[i].inverse_mass = 1.0f + 0.5f * random.next();
      motion[i].delta_position = random.vector(0.01f);
      inertia[i].inverse = {.xx = 20 + random.next(),
                            .yy = 30 + random.next(),
                            .zz = 25 + random.next(),
                            .xy = random.next(),
                            .xz = random.next(),
                            .yz = random.next()};
      orientation[i] = from_rotation_vector(random.vector(1.0f));
    }
    for (std::size_t i = 0; i < records.size(); ++i) set_joint(i, random, tension);
    for (std::size_t i = 0; driven != Driven::no && i < records.size(); ++i) drive_joint(i, random);
    if (driven == Driven::motors) open_limits();
    for (std::size_t i = 0; i < records.size(); ++i)
      begin_joint(records[i], detail_of(i), {}, work[i], 1.0f, arena);
  }

  void set_joint(std::size_t i, Random& random, float tension) {
    const Member& member = kMembers[i % kJoints];
    const std::int32_t first = std::int32_t(i) / kJoints * kBodies;
    JointRecord& joint = records[i];
    joint.kind = member.kind;
    joint.body_a = member.a == kNoBody ? kNoBody : first + member.a;
    joint.body_b = first + member.b;
    joint.local_anchor_a = random.vector(0.3f);
    joint.local_anchor_b = random.vector(0.3f);
    joint.local_frame_a = from_rotation_vector(random.vector(0.3f));
    joint.local_frame_b = from_rotation_vector(random.vector(0.3f));
    joint.linear_impulse = random.vector(tension);
    const Quat a = joint.body_a == kNoBody ? Quat{} : orientation[std::size_t(joint.body_a)];
    const Quat b = orientation[std::size_t(joint.body_b)];
    if (joint.kind == JointKind::hinge) {  // near its target
      joint.local_frame_b =
          conjugate(b) * (from_rotation_vector(random.vector(0.02f)) * a * joint.local_frame_a);
      joint.angular_impulse = random.vector(0.01f);
    }
    const Vec3 moved = motion[std::size_t(joint.body_b)].delta_position -
                       (joint.body_a == kNoBody ? Vec3{} : motion[std::size_t(joint.body_a)].delta_position);
    offsets[i].offset =
        rotate(a, joint.local_anchor_a) - rotate(b, joint.local_anchor_b) - moved + random.vector(0.002f);
    if (!member.limits) return;
    joint.has_limits = true;
    joint.limits = {-0.2f, 0.1f + 0.2f * random.next()};
    joint.low_impulse = 0.003f;
    JointDetail& detail = details[i];
    detail.swing_y = 0.4f;
    detail.swing_z = 0.7f;
    for (const JointAxis axis : {JointAxis::angular_x, JointAxis::angular_y}) {
      if (joint.kind == JointKind::hinge) break;
      detail.axes[int(axis)].motion = AxisMotion::limited;
      detail.axes[int(axis)].limits = joint.limits;
      detail.axes[int(axis)].high_impulse = 0.002f;
    }
  }
  // It takes some 0.3 N m s to stop a body: in the first copies friction holds and drives are strong, in the
  // last ones they are weak.
  void drive_joint(std::size_t i, Random& random) {
    const std::size_t member = i % kJoints;
    const float strength = 8.0f / (1.0f + 3.0f * float(i / kJoints));
    JointRecord& joint = records[i];
    JointDetail& detail = details[i];
    if (joint.kind == JointKind::hinge) {
      joint.motor_force = 100.0f * strength;
      joint.motor_velocity = 3.0f * random.next();
      joint.motor_impulse = 0.01f * random.next();
      joint.has_motor_target = kMembers[member].limits;
      joint.motor_position = random.next();
      if (driven == Driven::motors) return;
      joint.motor_frequency = 6.0f;
      JointAxisRecord& axis = detail.axes[int(JointAxis::angular_x)];
      if (!kMembers[member].limits) return;
      axis.friction = 60.0f * strength;
      axis.friction_impulse = 0.01f * random.next();
      return;
    }
    if (member == kJoints - 1 || driven == Driven::motors) return;
    detail.friction = 120.0f * strength;
    detail.friction_impulse = random.vector(0.01f);
    if (member != 1) return;
    detail.drive.max_torque = 400.0f * strength;
    detail.drive.frequency = i / kJoints % 2 == 0 ? 0.0f : 8.0f;
    detail.drive.orientation = from_rotation_vector(random.vector(1.5f));
    detail.drive.angular_velocity = random.vector(2.0f);
    detail.drive_torque_impulse = random.vector(0.01f);
  }
  // None is near its limits.
  void open_limits() {
    for (JointRecord& joint : records) joint.limits = {-10.0f, 10.0f}, joint.low_impulse = 0.0f;
    for (JointDetail& detail : details) {
      detail.swing_y = detail.swing_z = kPi;
      for (JointAxisRecord& axis : detail.axes) axis.limits = {-10.0f, 10.0f}, axis.high_impulse = 0.0f;
    }
  }
  JointDetail* detail_of(std::size_t i) {
    const Member& member = kMembers[i % kJoints];
    return driven != Driven::no || (member.limits && member.kind != JointKind::hinge) ? &details[i] : nullptr;
  }

  ArticulationSolve solve() {
    return {.records = records,
            .work = work,
            .offsets = offsets,
            .bodies = {motion.data(), inertia.data(), orientation.data()},
            .settings = kSettings,
            .compliance = 1.0e-4f};
  }
};

// The plan and the couplings, in scalar form and in that of lanes.
struct Shape {
  Arena arena;
  BlockPlan plan;
  std::vector<ArticulationCoupling> couplings;
  std::vector<LaneCoupling> lane_couplings;
  std::vector<LaneNode> nodes{std::size_t(kJoints)};

  Shape() {
    std::vector<std::uint8_t> sizes;
    std::vector<BlockEdge> edges;
    for (const Member& m : kMembers) sizes.push_back(m.kind == JointKind::hinge ? 5 : 3);
    for (std::uint32_t i = 0; i < kJoints; ++i) {
      for (std::uint32_t j = 0; j < i; ++j) {
        for (const std::int32_t body : {kMembers[i].a, kMembers[i].b}) {
          if (body == kNoBody || (kMembers[j].a != body && kMembers[j].b != body)) continue;
          edges.push_back({i, j});
          couplings.push_back({i, j, 0, body, kMembers[i].b == body, kMembers[j].b == body});
        }
      }
    }
    EXPECT_TRUE(plan_blocks(sizes, edges, 100000, arena, plan));
    for (ArticulationCoupling& c : couplings) {
      const BlockLocation block = find_block(plan, c.row, c.column);
      if (!block.first_is_row) c = {c.column, c.row, 0, c.body, c.column_has_b, c.row_has_b};
      c.offset = block.offset;
      const bool is_first = std::none_of(lane_couplings.begin(), lane_couplings.end(),
                                         [&](const LaneCoupling& other) { return other.offset == c.offset; });
      lane_couplings.push_back(
          {c.row, c.column, c.offset, std::uint32_t(c.body), c.row_has_b, c.column_has_b, is_first});
    }
    for (std::size_t i = 0; i < kJoints; ++i) {
      LaneNode& node = nodes[i];
      node.a = kMembers[i].a == kNoBody ? kBodies : std::uint32_t(kMembers[i].a);
      node.b = std::uint32_t(kMembers[i].b);
      node.rows = sizes[i];
      node.row = plan.columns[plan.index_of[i]].row;
      node.column = plan.index_of[i];
      node.diagonal = plan.columns[plan.index_of[i]].diagonal;
    }
  }
};

inline void solve_one_by_one(Crowd& crowd, const Shape& shape) {
  ArticulationSolve solve = crowd.solve();
  std::vector<double> limit_room(limits_room(shape.plan.rows, kBodies));
  solve.room = limit_room;
  for (int copy = 0; copy < kCopies; ++copy) {
    std::vector<ArticulationNode> nodes{std::size_t(kJoints)};
    std::vector<ArticulationBody> bodies{std::size_t(kBodies)};
    std::vector<ArticulationCoupling> couplings = shape.couplings;
    std::vector<double> values(shape.plan.values), room(factor_room(shape.plan)), vector(shape.plan.rows);
    for (int i = 0; i < kBodies; ++i) bodies[std::size_t(i)].body = copy * kBodies + i;
    for (ArticulationCoupling& c : couplings) c.body += copy * kBodies;
    for (int i = 0; i < kJoints; ++i) {
      ArticulationNode& node = nodes[std::size_t(i)];
      node.record = node.work = std::uint32_t(copy * kJoints + i);
      node.body_a = crowd.records[node.record].body_a;
      node.body_b = crowd.records[node.record].body_b;
      node.side_a = kMembers[i].a == kNoBody ? -1 : kMembers[i].a;
      node.side_b = kMembers[i].b;
      node.count = int(shape.nodes[std::size_t(i)].rows);
    }
    Articulation articulation{nodes, bodies, couplings, shape.plan, values, room, vector, true};
    std::vector<DrivenAxis> axes;
    for (std::uint32_t i = 0; crowd.driven == Driven::motors && i < kJoints; ++i) {
      if (kMembers[i].kind != JointKind::hinge) continue;
      axes.push_back({i, &crowd.work[nodes[i].work].axes[0]});
      axes.back().axis->in_articulation = true;
    }
    articulation.axes = axes;
    std::vector<double> axis_room(drives_room(articulation, axes.size()));
    articulation.axis_room = axis_room;
    for (int part = 0; part < 2; ++part) {
      prepare_articulation(articulation, solve);
      warm_start_articulation(articulation, solve);
      solve_articulation(articulation, solve);
      solve_articulation_after_contacts(articulation, solve);
    }
    relax_articulation(articulation, solve);
  }
  for (std::size_t i = 0; i < crowd.records.size(); ++i) finish_joint(crowd.records[i], crowd.work[i]);
}

// Changes between the two half steps of solve_side_by_side.
struct Between {
  float turn = 0.0f;    // rad: rotation of the second body of every other copy
  bool forget = false;  // only impulses remain of the first half step
  // The stage between the half steps: none, that between half steps, or that at the end of a step.
  enum class Ends : std::uint8_t { no, passes, finishes } ends = Ends::no;
  bool computes_bias = true;  // the bias of the second half step is computed by itself too
};

// The bundle of one block of lanes.
inline ArticulationBundle make_bundle(Shape& shape, const ArticulationKernels& kernels, Arena& arena) {
  const std::size_t lanes = std::size_t(kernels.width);
  ArticulationBundle bundle;
  bundle.kernels = &kernels;
  bundle.nodes = shape.nodes.data();
  bundle.couplings = shape.lane_couplings.data();
  bundle.node_count = kJoints;
  bundle.coupling_count = std::uint32_t(shape.lane_couplings.size());
  bundle.body_count = kBodies + 1;
  bundle.moving_count = kBodies;
  bundle.columns = shape.plan.columns.data();
  bundle.entries = shape.plan.entries.data();
  bundle.targets = shape.plan.targets.data();
  bundle.column_count = kJoints;
  bundle.value_count = shape.plan.values;
  bundle.row_count = shape.plan.rows;
  bundle.has_fill = true;
  for (LaneNode& node : shape.nodes) {
    bundle.limit_count += (node.has_twist ? 1 : 0) + (node.has_swing ? 1 : 0) + (node.has_servo ? 1 : 0);
    if (node.is_driven()) node.drives = bundle.drive_count++;
    if (node.has_servo) node.servo = bundle.servo_count++;
    bundle.has_drives = bundle.has_drives || node.has_drive || node.has_servo;
  }
  bundle.bodies = arena.make<std::byte>((kBodies + 1) * kernels.body_bytes).data();
  bundle.joints = arena.make<std::byte>(kJoints * kernels.joint_bytes).data();
  bundle.drives = arena.make<std::byte>(bundle.drive_count * kernels.drives_bytes).data();
  bundle.servos = arena.make<std::byte>(bundle.servo_count * kernels.servo_bytes).data();
  bundle.values = arena.make<float>(lanes * shape.plan.values).data();
  bundle.energy_gain = arena.make<float>(2 * lanes).data();
  bundle.has_extreme_mass_ratio = arena.make<float>(lanes).data();
  for (int lane = 0; lane < kernels.width; ++lane) bundle.has_extreme_mass_ratio[lane] = 0.0f;
  bundle.vector = arena.make<float>(lanes * shape.plan.rows).data();
  bundle.room = arena.make<float>(lanes * shape.plan.widest).data();
  bundle.is_factored = arena.make<bool>(1).data();
  bundle.limits = arena.make<std::byte>(kernels.limit_room(bundle)).data();
  return bundle;
}

inline void solve_side_by_side(Crowd& crowd, Shape& shape, const ArticulationKernels& kernels,
                               const Between& between) {
  const ArticulationSolve solve = crowd.solve();
  const LaneArrays arrays{crowd.motion.data(), crowd.inertia.data(), crowd.orientation.data()};
  const LaneSettings settings{kSubstep, kSettings.softness.bias_rate, solve.compliance,
                              add_geometric_stiffness};
  const LaneStart start{.substep = kSubstep, .softness = kSettings.softness};
  for (std::size_t i = 0; i < kJoints; ++i)
    ASSERT_TRUE(fits_lane(crowd.records[i], crowd.detail_of(i), start, shape.nodes[i]));
  Arena arena;
  const ArticulationBundle bundle = make_bundle(shape, kernels, arena);
  for (int first = 0; first < kCopies; first += kernels.width) {
    const int used = std::min(kernels.width, kCopies - first);
    clear_lanes(bundle);
    kernels.begin(bundle);
    const auto for_each_joint = [&](auto&& call) {
      for (int lane = 0; lane < used; ++lane) {
        for (std::uint32_t n = 0; n < kJoints; ++n) call(lane, n, std::size_t(first + lane) * kJoints + n);
      }
    };
    for_each_joint([&](int lane, std::uint32_t n, std::size_t i) {
      load_lane(bundle, lane, n, crowd.records[i], crowd.detail_of(i), crowd.offsets[i].offset, start);
      set_lane_body(bundle, lane, shape.nodes[n].a, crowd.records[i].body_a, false);
      set_lane_body(bundle, lane, shape.nodes[n].b, crowd.records[i].body_b, false);
    });
    for (int part = 0; part < 2; ++part) {
      if (part == 1) {
        if (between.ends == Between::Ends::passes) {
          kernels.prepare(bundle, arrays, settings);
          kernels.end_half_step(bundle, arrays, settings);
        }
        if (between.ends == Between::Ends::finishes) kernels.end_step(bundle, arrays, settings);
        for (int copy = first + (first + 1) % 2; copy < first + used; copy += 2) {
          Quat& body = crowd.orientation[std::size_t(copy * kBodies + 1)];
          body = from_rotation_vector({between.turn, 0, 0}) * body;
        }
        if (between.forget) kernels.begin(bundle);
      }
      // end_half_step follows preparation, and computes the bias.
      const bool passed = part == 1 && between.ends == Between::Ends::passes;
      if (!passed) kernels.prepare(bundle, arrays, settings);
      if (!passed || between.computes_bias) kernels.compute_bias(bundle, arrays, settings);
      kernels.solve(bundle, arrays, settings);
      kernels.solve_after_contacts(bundle, arrays, settings);
    }
    kernels.end_step(bundle, arrays, settings);
    for_each_joint([&](int lane, std::uint32_t n, std::size_t i) {
      store_lane(bundle, lane, n, crowd.records[i], crowd.detail_of(i));
    });
  }
}
inline void solve_side_by_side(Crowd& crowd, Shape& shape, int width, const Between& between = {}) {
  solve_side_by_side(crowd, shape, select_kernels(width).articulations, between);
}

inline double apart(Vec3 a, Vec3 b) { return double(length(a - b)); }

// Rounding to float in some ten solves of a system with a condition of about a thousand.
inline constexpr double kRounding = 2.0e-4;

// Difference of the second half step's bias with or without the speeds of error removal in the first, some
// 0.8 rad/s beside 8, as rad/s over a half step.
inline constexpr double kLeftOver = 0.8 * 8.0 * double(kSubstep);

// `times`: allowed difference as a multiple of rounding.
inline void expect_same(const Crowd& one, const Crowd& other, double times = 1.0) {
  const double rounding = times * kRounding;
  for (std::size_t i = 0; i < one.motion.size(); ++i) {
    EXPECT_LT(apart(one.motion[i].linear_velocity, other.motion[i].linear_velocity), 3.0 * rounding)
        << "body " << i;
    EXPECT_LT(apart(one.motion[i].angular_velocity, other.motion[i].angular_velocity), 8.0 * rounding)
        << "body " << i;
  }
  for (std::size_t i = 0; i < one.records.size(); ++i) {
    const JointRecord &a = one.records[i], &b = other.records[i];
    if (i % kJoints != 2 && i % kJoints != 5) {  // the two balls that share their load by compliance alone
      EXPECT_LT(apart(a.linear_impulse, b.linear_impulse), 3.0 * rounding) << "joint " << i;
      EXPECT_LT(apart(a.total_linear, b.total_linear), 3.0 * rounding) << "joint " << i;
    }
    EXPECT_LT(apart(a.angular_impulse, b.angular_impulse), rounding) << "joint " << i;
    EXPECT_LT(apart(a.total_angular, b.total_angular), rounding) << "joint " << i;
    EXPECT_NEAR(double(a.low_impulse), double(b.low_impulse), rounding) << "joint " << i;
    EXPECT_NEAR(double(a.high_impulse), double(b.high_impulse), rounding) << "joint " << i;
    EXPECT_NEAR(double(a.position), double(b.position), 2.0e-6) << "joint " << i;
    EXPECT_NEAR(double(a.motor_impulse), double(b.motor_impulse), rounding) << "joint " << i;
    const JointDetail &its = one.details[i], &others = other.details[i];
    EXPECT_LT(apart(its.drive_torque_impulse, others.drive_torque_impulse), rounding) << "joint " << i;
    EXPECT_LT(apart(its.friction_impulse, others.friction_impulse), rounding) << "joint " << i;
    for (int axis = 3; axis < 5; ++axis) {
      const JointAxisRecord &x = one.details[i].axes[axis], &y = other.details[i].axes[axis];
      EXPECT_NEAR(double(x.low_impulse), double(y.low_impulse), rounding) << "joint " << i;
      EXPECT_NEAR(double(x.high_impulse), double(y.high_impulse), rounding) << "joint " << i;
      EXPECT_NEAR(double(x.friction_impulse), double(y.friction_impulse), rounding) << "joint " << i;
      EXPECT_NEAR(double(x.total), double(y.total), rounding) << "joint " << i;
      EXPECT_NEAR(double(x.position), double(y.position), 2.0e-5) << "joint " << i;
    }
  }
}

}  // namespace gyre::articulation_test
