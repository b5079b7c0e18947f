// World::cloth_crossings: where cloths pass through themselves and each other. In: the vertices of all cloths. Out: a number, exact for these positions.
// The test is that of soft/contact/surface_crossings.h.
#include "base/float_mode.h"
#include "soft/contact/surface_crossings.h"
#include "world/world_state.h"

namespace gyre {

std::size_t World::cloth_crossings() const {
  const FloatMode mode;
  Array<PlacedSurface> placed;
  Array<DVec3> positions;
  state_->soft.for_each([&](const SoftEntry& entry) {
    if (entry.kind != SoftKind::cloth || entry.contact_surface == nullptr) return;
    placed.push_back({entry.contact_surface.get(), std::uint32_t(positions.size())});
    const Particles& p = entry.body.particles;
    for (int i = 0; i < p.count; ++i) positions.push_back(p.place(i));
  });
  Arena arena;
  return placed.empty() ? 0 : std::size_t(count_crossings(placed.view(), positions.view(), arena));
}

}  // namespace gyre
