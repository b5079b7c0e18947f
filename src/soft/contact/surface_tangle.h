// Tangle: where soft surfaces cross, and which way leads out. Surfaces that do not cross never begin to (displacement_bounds.h), so a tangle comes from
// outside: from a crossed start, from vertices that were set, or from vertices that are held at crossing places.
//
// An edge that passes through a triangle wants to move against it:
//
//   sides    Edges that cross the other surface are taken out of the net of edges of their surface. If that leaves both ends of the edge in different
//            pieces, the end in the piece with fewer vertices is on the wrong side, and the edge moves along the normal of the triangle towards the other end. So
//            a corner, or a strip that hangs through, goes back as a whole, also where the line of intersection is straight.
//   contour  Else the line of intersection ends within both surfaces, as of two sheets whose slits grip each other. The edge moves so that the line gets shorter, by the
//            gradient of its length. With R the direction of the line into a triangle at the edge, E that of the edge and N the normal of the triangle that it
//            passes, the gradient is the sum over the triangles at the edge of R - (E.R / E.N) N.
//
// Both follow from the places of vertices alone: there is no memory of sides.
//
// In: surfaces and positions. Out: crossings with weights and directions, and marks of the vertices whose pairs would hold the surfaces on the
// wrong sides.
//
// Sources: D. Baraff, A. Witkin, M. Kass, "Untangling Cloth", 2003 (pieces on the wrong side); P. Volino, N. Magnenat-Thalmann, "Resolving Surface
// Collisions through Intersection Contour Minimization", 2006 (the gradient).
#pragma once

#include "base/arena/arena.h"
#include "base/container/array.h"
#include "soft/contact/soft_surface.h"
#include "soft/contact/surface_crossings.h"
#include "soft/contact/surface_pairs.h"

#include <gyre/math.h>

#include <cstdint>
#include <span>

namespace gyre {

// An edge that passes through a triangle.
struct TangledEdge {
  std::uint32_t vertex[5] = {};  // two of the edge, three of the triangle
  float weight[5] = {};          // of the common point: positive on the edge, negative on the triangle
  Vec3 way{};                    // in which the edge is to move against the triangle, of unit length
  float share = 1.0f;            // of the speed of untangling
  float edge = 0.0f;             // m: the smaller mean length of the edges of both surfaces
};

struct SurfaceTangle {
  Array<EdgeCrossing> crossings;
  Array<TangledEdge> edges;      // of the crossings, those that know a way
  Array<std::uint32_t> surface;  // by vertex: its placed surface; only if there are crossings
  // By vertex: bit n % 64 for surface n if an edge or triangle at it, or at a vertex next to it, crosses one of n.
  Array<std::uint64_t> partners;

  bool empty() const { return crossings.empty(); }
  // True if features A and B of the pair both have vertices at crossings of their surfaces: the pair may hold them on the wrong side.
  bool has(const SurfacePair& pair) const;
};

// Searches all pairs of edges and triangles: exact, and not for every step. What touches without passing through is no tangle.
void find_tangle(std::span<const PlacedSurface> surfaces, std::span<const DVec3> positions, Arena& arena,
                 SurfaceTangle& tangle);
// Takes out the pairs that it has.
void leave_out(const SurfaceTangle& tangle, Array<SurfacePair>& pairs);

}  // namespace gyre
