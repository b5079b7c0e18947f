// FluidStore: all gases and liquids of a world, by the index of their ids. An entry is rebuilt from its definition when a state is loaded;
// only what changes is saved.
#pragma once

#include "base/container/array.h"
#include "base/container/slot_map.h"
#include "fluid/gas/gas_step.h"
#include "fluid/grid/fluid_frame.h"
#include "fluid/liquid/liquid_step.h"

#include <gyre/events.h>
#include <gyre/fluid.h>

#include <memory>
#include <variant>
#include <vector>

namespace gyre {

using FluidDef = std::variant<GasDef, LiquidDef>;

// The force of a fluid on a body in the last step in which the body was awake. A body that sleeps wakes when it changes.
struct FluidPush {
  std::uint32_t body = 0;
  Vec3 force{}, torque{};  // N, N m about the centre of mass
};

// A body or a piece of soft matter that was inside a fluid at the end of the last step.
struct FluidVisitor {
  std::uint32_t index = 0, generation = 0;
  std::uint32_t is_soft = 0;
};

struct FluidEntry {
  std::shared_ptr<const FluidDef> def;  // null: the slot is free
  GasGrid gas;                          // of a gas, else empty
  LiquidGrid liquid;                    // of a liquid, else empty
  Array<GasEmitter> emitters;
  Array<float> emitter_fuel;     // kg/m^3, one for each emitter of a gas with combustion, else empty
  Array<FluidPush> pushes;       // ascending by body
  Array<FluidVisitor> visitors;  // bodies, then soft matter, each ascending by index
  Array<FluidFrame> frames;      // none: the axes of the world; or one

  const FluidFrame* frame() const { return frames.empty() ? nullptr : frames.data(); }
  FluidKind kind() const { return FluidKind(def->index()); }
  bool is_liquid() const { return kind() == FluidKind::liquid; }
  bool burns() const { return !is_liquid() && gas_def().combustion.has_value(); }
  const GasDef& gas_def() const { return std::get<GasDef>(*def); }
  const LiquidDef& liquid_def() const { return std::get<LiquidDef>(*def); }
  bool is_adaptive() const { return !is_liquid() && gas_def().adaptive_domain.has_value(); }
  const GasBox& box() const { return is_liquid() ? liquid.box : gas.whole; }
  const GridShape& shape() const { return is_liquid() ? liquid.shape : gas.shape; }
};

struct FluidStore {
  IdPool ids;
  std::vector<FluidEntry> entries;
  Array<FluidTouch> events;  // collected for the end of the step; no state

  bool empty() const { return ids.size() == 0; }
  void clear() {
    ids = {};
    entries.clear();
    events.clear();
  }
  template <class Fn>
  void for_each(Fn&& fn) const {
    for (const FluidEntry& entry : entries)
      if (entry.def != nullptr) fn(entry);
  }
};

// Calls visit(array) for every array of an entry that a step or a command changes: with the definition they are its state.
template <class Entry, class Visitor>
void for_each_fluid_array(Entry& entry, Visitor&& visit) {
  for (auto& faces : entry.gas.velocity) visit(faces);
  visit(entry.gas.density), visit(entry.gas.temperature), visit(entry.gas.pressure);
  for (auto& column : entry.liquid.position) visit(column);
  for (auto& column : entry.liquid.motion) visit(column);
  for (auto& column : entry.liquid.affine) visit(column);
  visit(entry.liquid.volume);
  for (auto& faces : entry.liquid.velocity) visit(faces);
  visit(entry.liquid.surface), visit(entry.liquid.pressure);
  visit(entry.emitters);
  visit(entry.pushes);
  if (entry.burns()) visit(entry.gas.fuel), visit(entry.emitter_fuel);
  if (entry.is_adaptive()) visit(entry.gas.window);
}

// State that files of older versions lack, and which then is as in a new fluid.
template <class Entry, class Visitor>
void for_each_later_fluid_array(Entry& entry, Visitor&& visit) {
  visit(entry.visitors), visit(entry.frames);
}

}  // namespace gyre
