// The solver of a world, if it is not the default one, and its options. Part of the state. A world with the default
// solver has no such record, so its hash and snapshots are those of older versions.
#pragma once

#include <gyre/defs.h>

#include <cstdint>

namespace gyre {

struct SolverSettings {
  SolverKind kind = SolverKind::sequential_impulses;
  SolverOptions options;
};

// Why these settings are invalid; null if they are valid.
const char* fault_in(const SolverSettings& solver);

// The defaults that 0 iterations stand for.
constexpr int kSequentialIterations = 10;
constexpr int kNncgIterations = 200;

// Statistics of the islands of a step, over all sub-steps.
struct RowStats {
  double residual = 0.0;      // N s, or N m s
  double missed_share = 0.0;  // of sequential impulses: speed at which a joint opens, over that of a fall for a sub-step
  int islands = 0;
  int largest = 0;    // rows of the largest island
  int direct = 0;     // islands solved by a direct method
  int too_large = 0;  // islands too large for the method that the user chose
  int sweeps = 0;     // largest number of iterations of an island
};

}  // namespace gyre
