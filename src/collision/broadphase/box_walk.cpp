// Chooses how many boxes are tested side by side on this machine.
#include "collision/broadphase/box_walk.h"

#include "base/processor.h"
#include "collision/broadphase/box_walk_lanes.h"

namespace gyre {

#if defined(__x86_64__)
extern const WalkBoxes kWalkBoxes_avx2;
extern const RayTraversalKernel<BoxTreeNode> kBoxRayTraversal_avx2;
#endif

WalkBoxes select_box_walk() {
#if defined(__x86_64__)
  if (max_lanes() >= 8) return kWalkBoxes_avx2;
#endif
  return walk_boxes<4>;
}

RayTraversalKernel<BoxTreeNode> select_box_ray_traversal() {
#if defined(__x86_64__)
  if (max_lanes() >= 8) return kBoxRayTraversal_avx2;
#endif
  return next_ray_leaf<4, BoxTreeNode>;
}

}  // namespace gyre
