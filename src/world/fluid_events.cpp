#include "world/fluid_events.h"

#include "dynamics/fluid_visitors.h"
#include "world/world_state.h"

namespace gyre {

namespace {

FluidTouch touch_of(const WorldState& s, std::uint32_t slot, const FluidVisitor& who, int vertex,
                    bool begins) {
  FluidTouch out;
  out.fluid = {slot, std::uint16_t(s.fluids.ids.generation(slot)), s.number};
  if (who.is_soft != 0)
    out.soft = {who.index, std::uint16_t(who.generation), s.number};
  else
    out.body = {who.index, std::uint16_t(who.generation), s.number};
  out.vertex = vertex, out.begins = begins;
  return out;
}

std::uint64_t order_of(const FluidVisitor& who) { return std::uint64_t(who.is_soft) << 32 | who.index; }

}  // namespace

void report_fluid_events(WorldState& s) {
  std::swap(s.published_fluid_touches, s.fluids.events);
  s.fluids.events.clear();
  Array<FoundVisitor> found;
  for (std::uint32_t slot = 0; slot < s.fluids.entries.size(); ++slot) {
    FluidEntry& entry = s.fluids.entries[slot];
    if (entry.def == nullptr) continue;
    find_fluid_visitors(s.rigid, s.soft, entry, found);
    const auto tell = [&](const FluidVisitor& who, int vertex, bool begins) {
      s.published_fluid_touches.push_back(touch_of(s, slot, who, vertex, begins));
    };
    const Array<FluidVisitor>& before = entry.visitors;
    std::size_t a = 0, b = 0;
    while (a < before.size() || b < found.size()) {
      const bool only_before =
          b == found.size() || (a < before.size() && order_of(before[a]) < order_of(found[b].who));
      const bool only_now =
          a == before.size() || (!only_before && order_of(found[b].who) < order_of(before[a]));
      if (only_before) {
        tell(before[a++], -1, false);
      } else if (only_now) {
        tell(found[b].who, found[b].vertex, true);
        ++b;
      } else {
        // Another object has the index of one that was removed.
        if (before[a].generation != found[b].who.generation)
          tell(before[a], -1, false), tell(found[b].who, found[b].vertex, true);
        ++a, ++b;
      }
    }
    entry.visitors.clear();
    for (const FoundVisitor& one : found) entry.visitors.push_back(one.who);
  }
}

void end_fluid_touches(WorldState& s, std::uint32_t slot) {
  for (const FluidVisitor& who : s.fluids.entries[slot].visitors)
    s.fluids.events.push_back(touch_of(s, slot, who, -1, false));
}

}  // namespace gyre
