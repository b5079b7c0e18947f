// The velocity of a fluid at a point, as probes and soft matter see it.
#pragma once

#include "fluid/grid/gas_grid.h"

namespace gyre {

// Linearly between faces. In the half cell at a no-slip side the velocity goes over to that of the wall.
inline Vec3 sample_velocity(const GasBox& box, const GridShape& shape, const Array<float> (&velocity)[3],
                            Vec3 point) {
  Vec3 result{sample_field(box, shape, velocity[0].data(), 0, point),
              sample_field(box, shape, velocity[1].data(), 1, point),
              sample_field(box, shape, velocity[2].data(), 2, point)};
  const float place[3] = {point.x / box.cell.x, point.y / box.cell.y, point.z / box.cell.z};
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    if (box.side[side] != GasBoundary::no_slip || box.flat(axis)) continue;
    const float cells = side % 2 == 0 ? place[axis] : float(box.cells[axis]) - place[axis];
    const float share = 1.0f - 2.0f * clamp(cells, 0.0f, 0.5f);  // of the wall's velocity
    const Vec3 wall = box.wall_velocity[side];
    if (axis != 0) result.x += share * (wall.x - result.x);
    if (axis != 1) result.y += share * (wall.y - result.y);
    if (axis != 2) result.z += share * (wall.z - result.z);
  }
  return result;
}

}  // namespace gyre
