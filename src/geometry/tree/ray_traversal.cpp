// Chooses how many boxes are tested side by side on this machine.
#include "geometry/tree/ray_traversal.h"

#include "base/processor.h"
#include "geometry/tree/ray_traversal_lanes.h"

namespace gyre {

#if defined(__x86_64__)
extern const RayTraversalKernel<StaticNode> kStaticRayTraversal_avx2;
#endif

RayTraversalKernel<StaticNode> select_static_ray_traversal() {
#if defined(__x86_64__)
  if (max_lanes() >= 8) return kStaticRayTraversal_avx2;
#endif
  return next_ray_leaf<4, StaticNode>;
}

}  // namespace gyre
