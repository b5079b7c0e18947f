#include "debug/islands.h"

#include "rigid/sleep/island.h"

#include <gyre/debug.h>

namespace gyre {

namespace {

std::uint32_t find_root(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

IslandMap find_islands(const RigidWorld& w) {
  const std::size_t count = w.bodies.motion.size();
  const auto moves = [&](std::uint32_t body) {
    return w.bodies.ids.live(body) && is_movable(w.bodies.flags[body]);
  };
  IslandMap map;
  map.roots.resize(count);
  map.sizes.assign(count, 0);
  for (std::uint32_t i = 0; i < count; ++i) map.roots[i] = i;
  for_each_island_edge(w, [&](std::uint32_t a, std::uint32_t b) {
    if (!moves(a) || !moves(b)) return;
    a = find_root(map.roots, a);
    b = find_root(map.roots, b);
    if (a < b) {
      map.roots[b] = a;
    } else {
      map.roots[a] = b;
    }
  });
  // A root has the lowest index of its members: in ascending order, each parent is final when it is read.
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!moves(i)) continue;
    map.roots[i] = map.roots[map.roots[i]];
    if (map.sizes[map.roots[i]]++ == 0) ++map.count;
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!moves(i)) map.roots[i] = kNoIsland;
  }
  return map;
}

}  // namespace gyre
