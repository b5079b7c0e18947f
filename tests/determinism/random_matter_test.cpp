// The promise of determinism.md for worlds of ropes, cloths, solids, gases and liquids that nobody chose: every way to compute them gives the
// same bits after every step, and tells the same events and readings.
#include "determinism/random_matter.h"
#include "determinism/random_run.h"

#include <gtest/gtest.h>

namespace gyre::random_matter_test {
namespace {

using namespace random_run;
using scenes::RandomMatter;

constexpr int kSteps = 30;

class RandomMatterWorlds : public testing::TestWithParam<int> {
 protected:
  std::uint32_t number() const { return std::uint32_t(GetParam()); }
};

TEST_P(RandomMatterWorlds, AreTheSameInEveryWay) {
  const auto reference = make_reference<RandomMatter>(number(), kSteps);
  expect_same_when_computed(reference, {2, 4, BroadPhaseKind::bvh});
  expect_same_when_computed(reference, {3, 8, BroadPhaseKind::brute_force});
  expect_same_from_bookmarks(reference, {1, 0}, kSteps);
  expect_same_with_rollback(reference, {1, 0});
  expect_same_when_played(reference, {2, 16});
}

// Quick worlds. World 8 throws a cloth 1e24 m away, where candidates of folds may not be kept.
INSTANTIATE_TEST_SUITE_P(Numbers, RandomMatterWorlds, testing::Values(1, 4, 5, 7, 8, 9));

class LongRandomMatterWorlds : public testing::TestWithParam<int> {};

TEST_P(LongRandomMatterWorlds, AreTheSameInEveryWay) {
  constexpr int kThreads[] = {1, 2, 3, 8}, kWidths[] = {1, 4, 8, 16};
  for (std::uint32_t number = std::uint32_t(GetParam()); number < std::uint32_t(GetParam()) + 10; ++number) {
    const auto reference = make_reference<RandomMatter>(number, 150);
    for (std::uint32_t i = 0; i < 4; ++i)
      expect_same_when_computed(reference, {kThreads[i], kWidths[(i + number) % 4]});
    for (const Way& way : {Way{1, 1}, Way{3, 8, BroadPhaseKind::brute_force}}) {
      expect_same_from_bookmarks(reference, way, 60);
      expect_same_with_rollback(reference, way);
      expect_same_when_played(reference, way);
    }
    if (HasFailure()) break;
  }
}

INSTANTIATE_TEST_SUITE_P(LongNumbers, LongRandomMatterWorlds, testing::Range(100, 300, 10));

}  // namespace
}  // namespace gyre::random_matter_test
