// Linkages side by side against the same linkages one by one: the equations are the same, so the results agree to rounding; and
// each lane has the same bits whatever the width.
#include "base/arena.h"
#include "math/rotation.h"
#include "math/trig.h"
#include "solver/contact_block.h"
#include "solver/lane_records.h"
#include "solver/linkage.h"
#include "solver/linkage_matrix.h"
#include "solver/linkage_stops.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace gyre {
namespace {

constexpr int kBodies = 6, kJoints = 6, kCopies = 7;
constexpr float kSubstep = 1.0f / 480.0f;
const JointSettings kSettings{kSubstep, {40.0f, 0.96f, 0.04f}, false};

struct Random {
  std::uint32_t state;
  float next() {  // -1 to 1
    state = state * 1664525u + 1013904223u;
    return float(state >> 8) / float(1 << 23) - 1.0f;
  }
  Vec3 vector(float size) { return {size * next(), size * next(), size * next()}; }
};

// Who hangs on whom: from the world a hinge with stops, cones with and without stops, a ball, a hinge without stops, and a second
// ball between the same two bodies, which makes a loop.
struct Member {
  JointKind kind;
  std::int32_t a, b;
  bool stops;
};
constexpr Member kMembers[kJoints] = {{JointKind::hinge, kNoBody, 0, true}, {JointKind::cone, 0, 1, true},
                                      {JointKind::ball, 1, 2, false},       {JointKind::hinge, 3, 1, false},
                                      {JointKind::cone, 0, 4, false},       {JointKind::ball, 1, 2, false}};

// Several copies of that linkage, each in a state of its own, and the work of a step.
struct Crowd {
  Arena arena;
  std::vector<BodyMotion> motion{std::size_t(kBodies * kCopies)};
  std::vector<BodyInertia> inertia{std::size_t(kBodies * kCopies)};
  std::vector<Quat> orientation{std::size_t(kBodies * kCopies)};
  std::vector<JointRecord> records{std::size_t(kJoints * kCopies)};
  std::vector<JointDetail> details{std::size_t(kJoints * kCopies)};
  std::vector<JointWork> work{std::size_t(kJoints * kCopies)};
  std::vector<JointPlaces> places{std::size_t(kJoints * kCopies)};

  explicit Crowd(float tension) {
    Random random{12345};
    for (std::size_t i = 0; i < motion.size(); ++i) {
      motion[i].linear_velocity = random.vector(3.0f);
      motion[i].angular_velocity = random.vector(8.0f);
      motion[i].inverse_mass = inertia[i].inverse_mass = 1.0f + 0.5f * random.next();
      motion[i].moved = random.vector(0.01f);
      inertia[i].inverse = {.xx = 20 + random.next(),
                            .yy = 30 + random.next(),
                            .zz = 25 + random.next(),
                            .xy = random.next(),
                            .xz = random.next(),
                            .yz = random.next()};
      orientation[i] = from_rotation_vector(random.vector(1.0f));
    }
    for (std::size_t i = 0; i < records.size(); ++i) set_joint(i, random, tension);
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
    if (joint.kind == JointKind::hinge) {  // not far from where it should be
      joint.local_frame_b =
          conjugate(b) * (from_rotation_vector(random.vector(0.02f)) * a * joint.local_frame_a);
      joint.angular_impulse = random.vector(0.01f);
    }
    const Vec3 moved = motion[std::size_t(joint.body_b)].moved -
                       (joint.body_a == kNoBody ? Vec3{} : motion[std::size_t(joint.body_a)].moved);
    places[i].offset =
        rotate(a, joint.local_anchor_a) - rotate(b, joint.local_anchor_b) - moved + random.vector(0.002f);
    if (!member.stops) {
      begin_joint(joint, detail_of(i), {}, work[i], 1.0f, arena);
      return;
    }
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
    begin_joint(joint, detail_of(i), {}, work[i], 1.0f, arena);
  }
  // None is near its stops.
  void open_stops() {
    for (JointRecord& joint : records) joint.limits = {-10.0f, 10.0f}, joint.low_impulse = 0.0f;
    for (JointDetail& detail : details) {
      detail.swing_y = detail.swing_z = kPi;
      for (JointAxisRecord& axis : detail.axes) axis.limits = {-10.0f, 10.0f}, axis.high_impulse = 0.0f;
    }
  }
  JointDetail* detail_of(std::size_t i) {
    const Member& member = kMembers[i % kJoints];
    return member.stops && member.kind != JointKind::hinge ? &details[i] : nullptr;
  }

