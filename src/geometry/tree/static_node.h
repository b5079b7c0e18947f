// A node of a static tree (static_tree.h) with eight boxes side by side, in a header of its own because kernels read
// it.
#pragma once

#include <cstdint>

namespace gyre {

struct StaticNode {
  static constexpr int kWidth = 8;
  static constexpr std::uint32_t kMaxItems = 1u << 28;

  // A child is the index of a node, or a leaf: kLeafBit, then its number of items less one (3 bits), then its first
  // position. The boxes of unused lanes overlap nothing.
  static constexpr std::uint32_t kLeafBit = 1u << 31;
  static constexpr std::uint32_t kNoChild = 0xffffffffu;

  float low[3][kWidth];
  float high[3][kWidth];
  std::uint32_t child[kWidth];
};

constexpr bool is_leaf(std::uint32_t child) { return (child & StaticNode::kLeafBit) != 0; }
constexpr std::uint32_t leaf_first(std::uint32_t child) { return child & (StaticNode::kMaxItems - 1); }
constexpr std::uint32_t leaf_count(std::uint32_t child) { return ((child >> 28) & 7u) + 1; }

}  // namespace gyre
