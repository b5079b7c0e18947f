#include "dynamics/soft/soft_groups.h"

#include "base/container/disjoint_sets.h"

namespace gyre {

namespace {

struct WideBox {
  DVec3 low{}, high{};
};

WideBox box_of(const SoftEntry& entry, float gravity, float seconds) {
  const Particles& p = entry.body.particles;
  const float fall = entry.is_awake() ? gravity * seconds * seconds : 0.0f;
  WideBox box;
  for (int i = 0; i < p.count; ++i) {
    const DVec3 at = p.place(i);
    const double pad = double(entry.contact_surface->radius[i] + seconds * length(p.velocity(i)) + fall);
    const DVec3 low = at - DVec3{pad, pad, pad}, high = at + DVec3{pad, pad, pad};
    box.low = i == 0 ? low : DVec3{min(box.low.x, low.x), min(box.low.y, low.y), min(box.low.z, low.z)};
    box.high =
        i == 0 ? high : DVec3{max(box.high.x, high.x), max(box.high.y, high.y), max(box.high.z, high.z)};
  }
  return box;
}

bool overlap(const WideBox& a, const WideBox& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y &&
         a.low.z <= b.high.z && b.low.z <= a.high.z;
}

}  // namespace

std::span<const std::uint32_t> group_soft(const SoftStore& soft, float gravity, float seconds, Arena& arena) {
  const DisjointSets sets(arena.make<std::uint32_t>(soft.entries.size()));
  const std::span<WideBox> boxes = arena.make<WideBox>(soft.entries.size());
  const std::span<std::uint32_t> slots = arena.make<std::uint32_t>(soft.entries.size());
  std::size_t count = 0;
  for (std::uint32_t slot = 0; slot < std::uint32_t(soft.entries.size()); ++slot) {
    const SoftEntry& entry = soft.entries[slot];
    if (entry.def == nullptr || entry.contact_surface == nullptr || !entry.contact_surface->touches_soft)
      continue;
    boxes[count] = box_of(entry, gravity, seconds);
    slots[count++] = slot;
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = i + 1; k < count; ++k) {
      if (overlap(boxes[i], boxes[k])) sets.unite(slots[i], slots[k]);
    }
  }
  sets.flatten();
  return sets.parents;
}

}  // namespace gyre