  LinkageSolve solve() {
    return {.records = records,
            .work = work,
            .places = places,
            .bodies = {motion.data(), inertia.data(), orientation.data()},
            .settings = kSettings,
            .give = 1.0e-4f};
  }
};

// The plan and the couplings, and the lanes' form of them.
struct Shape {
  Arena arena;
  BlockPlan plan;
  std::vector<LinkageCoupling> couplings;
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
    for (LinkageCoupling& c : couplings) {
      const BlockPlace block = find_block(plan, c.row, c.column);
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
      node.row = plan.columns[plan.place_of[i]].row;
      node.column = plan.place_of[i];
      node.diagonal = plan.columns[plan.place_of[i]].diagonal;
    }
  }
};

void solve_one_by_one(Crowd& crowd, const Shape& shape) {
  LinkageSolve solve = crowd.solve();
  std::vector<double> stop_room(stops_room(shape.plan.rows, kBodies));
  solve.room = stop_room;
  for (int copy = 0; copy < kCopies; ++copy) {
    std::vector<LinkageNode> nodes{std::size_t(kJoints)};
    std::vector<LinkageBody> bodies{std::size_t(kBodies)};
    std::vector<LinkageCoupling> couplings = shape.couplings;
    std::vector<double> values(shape.plan.values), room(shape.plan.widest), vector(shape.plan.rows);
    for (int i = 0; i < kBodies; ++i) bodies[std::size_t(i)].body = copy * kBodies + i;
    for (LinkageCoupling& c : couplings) c.body += copy * kBodies;
    for (int i = 0; i < kJoints; ++i) {
      LinkageNode& node = nodes[std::size_t(i)];
      node.record = node.work = std::uint32_t(copy * kJoints + i);
      node.body_a = crowd.records[node.record].body_a;
      node.body_b = crowd.records[node.record].body_b;
      node.side_a = kMembers[i].a == kNoBody ? -1 : kMembers[i].a;
      node.side_b = kMembers[i].b;
      node.count = int(shape.nodes[std::size_t(i)].rows);
    }
    const Linkage linkage{nodes, bodies, couplings, shape.plan, values, room, vector, true};
    for (int part = 0; part < 2; ++part) {
      place_linkage(linkage, solve);
      warm_linkage(linkage, solve);
      solve_linkage(linkage, solve);
      solve_linkage_again(linkage, solve);
    }
    relax_linkage(linkage, solve);
  }
  for (std::size_t i = 0; i < crowd.records.size(); ++i) finish_joint(crowd.records[i], crowd.work[i]);
}

// What happens between the two parts of solve_side_by_side.
struct Between {
  float turn = 0.0f;    // rad: how far the second body of every other copy turns
  bool forget = false;  // nothing of the first part is kept but impulses
  // What speed came from taking errors back is left to the second part, or not.
  enum class Ends : std::uint8_t { no, passes, finishes } ends = Ends::no;
  bool asks = true;  // what the second part begins with is asked for by itself too
};

