// Volume, energies, momenta and probes of a liquid.
#include "fluid/liquid/liquid_reading.h"

#include "fluid/grid/velocity_sample.h"
#include "fluid/liquid/liquid_pass.h"

namespace gyre {

double liquid_volume(const LiquidGrid& grid, const GasSolids& solids, const FluidWindow* given) {
  const FluidWindow window = given != nullptr ? *given : whole_window(grid.box);
  const GridShape &shape = grid.shape, &own = window.shape;
  const double cell = double(grid.box.cell.x) * double(grid.box.cell.y) * double(grid.box.cell.z);
  const float inverse = 1.0f / grid.box.cell.x;
  const float* const distance =
      solids.present() && !solids.distance.empty() ? solids.distance.data() : nullptr;
  const std::uint8_t* const solid = solids.present() ? solids.solid.data() : nullptr;
  const float* const surface = grid.surface.data();
  double sum = 0.0;
  for (int row = 0; row < own.rows(); ++row) {
    const int j = row % own.cells[1], k = row / own.cells[1], first = own.row(j, k);
    const int c = shape.at(window.first[0], window.first[1] + j, window.first[2] + k);
    for (int i = c; i < c + own.cells[0]; ++i) {
      const int at = first + (i - c);
      const float depth = -surface[i] * inverse;
      float full = depth >= 0.0f ? 1.0f - 0.5f * (1.0f - depth) * (1.0f - depth)
                                 : 0.5f * (1.0f + depth) * (1.0f + depth);
      bool deep = depth >= 0.0f;
      for (const int step : {1, shape.pitch, shape.plane})
        deep = deep && surface[i - step] <= 0.0f && surface[i + step] <= 0.0f;
      if (deep) full = 1.0f;
      if (distance != nullptr) {
        full *= clamp(0.5f + distance[at] * inverse, 0.0f, 1.0f);
      } else if (solid != nullptr && solid[at] != 0) {
        full = 0.0f;
      }
      sum += double(full);
    }
  }
  return cell * sum;
}

LiquidTotals liquid_totals(const LiquidGrid& grid, float density, Vec3 gravity, const FluidFrame* frame) {
  LiquidTotals totals;
  const DVec3 g{double(gravity.x), double(gravity.y), double(gravity.z)};
  for (int p = 0; p < grid.particles(); ++p) {
    const double mass = double(density) * double(grid.volume[p]);
    DVec3 at = grid.box.corner + Vec3{grid.position[0][p], grid.position[1][p], grid.position[2][p]};
    DVec3 velocity{double(grid.motion[0][p]), double(grid.motion[1][p]), double(grid.motion[2][p])};
    if (frame != nullptr) {
      at = point_to_world(frame, at);
      velocity = DVec3(velocity_to_world(frame, at, to_float(velocity)));
    }
    totals.mass += mass;
    totals.kinetic_energy += 0.5 * mass * dot(velocity, velocity);
    totals.potential_energy -= mass * dot(g, at);
    totals.momentum += mass * velocity;
    totals.angular_momentum += mass * cross(at, velocity);
  }
  return totals;
}

namespace {

// Pressure over density, linearly between centres, and on from them in the half cell at a wall. Outside it is zero. Between centres of which some
// are outside it grows from the surface on, so it is the mean of the centres within.
float pressure_at(const LiquidGrid& grid, Vec3 local) {
  const GridShape& shape = grid.shape;
  int base[3];
  float fraction[3];
  for (int axis = 0; axis < 3; ++axis) {
    const ParticleAxis points = particle_axis(grid.box, axis);
    float place = part_along(local, axis) * points.inverse_edge - 0.5f;
    const bool wall_below = !points.wraps && !grid.box.open(2 * axis) && !grid.box.flat(axis),
               wall_above = !points.wraps && !grid.box.open(2 * axis + 1) && !grid.box.flat(axis);
    place = clamp(place, float(points.low) - (wall_below ? 0.5f : 0.0f),
                  points.highest_center + (wall_above ? 0.5f : 0.0f));
    const int whole = place < float(points.low) ? points.low : int(place - float(points.low)) + points.low;
    base[axis] = whole < points.last_center ? whole : points.last_center;
    fraction[axis] = place - float(base[axis]);
  }
  // Beyond the last centres only if all of them are within.
  float sum = 0.0f, weights = 0.0f, beyond = 0.0f;
  bool all_within = true;
  for (int corner = 0; corner < 8; ++corner) {
    float weight = 1.0f, inner_weight = 1.0f;
    int at = shape.first;
    for (int axis = 0; axis < 3; ++axis) {
      const int up = corner >> axis & 1;
      const float inner = clamp(fraction[axis], 0.0f, 1.0f);
      weight *= up != 0 ? fraction[axis] : 1.0f - fraction[axis];
      inner_weight *= up != 0 ? inner : 1.0f - inner;
      at += (base[axis] + up) * shape.stride(axis);
    }
    if (weight == 0.0f) continue;
    const bool within = grid.surface[at] <= 0.0f;
    all_within = all_within && within;
    if (!within) continue;
    beyond += weight * grid.pressure[at];
    sum += inner_weight * grid.pressure[at];
    weights += inner_weight;
  }
  if (all_within) return beyond;
  return weights > 0.0f ? sum / weights : 0.0f;
}

}  // namespace

LiquidProbe probe_liquid(const LiquidGrid& grid, DVec3 point, float density) {
  const GasBox& box = grid.box;
  const GridShape& shape = grid.shape;
  const Vec3 local = difference(point, box.corner);
  LiquidProbe probe;
  const float depth = -sample_field(box, shape, grid.surface.data(), -1, local);
  probe.inside = depth > 0.0f;
  if (probe.inside) {
    probe.velocity = sample_velocity(box, shape, grid.velocity, local);
    probe.pressure = density * pressure_at(grid, local);
  }
  // The column, from above.
  const float top = (float(shape.cells[1]) - 0.5f) * box.cell.y;
  const auto distance_at = [&](float y) {
    return sample_field(box, shape, grid.surface.data(), -1, {local.x, y, local.z});
  };
  float above = distance_at(top);
  if (above <= 0.0f) {
    probe.has_surface = true;
    probe.surface = box.corner.y + double(float(shape.cells[1]) * box.cell.y);
    return probe;
  }
  for (int j = shape.cells[1] - 2; j >= 0; --j) {
    const float y = (float(j) + 0.5f) * box.cell.y, here = distance_at(y);
    if (here <= 0.0f) {
      probe.has_surface = true;
      probe.surface = box.corner.y + double(y + box.cell.y * (here / (here - above)));
      return probe;
    }
    above = here;
  }
  return probe;
}

}  // namespace gyre
