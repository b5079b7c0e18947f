// Ray traversal for one kind of CPU, in a namespace of its own, so that the linker never mixes it with the others.
#define GYRE_TARGET_NAMESPACE target_avx2
#include "geometry/tree/ray_traversal_lanes.h"

namespace gyre {

extern const RayTraversalKernel<StaticNode> kStaticRayTraversal_avx2;
const RayTraversalKernel<StaticNode> kStaticRayTraversal_avx2 = next_ray_leaf<8, StaticNode>;

}  // namespace gyre