void solve_side_by_side(Crowd& crowd, Shape& shape, const LinkageKernels& kernels, const Between& between) {
  const LinkageSolve solve = crowd.solve();
  const LaneArrays arrays{crowd.motion.data(), crowd.inertia.data(), crowd.orientation.data()};
  const LaneSettings settings{kSubstep, kSettings.softness.bias_rate, solve.give, raise_inertia};
  for (std::size_t i = 0; i < kJoints; ++i) {
    ASSERT_TRUE(fits_lane(crowd.records[i], crowd.detail_of(i), {}, shape.nodes[i]));
  }
  Arena arena;
  const std::size_t lanes = std::size_t(kernels.width);
  LinkageBundle bundle{&kernels,
                       shape.nodes.data(),
                       shape.lane_couplings.data(),
                       kJoints,
                       std::uint32_t(shape.lane_couplings.size()),
                       kBodies + 1,
                       kBodies,
                       shape.plan.columns.data(),
                       shape.plan.entries.data(),
                       shape.plan.targets.data(),
                       kJoints,
                       shape.plan.values,
                       shape.plan.rows,
                       true,
                       0,
                       arena.make<std::byte>((kBodies + 1) * kernels.body_bytes).data(),
                       arena.make<std::byte>(kJoints * kernels.joint_bytes).data(),
                       arena.make<float>(lanes * shape.plan.values).data(),
                       arena.make<float>(lanes * shape.plan.rows).data(),
                       arena.make<float>(lanes * shape.plan.widest).data(),
                       arena.make<bool>(1).data(),
                       nullptr};
  for (const LaneNode& node : shape.nodes)
    bundle.stop_count += (node.has_twist ? 1 : 0) + (node.has_swing ? 1 : 0);
  bundle.stops = arena.make<std::byte>(kernels.stop_room(bundle)).data();
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
      begin_lane(bundle, lane, n, crowd.records[i], crowd.detail_of(i), crowd.places[i].offset, {});
      set_lane_body(bundle, lane, shape.nodes[n].a, crowd.records[i].body_a);
      set_lane_body(bundle, lane, shape.nodes[n].b, crowd.records[i].body_b);
    });
    for (int part = 0; part < 2; ++part) {
      if (part == 1) {
        if (between.ends == Between::Ends::passes) {
          kernels.place(bundle, arrays, settings);
          kernels.pass(bundle, arrays, settings);
        }
        if (between.ends == Between::Ends::finishes) kernels.finish(bundle, arrays, settings);
        for (int copy = first + (first + 1) % 2; copy < first + used; copy += 2) {
          Quat& body = crowd.orientation[std::size_t(copy * kBodies + 1)];
          body = from_rotation_vector({between.turn, 0, 0}) * body;
        }
        if (between.forget) kernels.begin(bundle);
      }
      // Passing on comes after placing, and asks.
      const bool passed = part == 1 && between.ends == Between::Ends::passes;
      if (!passed) kernels.place(bundle, arrays, settings);
      if (!passed || between.asks) kernels.ask(bundle, arrays, settings);
      kernels.solve(bundle, arrays, settings);
      kernels.solve_again(bundle, arrays, settings);
    }
    kernels.finish(bundle, arrays, settings);
    for_each_joint([&](int lane, std::uint32_t n, std::size_t i) {
      finish_lane(bundle, lane, n, crowd.records[i], crowd.detail_of(i));
    });
  }
}
void solve_side_by_side(Crowd& crowd, Shape& shape, int width, const Between& between = {}) {
  solve_side_by_side(crowd, shape, select_contact_kernels(width).linkages, between);
}

double apart(Vec3 a, Vec3 b) { return double(length(a - b)); }

// Rounding to float in some ten solutions of a system with a condition of about a thousand.
constexpr double kRounding = 2.0e-4;

// How a joint bends in the second part is asked with or without the speeds that errors gave in the first, some 0.8 rad/s beside 8: over a
// part that makes so many rad/s.
constexpr double kLeftOver = 0.8 * 8.0 * double(kSubstep);

void expect_same(const Crowd& one, const Crowd& other) {
  for (std::size_t i = 0; i < one.motion.size(); ++i) {
    EXPECT_LT(apart(one.motion[i].linear_velocity, other.motion[i].linear_velocity), 3.0 * kRounding)
        << "body " << i;
    EXPECT_LT(apart(one.motion[i].angular_velocity, other.motion[i].angular_velocity), 8.0 * kRounding)
        << "body " << i;
  }
  for (std::size_t i = 0; i < one.records.size(); ++i) {
    const JointRecord &a = one.records[i], &b = other.records[i];
    if (i % kJoints != 2 && i % kJoints != 5) {  // the two balls that share their load by the give alone
      EXPECT_LT(apart(a.linear_impulse, b.linear_impulse), 3.0 * kRounding) << "joint " << i;
      EXPECT_LT(apart(a.total_linear, b.total_linear), 3.0 * kRounding) << "joint " << i;
    }
    EXPECT_LT(apart(a.angular_impulse, b.angular_impulse), kRounding) << "joint " << i;
    EXPECT_LT(apart(a.total_angular, b.total_angular), kRounding) << "joint " << i;
    EXPECT_NEAR(double(a.low_impulse), double(b.low_impulse), kRounding) << "joint " << i;
    EXPECT_NEAR(double(a.high_impulse), double(b.high_impulse), kRounding) << "joint " << i;
    EXPECT_NEAR(double(a.position), double(b.position), 2.0e-6) << "joint " << i;
    for (int axis = 3; axis < 5; ++axis) {
      const JointAxisRecord &x = one.details[i].axes[axis], &y = other.details[i].axes[axis];
      EXPECT_NEAR(double(x.low_impulse), double(y.low_impulse), kRounding) << "joint " << i;
      EXPECT_NEAR(double(x.high_impulse), double(y.high_impulse), kRounding) << "joint " << i;
      EXPECT_NEAR(double(x.total), double(y.total), kRounding) << "joint " << i;
      EXPECT_NEAR(double(x.position), double(y.position), 2.0e-5) << "joint " << i;
    }
  }
}

