// Cloths as particles with springs. Stiffness is that of the material, whatever the cells: see grid_cloth().
#pragma once

#include "soft/body/soft_body.h"

#include <gyre/soft.h>

namespace gyre {

struct ClothMaterial {
  ClothLinks links = ClothLinks::springs;
  float area_density = 0.2f;          // kg/m^2
  float stretch_stiffness = 1000.0f;  // N/m: force per width and strain
  float shear_stiffness = 200.0f;     // N/m: force per width and angle
  float bend_stiffness = 1.0e-4f;     // N m: moment per width and curvature
  float damping = 0.0f;               // s
  bool is_visual = false;             // links alone
};

// A rectangle of size[0] x size[1] in the x-z plane of `pose`, its middle there, flat and at rest, in cells[0] x cells[1] cells. Particle
// i + j (cells[0] + 1) is corner i, j.
//
// Links springs: springs along the lines of the grid carry stretch, springs across the cells shear; where both are there the ones along the lines are
// softer by what the others carry, so that a strip pulled along a line has the stretch stiffness. In long cells springs across would carry so much
// that the sheet folds; there the triangles of a membrane without stretch stiffness shear. Bending is that of a plate
// without lateral contraction, 1/2 B (kxx^2 + kyy^2 + 2 kxy^2), with curvatures by central differences. Links membrane: triangles
// with the stretch stiffness along both lines, the shear stiffness, and no lateral contraction.
SoftBody grid_cloth(const float (&size)[2], const int (&cells)[2], const Pose& pose,
                    const ClothMaterial& material);

// Where the corners of the cells of a grid are.
Array<DVec3> grid_places(const float (&size)[2], const int (&cells)[2], const Pose& pose);

// A cloth of triangles, at rest as they lie. Links springs: one along each edge, k = stretch stiffness times area of both triangles over the
// square of the edge (A. Van Gelder, "Approximate Simulation of Elastic Membranes by Triangulated Spring Meshes", 1998), which is
// right for triangles of equal sides, whose lateral contraction is 1/3; the shear stiffness is not asked for. Links membrane: isotropic,
// E the stretch stiffness and G the shear stiffness, without lateral contraction where G = E / 2.
//
// Bending is that of the same plate, flat at rest: the curvature of a triangle is what its three edges bend by,
// k = 1 / A sum |e| w_e b_e n_e n_e^T, with b_e the change of slope across edge e, n_e the direction across it, and w_e the triangle's share
// of the area of both. So a cylinder has its energy whatever the triangles. Each b_e is linear in the places of four particles (M.
// Bergou et al., 2006), so the energy is quadratic.
SoftBody mesh_cloth(std::span<const DVec3> places, std::span<const std::uint32_t> triangles,
                    const ClothMaterial& material);

}  // namespace gyre
