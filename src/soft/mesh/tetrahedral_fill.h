// Fills a closed triangle surface with tetrahedra, for a solid, and embeds the surface in them, so that it moves with the solid.
//
// In: vertices in metres, triangles, and the number of cells along the longest side of the surface's box. Out: tetrahedra of positive volume
// whose boundary is close to the surface (within a fraction of a cell), and the surface's vertices as weighted sums of their corners. A
// surface that is inside out is reversed. The same input gives the same bits everywhere.
// Method: isosurface stuffing. Dihedral angles are within kMinDihedral and kMaxDihedral, whatever the surface.
// Source: F. Labelle, J. R. Shewchuk, "Isosurface Stuffing: Fast Tetrahedral Meshes with Good Dihedral Angles", 2007.
// docs/decisions/tetrahedral-fill.md has the measurements.
#pragma once

#include "base/container/array.h"
#include "soft/mesh/embedded_surface.h"

#include <gyre/math.h>
#include <gyre/result.h>

#include <cstdint>
#include <span>

namespace gyre {

constexpr int kMinFillResolution = 2, kMaxFillResolution = 128;
constexpr std::uint32_t kMaxFillTetrahedra = 2'000'000;
// Degrees; the share of the lattice's tetrahedra. No choice of cut points and moved points gives less or more: lattice_stencils_test.cpp
// tries the extreme ones.
constexpr double kMinDihedral = 9.2, kMaxDihedral = 161.7, kMinVolumeShare = 0.025;
// The share of the surface's volume by which that of the tetrahedra may differ.
constexpr double kFillVolumeShare = 0.15;
// A surface vertex farther than both from all tetrahedra belongs to a feature that is too thin for the cells.
constexpr double kMaxUncoveredCells = 2.0, kMaxUncoveredShare = 0.1;  // cells; of the longest side

struct TetrahedralMesh {
  Array<Vec3> vertices;
  Array<std::uint32_t> tetrahedra;  // four indices each, wound so that the volume is positive
  EmbeddedSurface surface;          // a point for each vertex given
  double surface_volume = 0.0;      // m^3, inside the triangles
  double filled_volume = 0.0;       // m^3, of all tetrahedra
};

// Refuses: indices out of range or not in threes, vertices that are not finite, a triangle without area, an edge that is not shared evenly,
// a surface that crosses itself or encloses no volume, a resolution out of range, more than kMaxFillTetrahedra, and features that are
// too thin, with a resolution that keeps them.
Result<TetrahedralMesh> fill_with_tetrahedra(std::span<const Vec3> vertices,
                                             std::span<const std::uint32_t> triangles, int resolution);

}  // namespace gyre