TEST(LinkageKernel, LanesDoWhatOneLinkageDoes) {
  for (const float tension : {0.05f, 50.0f}) {  // the second raises inertias
    SCOPED_TRACE(tension);
    Shape shape;
    Crowd one_by_one(tension), side_by_side(tension), untouched(tension);
    solve_one_by_one(one_by_one, shape);
    solve_side_by_side(side_by_side, shape, 0);
    EXPECT_GT(apart(one_by_one.motion[0].linear_velocity, untouched.motion[0].linear_velocity), 0.1);
    if (tension < 1.0f) expect_same(one_by_one, side_by_side);
  }
}

void expect_same_bits_at_every_width(float tension, const Between& between, float spins) {
  Shape shape;
  const auto start = [&] {
    Crowd crowd(tension);
    for (std::size_t i = 0; i < crowd.motion.size(); ++i)
      if (i / kBodies % 2 != 0) crowd.motion[i].angular_velocity = spins * crowd.motion[i].angular_velocity;
    return crowd;
  };
  Crowd reference = start();
  solve_side_by_side(reference, shape, 1, between);
  const ContactKernels &widest = select_contact_kernels(0), &narrower = narrower_kernels(widest);
  for (const ContactKernels* kernels : {&widest, &narrower, &select_contact_kernels(4),
                                        &select_contact_kernels(8), &select_contact_kernels(16)}) {
    const int width = kernels->width;
    Crowd crowd = start();
    solve_side_by_side(crowd, shape, kernels->linkages, between);
    const std::size_t motions = crowd.motion.size() * sizeof(BodyMotion);
    EXPECT_EQ(std::memcmp(crowd.motion.data(), reference.motion.data(), motions), 0) << "width " << width;
    const auto same = [](const JointRecord& a, const JointRecord& b) {
      return a.linear_impulse == b.linear_impulse && a.angular_impulse == b.angular_impulse &&
             a.total_linear == b.total_linear && a.total_angular == b.total_angular &&
             a.low_impulse == b.low_impulse && a.high_impulse == b.high_impulse && a.position == b.position;
    };
    for (std::size_t i = 0; i < crowd.records.size(); ++i)
      EXPECT_TRUE(same(crowd.records[i], reference.records[i])) << "width " << width << ", joint " << i;
  }
}

TEST(LinkageKernel, EveryWidthHasTheSameBits) {
  for (const float tension : {0.05f, 50.0f}) {
    // Some lanes keep what others find anew; some spin so fast that they lose what errors gave them at once.
    expect_same_bits_at_every_width(tension, {.turn = 0.4f}, 1.0f);
    expect_same_bits_at_every_width(tension, {.ends = Between::Ends::passes}, 6.0f);
  }
}

