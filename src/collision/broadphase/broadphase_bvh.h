// The default broad phase: two bounding volume hierarchies with wide nodes, one of fixed and one of moving proxies.
#pragma once

#include "collision/broadphase/box_tree.h"
#include "collision/broadphase/broadphase_base.h"

namespace gyre {

class BroadphaseBvh final : public BroadphaseBase<BoxTree> {
 public:
  const BoxTree& moving_tree() const { return indices_[kMoving]; }
  const BoxTree& fixed_tree() const { return indices_[kFixed]; }
};

}  // namespace gyre
