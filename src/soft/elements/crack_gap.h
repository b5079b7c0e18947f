// The gap of cracks: where the parts of split vertices of a solid are at rest.
//
// At each face of a crack, the parts on its two sides are apart by the gap along the normal of the face. So pieces that lie as they did before the break
// just touch, and no elastic force has to make room for contacts. Of all displacements u of the parts of a vertex that fulfil
// (u_a - u_b).n >= gap for all faces, those with the least sum of m u^2 are taken, m being the volumes at the parts. They leave the centre of mass
// where it is. Projected Gauss-Seidel finds them. Parts that grip each other have no such displacements: a crack must not make them.
//
// In: places of the vertices of the whole solid, corners of its tetrahedra, and the roots of the vertices. Out: the places at rest.
#pragma once

#include "base/container/array.h"

#include <gyre/math.h>

#include <cstdint>
#include <span>

namespace gyre {

// A face of a crack at one of its corners.
struct CrackFace {
  std::uint32_t root = 0;
  std::uint32_t a = 0, b = 0;  // the parts of the root on both sides
  DVec3 normal{};              // unit, into the side of a
};

// The faces of cracks between tetrahedra, ascending by root. `corners`: of the tetrahedra, four each. `roots`: by vertex, the vertex that it was. `whole`: by
// root, where it was at rest. Vertices with one root are its parts.
void list_crack_faces(std::span<const std::uint32_t> corners, std::span<const std::uint32_t> roots,
                      std::span<const DVec3> whole, Array<CrackFace>& faces);

// Finds the displacements of the parts of one vertex, in gaps: those in `moves` (by vertex), at first zero, change. `volume`: by vertex. False if there
// are none, or if a part would go too far.
bool separate_parts(std::span<const CrackFace> faces, std::span<const double> volume, std::span<DVec3> moves);

// Moves `places` (by vertex) from where they were in the whole solid to where they are at rest.
void open_cracks(std::span<const std::uint32_t> corners, std::span<const std::uint32_t> roots, double gap,
                 std::span<DVec3> places);

}  // namespace gyre
