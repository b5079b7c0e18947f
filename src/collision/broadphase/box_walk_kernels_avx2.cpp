// Traversals of box trees for one kind of CPU, in their own namespace so that the linker cannot mix kinds.
#define GYRE_TARGET_NAMESPACE target_avx2
#include "collision/broadphase/box_walk_lanes.h"

namespace gyre {

extern const WalkBoxes kWalkBoxes_avx2;
const WalkBoxes kWalkBoxes_avx2 = walk_boxes<8>;

extern const RayTraversalKernel<BoxTreeNode> kBoxRayTraversal_avx2;
const RayTraversalKernel<BoxTreeNode> kBoxRayTraversal_avx2 = next_ray_leaf<8, BoxTreeNode>;

}  // namespace gyre
