// Particles of a liquid: where they are at the start.
#include "fluid/liquid/liquid_grid.h"

#include "fluid/liquid/liquid_pass.h"

namespace gyre {

LiquidGrid make_liquid_grid(const GasBox& box) {
  LiquidGrid grid;
  grid.box = box;
  grid.shape = make_grid_shape(box.cells[0], box.cells[1], box.cells[2]);
  const std::size_t size = std::size_t(grid.shape.size);
  for (Array<float>& faces : grid.velocity) faces.resize(size, 0.0f);
  grid.surface.resize(size, box.cell.x);
  grid.pressure.resize(size, 0.0f);
  return grid;
}

namespace {

double cell_volume(const GasBox& box) { return double(box.cell.x) * double(box.cell.y) * double(box.cell.z); }
int flat_axes(const GasBox& box) {
  return (box.flat(0) ? 1 : 0) + (box.flat(1) ? 1 : 0) + (box.flat(2) ? 1 : 0);
}

// Half cells that have a particle.
struct Occupied {
  int counts[3];
  Array<std::uint8_t> taken;

  explicit Occupied(const GasBox& box) {
    for (int axis = 0; axis < 3; ++axis) counts[axis] = 2 * box.cells[axis];
    taken.resize(std::size_t(counts[0]) * std::size_t(counts[1]) * std::size_t(counts[2]), std::uint8_t(0));
  }
  std::size_t index(const GasBox& box, Vec3 at) const {
    std::size_t place = 0;
    for (int axis = 2; axis >= 0; --axis) {
      int i = int(2.0f * part_along(at, axis) / part_along(box.cell, axis));
      i = i < 0 ? 0 : i < counts[axis] ? i : counts[axis] - 1;
      place = place * std::size_t(counts[axis]) + std::size_t(i);
    }
    return place;
  }
};

// A lattice of about two points a cell along each axis that fills [lower, upper] evenly. Calls fn with each point.
template <class Fn>
void for_lattice(const GasBox& box, const double (&lower)[3], const double (&upper)[3], Fn&& fn) {
  int count[3];
  double spacing[3], volume = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double length = upper[axis] - lower[axis], edge = double(part_along(box.cell, axis));
    count[axis] = box.flat(axis) ? 1 : int(2.0 * length / edge + 0.5);
    if (count[axis] < 1) count[axis] = 1;
    spacing[axis] = length / double(count[axis]);
    volume *= spacing[axis];
  }
  for (int k = 0; k < count[2]; ++k) {
    for (int j = 0; j < count[1]; ++j) {
      for (int i = 0; i < count[0]; ++i) {
        const Vec3 at{float(lower[0] + (double(i) + 0.5) * spacing[0]),
                      float(lower[1] + (double(j) + 0.5) * spacing[1]),
                      float(lower[2] + (double(k) + 0.5) * spacing[2])};
        fn(at, volume);
      }
    }
  }
}

// The part of [lower, upper] within the box. False if it is empty.
bool clip(const GasBox& box, double (&lower)[3], double (&upper)[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    const double length = double(box.cells[axis]) * double(part_along(box.cell, axis));
    lower[axis] = lower[axis] > 0.0 ? lower[axis] : 0.0;
    upper[axis] = upper[axis] < length ? upper[axis] : length;
    if (box.flat(axis) && upper[axis] > lower[axis]) lower[axis] = 0.0, upper[axis] = length;
    if (!(upper[axis] > lower[axis])) return false;
  }
  return true;
}

template <class Inside>
int fill(LiquidGrid& grid, const double (&lower)[3], const double (&upper)[3], Vec3 velocity,
         const GasSolids& solids, Inside&& inside) {
  Occupied occupied(grid.box);
  for (int p = 0; p < grid.particles(); ++p)
    occupied
        .taken[occupied.index(grid.box, {grid.position[0][p], grid.position[1][p], grid.position[2][p]})] = 1;
  const bool empty = grid.particles() == 0;
  const FluidWindow whole = whole_window(grid.box);
  const int before = grid.particles();
  for_lattice(grid.box, lower, upper, [&](Vec3 at, double volume) {
    if (!inside(at) || !has_room(grid.box, whole, solids, at)) return;
    if (!empty && occupied.taken[occupied.index(grid.box, at)] != 0) return;
    add_particle(grid, at, velocity, float(volume));
  });
  return grid.particles() - before;
}

}  // namespace

