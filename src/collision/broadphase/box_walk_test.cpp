// Traversals of trees at every width against plain loops over all boxes, with more results than fit at once.
#include "collision/broadphase/box_walk.h"

#include "collision/broadphase/box_walk_lanes.h"
#include "random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace gyre::box_walk_test {
namespace {

using testing_random::Random;

struct Tree {
  std::vector<BoxTreeNode> nodes;
  std::vector<Aabb> boxes;

  explicit Tree(Random& random, std::uint32_t min_children = 1) : min_children_(min_children) {
    nodes.resize(1), fill(0, kLevel, random);
  }

  static constexpr int kLevel = 3;  // of the root

 private:
  // Fills some lanes of the node and all nodes below; returns their bounds.
  Aabb fill(std::size_t index, int level, Random& random) {
    const std::uint32_t count = min_children_ + random.next(BoxLanes::kWidth + 1 - min_children_);
    nodes[index].level = std::uint8_t(level);
    for (int lane = 0; lane < BoxLanes::kWidth; ++lane) clear_lane_box(nodes[index], lane);
    Aabb around;
    for (std::uint32_t lane = 0; lane < count; ++lane) {
      std::uint32_t child = std::uint32_t(boxes.size());
      Aabb box;
      if (level == 0) {
        const Vec3 low = random.vector(-5, 5);
        box = {low, low + random.vector(0, 2)};
        boxes.push_back(box);
      } else {
        child = std::uint32_t(nodes.size());
        nodes.emplace_back();
        box = fill(child, level - 1, random);
      }
      nodes[index].child[lane] = child;
      set_lane_box(nodes[index], int(lane), box);
      around = lane == 0 ? box : merge(around, box);
    }
    return around;
  }

  std::uint32_t min_children_;  // children of a node
};

std::vector<std::uint32_t> walk_all(WalkBoxes walk_boxes, const Tree& tree, const Aabb& box) {
  // For each level below the root, no more than the children of two nodes.
  constexpr int kMaxWaiting = 2 * Tree::kLevel * BoxLanes::kWidth;
  std::vector<std::uint32_t> all;
  BoxWalk walk(box, 0);
  do {
    walk_boxes(tree.nodes.data(), walk);
    EXPECT_LE(walk.found_count, BoxWalk::kRoom);
    EXPECT_LE(walk.depth, kMaxWaiting);
    all.insert(all.end(), walk.found, walk.found + walk.found_count);
  } while (walk.depth > 0);
  std::sort(all.begin(), all.end());
  return all;
}

TEST(BoxWalk, FindsOverlaps) {
  Random random(7);
  std::size_t max_found = 0;
  for (int round = 0; round < 200; ++round) {
    const Tree tree(random);
    const Vec3 low = random.vector(-7, 7);
    const Aabb box = {low, low + random.vector(0, round % 4 == 0 ? 14.0f : 2.0f)};
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < tree.boxes.size(); ++i) {
      if (overlap(tree.boxes[i], box)) expected.push_back(i);
    }
    EXPECT_EQ(walk_all(walk_boxes<1>, tree, box), expected);
    EXPECT_EQ(walk_all(walk_boxes<4>, tree, box), expected);
    EXPECT_EQ(walk_all(walk_boxes<8>, tree, box), expected);
    EXPECT_EQ(walk_all(select_box_walk(), tree, box), expected);
    max_found = std::max(max_found, expected.size());
  }
  EXPECT_GT(max_found, std::size_t(BoxWalk::kRoom)) << "no walk went on after its room was full";
}

TEST(BoxWalk, FindsAllOfFullNodes) {
  Random random(8);
  const Tree tree(random, BoxLanes::kWidth);
  ASSERT_EQ(tree.boxes.size(), std::size_t(8 * 8 * 8 * 8));
  const Aabb everything = {{-10, -10, -10}, {10, 10, 10}};
  for (const WalkBoxes walk : {WalkBoxes(walk_boxes<1>), WalkBoxes(walk_boxes<8>), select_box_walk()}) {
    const std::vector<std::uint32_t> found = walk_all(walk, tree, everything);
    ASSERT_EQ(found.size(), tree.boxes.size());
    for (std::uint32_t i = 0; i < found.size(); ++i) ASSERT_EQ(found[i], i);
  }
}

}  // namespace
}  // namespace gyre::box_walk_test
