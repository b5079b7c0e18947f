// A triangle mesh prepared for decomposition: welded, wound alike, in coordinates of about one, grouped into solids,
// with a report of its defects.
//
// In: vertices in metres and triangles of any quality. Out: a Model whose solid is where SurfaceField::inside() holds,
// or the error. A surface that bounds no solid is thickened into a shell, which is a solid like any other.
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
  // For each triangle the solid that it bounds. Cavities belong to the solid around them.
  std::vector<std::uint32_t> group;
  std::uint32_t group_count = 0;
  DVec3 origin;         // m, of the coordinates
  double scale = 1.0;   // coordinates per metre, a power of two
  double size = 1.0;    // diameter of the smallest enclosing sphere, in coordinates
  double area = 0.0;    // of all triangles, in coordinates
  bool closed = false;  // each edge is run equally often both ways, so that winding numbers are whole
  MeshFindings findings;

  DVec3 corner(std::size_t triangle, std::size_t i) const { return vertices[indices[3 * triangle + i]]; }
  std::size_t triangle_count() const { return indices.size() / 3; }
  DVec3 to_metres(DVec3 p) const { return origin + p / scale; }
};

Result<Model> make_model(const DecompositionDef& def);

// The directed edges of the triangles between two vertices.
struct EdgeUse {
  std::uint32_t forward = 0, backward = 0;  // uses from the lower to the higher vertex, and in reverse
  std::uint32_t first = 0, last = 0;        // triangles
};

// Flips triangles so that neighbours across an edge of two use it in opposite directions. Of each connected surface the
// larger area stays as it was. Returns the number of flipped triangles.
std::uint32_t wind_alike(Model& model);
// Flips whole closed surfaces that are inside out, unless they are cavities of others, and assigns groups.
void group_solids(Model& model);
// The volume within a closed surface; parts that overlap count twice.
double enclosed_volume(const Model& model);
// Replaces the surface by a shell of thickness 2 * `half`, in coordinates.
void thicken(Model& model, double half);

}  // namespace gyre
