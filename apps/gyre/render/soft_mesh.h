// Ropes, cloths and solids as triangles, for pictures: their vertices as they are now, with normals that follow them.
#pragma once

#include "render/shape_mesh.h"
#include "render/tube.h"

#include <cstdint>
#include <span>
#include <vector>

namespace gyre {

// A line through all points of `line`, with `pieces` in each of its parts and no corners (E. Catmull, R. Rom, "A class of local
// interpolating splines", 1974).
std::vector<Vec3> smooth_line(std::span<const Vec3> line, int pieces);

// Rings as tube_rings makes them, and half a ball at each end.
std::vector<TubePoint> capped_tube(const std::vector<Vec3>& line, float radius, int sides);

// A surface whose normals are smooth. `sharp_edges`: but for edges of more than 50 degrees.
ShapeMesh soft_surface_mesh(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles,
                            bool sharp_edges);

}  // namespace gyre