// All of a copy hangs as it should, within its stops, but for speeds of about `noise`.
void calm(Crowd& crowd, int copy, float noise) {
  Random random{std::uint32_t(copy)};
  for (std::size_t i = std::size_t(copy * kBodies); i < std::size_t((copy + 1) * kBodies); ++i) {
    crowd.motion[i].linear_velocity = random.vector(noise);
    crowd.motion[i].angular_velocity = random.vector(noise);
    crowd.motion[i].moved = {};
    crowd.orientation[i] = {};
  }
  for (std::size_t i = std::size_t(copy * kJoints); i < std::size_t((copy + 1) * kJoints); ++i) {
    JointRecord& joint = crowd.records[i];
    joint.local_frame_a = joint.local_frame_b = {};
    joint.linear_impulse = joint.angular_impulse = {};
    joint.low_impulse = 0.0f;
    joint.limits = {-0.2f, 0.2f};
    for (JointAxisRecord& axis : crowd.details[i].axes) axis.high_impulse = 0.0f, axis.limits = joint.limits;
    crowd.places[i].offset = joint.local_anchor_a - joint.local_anchor_b;
  }
}

bool same_motion(const Crowd& a, const Crowd& b, int copy) {
  const std::size_t first = std::size_t(copy * kBodies);
  return std::memcmp(&a.motion[first], &b.motion[first], kBodies * sizeof(BodyMotion)) == 0;
}

TEST(LinkageKernel, WaysOfStopsAreKeptUntilAJointHasTurnedFar) {
  Shape shape;
  Crowd kept(0.05f), forgotten(0.05f), still(0.05f);
  solve_side_by_side(kept, shape, 0, {.turn = 0.4f});
  solve_side_by_side(forgotten, shape, 0, {.turn = 0.4f, .forget = true});
  solve_side_by_side(still, shape, 0);
  for (int copy = 0; copy < kCopies; ++copy) {
    const bool turned = copy % 2 != 0;
    EXPECT_EQ(same_motion(kept, still, copy), !turned)
        << "of its neighbours' turns a lane notices nothing, " << copy;
    if (turned) {
      EXPECT_TRUE(same_motion(kept, forgotten, copy)) << "copy " << copy;
    }
  }
  // Those that hardly turn go on with what they have: to rounding as with what would be found anew.
  Crowd nearly_kept(0.05f), nearly_forgotten(0.05f);
  solve_side_by_side(nearly_kept, shape, 0, {.turn = 0.02f});
  solve_side_by_side(nearly_forgotten, shape, 0, {.turn = 0.02f, .forget = true});
  expect_same(nearly_kept, nearly_forgotten);
  for (int copy = 1; copy < kCopies; copy += 2)
    EXPECT_FALSE(same_motion(nearly_kept, nearly_forgotten, copy)) << "nothing is kept, copy " << copy;
}

TEST(LinkageKernel, WhatMissesNothingButRoundingIsLeftAsItIs) {
  Shape shape;
  const auto calm_every_other = [](Crowd& crowd) {
    for (int copy = 0; copy < kCopies; copy += 2) calm(crowd, copy, copy == 2 ? 1.0e-4f : 1.0e-6f);
  };
  Crowd before(0.05f);
  calm_every_other(before);
  for (const int width : {0, 1, 4, 8, 16}) {
    Crowd after(0.05f);
    calm_every_other(after);
    solve_side_by_side(after, shape, width);
    for (int copy = 0; copy < kCopies; ++copy)
      EXPECT_EQ(same_motion(before, after, copy), copy % 2 == 0 && copy != 2)
          << "width " << width << ", copy " << copy;
  }
}

// Rounding of sums of a dozen impulses, which go back and forth and are larger in between than what is left of them: so many of a
// float's steps of all that a body has and got.
constexpr double kSumRounding = 32 * 0x1p-23;

TEST(LinkageKernel, WhatCameFromErrorsMayBeLeftToTheNextPart) {
  Shape shape;
  Crowd left(0.05f), taken(0.05f), before(0.05f);
  for (Crowd* crowd : {&left, &taken}) crowd->open_stops();
  solve_side_by_side(left, shape, 0, {.ends = Between::Ends::passes});
  solve_side_by_side(taken, shape, 0, {.ends = Between::Ends::finishes});
  std::vector<Vec3> given(left.motion.size());
  std::vector<float> sizes(left.motion.size());  // of all that was given, N s
  const auto give = [&](std::int32_t body, Vec3 impulse) {
    given[std::size_t(body)] += impulse;
    sizes[std::size_t(body)] += length(impulse);
  };
  for (const JointRecord& joint : left.records) {
    if (joint.body_a != kNoBody) give(joint.body_a, -joint.total_linear);
    give(joint.body_b, joint.total_linear);
  }
  for (std::size_t i = 0; i < left.motion.size(); ++i) {
    const Vec3 now = left.motion[i].linear_velocity;
    const Vec3 gained = left.inertia[i].inverse_mass * given[i];
    const float speeds = length(before.motion[i].linear_velocity) + left.inertia[i].inverse_mass * sizes[i];
    EXPECT_LT(apart(now, before.motion[i].linear_velocity + gained), kSumRounding * speeds)
        << "sums are all that was given, " << i;
    EXPECT_LT(apart(now, taken.motion[i].linear_velocity), kLeftOver) << "body " << i;
    EXPECT_LT(apart(left.motion[i].angular_velocity, taken.motion[i].angular_velocity), kLeftOver)
        << "body " << i;
  }
}

