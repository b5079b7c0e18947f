// Linkages side by side against the same linkages one by one: the equations are the same, so the results agree to rounding; and
// each lane has the same bits whatever the width.
#include "solver/articulation/linkage_matrix.h"
#include "solver/articulation/linkage_test_kit.h"

#include <cmath>

namespace gyre::linkage_test {
namespace {

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

TEST(LinkageKernel, DrivesAndFrictionInLanesDoWhatTheyDoInOneLinkage) {
  Shape shape;
  Crowd one_by_one(0.05f, Driven::swept), side_by_side(0.05f, Driven::swept);
  solve_one_by_one(one_by_one, shape);
  solve_side_by_side(side_by_side, shape, 0);
  expect_same(one_by_one, side_by_side);
  // Some slip, and some hold.
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

// Strong ones keep what they are told, weak ones give all they have.
TEST(LinkageKernel, MotorsInLanesDoWhatTheyDoInOneLinkage) {
  Shape shape;
  Crowd one_by_one(0.05f, Driven::motors), side_by_side(0.05f, Driven::motors);
  solve_one_by_one(one_by_one, shape);
  solve_side_by_side(side_by_side, shape, 0);
  // Sweeps over several motors end where none changes a speed by 1e-4 rad/s: 4e-4 N m s where least of the linkage turns.
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
  for (const SolverKernels* kernels : {&widest, &narrower, &select_kernels(4),
                                        &select_kernels(8), &select_kernels(16)}) {
    const int width = kernels->width;
    Crowd crowd = start();
    solve_side_by_side(crowd, shape, kernels->linkages, between);
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

TEST(LinkageKernel, EveryWidthHasTheSameBits) {
  for (const Driven driven : {Driven::no, Driven::swept, Driven::motors}) {
    for (const float tension : {0.05f, 50.0f}) {
      // Some lanes keep what others find anew; some spin so fast that they lose what errors gave them at once.
      expect_same_bits_at_every_width(tension, driven, {.turn = 0.4f}, 1.0f);
      expect_same_bits_at_every_width(tension, driven, {.ends = Between::Ends::passes}, 6.0f);
    }
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
  int kept_copies = 0;  // not all have a stop in question
  for (int copy = 1; copy < kCopies; copy += 2)
    kept_copies += same_motion(nearly_kept, nearly_forgotten, copy) ? 0 : 1;
  EXPECT_GE(kept_copies, 2) << "nothing is kept";
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

// What is swept would hold against it.
TEST(LinkageKernel, WhatCameFromErrorsIsTakenAwayWhereSomethingIsSwept) {
  Shape shape;
  Crowd passed(0.05f, Driven::swept), finished(0.05f, Driven::swept);
  for (Crowd* crowd : {&passed, &finished}) crowd->open_stops();
  solve_side_by_side(passed, shape, 0, {.ends = Between::Ends::passes});
  solve_side_by_side(finished, shape, 0, {.ends = Between::Ends::finishes});
  for (int copy = 0; copy < kCopies; ++copy)
    EXPECT_TRUE(same_motion(passed, finished, copy)) << "copy " << copy;
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
}  // namespace gyre::linkage_test
