// Ropes, cloths and solids as triangles, for pictures: their vertices as they are now, with normals that follow them.
#pragma once

#include "formats/shape_mesh.h"
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

// The surface of a solid, smooth but for edges of more than 50 degrees. A vertex for each corner of the triangles, in their order.
ShapeMesh solid_mesh(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles);

// A cloth as thick as it is: two sheets with smooth normals, `radius` before and behind its middle, and a rim where it ends.
struct ClothMesh {
  ShapeMesh front, back, rim;
  std::vector<std::uint32_t> rim_of;  // the vertex of the cloth that each vertex of the rim stands at
};
ClothMesh cloth_mesh(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles, float radius);

}  // namespace gyre
