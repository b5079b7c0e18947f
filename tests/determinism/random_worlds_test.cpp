// The promise of determinism.md as a property of worlds that nobody chose: whatever happens in them, every way to compute
// them gives the same bits after every step, and tells the same events, contacts and readings.
//
// Each number is a world (random_world.h) that is run once as the reference; then again in every other way (random_run.h).
#include "determinism/random_run.h"
#include "determinism/random_world.h"

#include <gtest/gtest.h>

#include <cfenv>

namespace gyre::random_worlds_test {
namespace {

using namespace random_run;
using scenes::RandomWorld;
using Reference = random_run::Reference<RandomWorld>;

Reference make_reference(std::uint32_t number, int steps) {
  return random_run::make_reference<RandomWorld>(number, steps);
}

class HostRounding {
 public:
  explicit HostRounding(int rounding) { std::fesetround(rounding); }
  ~HostRounding() { std::fesetround(FE_TONEAREST); }
  HostRounding(const HostRounding&) = delete;
  HostRounding& operator=(const HostRounding&) = delete;
};

// ------------------------------------------------------------------------------------------------------------- tests

constexpr int kSteps = 90;

class RandomWorlds : public testing::TestWithParam<int> {
 protected:
  std::uint32_t number() const { return std::uint32_t(GetParam()); }
};

TEST_P(RandomWorlds, AreTheSameHoweverTheyAreComputed) {
  const Reference reference = make_reference(number(), kSteps);
  // Over the worlds, each broad phase has its turn.
  const auto kind = [&](std::uint32_t i) { return BroadPhaseKind((number() + i) % kBroadPhaseKindCount); };
  for (const Way& way : {Way{1, 4, kind(0)}, Way{2, 8, kind(2)}, Way{3, 16, kind(4)}, Way{4, 0, kind(6)}})
    expect_same_when_computed(reference, way);
}
TEST_P(RandomWorlds, GoOnFromSnapshots) {
  const Reference reference = make_reference(number(), kSteps);
  expect_same_from_bookmarks(reference, {2, 4, BroadPhaseKind::brute_force}, 30);
}
TEST_P(RandomWorlds, GoOnAfterRollbacks) {
  const Reference reference = make_reference(number(), kSteps);
  expect_same_with_rollback(reference, {2, 0});
}
TEST_P(RandomWorlds, ArePlayedBack) {
  const Reference reference = make_reference(number(), kSteps);
  expect_same_when_played(reference, {2, 4});
}

// A host that leaves another rounding behind: what commands, steps and readings compute does not follow it.
TEST_P(RandomWorlds, DoNotFollowTheHostsRounding) {
  const Reference reference = make_reference(number(), kSteps);
  for (const int rounding : {FE_UPWARD, FE_TOWARDZERO}) {
    const HostRounding host(rounding);
    Result<Replay> replay = Replay::open(reference.recording);
    ASSERT_TRUE(replay) << replay.error().message;
    for (int step = 0; step < reference.steps(); ++step) {
      ASSERT_TRUE(replay->step());
      const auto result = equal(reference.seen[std::size_t(step)], look(replay->world()), true, step);
      ASSERT_TRUE(result) << "world " << number();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Numbers, RandomWorlds, testing::Range(0, 24));

class LongRandomWorlds : public testing::TestWithParam<int> {};

// Six ways a world, so that every number of threads meets every width within four worlds.
TEST_P(LongRandomWorlds, AreTheSameInEveryWay) {
  constexpr int kThreads[] = {1, 2, 3, 4, 8, 16}, kWidths[] = {1, 4, 8, 16};
  for (std::uint32_t number = std::uint32_t(GetParam()); number < std::uint32_t(GetParam()) + 10; ++number) {
    const Reference reference = make_reference(number, 300);
    for (std::uint32_t i = 0; i < 6; ++i) {
      const bool brute = (i + number / 4) % 2 == 0;
      expect_same_when_computed(reference, {kThreads[i], kWidths[(i + number) % 4],
                                            brute ? BroadPhaseKind::brute_force : BroadPhaseKind::bvh});
    }
    for (const Way& way : {Way{1, 1}, Way{4, 8, BroadPhaseKind::brute_force}}) {
      expect_same_from_bookmarks(reference, way, 120);
      expect_same_with_rollback(reference, way);
      expect_same_when_played(reference, way);
    }
    if (HasFailure()) break;
  }
}

INSTANTIATE_TEST_SUITE_P(LongNumbers, LongRandomWorlds, testing::Range(100, 500, 10));

}  // namespace
}  // namespace gyre::random_worlds_test
