// Islands between two steps, for reading: union-find over island edges (rigid/sleep/island.h).
#pragma once

#include "rigid/store/rigid_world.h"

#include <vector>

namespace gyre {

struct IslandMap {
  std::vector<std::uint32_t>
      roots;  // by body slot: the lowest body of its island; kNoIsland for static and kinematic bodies
  std::vector<std::uint32_t> sizes;  // by root: bodies in its island; 0 for others
  std::uint32_t count = 0;
};
IslandMap find_islands(const RigidWorld& w);

}  // namespace gyre
