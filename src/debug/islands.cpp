#include "debug/islands.h"

#include "base/container/disjoint_sets.h"
#include "rigid/sleep/island.h"

#include <gyre/debug.h>

namespace gyre {

IslandMap find_islands(const RigidWorld& w) {
  const std::size_t count = w.bodies.motion.size();
  const auto moves = [&](std::uint32_t body) {
    return w.bodies.ids.live(body) && is_movable(w.bodies.flags[body]);
  };
  IslandMap map;
  map.roots.resize(count);
  map.sizes.assign(count, 0);
  const DisjointSets sets(map.roots);
  for_each_island_edge(w, [&](std::uint32_t a, std::uint32_t b) {
    if (moves(a) && moves(b)) sets.unite(a, b);
  });
  sets.flatten();
  for (std::uint32_t i = 0; i < count; ++i) {
    if (moves(i) && map.sizes[map.roots[i]]++ == 0) ++map.count;
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!moves(i)) map.roots[i] = kNoIsland;
  }
  return map;
}

}  // namespace gyre
