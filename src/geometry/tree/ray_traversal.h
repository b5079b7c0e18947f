// Walks over trees of boxes along a line, from near to far: what rays and moving shapes look for candidates with.
//
// In: nodes, eight boxes side by side in each, and a box that moves along a line, or a ray (a box without size). Out: the
// leaves that it meets, one at a time and roughly from near to far (of one node's children the nearest first); whoever walks may
// shorten what is still looked at in between. It is a kernel, since a processor with eight lanes tests a node by half of the instructions.
//
// Never misses: the moving box is enlarged by more than what rounding to float can do, so a caller who tests exactly
// afterwards loses nothing. Where the line runs along an axis no division goes wrong: a way below 1e-30 m counts as such a
// way, with the sign that it has.
//
// Source: T. Kay, J. Kajiya, "Ray Tracing Complex Scenes", 1986 (slabs); the near and far planes chosen once by the sign of
// the direction as in A. Williams et al., "An Efficient and Robust Ray-Box Intersection Algorithm", 2005.
#pragma once

#include "geometry/tree/static_node.h"

#include <gyre/math.h>

#include <cstdint>

namespace gyre {

// What planes are held against on each axis: the moving box begins to touch one where (plane - near) * inverse is the fraction
// of its way, and ends to touch one where it is (plane - far) * inverse.
struct BoxRay {
  float near[3], far[3], inverse[3];
  bool negative[3];  // low planes are met last

  static constexpr double kSlack = 4.0e-7;  // six roundings of floats
  static constexpr double kStill = 1.0e-30;

  // A box of half size `half` around `origin` that moves by `way`. Boxes that hold coordinates much larger than all
  // three are met late or early by no more than their own rounding.
  BoxRay(DVec3 origin, DVec3 way, Vec3 half) {
    for (int axis = 0; axis < 3; ++axis) {
      const double o = origin[axis], w = way[axis];
      double margin = double(half[axis]) + kSlack * (absolute(o) + absolute(w) + double(half[axis]));
      // What lies in the plane of a box without thickness, and stays there, meets it all the way.
      if (absolute(w) < kStill) margin += 10.0 * kStill;
      negative[axis] = w < 0.0;
      const double least = absolute(w) < kStill ? kStill : absolute(w);
      inverse[axis] = float((negative[axis] ? -1.0 : 1.0) / least);
      near[axis] = float(negative[axis] ? o - margin : o + margin);
      far[axis] = float(negative[axis] ? o + margin : o - margin);
    }
  }
};

// A walk on its way.
struct RayTraversal {
  static constexpr int kRoom = 256;  // 32 levels of trees, eight lanes each

  BoxRay line;
  float reach;  // 0 or more: the fraction of the way up to which is looked, which whoever walks may shorten
  std::uint32_t leaf;  // the one that was met last, without kLeafBit
  int depth = 1;
  // Nodes and leaves that wait, each below the fraction at which it is met (0 or more, whose bits order as its values do), the
  // nearest last. Not cleared: only the counted ones are ever read.
  union {
    std::uint64_t waiting[kRoom];
  };

  // `root`: the index of a node.
  RayTraversal(const BoxRay& along, std::uint32_t root, float to) : line(along), reach(to) { waiting[0] = root; }
};

// Goes on to the next leaf; false if there is none.
template <class Node>
using RayTraversalKernel = bool (*)(const Node* nodes, RayTraversal& walk);

// The one that this machine runs best.
RayTraversalKernel<StaticNode> select_static_ray_traversal();

}  // namespace gyre
