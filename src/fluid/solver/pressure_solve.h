// Solves the pressure equation by conjugate gradients (M. Hestenes, E. Stiefel, 1952), with one cycle over the levels as preconditioner. A cycle
// smooths by two steps of Chebyshev's iteration before and after the coarser level: a polynomial in the matrix, so the preconditioner is
// symmetric, has no order of cells, and needs no colours. Its bound is exact: rows of the matrix over their diagonals have eigenvalues up
// to 2 (S. Gershgorin).
#pragma once

#include "fluid/solver/body_coupling.h"
#include "fluid/solver/pressure_matrix.h"

namespace gyre {

// Arrays of the finest level.
struct PressureVectors {
  float* x = nullptr;  // out
  float* r = nullptr;  // in: the right side; out: what remains
  float* p = nullptr;
  float* q = nullptr;
  float* z = nullptr;
  float* other = nullptr;
};

struct PressureReport {
  int iterations = 0;
  float first = 0.0f;  // the largest number of the right side
  float last = 0.0f;   // and of what remains
};

// Until no number of what remains is larger than `target`. The ghosts and the cells beyond the ends of rows of all vectors are zero.
// `coupling`: bodies that move by the pressure; the preconditioner takes no part in them.
PressureReport solve_pressure(PressureMatrix& matrix, const PressureVectors& vectors, float target,
                              int max_iterations, const GasKernels& kernels, TaskSystem& tasks,
                              const BodyCoupling* coupling = nullptr);

}  // namespace gyre
