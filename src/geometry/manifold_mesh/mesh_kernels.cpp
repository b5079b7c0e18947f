// Chooses the kernels for this machine.
#include "geometry/manifold_mesh/mesh_kernels.h"

#include "base/processor.h"
#include "geometry/manifold_mesh/mesh_lanes.h"

namespace gyre {

#if defined(__x86_64__)
extern const MeshKernels kMeshKernels_avx2;
#endif

const MeshKernels& select_mesh_kernels() {
#if defined(__x86_64__)
  if (max_lanes() >= 8) return kMeshKernels_avx2;
#endif
  static constexpr MeshKernels kDefault = mesh_kernels<4>();
  return kDefault;
}

}  // namespace gyre
