// The factory of broad phases.
#include "collision/broadphase.h"

#include "collision/broadphase_brute.h"
#include "collision/broadphase_bvh.h"

namespace gyre {

void Broadphase::for_each_node(FunctionRef<void(const NodeBox&)>) const {}
const char* Broadphase::find_fault(std::span<const Proxy>, std::span<const std::uint32_t>) const {
  return nullptr;
}

std::unique_ptr<Broadphase> make_broadphase(BroadPhaseKind kind) {
  switch (kind) {
    case BroadPhaseKind::bvh:
      return std::make_unique<BroadphaseBvh>();
    case BroadPhaseKind::brute_force:
      return std::make_unique<BroadphaseBrute>();
  }
  return std::make_unique<BroadphaseBvh>();
}

}  // namespace gyre
