// A triangle mesh made ready for decomposition: welded, wound alike, in coordinates of about one, with its parts counted; and
// what was found wrong with it.
//
// In: vertices in metres and triangles of any quality. Out: a Model whose solid is where SurfaceField::inside() holds, or why
// there is none. A surface that bounds no solid is thickened into a shell, which is a solid like any other from there on.
#pragma once

#include <gyre/decomposition.h>
#include <gyre/math.h>
#include <gyre/result.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gyre {

struct Model {
  std::vector<DVec3> vertices;
  std::vector<std::uint32_t> indices;  // three a triangle, counter-clockwise seen from outside
  std::vector<std::uint32_t>
      group;  // one a triangle: which solid it bounds; cavities go with what is around them
  std::uint32_t group_count = 0;
  DVec3 origin;        // m, of the coordinates
  double scale = 1.0;  // coordinates a metre, a power of two
  double size = 1.0;   // diameter of the smallest sphere around, in coordinates
  double area = 0.0;   // of all triangles, in coordinates
  MeshFindings findings;

  DVec3 place(std::size_t triangle, std::size_t i) const { return vertices[indices[3 * triangle + i]]; }
  std::size_t triangle_count() const { return indices.size() / 3; }
  DVec3 to_metres(DVec3 p) const { return origin + p / scale; }
};

Result<Model> make_model(const DecompositionDef& def);

// Directed edges of the triangles, joined by their ends.
struct EdgeUse {
  std::uint32_t forward = 0, backward = 0;  // runs from the lower to the higher vertex, and back
  std::uint32_t first = 0, last = 0;        // triangles
};

// Turns triangles so that neighbours across an edge of two run along it in opposite ways; of each connected surface the
// larger part stays as it was. Returns how many were turned.
std::uint32_t wind_alike(Model& model);
// Turns whole closed surfaces that are inside out, unless they are cavities of others, and numbers groups.
void group_solids(Model& model);
// Replaces the surface by a shell of thickness 2 * `half`, in coordinates.
void thicken(Model& model, double half);

}  // namespace gyre
