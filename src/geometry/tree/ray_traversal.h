// Traversal of box trees along a line, from near to far, for rays and for boxes that move along a line (casts).
//
// In: nodes with eight boxes side by side, and a ray or a moving box. Out: the leaves that it meets, one at a time and
// roughly from near to far; among the children of one node the nearest comes first. The caller may shorten the ray in
// between. This is a kernel, because a processor with eight lanes tests a node with half of the instructions.
//
// It never misses a box: the moving box is enlarged by more than the rounding error of float, so an exact test
// afterwards loses nothing. No division fails on a line along an axis: a component below 1e-30 m counts as 1e-30 m with
// its sign.
//
// Source: T. Kay, J. Kajiya, "Ray Tracing Complex Scenes", 1986 (slabs); A. Williams et al., "An Efficient and Robust
// Ray-Box Intersection Algorithm", 2005 (near and far planes chosen once by the sign of the direction).
#pragma once

#include "geometry/tree/static_node.h"

#include <gyre/math.h>

#include <cstdint>

namespace gyre {

// A moving box as a ray against slabs. On each axis the box begins to touch a plane at the fraction (plane - near) *
// inverse of its translation, and ceases at (plane - far) * inverse.
struct BoxRay {
  float near[3], far[3], inverse[3];
  bool negative[3];  // the high plane of a box is met first

  static constexpr double kSlack = 4.0e-7;  // six roundings of float
  static constexpr double kStill = 1.0e-30;  // components of a direction below this count as zero

  // A box of half size `half` that moves from `origin` by the translation. Boxes with coordinates much larger than all
  // three are met early or late by no more than their own rounding.
  BoxRay(DVec3 origin, DVec3 translation, Vec3 half) {
    for (int axis = 0; axis < 3; ++axis) {
      const double o = origin[axis], w = translation[axis];
      double margin = double(half[axis]) + kSlack * (absolute(o) + absolute(w) + double(half[axis]));
      // A box without thickness that moves within its plane meets it all the time.
      if (absolute(w) < kStill) margin += 10.0 * kStill;
      negative[axis] = w < 0.0;
      const double step = absolute(w) < kStill ? kStill : absolute(w);
      inverse[axis] = float((negative[axis] ? -1.0 : 1.0) / step);
      near[axis] = float(negative[axis] ? o - margin : o + margin);
      far[axis] = float(negative[axis] ? o + margin : o - margin);
    }
  }
};

// The state of a traversal.
struct RayTraversal {
  static constexpr int kRoom = 256;  // 32 levels of trees, eight lanes each

  BoxRay line;
  float max_fraction;  // 0 or more: the fraction at which the ray ends; the caller may shorten it
  std::uint32_t leaf;  // the leaf that was met last, without kLeafBit
  int depth = 1;
  // Nodes and leaves still to visit, the nearest last. The high word is the fraction at which one is met (0 or more, so
  // its bits order like its value). Not cleared: only the counted elements are read.
  union {
    std::uint64_t waiting[kRoom];
  };

  // `root`: the index of a node.
  RayTraversal(const BoxRay& along, std::uint32_t root, float to) : line(along), max_fraction(to) {
    waiting[0] = root;
  }
};

// Moves to the next leaf. Returns false at the end.
template <class Node>
using RayTraversalKernel = bool (*)(const Node* nodes, RayTraversal& walk);

// The fastest kernel on this machine.
RayTraversalKernel<StaticNode> select_static_ray_traversal();

}  // namespace gyre
