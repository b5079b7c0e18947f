// SoftSurface: the triangles of a cloth, or of the boundary of a solid, and a tree of boxes over them. Made once; the boxes follow the vertices.
//
// Each vertex and each edge is owned by one triangle, so that a search for pairs of triangles finds each pair of features once (S. Curtis,
// R. Tamstorf, D. Manocha, "Fast Collision Detection for Deformable Models using Representative-Triangles", 2008).
//
// Several surfaces share one space of vertex numbers: the vertices of a placed surface are `first`, first + 1, ... in the arrays of positions.
#pragma once

#include "base/arena/arena.h"
#include "base/container/array.h"
#include "geometry/tree/static_tree.h"

#include <gyre/math.h>

#include <cstdint>
#include <span>

namespace gyre {

struct SurfaceEdge {
  std::uint32_t a = 0, b = 0;            // a < b
  std::uint32_t triangle = 0, side = 0;  // of which it is the edge 01, 12 or 20, the one that owns it
};

struct SoftTriangle {
  std::uint32_t corner[3] = {};
  std::int32_t owned_edge[3] = {-1, -1, -1};  // of the edges 01, 12, 20: those that this triangle owns
  std::uint32_t owned_corners = 0;            // bit i: this triangle owns corner i
  std::int32_t neighbour[3] = {-1, -1, -1};   // across the edges 01, 12, 20; -1: a boundary of the surface
};

struct SoftSurface {
  int vertices = 0;
  Array<SoftTriangle> triangles;  // in the order of the leaves
  Array<SurfaceEdge> edges;
  // Vertices that share an edge with vertex v: around[around_begin[v]] to around[around_begin[v + 1] - 1].
  Array<std::uint32_t> around_begin, around;
  Array<float> radius;     // m, by vertex: surfaces keep the sum of their radii apart
  StaticTree tree;         // its items are not used
  float mean_edge = 0.0f;  // m, at rest
  float static_friction = 0.4f;
  float dynamic_friction = 0.4f;
  bool self_collision = true;
  bool touches_soft = true;  // or it is there for queries alone
};

// The radius of a vertex is `radius`, but at most a third of the lowest height of the triangles around it at `places`, so that a surface at rest does
// not touch itself.
SoftSurface make_surface(std::span<const DVec3> places, std::span<const std::uint32_t> triangles,
                         float radius);

struct PlacedSurface {
  const SoftSurface* surface = nullptr;
  std::uint32_t first = 0;  // its vertex 0
};

// Boxes of one feature at both ends of a move, three floats and one that is no matter: one cache line.
struct alignas(64) SweptBox {
  float low[4], high[4], end_low[4], end_high[4];
};

constexpr Aabb start_box(const SweptBox& box) {
  return {{box.low[0], box.low[1], box.low[2]}, {box.high[0], box.high[1], box.high[2]}};
}
constexpr Aabb end_box(const SweptBox& box) {
  return {{box.end_low[0], box.end_low[1], box.end_low[2]},
          {box.end_high[0], box.end_high[1], box.end_high[2]}};
}
inline SweptBox merge(const SweptBox& a, const SweptBox& b) {
  using Floats = Wide<4>;
  SweptBox out;
  min(Floats::load(a.low), Floats::load(b.low)).store(out.low);
  max(Floats::load(a.high), Floats::load(b.high)).store(out.high);
  min(Floats::load(a.end_low), Floats::load(b.end_low)).store(out.end_low);
  max(Floats::load(a.end_high), Floats::load(b.end_high)).store(out.end_high);
  return out;
}
// False if one axis separates the boxes at both ends of a move, the same way round: as all in them moves straight, they then never meet.
inline bool may_meet(const SweptBox& a, const SweptBox& b) {
  using Floats = Wide<4>;
  const auto meets =
      ((Floats::load(a.low) <= Floats::load(b.high)) |
       (Floats::load(a.end_low) <= Floats::load(b.end_high))) &
      ((Floats::load(b.low) <= Floats::load(a.high)) | (Floats::load(b.end_low) <= Floats::load(a.end_high)));
  return (to_bits(meets) & 7u) == 7u;
}

// The boxes of one surface at the present positions, and at the ends of moves (the same boxes where nothing moves).
struct SurfaceBoxes {
  const SoftSurface* surface = nullptr;
  std::uint32_t first = 0;
  std::span<StaticNode> nodes, end_nodes;
  std::span<SweptBox> vertices, triangles;
  Aabb box{}, end_box{};
};

// The same.
constexpr bool may_meet(const Aabb& a, const Aabb& a_end, const Aabb& b, const Aabb& b_end) {
  for (int axis = 0; axis < 3; ++axis) {
    if (a.high[axis] < b.low[axis] && a_end.high[axis] < b_end.low[axis]) return false;
    if (b.high[axis] < a.low[axis] && b_end.high[axis] < a_end.low[axis]) return false;
  }
  return true;
}
inline bool may_meet(const SurfaceBoxes& a, const SurfaceBoxes& b) {
  return !a.nodes.empty() && !b.nodes.empty() && may_meet(a.box, a.end_box, b.box, b.end_box);
}
// A bit for each child that may meet the box.
inline unsigned meeting_mask(const StaticNode& node, const StaticNode& end, const Aabb& box,
                             const Aabb& box_end) {
  constexpr int kHalf = 4;
  using Floats = Wide<kHalf>;
  unsigned mask = 0;
  for (int i = 0; i < StaticTree::kWidth; i += kHalf) {
    const auto meets = [&](int axis) {
      return ((Floats::load_unaligned(node.low[axis] + i) <= Floats(box.high[axis])) |
              (Floats::load_unaligned(end.low[axis] + i) <= Floats(box_end.high[axis]))) &
             ((Floats(box.low[axis]) <= Floats::load_unaligned(node.high[axis] + i)) |
              (Floats(box_end.low[axis]) <= Floats::load_unaligned(end.high[axis] + i)));
    };
    mask |= to_bits(meets(0) & meets(1) & meets(2)) << i;
  }
  return mask;
}

// The boxes hold each vertex and a margin of `pads[v]` about it (none: no margin). Positions are measured from `origin`, and
// rounding only enlarges a box. `moves` (none: nothing moves) lead to the ends. Memory is the arena's.
SurfaceBoxes fit_boxes(const PlacedSurface& placed, std::span<const DVec3> positions,
                       std::span<const float> pads, DVec3 origin, Arena& arena,
                       std::span<const DVec3> moves = {});

// Calls visit(i, k) for pairs of triangles whose boxes may meet, of which one at least is marked: i of `a`, k of `b`; of one surface (a and b the same)
// each pair once. This call visits pairs with a marked i; of two surfaces, the call with a and b in turn visits the others, with `rest`.
// The order follows from the trees and the marks alone. Nodes [begin, end) of a are visited, so that several calls may share the work.
template <class MarkA, class MarkB, class Visit>
void for_each_marked_pair(const SurfaceBoxes& a, MarkA&& marked_a, const SurfaceBoxes& b, MarkB&& marked_b,
                          bool rest, std::size_t begin, std::size_t end, Visit&& visit) {
  const bool same = &a == &b;
  const auto count_marked = [](std::uint32_t leaf, auto& marked) {
    std::uint32_t count = 0;
    for (std::uint32_t i = leaf_first(leaf); i < leaf_first(leaf) + leaf_count(leaf); ++i) count += marked(i);
    return count;
  };
  const auto visit_leaf = [&](std::uint32_t leaf, const Aabb& box, const Aabb& box_end) {
    const std::uint32_t first = leaf_first(leaf), past = first + leaf_count(leaf);
    std::uint32_t stack[StaticTree::kStackSize];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const std::uint32_t child = stack[--depth];
      if (!is_leaf(child)) {
        const StaticNode& node = b.nodes[child];
        for (unsigned mask = meeting_mask(node, b.end_nodes[child], box, box_end); mask != 0;) {
          const int lane = int(std::bit_width(mask)) - 1;
          mask ^= 1u << lane;
          // Leaves before this one, if all of them is marked, have been there already.
          const std::uint32_t next = node.child[lane];
          if (same && is_leaf(next) && leaf_first(next) < first &&
              count_marked(next, marked_b) == leaf_count(next))
            continue;
          stack[depth++] = next;
        }
        continue;
      }
      const std::uint32_t other = leaf_first(child), others = leaf_count(child);
      for (std::uint32_t i = first; i < past; ++i) {
        if (!marked_a(i)) continue;
        for (std::uint32_t k = other; k < other + others; ++k) {
          if (marked_b(k) && (same ? k <= i : rest)) continue;
          if (may_meet(a.triangles[i], b.triangles[k])) visit(i, k);
        }
      }
    }
  };
  for (std::size_t n = begin; n < end; ++n) {
    const StaticNode& node = a.nodes[n];
    for (int lane = 0; lane < StaticNode::kWidth; ++lane) {
      const std::uint32_t child = node.child[lane];
      if (child == StaticNode::kNoChild || !is_leaf(child) || count_marked(child, marked_a) == 0) continue;
      const Aabb box = child_box(node, lane), box_end = child_box(a.end_nodes[n], lane);
      if (same || may_meet(box, box_end, b.box, b.end_box)) visit_leaf(child, box, box_end);
    }
  }
}

// The same for all pairs; of one surface with i < k.
template <class Visit>
void for_each_triangle_pair(const SurfaceBoxes& a, const SurfaceBoxes& b, Visit&& visit) {
  if (!may_meet(a, b)) return;
  const auto all = [](std::uint32_t) { return true; };
  for_each_marked_pair(a, all, b, all, false, 0, a.nodes.size(), visit);
}

}  // namespace gyre
