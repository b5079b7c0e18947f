// Which solver a world has, if not the default one, and how it is set. Part of the state: worlds with the default solver have
// no such record, and the hashes and snapshots that they always had.
#pragma once

#include <gyre/defs.h>

#include <cstdint>

namespace gyre {

struct SolverSettings {
  SolverKind kind = SolverKind::sequential_impulses;
  SolverOptions options;
};

// Why a solver cannot be set like this; null if it can.
const char* fault_in(const SolverSettings& solver);

// What iterations 0 stands for.
constexpr int kSequentialIterations = 10;
constexpr int kNncgIterations = 200;

// What a step's islands had to say, the sub-steps together.
struct RowStats {
  double residual = 0.0;  // N s, or N m s
  int islands = 0;
  int largest = 0;    // rows of the largest island
  int direct = 0;     // islands that a direct method solved
  int too_large = 0;  // islands that the method that was asked for does not take
  int sweeps = 0;     // the most that an island took
};

}  // namespace gyre
