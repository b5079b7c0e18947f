// Articulations side by side against the same articulations one by one: the equations are the same, so
// results agree to rounding; and each lane has the same bits at every width.
#include "solver/articulation/articulation_matrix.h"
#include "solver/articulation/articulation_test_kit.h"

#include <cmath>
#include <memory>

namespace gyre::articulation_test::articulation_kernel_test {
namespace {

TEST(ArticulationKernel, LanesMatchOneArticulation) {
  for (const float tension : {0.05f, 50.0f}) {  // the second adds geometric stiffness
    SCOPED_TRACE(tension);
    Shape shape;
    Crowd one_by_one(tension), side_by_side(tension), untouched(tension);
    solve_one_by_one(one_by_one, shape);
    solve_side_by_side(side_by_side, shape, 0);
    EXPECT_GT(apart(one_by_one.motion[0].linear_velocity, untouched.motion[0].linear_velocity), 0.1);
    if (tension < 1.0f) expect_same(one_by_one, side_by_side);
  }
}

TEST(ArticulationKernel, DrivesAndFrictionInLanesMatchOneArticulation) {
  Shape shape;
  Crowd one_by_one(0.05f, Driven::iterative), side_by_side(0.05f, Driven::iterative);
  solve_one_by_one(one_by_one, shape);
  solve_side_by_side(side_by_side, shape, 0);
  expect_same(one_by_one, side_by_side);
  // Some slip, and some stick.
  int slipping = 0, holding = 0;
  const auto count = [&](float size, float most) {
    ++(size < 0.999f * kSubstep * most ? holding : slipping);
  };
  for (std::size_t i = 0; i < side_by_side.records.size(); ++i) {
    const JointDetail& detail = side_by_side.details[i];
    const JointAxisRecord& axis = detail.axes[int(JointAxis::angular_x)];
    if (axis.friction > 0.0f) count(std::abs(axis.friction_impulse), axis.friction);
    if (detail.friction > 0.0f) count(length(detail.friction_impulse), detail.friction);
  }
  EXPECT_GT(slipping, 3);
  EXPECT_GT(holding, 3);
}

// Strong ones reach their targets, weak ones act with all their force.
TEST(ArticulationKernel, MotorsInLanesMatchOneArticulation) {
  Shape shape;
  Crowd one_by_one(0.05f, Driven::motors), side_by_side(0.05f, Driven::motors);
  solve_one_by_one(one_by_one, shape);
  solve_side_by_side(side_by_side, shape, 0);
  // Iterations over several motors end where none changes a speed by 1e-4 rad/s: 4e-4 N m s for the smallest
  // inertia of the articulation.
  expect_same(one_by_one, side_by_side, 5.0);
  int weak = 0, strong = 0;
  for (const JointRecord& joint : side_by_side.records) {
    if (joint.kind != JointKind::hinge) continue;
    ++(std::abs(joint.motor_impulse) < 0.999f * kSubstep * joint.motor_force ? strong : weak);
  }
  EXPECT_GT(weak, 3);
  EXPECT_GT(strong, 3);
}

void expect_same_bits_at_every_width(float tension, Driven driven, const Between& between, float spins) {
  Shape shape;
  const auto start = [&] {
    Crowd crowd(tension, driven);
    for (std::size_t i = 0; i < crowd.motion.size(); ++i)
      if (i / kBodies % 2 != 0) crowd.motion[i].angular_velocity = spins * crowd.motion[i].angular_velocity;
    return crowd;
  };
  Crowd reference = start();
  solve_side_by_side(reference, shape, 1, between);
  const SolverKernels &widest = select_kernels(0), &narrower = narrower_kernels(widest);
  for (const SolverKernels* kernels :
       {&widest, &narrower, &select_kernels(4), &select_kernels(8), &select_kernels(16)}) {
    const int width = kernels->width;
    Crowd crowd = start();
    solve_side_by_side(crowd, shape, kernels->articulations, between);
    const std::size_t motions = crowd.motion.size() * sizeof(BodyMotion);
    EXPECT_EQ(std::memcmp(crowd.motion.data(), reference.motion.data(), motions), 0) << "width " << width;
    const auto same = [](const JointRecord& a, const JointRecord& b) {
      return a.linear_impulse == b.linear_impulse && a.angular_impulse == b.angular_impulse &&
             a.total_linear == b.total_linear && a.total_angular == b.total_angular &&
             a.low_impulse == b.low_impulse && a.high_impulse == b.high_impulse &&
             a.motor_impulse == b.motor_impulse && a.position == b.position;
    };
    const auto same_drives = [](const JointDetail& a, const JointDetail& b) {
      const JointAxisRecord &x = a.axes[int(JointAxis::angular_x)], &y = b.axes[int(JointAxis::angular_x)];
      return a.drive_torque_impulse == b.drive_torque_impulse && a.friction_impulse == b.friction_impulse &&
             x.friction_impulse == y.friction_impulse && x.total == y.total;
    };
    for (std::size_t i = 0; i < crowd.records.size(); ++i) {
      EXPECT_TRUE(same(crowd.records[i], reference.records[i])) << "width " << width << ", joint " << i;
      EXPECT_TRUE(same_drives(crowd.details[i], reference.details[i]))
          << "width " << width << ", joint " << i;
    }
  }
}

TEST(ArticulationKernel, EveryWidthHasTheSameBits) {
  for (const Driven driven : {Driven::no, Driven::iterative, Driven::motors}) {
    for (const float tension : {0.05f, 50.0f}) {
      // Some lanes have cached entries that others compute anew; some spin so fast that they lose the speed
      // of error removal at once.
      expect_same_bits_at_every_width(tension, driven, {.turn = 0.4f}, 1.0f);
      expect_same_bits_at_every_width(tension, driven, {.ends = Between::Ends::passes}, 6.0f);
    }
  }
}

// Brings a copy into position, within its limits, with speeds of about `noise`.
void settle(Crowd& crowd, int copy, float noise) {
  Random random{std::uint32_t(copy)};
  for (std::size_t i = std::size_t(copy * kBodies); i < std::size_t((copy + 1) * kBodies); ++i) {
    crowd.motion[i].linear_velocity = random.vector(noise);
    crowd.motion[i].angular_velocity = random.vector(noise);
    crowd.motion[i].delta_position = {};
    crowd.orientation[i] = {};
  }
  for (std::size_t i = std::size_t(copy * kJoints); i < std::size_t((copy + 1) * kJoints); ++i) {
    JointRecord& joint = crowd.records[i];
    joint.local_frame_a = joint.local_frame_b = {};
    joint.linear_impulse = joint.angular_impulse = {};
    joint.low_impulse = 0.0f;
    joint.limits = {-0.2f, 0.2f};
    for (JointAxisRecord& axis : crowd.details[i].axes) axis.high_impulse = 0.0f, axis.limits = joint.limits;
    crowd.offsets[i].offset = joint.local_anchor_a - joint.local_anchor_b;
  }
}

// Impulses of zero may be negative: the last ones, or those of rows that nothing can move.
TEST(ArticulationKernel, ALaneAtRestKeepsNegativeZerosBesideOthersThatMove) {
  for (const Driven driven : {Driven::iterative, Driven::motors}) {
    Shape shape;
    const auto solve = [&](int width) {
      auto crowd = std::make_unique<Crowd>(0.05f, driven);
      for (int copy = 0; copy < kCopies; copy += 2) {
        settle(*crowd, copy, 0.0f);
        for (int i = copy * kJoints; i < (copy + 1) * kJoints; ++i) {
          JointRecord& joint = crowd->records[std::size_t(i)];
          joint.linear_impulse = {-0.0f, -0.0f, -0.0f};
          joint.motor_impulse = -0.0f, joint.motor_velocity = 0.0f, joint.has_motor_target = false;
          JointDetail& detail = crowd->details[std::size_t(i)];
          detail.drive = {}, detail.drive_torque_impulse = detail.friction_impulse = {};
          detail.axes[int(JointAxis::angular_x)].friction_impulse = 0.0f;
        }
      }
      solve_side_by_side(*crowd, shape, width);
      return crowd;
    };
    const auto alone = solve(1);
    for (const int width : {4, 8, 16}) {
      const auto beside = solve(width);
      for (std::size_t i = 0; i < alone->records.size(); ++i) {
        const JointRecord &a = alone->records[i], &b = beside->records[i];
        EXPECT_EQ(std::memcmp(&a.linear_impulse, &b.linear_impulse, sizeof(Vec3)), 0) << width << ", " << i;
        EXPECT_EQ(std::memcmp(&a.angular_impulse, &b.angular_impulse, sizeof(Vec3)), 0) << width << ", " << i;
        EXPECT_EQ(std::signbit(a.motor_impulse), std::signbit(b.motor_impulse)) << width << ", " << i;
      }
      const JointRecord& last = beside->records[0];
      EXPECT_TRUE(std::signbit(driven == Driven::motors ? last.motor_impulse : last.linear_impulse.x));
    }
  }
}

bool same_motion(const Crowd& a, const Crowd& b, int copy) {
  const std::size_t first = std::size_t(copy * kBodies);
  return std::memcmp(&a.motion[first], &b.motion[first], kBodies * sizeof(BodyMotion)) == 0;
}

TEST(ArticulationKernel, DelassusEntriesStayCachedUntilAJointRotatesFar) {
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
  // Copies that hardly rotate go on with cached entries: equal to new ones up to rounding.
  Crowd nearly_cached(0.05f), nearly_forgotten(0.05f);
  solve_side_by_side(nearly_cached, shape, 0, {.turn = 0.02f});
  solve_side_by_side(nearly_forgotten, shape, 0, {.turn = 0.02f, .forget = true});
  expect_same(nearly_cached, nearly_forgotten);
  int cached_copies = 0;  // not all have an active limit
  for (int copy = 1; copy < kCopies; copy += 2)
    cached_copies += same_motion(nearly_cached, nearly_forgotten, copy) ? 0 : 1;
  EXPECT_GE(cached_copies, 2) << "nothing is kept";
}

TEST(ArticulationKernel, WhatMissesNothingButRoundingIsLeftAsItIs) {
  Shape shape;
  const auto settle_every_other = [](Crowd& crowd) {
    for (int copy = 0; copy < kCopies; copy += 2) settle(crowd, copy, copy == 2 ? 1.0e-4f : 1.0e-6f);
  };
  Crowd before(0.05f);
  settle_every_other(before);
  for (const int width : {0, 1, 4, 8, 16}) {
    Crowd after(0.05f);
    settle_every_other(after);
    solve_side_by_side(after, shape, width);
    for (int copy = 0; copy < kCopies; ++copy)
      EXPECT_EQ(same_motion(before, after, copy), copy % 2 == 0 && copy != 2)
          << "width " << width << ", copy " << copy;
  }
}

// Rounding of sums of a dozen impulses that alternate and are larger in between than their sum, as a number
// of float steps of all momentum and impulses of a body.
constexpr double kSumRounding = 32 * 0x1p-23;

TEST(ArticulationKernel, SpeedFromErrorsMayStayForTheNextHalfStep) {
  Shape shape;
  Crowd left(0.05f), taken(0.05f), before(0.05f);
  for (Crowd* crowd : {&left, &taken}) crowd->open_limits();
  solve_side_by_side(left, shape, 0, {.ends = Between::Ends::passes});
  solve_side_by_side(taken, shape, 0, {.ends = Between::Ends::finishes});
  std::vector<Vec3> given(left.motion.size());
  std::vector<float> sizes(left.motion.size());  // of all impulses, N s
  const auto compliance = [&](std::int32_t body, Vec3 impulse) {
    given[std::size_t(body)] += impulse;
    sizes[std::size_t(body)] += length(impulse);
  };
  for (const JointRecord& joint : left.records) {
    if (joint.body_a != kNoBody) compliance(joint.body_a, -joint.total_linear);
    compliance(joint.body_b, joint.total_linear);
  }
  for (std::size_t i = 0; i < left.motion.size(); ++i) {
    const Vec3 now = left.motion[i].linear_velocity;
    const Vec3 energy_gain = left.inertia[i].inverse_mass * given[i];
    const float speeds = length(before.motion[i].linear_velocity) + left.inertia[i].inverse_mass * sizes[i];
    EXPECT_LT(apart(now, before.motion[i].linear_velocity + energy_gain), kSumRounding * speeds)
        << "sums are all that was given, " << i;
    EXPECT_LT(apart(now, taken.motion[i].linear_velocity), kLeftOver) << "body " << i;
    EXPECT_LT(apart(left.motion[i].angular_velocity, taken.motion[i].angular_velocity), kLeftOver)
        << "body " << i;
  }
}

// Drives would hold against it.
TEST(ArticulationKernel, SpeedFromErrorsIsRemovedWithIterativeDrives) {
  Shape shape;
  Crowd passed(0.05f, Driven::iterative), finished(0.05f, Driven::iterative);
  for (Crowd* crowd : {&passed, &finished}) crowd->open_limits();
  solve_side_by_side(passed, shape, 0, {.ends = Between::Ends::passes});
  solve_side_by_side(finished, shape, 0, {.ends = Between::Ends::finishes});
  for (int copy = 0; copy < kCopies; ++copy)
    EXPECT_TRUE(same_motion(passed, finished, copy)) << "copy " << copy;
}

TEST(ArticulationKernel, EndOfHalfStepComputesTheNextBias) {
  Shape shape;
  Crowd passed(0.05f), asked(0.05f);
  solve_side_by_side(passed, shape, 0, {.ends = Between::Ends::passes, .computes_bias = false});
  solve_side_by_side(asked, shape, 0, {.ends = Between::Ends::passes});
  for (int copy = 0; copy < kCopies; ++copy) EXPECT_TRUE(same_motion(passed, asked, copy)) << "copy " << copy;
}

// More columns than a word has bits: two branches of a tree, with alternating columns, that meet at the last.
TEST(ArticulationMatrix, WhatEliminationReachesHasABitForEachColumn) {
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
    if (i + 1 < kColumns) entries[i].index = i + (i < kMeet - 1 ? 2 : 1);
  }
  ArticulationBundle bundle;
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
  // Their product is over the columns from the meeting on. (All numbers and sums are exact in floats.)
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
}  // namespace gyre::articulation_test::articulation_kernel_test
