#include "dynamics/fluid/fluid_reaction.h"

#include "fluid/liquid/liquid_pass.h"
#include "fluid/liquid/liquid_window.h"

namespace gyre {

namespace {

// An impulse on a fluid at a place from the lower corner of its box.
struct FluidKick {
  Vec3 place{};    // m
  Vec3 impulse{};  // N s
};

// Calls fn(point, weight) for the eight points of the grid around a place by linear weights; `faces`: the axis of faces, -1: centres. Points
// of periodic axes are those within the box.
template <class Fn>
void for_points_around(const GasBox& box, const GridShape& shape, int faces, Vec3 place, Fn&& fn) {
  int base[3];
  float fraction[3];
  for (int axis = 0; axis < 3; ++axis) {
    const bool wraps = box.periodic(axis) && !box.flat(axis);
    const float last = float(shape.cells[axis] - (axis == faces ? 0 : 1));
    const float at = part_along(place, axis) / part_along(box.cell, axis) - (axis == faces ? 0.0f : 0.5f);
    const float inside = clamp(at, wraps ? -1.0f : 0.0f, wraps ? last + 1.0f : last);
    const int whole = int(inside + 1.0f) - 1;
    base[axis] = whole;
    fraction[axis] = inside - float(whole);
  }
  for (int corner = 0; corner < 8; ++corner) {
    float weight = 1.0f;
    int index[3];
    for (int axis = 0; axis < 3; ++axis) {
      const int up = corner >> axis & 1, n = shape.cells[axis];
      weight *= up != 0 ? fraction[axis] : 1.0f - fraction[axis];
      index[axis] = base[axis] + up;
      if (box.periodic(axis) && !box.flat(axis)) index[axis] = (index[axis] + n) % n;
    }
    if (weight > 0.0f) fn(shape.at(index[0], index[1], index[2]), weight);
  }
}

void kick_gas(FluidEntry& entry, const GasMemory& memory, Array<FluidKick>& kicks) {
  GasGrid& gas = entry.gas;
  const Vec3 origin = difference(gas.box.corner, gas.whole.corner);
  for (FluidKick& kick : kicks) kick.place -= origin;
  const PressureGrid& finest = memory.matrix.levels[0];
  if (memory.matrix.count == 0) return;
  const Vec3 h = gas.box.cell;
  const float mass = entry.gas_def().density * (h.x * h.y * h.z);
  const bool periodic[3] = {gas.box.periodic(0), gas.box.periodic(1), gas.box.periodic(2)};
  for (int axis = 0; axis < 3; ++axis) {
    if (gas.box.flat(axis)) continue;
    const float* const face = finest.face[axis].data();
    float* const velocity = gas.velocity[axis].data();
    for (const FluidKick& kick : kicks) {
      float open = 0.0f;
      for_points_around(gas.box, gas.shape, axis, kick.place,
                        [&](int f, float weight) { open += face[f] > 0.0f ? weight : 0.0f; });
      if (!(open > 0.0f)) continue;
      const float change = part_along(kick.impulse, axis) / (open * mass);
      for_points_around(gas.box, gas.shape, axis, kick.place, [&](int f, float weight) {
        if (face[f] > 0.0f) velocity[f] += weight * change;
      });
    }
    wrap_ghosts(gas.shape, periodic, velocity);
  }
}

// The cells of kicks, and those of all particles that share a centre with one.
CellBox cells_around(const GasBox& box, const Array<FluidKick>& kicks) {
  CellBox cells = cells_of(box, kicks[0].place, kicks[0].place);
  for (const FluidKick& kick : kicks) cells.include(cells_of(box, kick.place, kick.place));
  for (int axis = 0; axis < 3; ++axis) {
    const int last = box.cells[axis];
    const bool wraps = box.periodic(axis);
    cells.low[axis] = wraps || cells.low[axis] < 2 ? 0 : cells.low[axis] - 2;
    cells.high[axis] = wraps || cells.high[axis] + 2 > last ? last : cells.high[axis] + 2;
  }
  return cells;
}

void kick_liquid(FluidEntry& entry, const Array<FluidKick>& kicks) {
  LiquidGrid& liquid = entry.liquid;
  const CellBox cells = cells_around(liquid.box, kicks);
  const FluidWindow window = window_around(liquid.box, with_margin(liquid.box, cells));
  const std::size_t size = std::size_t(window.shape.size);
  // As if the window were all of the box, with places counted from the box's first cell.
  GridShape shape = window.shape;
  for (int axis = 0; axis < 3; ++axis) {
    shape.first -= window.first[axis] * shape.stride(axis);
    shape.cells[axis] = liquid.box.cells[axis];
  }
  const float density = entry.liquid_def().density;
  // Of centres near an impulse: the mass of the particles around, and the impulse they get.
  Array<std::uint8_t> near;
  Array<float> mass, impulse[3];
  near.resize(size, std::uint8_t(0));
  mass.resize(size, 0.0f);
  for (Array<float>& part : impulse) part.resize(size, 0.0f);
  const auto around = [&](Vec3 place, auto&& fn) { for_points_around(liquid.box, shape, -1, place, fn); };
  for (const FluidKick& kick : kicks) around(kick.place, [&](int c, float) { near[c] = 1; });
  const auto place_of = [&](int p) {
    return Vec3{liquid.position[0][p], liquid.position[1][p], liquid.position[2][p]};
  };
  const auto is_near = [&](int p) { return cells.contains(cells_of(liquid.box, place_of(p), place_of(p))); };
  for (int p = 0; p < liquid.particles(); ++p) {
    if (!is_near(p)) continue;
    around(place_of(p), [&](int c, float weight) {
      if (near[c] != 0) mass[c] += weight * density * liquid.volume[p];
    });
  }
  for (const FluidKick& kick : kicks) {
    float filled = 0.0f;
    around(kick.place, [&](int c, float weight) { filled += mass[c] > 0.0f ? weight : 0.0f; });
    if (!(filled > 0.0f)) continue;
    around(kick.place, [&](int c, float weight) {
      if (!(mass[c] > 0.0f)) return;
      for (int axis = 0; axis < 3; ++axis)
        impulse[axis][c] += weight / filled * part_along(kick.impulse, axis);
    });
  }
  for (int p = 0; p < liquid.particles(); ++p) {
    if (!is_near(p)) continue;
    around(place_of(p), [&](int c, float weight) {
      if (near[c] == 0 || !(mass[c] > 0.0f)) return;
      for (int axis = 0; axis < 3; ++axis) {
        if (!liquid.box.flat(axis)) liquid.motion[axis][p] += weight * impulse[axis][c] / mass[c];
      }
    });
  }
}

}  // namespace

void clear_fluid_impulses(SoftStore& soft) {
  soft.for_each([](SoftEntry& entry) { entry.fluid_last.clear(), entry.fluid_sum.clear(); });
}

void push_fluids_back(SoftStore& soft, FluidStore& fluids, std::vector<FluidScratch>& scratch) {
  std::vector<Array<FluidKick>> kicks(fluids.entries.size());
  bool any = false;
  soft.for_each([&](SoftEntry& entry) {
    const Particles& p = entry.body.particles;
    for (int i = 0; i < p.count && std::size_t(i) < entry.fluid_last.size(); ++i) {
      const DVec3 impulse = entry.fluid_sum[i] + entry.fluid_last[i];
      if (impulse == DVec3{}) continue;
      const int slot = find_fluid(fluids, p.place(i));
      if (slot < 0) continue;
      const FluidEntry& fluid = fluids.entries[std::size_t(slot)];
      const Vec3 place = difference(point_to_frame(fluid.frame(), p.place(i)), fluid.box().corner);
      kicks[std::size_t(slot)].push_back({place, -to_float(vector_to_frame(fluid.frame(), impulse))});
      any = true;
    }
  });
  if (!any) return;
  for (std::size_t slot = 0; slot < kicks.size(); ++slot) {
    FluidEntry& entry = fluids.entries[slot];
    if (kicks[slot].empty() || slot >= scratch.size()) continue;
    if (entry.is_liquid())
      kick_liquid(entry, kicks[slot]);
    else
      kick_gas(entry, scratch[slot].gas, kicks[slot]);
  }
}

}  // namespace gyre
