// The surface of a liquid as triangles, for drawing.
#pragma once

#include "fluid/liquid/liquid_grid.h"

#include <cstdint>

namespace gyre {

// Vertices in metres from the lower corner of the box, and three indices for each triangle, anticlockwise from outside. The mesh is closed.
void find_surface_mesh(const LiquidGrid& grid, Array<Vec3>& vertices, Array<std::uint32_t>& indices);

}  // namespace gyre
