#include "dynamics/fluid/adaptive_domain.h"

#include "fluid/gas/gas_window.h"

namespace gyre {

namespace {

CellBox all_cells(const GasBox& box) { return whole_window(box).cells(); }

// The cells of a region in the axes of the box of the gas.
CellBox cells_of_region(const GasBox& box, DVec3 low, DVec3 high) {
  return cells_of(box, difference(low, box.corner), difference(high, box.corner));
}

// True if the air far from everything moves or is accelerated, relative to the box.
bool moves_everywhere(const FluidEntry& entry, Vec3 gravity) {
  if (entry.frame() != nullptr && entry.frame()->moves()) return true;
  const GasBox& box = entry.gas.whole;
  const float weight[3] = {gravity.x, gravity.y, gravity.z};
  for (int axis = 0; axis < 3; ++axis)
    if (box.periodic(axis) && !box.flat(axis) && weight[axis] != 0.0f) return true;
  return false;
}

void include_emitters(const FluidEntry& entry, double time, CellBox& range) {
  for (const GasEmitter& emitter : entry.emitters) {
    if (!(time >= emitter.start && time < emitter.end)) continue;
    const double r = double(emitter.radius);
    const DVec3 reach{r, r, r};
    range.include(cells_of_region(entry.gas.whole, emitter.position - reach, emitter.position + reach));
  }
}

// Air at rest turns round a body that moves, and the gas bears a body that may fall.
void include_bodies(const RigidWorld& w, const FluidEntry& entry, const FluidSolids& solids, CellBox& range) {
  for (const NearShape& near : solids.moving) {
    const bool moves = w.bodies.flags[near.body].type == BodyType::dynamic
                           ? w.bodies.flags[near.body].awake != 0
                           : w.bodies.motion[near.body].linear_velocity != Vec3{} ||
                                 w.bodies.motion[near.body].angular_velocity != Vec3{};
    if (moves) range.include(cells_of_region(entry.gas.whole, DVec3(near.box.low), DVec3(near.box.high)));
  }
}

void include_soft(const SoftStore& soft, const FluidEntry& entry, CellBox& range) {
  const CellBox whole = all_cells(entry.gas.whole);
  for (const SoftEntry& one : soft.entries) {
    if (one.def == nullptr || one.body.particles.count == 0) continue;
    const Particles& p = one.body.particles;
    DVec3 low = point_to_frame(entry.frame(), p.place(0)), high = low;
    for (int i = 1; i < p.count; ++i) {
      const DVec3 at = point_to_frame(entry.frame(), p.place(i));
      low = {min(low.x, at.x), min(low.y, at.y), min(low.z, at.z)};
      high = {max(high.x, at.x), max(high.y, at.y), max(high.z, at.z)};
    }
    const Vec3 from = difference(low, entry.gas.whole.corner), to = difference(high, entry.gas.whole.corner);
    const Vec3 size{float(whole.high[0]) * entry.gas.whole.cell.x,
                    float(whole.high[1]) * entry.gas.whole.cell.y,
                    float(whole.high[2]) * entry.gas.whole.cell.z};
    const bool meets = to.x >= 0.0f && to.y >= 0.0f && to.z >= 0.0f && from.x <= size.x && from.y <= size.y &&
                       from.z <= size.z;
    if (meets) range.include(cells_of(entry.gas.whole, from, to));
  }
}

// A wall that moves drags the viscous gas along all of it.
void include_walls(const FluidEntry& entry, CellBox& range) {
  const GasBox& box = entry.gas.whole;
  for (int side = 0; side < 6; ++side) {
    const bool drags = box.side[side] == FluidBoundary::no_slip && box.wall_velocity[side] != Vec3{} &&
                       entry.gas_def().viscosity > 0.0f;
    if (!drags) continue;
    CellBox layer = all_cells(box);
    const int axis = side / 2;
    (side % 2 == 0 ? layer.high[axis] : layer.low[axis]) = side % 2 == 0 ? 1 : box.cells[axis] - 1;
    range.include(layer);
  }
}

}  // namespace

void adapt_domain(const RigidWorld& w, const SoftStore& soft, const FluidSolids& solids, Vec3 gravity,
                  double time, float seconds, TaskSystem& tasks, FluidEntry& entry) {
  if (!entry.is_adaptive()) return;
  GasGrid& gas = entry.gas;
  const AdaptiveDomain& domain = *entry.gas_def().adaptive_domain;
  if (moves_everywhere(entry, gravity)) return set_gas_window(gas, whole_window(gas.whole));
  CellBox range = find_active_cells(gas, domain.threshold, seconds, tasks);
  include_emitters(entry, time, range);
  include_bodies(w, entry, solids, range);
  include_soft(soft, entry, range);
  include_walls(entry, range);
  if (!is_empty(range)) range = grow(gas.whole, range, domain.margin);
  set_gas_window(gas, gas_window(gas.whole, range));
}

bool is_within_window(const GasGrid& gas, const FluidSolids& solids, std::uint32_t body) {
  for (const NearShape& near : solids.moving) {
    if (near.body != body) continue;
    if (!gas.cells().contains(cells_of_region(gas.whole, DVec3(near.box.low), DVec3(near.box.high))))
      return false;
  }
  return true;
}

}  // namespace gyre