bool has_room(const GasBox& box, const FluidWindow& window, const GasSolids& solids, Vec3 point) {
  int index[3];
  for (int axis = 0; axis < 3; ++axis) {
    const float at = part_along(point, axis), edge = part_along(box.cell, axis);
    if (!(at >= 0.0f && at <= float(box.cells[axis]) * edge)) return false;
    const int i = int(at / edge) - window.first[axis], last = window.box.cells[axis] - 1;
    index[axis] = i < 0 ? 0 : i < last ? i : last;
  }
  if (!solids.present()) return true;
  if (solids.distance.empty()) return solids.solid[window.shape.at(index[0], index[1], index[2])] == 0;
  // Particles that touch the surface would be pushed out at once.
  return sample_field(window.box, window.shape, solids.distance.data(), -1, point - window.origin()) >=
         kParticleSkin * box.cell.x;
}

float particle_volume(const GasBox& box) {
  const double share[4] = {0.125, 0.25, 0.5, 1.0};
  return float(cell_volume(box) * share[flat_axes(box)]);
}

void add_particle(LiquidGrid& grid, Vec3 position, Vec3 velocity, float volume) {
  for (int axis = 0; axis < 3; ++axis) {
    grid.position[axis].push_back(part_along(position, axis));
    grid.motion[axis].push_back(part_along(velocity, axis));
  }
  for (Array<float>& one : grid.affine) one.push_back(0.0f);
  grid.volume.push_back(volume);
}

int fill_liquid_box(LiquidGrid& grid, DVec3 lower, DVec3 upper, Vec3 velocity, const GasSolids& solids) {
  const DVec3 low = lower - grid.box.corner, high = upper - grid.box.corner;
  double from[3] = {low.x, low.y, low.z}, to[3] = {high.x, high.y, high.z};
  if (!clip(grid.box, from, to)) return 0;
  return fill(grid, from, to, velocity, solids, [](Vec3) { return true; });
}

int fill_liquid_ball(LiquidGrid& grid, DVec3 center, float radius, Vec3 velocity, const GasSolids& solids) {
  const DVec3 middle = center - grid.box.corner;
  const double r = double(radius);
  double from[3] = {middle.x - r, middle.y - r, middle.z - r},
         to[3] = {middle.x + r, middle.y + r, middle.z + r};
  double whole[3][2];
  for (int axis = 0; axis < 3; ++axis) whole[axis][0] = from[axis], whole[axis][1] = to[axis];
  if (!clip(grid.box, from, to)) return 0;
  // The lattice of the whole ball, so that what the box cuts off leaves no trace in the rest.
  double lower[3], upper[3];
  for (int axis = 0; axis < 3; ++axis) {
    const bool flat = grid.box.flat(axis);
    lower[axis] = flat ? from[axis] : whole[axis][0];
    upper[axis] = flat ? to[axis] : whole[axis][1];
  }
  return fill(grid, lower, upper, velocity, solids, [&](Vec3 at) {
    double square = 0.0;
    const double centers[3] = {middle.x, middle.y, middle.z};
    for (int axis = 0; axis < 3; ++axis) {
      const double place = double(part_along(at, axis)), offset = place - centers[axis];
      if (place < 0.0 || place > double(grid.box.cells[axis]) * double(part_along(grid.box.cell, axis)))
        return false;
      if (!grid.box.flat(axis)) square += offset * offset;
    }
    return square <= r * r;
  });
}

}  // namespace gyre