TEST(LinkageKernel, PassingOnAsksForWhatTheNextPartBeginsWith) {
  Shape shape;
  Crowd passed(0.05f), asked(0.05f);
  solve_side_by_side(passed, shape, 0, {.ends = Between::Ends::passes, .asks = false});
  solve_side_by_side(asked, shape, 0, {.ends = Between::Ends::passes});
  for (int copy = 0; copy < kCopies; ++copy) EXPECT_TRUE(same_motion(passed, asked, copy)) << "copy " << copy;
}

// More columns than a word has bits. Two branches of a tree, every other column each, that meet where the last of them is.
TEST(LinkageMatrix, WhatEliminationReachesHasABitForEachColumn) {
  constexpr std::uint32_t kColumns = 151, kMeet = 140;
  std::vector<BlockColumn> columns(kColumns);
  std::vector<BlockEntry> entries(kColumns - 1);
  std::uint32_t rows = 0;
  for (std::uint32_t i = 0; i < kColumns; ++i) {
    columns[i].size = i % 3 == 0 ? 5 : 3;
    columns[i].row = rows;
    columns[i].begin = i;
    columns[i].end = i + 1 < kColumns ? i + 1 : i;
    rows += columns[i].size;
    if (i + 1 < kColumns) entries[i].place = i + (i < kMeet - 1 ? 2 : 1);
  }
  LinkageBundle bundle;
  bundle.columns = columns.data(), bundle.entries = entries.data();
  bundle.column_count = kColumns, bundle.row_count = rows;
  std::vector<std::uint64_t> even(reach_words(kColumns)), odd(reach_words(kColumns));
  ASSERT_EQ(even.size(), 3u);
  even[0] = 1u << 20;
  odd[1] = 1u << 3;  // column 67
  reach_columns(bundle, even.data());
  reach_columns(bundle, odd.data());
  const auto expect = [&](const std::vector<std::uint64_t>& words, std::uint32_t first) {
    std::vector<const BlockColumn*> found;
    for_columns(
        bundle, [&](std::uint32_t i) { return words[i]; },
        [&](const BlockColumn& c) { found.push_back(&c); });
    std::vector<const BlockColumn*> expected;
    for (std::uint32_t i = first; i < kColumns; i += i < kMeet - 1 ? 2 : 1) expected.push_back(&columns[i]);
    EXPECT_EQ(found, expected);
  };
  expect(even, 20);
  expect(odd, 67);
  // Their product is over the columns from the meeting on. (Of numbers that floats hold, sums included.)
  std::vector<float> a(rows), b(rows);
  float sum = 0.0f;
  for (std::uint32_t row = 0; row < rows; ++row) {
    a[row] = float(1 + row), b[row] = 0.5f * float(row);
    if (row >= columns[kMeet].row) sum += a[row] * b[row];
  }
  const Wide<1> product = dot_reached<1>(bundle, even.data(), a.data(), odd.data(), b.data());
  EXPECT_EQ(product[0], sum);
  clear_reached<1>(bundle, odd.data(), a.data());
  for (std::uint32_t i = 0; i < kColumns; ++i) {
    const bool is_reached = (odd[i / 64] >> i % 64 & 1u) != 0;
    for (std::uint32_t row = columns[i].row; row < columns[i].row + columns[i].size; ++row)
      EXPECT_EQ(a[row], is_reached ? 0.0f : float(1 + row));
  }
}

}  // namespace
}  // namespace gyre
