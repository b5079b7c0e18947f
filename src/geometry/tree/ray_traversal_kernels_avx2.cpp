// Walks along lines for one kind of CPU, in a namespace of its own so that the linker can never mix it with others'.
#define GYRE_TARGET_NAMESPACE target_avx2
#include "geometry/tree/ray_traversal_lanes.h"

namespace gyre {

extern const RayTraversalKernel<StaticNode> kStaticRayTraversal_avx2;
const RayTraversalKernel<StaticNode> kStaticRayTraversal_avx2 = next_ray_leaf<8, StaticNode>;

}  // namespace gyre
