// The static tree against brute force.
#include "geometry/tree/static_tree.h"

#include "geometry/query/box_cast.h"
#include "geometry/testing/mesh_test_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace gyre::static_tree_test {
namespace {

using test::Random;

std::vector<Aabb> random_boxes(Random& random, std::size_t count, float spread, float size) {
  std::vector<Aabb> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 c = random.in_box(spread);
    boxes.push_back({c - absolute(random.in_box(size)), c + absolute(random.in_box(size))});
  }
  return boxes;
}

// Every item occurs once, boxes contain everything below them, and the traversal visits exactly the leaves whose boxes
// overlap.
void expect_sound(const std::vector<Aabb>& boxes, const StaticTree& tree) {
  std::vector<std::uint32_t> sorted = tree.items;
  std::sort(sorted.begin(), sorted.end());
  ASSERT_EQ(sorted.size(), boxes.size());
  for (std::uint32_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(sorted[i], i);
  std::uint32_t next = 0;
  walk_overlaps(
      tree, tree.box, [](std::uint32_t, int) { return true; },
      [&](std::uint32_t first, std::uint32_t count) {
        EXPECT_EQ(first, next);
        next = first + count;
      });
  EXPECT_EQ(next, boxes.size());
  for (const StaticTree::Node& node : tree.nodes) {
    for (int lane = 0; lane < StaticTree::kWidth; ++lane) {
      const std::uint32_t child = node.child[lane];
      if (child == StaticTree::kNoChild) continue;
      const Aabb outer = child_box(node, lane);
      if (is_leaf(child)) {
        for (std::uint32_t i = 0; i < leaf_count(child); ++i) {
          EXPECT_TRUE(contains(outer, boxes[tree.items[leaf_first(child) + i]]));
        }
        continue;
      }
      for (int k = 0; k < StaticTree::kWidth; ++k) {
        if (tree.nodes[child].child[k] == StaticTree::kNoChild) continue;
        EXPECT_TRUE(contains(outer, child_box(tree.nodes[child], k)));
      }
    }
  }
}

TEST(StaticTree, FindsExactlyWhatBruteForceFinds) {
  Random random{7};
  for (const std::size_t count : {1u, 2u, 4u, 5u, 33u, 1000u}) {
    const std::vector<Aabb> boxes = random_boxes(random, count, 10.0f, 0.7f);
    StaticTree tree;
    build_static_tree(boxes, tree);
    expect_sound(boxes, tree);
    for (int query = 0; query < 200; ++query) {
      const Vec3 c = random.in_box(11.0f);
      const Aabb box{c - absolute(random.in_box(2.0f)), c + absolute(random.in_box(2.0f))};
      std::vector<std::uint32_t> out(count);
      const std::uint32_t found = find_overlaps(tree, box, out);
      ASSERT_LE(found, count);
      EXPECT_TRUE(std::is_sorted(out.begin(), out.begin() + found));
      std::vector<std::uint32_t> got, want;
      for (std::uint32_t i = 0; i < found; ++i) {
        if (overlap(boxes[tree.items[out[i]]], box)) got.push_back(tree.items[out[i]]);
      }
      for (std::uint32_t i = 0; i < count; ++i) {
        if (overlap(boxes[i], box)) want.push_back(i);
      }
      std::sort(got.begin(), got.end());
      EXPECT_EQ(got, want);
    }
  }
}

TEST(StaticTree, CountsBeyondTheRoomGiven) {
  Random random{3};
  const std::vector<Aabb> boxes = random_boxes(random, 100, 1.0f, 0.1f);
  StaticTree tree;
  build_static_tree(boxes, tree);
  std::uint32_t few[5] = {};
  EXPECT_EQ(find_overlaps(tree, {{-9, -9, -9}, {9, 9, 9}}, few), 100u);
  EXPECT_EQ(few[4], 4u);
}

TEST(StaticTree, TakesDegenerateInput) {
  std::vector<std::vector<Aabb>> sets;
  sets.emplace_back();                                    // nothing
  sets.emplace_back(500, Aabb{{1, 2, 3}, {1, 2, 3}});     // one point, many times
  sets.emplace_back(500, Aabb{{-1, -1, -1}, {1, 1, 1}});  // one box, many times
  std::vector<Aabb> growing;  // each far outside the last: the deepest kind of tree
  for (int i = 0; i < 96; ++i) growing.push_back({{0, 0, 0}, {std::ldexp(1.0f, i / 2 - 20), 1, 1}});
  sets.push_back(growing);
  std::vector<Aabb> line;
  for (int i = 0; i < 200; ++i) {
    const float x = std::ldexp(1.0f, i / 3 - 30);
    line.push_back({{x, 0, 0}, {x, 0, 0}});
  }
  sets.push_back(line);
  for (const std::vector<Aabb>& boxes : sets) {
    StaticTree tree;
    build_static_tree(boxes, tree);
    if (!boxes.empty()) expect_sound(boxes, tree);
    std::uint32_t out[4];
    EXPECT_EQ(find_overlaps(tree, {{1e9f, 1e9f, 1e9f}, {2e9f, 2e9f, 2e9f}}, out), 0u);
  }
}

TEST(StaticTree, AWalkCanLeaveParts) {
  Random random{5};
  const std::vector<Aabb> boxes = random_boxes(random, 300, 5.0f, 0.2f);
  StaticTree tree;
  build_static_tree(boxes, tree);
  int visits = 0;
  walk_overlaps(
      tree, tree.box, [](std::uint32_t, int) { return false; },
      [&](std::uint32_t, std::uint32_t) { ++visits; });
  EXPECT_EQ(visits, 0);
}

TEST(StaticTree, RaysMeetTheNearestBox) {
  Random random{13};
  const std::vector<Aabb> boxes = random_boxes(random, 400, 10.0f, 0.8f);
  StaticTree tree;
  build_static_tree(boxes, tree);
  const auto entry = [](const Aabb& box, Vec3 origin, Vec3 direction, float reach) {
    float enter = 0.0f, leave = reach;
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] == 0.0f) {
        if (origin[axis] < box.low[axis] || origin[axis] > box.high[axis]) return 2.0f * reach;
        continue;
      }
      const float a = (box.low[axis] - origin[axis]) / direction[axis];
      const float b = (box.high[axis] - origin[axis]) / direction[axis];
      enter = max(enter, min(a, b));
      leave = min(leave, max(a, b));
    }
    return enter <= leave ? enter : 2.0f * reach;
  };
  for (int i = 0; i < 500; ++i) {
    const Vec3 origin = random.in_box(12.0f);
    Vec3 direction = random.direction();
    if (i % 5 == 0) direction = {0, i % 10 == 0 ? 1.0f : -1.0f, 0};
    const float reach = 30.0f;
    float nearest = reach;
    for (const Aabb& box : boxes) nearest = min(nearest, entry(box, origin, direction, reach));
    float found = reach;
    const BoxRay ray(DVec3(origin), DVec3(reach * direction), Vec3{});
    traverse_cast(tree, ray, 1.0f, [&](std::uint32_t first, std::uint32_t count, float) {
      for (std::uint32_t k = first; k < first + count; ++k) {
        found = min(found, entry(boxes[tree.items[k]], origin, direction, reach));
      }
      return found / reach;
    });
    EXPECT_EQ(found, nearest);
  }
}

}  // namespace
}  // namespace gyre::static_tree_test
