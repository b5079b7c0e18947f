// Deformation gradients of elements of solids, in double: for energies and readings of stress.
#pragma once

#include "soft/body/soft_body.h"

namespace gyre {

// The columns of F.
template <int Corners>
void find_deformation(const Particles& particles, const SolidBlock<Corners>& block, int lane, DVec3 (&f)[3]) {
  constexpr int kOthers = SolidBlock<Corners>::kOthers;
  const DVec3 origin = particles.place(block.corner[0][lane]);
  for (DVec3& column : f) column = {};
  for (int a = 0; a < kOthers; ++a) {
    const DVec3 edge = particles.place(block.corner[a + 1][lane]) - origin;
    for (int c = 0; c < 3; ++c) f[c] += double(block.gradient[kOthers * c + a][lane]) * edge;
  }
}

// The deformation gradient of all tetrahedra of a cell together.
inline void find_mean_deformation(const SoftBody& body, std::int32_t cell, DVec3 (&f)[3]) {
  find_deformation(body.particles, body.continuum.cells[cell / kTetLanes], cell % kTetLanes, f);
}

// The deformation that the stress of a tetrahedron belongs to: in a cell the mean, and the share of its own difference from it.
inline void find_stressed_deformation(const SoftBody& body, std::size_t tetrahedron, DVec3 (&f)[3]) {
  const Continuum& continuum = body.continuum;
  find_deformation(body.particles, continuum.tetrahedra[tetrahedron / kTetLanes],
                   int(tetrahedron % kTetLanes), f);
  if (!continuum.is_in_cell(tetrahedron)) return;
  DVec3 mean[3];
  find_mean_deformation(body, continuum.cell_of[tetrahedron], mean);
  for (int c = 0; c < 3; ++c) f[c] = mean[c] + kSpreadShare * (f[c] - mean[c]);
}

}  // namespace gyre
