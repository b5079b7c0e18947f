#include "dynamics/soft/soft_loads.h"

#include "base/container/disjoint_sets.h"
#include "rigid/sleep/island.h"

namespace gyre {

void find_loads(const RigidWorld& w, const SoftStore& soft, std::span<const std::uint32_t> bodies,
                Arena& arena, std::span<double> loads) {
  if (bodies.empty()) return;
  const ArenaScope scope(arena);
  // Soft matter stands behind the bodies.
  const std::size_t first = w.bodies.inertia.size(), count = first + soft.entries.size();
  const DisjointSets islands(arena.make<std::uint32_t>(count));
  const auto mass_of = [&](std::uint32_t body) {
    const float inverse = w.bodies.inertia[body].inverse_mass;
    return inverse > 0.0f ? 1.0 / double(inverse) : 0.0;
  };
  const std::span<std::uint8_t> is_held = arena.make<std::uint8_t>(first);
  for (std::uint8_t& one : is_held) one = 0;
  w.joints.ids.for_each_live([&](std::uint32_t slot) {
    for (const std::int32_t body : {w.joints.records[slot].body_a, w.joints.records[slot].body_b})
      if (body != kNoBody) is_held[std::uint32_t(body)] = 1;
  });
  for_each_active_edge(w, [&](std::uint32_t a, std::uint32_t b) {
    is_held[a] = is_held[b] = 1;
    if (mass_of(a) > 0.0 && mass_of(b) > 0.0) islands.unite(a, b);
  });
  for (std::size_t slot = 0; slot < soft.entries.size(); ++slot) {
    const auto unite = [&](std::int32_t body) {
      if (body != kWorldAnchor && mass_of(std::uint32_t(body)) > 0.0)
        islands.unite(std::uint32_t(body), std::uint32_t(first + slot));
    };
    for_each_attachment(soft.entries[slot], [&](const auto& one) { unite(one.body); });
    for_each_contact(soft.entries[slot], [&](const SoftContact& one) { unite(one.body); });
  }
  islands.flatten();
  const std::span<double> masses = arena.make<double>(count);
  for (double& mass : masses) mass = 0.0;
  for (const std::uint32_t body : w.bodies.awake) masses[islands.parents[body]] += mass_of(body);
  for (std::size_t slot = 0; slot < soft.entries.size(); ++slot) {
    if (soft.entries[slot].def == nullptr) continue;
    const Particles& p = soft.entries[slot].body.particles;
    for (int i = 0; i < p.count; ++i) masses[islands.parents[first + slot]] += double(p.mass[i]);
  }
  for (std::size_t k = 0; k < bodies.size(); ++k)
    loads[k] = is_held[bodies[k]] != 0 ? masses[islands.parents[bodies[k]]] - mass_of(bodies[k]) : 0.0;
}

}  // namespace gyre
