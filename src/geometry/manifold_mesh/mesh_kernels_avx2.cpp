// Mesh kernels for one kind of CPU, in a namespace of its own, so that the linker never mixes them with the others.
#define GYRE_TARGET_NAMESPACE target_avx2
#include "geometry/manifold_mesh/mesh_lanes.h"

namespace gyre {

extern const MeshKernels kMeshKernels_avx2;
const MeshKernels kMeshKernels_avx2 = mesh_kernels<8>();

}  // namespace gyre
