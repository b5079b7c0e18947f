// Each articulation is in one lane, beside others of equal topology only, and no more than half of the lanes
// are idle if kernels of half as many would do.
#include "rigid/articulation/articulation_bundles.h"

#include <gtest/gtest.h>

#include <map>
#include <vector>

namespace gyre::articulation_bundles_test {
namespace {

constexpr std::size_t kMaxArticulations = 40;

// Numbers of articulations of each topology, one joint each, in mixed order.
struct Crowd {
  explicit Crowd(std::vector<std::size_t> counts)
      : nodes(counts.size()), shapes(counts.size()), joints(kMaxArticulations * counts.size()) {
    for (std::size_t shape = 0; shape < counts.size(); ++shape) {
      shapes[shape].nodes = {&nodes[shape], 1};
      shapes[shape].body_count = 2, shapes[shape].moving_count = 1;
    }
    for (std::size_t i = 0; i < kMaxArticulations; ++i) {
      for (std::size_t shape = 0; shape < counts.size(); ++shape)
        if (i < counts[shape]) grouped.push_back({{&joints[grouped.size()], 1}, std::uint32_t(shape)});
    }
  }
  BundleSolve lay_out(int width, Arena& arena) {
    return lay_out_bundles({{}, grouped, shapes, {}, {}}, select_kernels(width), {}, {}, arena);
  }

  std::vector<LaneNode> nodes;
  std::vector<ArticulationTopology> shapes;
  std::vector<ArticulationJoint> joints;
  std::vector<GroupedArticulation> grouped;
};

TEST(ArticulationBundlesTest, HaveEachArticulationOnce) {
  for (const int width : {0, 1, 4, 8, 16}) {
    for (std::size_t count = 1; count <= kMaxArticulations; ++count) {
      Crowd crowd({count, kMaxArticulations - count, 1});
      Arena arena;
      std::map<const GroupedArticulation*, int> times;
      for (const BundledArticulations& bundle : crowd.lay_out(width, arena).bundles) {
        ASSERT_LE(bundle.articulations.size(), std::size_t(bundle.lanes.kernels->width));
        for (const GroupedArticulation* articulation : bundle.articulations) {
          ++times[articulation];
          EXPECT_EQ(articulation->topology, bundle.articulations[0]->topology);
          EXPECT_EQ(bundle.lanes.nodes, crowd.shapes[articulation->topology].nodes.data());
        }
      }
      EXPECT_EQ(times.size(), crowd.grouped.size());
      for (const auto& [articulation, n] : times) EXPECT_EQ(n, 1);
    }
  }
}

TEST(ArticulationBundlesTest, LeaveNoHalfOfTheLanesIdleWhereFewerWouldDo) {
  for (const int width : {0, 1, 4, 8, 16}) {
    const SolverKernels& kernels = select_kernels(width);
    const int narrow = narrower_kernels(kernels).width;
    EXPECT_TRUE(narrow == kernels.width || 2 * narrow == kernels.width);
    for (std::size_t count = 1; count <= kMaxArticulations; ++count) {
      Crowd crowd({count});
      Arena arena;
      for (const BundledArticulations& bundle : crowd.lay_out(width, arena).bundles) {
        const int used = int(bundle.articulations.size()), lanes = bundle.lanes.kernels->width;
        EXPECT_EQ(lanes, used == 1 ? 1 : used <= narrow ? narrow : kernels.width) << used << " at " << width;
      }
    }
  }
}

// Sixteen lanes have kernels of eight with the same instructions.
TEST(ArticulationBundlesTest, SixteenLanesHaveKernelsOfHalfAsMany) {
  const SolverKernels& kernels = select_kernels(16);
  if (kernels.width < 16) GTEST_SKIP() << "this processor has none of sixteen lanes";
  EXPECT_EQ(narrower_kernels(kernels).width, 8);
}

}  // namespace
}  // namespace gyre::articulation_bundles_test
