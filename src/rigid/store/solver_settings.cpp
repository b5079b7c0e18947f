#include "rigid/store/solver_settings.h"

#include "solver/rows/friction_set.h"

namespace gyre {

const char* to_string(SolverKind kind) {
  constexpr const char* kNames[kSolverKindCount] = {"soft_step", "sequential_impulses", "lcp"};
  return int(kind) < kSolverKindCount ? kNames[int(kind)] : "?";
}
const char* to_string(LcpMethod method) {
  constexpr const char* kNames[kLcpMethodCount] = {"automatic", "dantzig", "lemke", "newton", "nncg"};
  return int(method) < kLcpMethodCount ? kNames[int(method)] : "?";
}

const char* fault_in(const SolverSettings& solver) {
  if (int(solver.kind) >= kSolverKindCount) return "solver: there is no such kind";
  if (int(solver.options.lcp_method) >= kLcpMethodCount) return "lcp_method: there is no such method";
  const int sides = solver.options.friction_sides;
  if (sides != 0 && (sides < kMinSides || sides > kMaxSides || sides % 2 != 0))
    return "friction_sides must be 0 or an even number of 4 to 32";
  if (solver.options.iterations < 0 || solver.options.iterations > 10000)
    return "iterations must lie within 0 and 10000";
  if (solver.options.direct_rows < 0 || solver.options.direct_rows > 600)
    return "direct_rows must lie within 0 and 600";
  const bool pivots =
      solver.options.lcp_method == LcpMethod::dantzig || solver.options.lcp_method == LcpMethod::lemke;
  if (solver.kind == SolverKind::lcp && pivots && sides == 0)
    return "lcp_method: pivoting needs a friction pyramid; friction_sides must be 4 to 32";
  return nullptr;
}

}  // namespace gyre
