// Ray traversal at every width: all leaves that a plain test in double meets, and hardly any others.
#include "geometry/tree/ray_traversal.h"

#include "geometry/tree/ray_traversal_lanes.h"
#include "geometry/tree/static_tree.h"
#include "random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace gyre::ray_traversal_test {
namespace {

using testing_random::Random;

// The fraction at which a moving box of half size `half` touches `box`. False if it does not up to `reach`.
bool touches(const Aabb& box, DVec3 from, Vec3 way, Vec3 half, double reach, double& enter) {
  enter = 0.0;
  double leave = reach;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = double(box.low[axis]) - double(half[axis]) - from[axis];
    const double high = double(box.high[axis]) + double(half[axis]) - from[axis];
    const auto w = double(way[axis]);
    if (w == 0.0) {
      if (low > 0.0 || high < 0.0) return false;
      continue;
    }
    enter = std::max(enter, std::min(low / w, high / w));
    leave = std::min(leave, std::max(low / w, high / w));
  }
  return enter <= leave;
}

std::vector<std::uint32_t> walk_all(RayTraversalKernel<StaticNode> walk_on, const StaticTree& tree,
                                    const BoxRay& line, float reach) {
  std::vector<std::uint32_t> leaves;
  RayTraversal walk(line, 0, reach);
  while (walk_on(tree.nodes.data(), walk)) leaves.push_back(walk.leaf);
  return leaves;
}

TEST(RayTraversal, FindsWhatLiesOnTheWay) {
  Random random(3);
  std::size_t met = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<Aabb> boxes;
    for (std::uint32_t i = 0, count = 1 + random.next(300); i < count; ++i) {
      const Vec3 low = random.vector(-5, 5);
      boxes.push_back({low, low + random.vector(0, 3)});
    }
    StaticTree tree;
    build_static_tree(boxes, tree);
    const DVec3 from(random.vector(-7, 7));
    Vec3 way = random.vector(-12, 12);
    if (round % 3 == 0) (round % 2 == 0 ? way.x : way.z) = 0.0f;
    if (round % 7 == 0) way = {};
    const Vec3 half = round % 2 == 0 ? Vec3{} : random.vector(0, 1);
    const float reach = round % 5 == 0 ? 0.5f : 1.0f;
    const BoxRay line(from, DVec3(way), half);
    const std::vector<std::uint32_t> leaves = walk_all(next_ray_leaf<1, StaticNode>, tree, line, reach);
    EXPECT_EQ(leaves, (walk_all(next_ray_leaf<4, StaticNode>, tree, line, reach)));
    EXPECT_EQ(leaves, (walk_all(next_ray_leaf<8, StaticNode>, tree, line, reach)));
    EXPECT_EQ(leaves, walk_all(select_static_ray_traversal(), tree, line, reach));

    std::vector<bool> visited(boxes.size());
    for (const std::uint32_t leaf : leaves) {
      Aabb around = boxes[tree.items[leaf_first(leaf)]];
      for (std::uint32_t i = leaf_first(leaf); i < leaf_first(leaf) + leaf_count(leaf); ++i) {
        EXPECT_FALSE(visited[tree.items[i]]);
        visited[tree.items[i]] = true;
        around = merge(around, boxes[tree.items[i]]);
      }
      double enter;
      const Vec3 slack{1.0e-4f, 1.0e-4f, 1.0e-4f};
      ASSERT_TRUE(touches(around, from, way, half + slack, double(reach), enter));
    }
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      double enter;
      if (!touches(boxes[i], from, way, half, double(reach), enter)) continue;
      EXPECT_TRUE(visited[i]);
      ++met;
    }
  }
  EXPECT_GT(met, 500u);
}

TEST(RayTraversal, BeginsBesideABox) {
  // Against the axis, a box that is touched from the first moment on is met at minus zero.
  const Aabb boxes[] = {{{-2, -1, -1}, {0, 1, 1}}};
  StaticTree tree;
  build_static_tree(boxes, tree);
  BoxRay line({}, {-1, 0, 0}, {});
  line.near[0] = 0.0f;
  for (const auto walk_on :
       {next_ray_leaf<1, StaticNode>, next_ray_leaf<4, StaticNode>, next_ray_leaf<8, StaticNode>})
    EXPECT_EQ(walk_all(walk_on, tree, line, 1.0f).size(), 1u);
}

TEST(RayTraversal, EndsWhereWhoeverWalksSays) {
  std::vector<Aabb> boxes;
  for (int i = 0; i < 100; ++i) boxes.push_back({{float(i), 0, 0}, {float(i) + 0.5f, 1, 1}});
  StaticTree tree;
  build_static_tree(boxes, tree);
  RayTraversal walk(BoxRay({-1, 0.5, 0.5}, {101, 0, 0}, {}), 0, 1.0f);
  int leaves = 0;
  while (next_ray_leaf<4>(tree.nodes.data(), walk)) {
    if (++leaves == 1) {
      const std::uint32_t* const first = tree.items.data() + leaf_first(walk.leaf);
      EXPECT_NE(std::find(first, first + leaf_count(walk.leaf), 0u), first + leaf_count(walk.leaf))
          << "the nearest box first";
    }
    walk.max_fraction = 3.5f / 101.0f;  // all but the first three
  }
  EXPECT_GE(leaves, 1);
  EXPECT_LE(leaves, 3);
}

}  // namespace
}  // namespace gyre::ray_traversal_test
