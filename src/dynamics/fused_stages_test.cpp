// Runs hold every bundle and every moved body of bundles exactly once, in whole blocks of their own.
#include "dynamics/fused_stages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace gyre::fused_stages_test {
namespace {

// Chains of three bodies; the last body is joined to the world.
struct Crowd {
  explicit Crowd(std::size_t count) : nodes(3), joints(3 * count) {
    nodes[0].a = 0, nodes[0].b = 1;
    nodes[1].a = 2, nodes[1].b = 1;
    nodes[2].a = 2, nodes[2].b = 3;
    shape.nodes = nodes;
    shape.body_count = 4, shape.moving_count = 3;
    for (std::size_t i = 0; i < count; ++i) {
      const std::int32_t first = std::int32_t(10 * i);
      joints[3 * i] = {0, 0, first, first + 1};
      joints[3 * i + 1] = {0, 0, first + 2, first + 1};
      joints[3 * i + 2] = {0, 0, first + 2, kNoBody};
      alike.push_back({{&joints[3 * i], 3}, 0});
    }
  }
  BundleSolve lay_out(int width, Arena& arena) {
    return lay_out_bundles({{}, alike, {&shape, 1}, {}, {}}, select_kernels(width), {}, {}, arena);
  }

  std::vector<LaneNode> nodes;
  std::vector<ArticulationJoint> joints;
  ArticulationTopology shape;
  std::vector<GroupedArticulation> alike;
};

TEST(RunLayout, HaveEachBundleAndEachPushedBodyOnce) {
  constexpr int kOthers = 37;  // blocks
  for (const int width : {1, 4, 8, 16}) {
    for (const std::size_t count : {1u, 5u, 16u, 33u, 100u}) {
      Crowd crowd(count);
      Arena arena;
      const BundleSolve bundles = crowd.lay_out(width, arena);
      RunLayout runs(bundles, std::size_t(kOthers * width), width, arena);
      const int led = runs.count_blocks();
      runs.add_blocks(kOthers);
      int bundle = 0, block = 0;
      std::vector<std::int32_t> pushed;
      for (const std::span<const ArticulationRun> part : {runs.of_articulations(), runs.of_others()})
        for (const ArticulationRun& run : part) {
          EXPECT_EQ(run.first_block, block);
          EXPECT_GT(run.blocks, 0);
          block += run.blocks;
          if (run.bundles == 0) {
            EXPECT_GE(run.first_block, led);
            continue;
          }
          EXPECT_EQ(run.first_bundle, bundle);
          bundle += run.bundles;
          std::vector<std::int32_t> bodies(std::size_t(run.blocks * width));
          list_run_bodies(bundles, run, bodies);
          const auto empty = std::count(bodies.begin(), bodies.end(), kNoBody);
          EXPECT_LT(empty, width) << "a block of nothing";
          std::copy_if(bodies.begin(), bodies.end(), std::back_inserter(pushed),
                       [](std::int32_t body) { return body != kNoBody; });
        }
      EXPECT_EQ(bundle, int(bundles.bundles.size()));
      EXPECT_EQ(block, led + kOthers);
      std::sort(pushed.begin(), pushed.end());
      std::vector<std::int32_t> expected;
      for (std::size_t i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k) expected.push_back(std::int32_t(10 * i) + k);
      EXPECT_EQ(pushed, expected);
    }
  }
}

// The lanes of a bundle's body are the lanes of one block.
TEST(RunLayout, ListTheBodiesOfAFullBundleLaneByLane) {
  constexpr int kWidth = 4;
  Crowd crowd(kWidth);
  Arena arena;
  const BundleSolve bundles = crowd.lay_out(kWidth, arena);
  const RunLayout runs(bundles, 0, kWidth, arena);
  ASSERT_EQ(runs.of_articulations().size(), 1u);
  std::vector<std::int32_t> bodies(std::size_t(runs.count_blocks() * kWidth));
  list_run_bodies(bundles, runs.of_articulations()[0], bodies);
  EXPECT_EQ(bodies, (std::vector<std::int32_t>{0, 10, 20, 30, 1, 11, 21, 31, 2, 12, 22, 32}));
}

TEST(RunLayout, OfNothingAreNone) {
  Arena arena;
  const RunLayout runs(BundleSolve{}, 100, 8, arena);
  EXPECT_EQ(runs.count_blocks(), 0);
  EXPECT_TRUE(runs.of_articulations().empty());
}

}  // namespace
}  // namespace gyre::fused_stages_test
