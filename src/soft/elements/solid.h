// Solids as particles with tetrahedra.
#pragma once

#include "soft/body/soft_body.h"

namespace gyre {

struct SolidMaterial {
  float density = 1000.0f;       // kg/m^3
  float young_modulus = 1.0e5f;  // Pa
  float poisson_ratio = 0.45f;
  float damping = 0.0f;  // s
  ElementModel model = ElementModel::neo_hookean;
};

// A solid of `places` at rest and four corners a tetrahedron. `group`: by tetrahedron, the cell that it is part of (make_continuum).
SoftBody tetrahedral_solid(std::span<const DVec3> places, std::span<const std::uint32_t> corners,
                           const SolidMaterial& material, std::span<const std::uint32_t> group = {});

// Four corners each of the tetrahedra of a box of cells, five a cell, of which the first has none of its faces on a side of the cell.
Array<std::uint32_t> box_tetrahedra(const int (&cells)[3]);
// The cell of each tetrahedron of a box.
Array<std::uint32_t> box_groups(const int (&cells)[3]);

// Where the corners of the cells of a box are.
Array<DVec3> box_places(Vec3 half_extents, const int (&cells)[3], const Pose& pose);

// A box, its middle at `pose`, in cells of five tetrahedra each. Particle i + (cells[0] + 1) (j + (cells[1] + 1) k) is corner i, j, k.
SoftBody box_solid(Vec3 half_extents, const int (&cells)[3], const Pose& pose, const SolidMaterial& material);

}  // namespace gyre
