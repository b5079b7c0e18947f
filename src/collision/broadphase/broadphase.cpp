// The factory of broad phases, and their names.
#include "collision/broadphase/broadphase.h"

#include "collision/broadphase/broadphase_brute.h"
#include "collision/broadphase/broadphase_bsp.h"
#include "collision/broadphase/broadphase_bvh.h"
#include "collision/broadphase/broadphase_grid.h"
#include "collision/broadphase/broadphase_kdtree.h"
#include "collision/broadphase/broadphase_sap.h"
#include "collision/broadphase/loose_tree.h"

namespace gyre {

void Broadphase::for_each_node(FunctionRef<void(const NodeBox&)>) const {}
const char* Broadphase::find_fault(std::span<const Proxy>, std::span<const std::uint32_t>) const {
  return nullptr;
}

const char* to_string(BroadPhaseKind kind) {
  constexpr const char* kNames[kBroadPhaseKindCount] = {
      "bvh", "brute_force", "grid", "octree", "quadtree", "kd_tree", "bsp_tree", "sweep_and_prune"};
  return int(kind) < kBroadPhaseKindCount ? kNames[int(kind)] : "?";
}

std::unique_ptr<Broadphase> make_broadphase(BroadPhaseKind kind) {
  switch (kind) {
    case BroadPhaseKind::bvh:
      return std::make_unique<BroadphaseBvh>();
    case BroadPhaseKind::grid:
      return std::make_unique<BroadphaseBase<HashedGrid>>();
    case BroadPhaseKind::octree:
      return std::make_unique<BroadphaseBase<LooseOctree>>();
    case BroadPhaseKind::quadtree:
      return std::make_unique<BroadphaseBase<LooseQuadtree>>();
    case BroadPhaseKind::kd_tree:
      return std::make_unique<BroadphaseBase<KdTree>>();
    case BroadPhaseKind::bsp_tree:
      return std::make_unique<BroadphaseBase<BspTree>>();
    case BroadPhaseKind::sweep_and_prune:
      return std::make_unique<BroadphaseSap>();
    case BroadPhaseKind::brute_force:
      return std::make_unique<BroadphaseBrute>();
  }
  return std::make_unique<BroadphaseBvh>();
}

}  // namespace gyre
