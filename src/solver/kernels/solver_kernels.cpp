// Chooses the kernels for this machine when a world is made.
#include "base/processor.h"
#include "solver/kernels/solver_kernels.h"

namespace gyre {

extern const SolverKernels kSolverKernels_w1;
extern const SolverKernels kSolverKernels_sse2;
#if defined(__x86_64__)
extern const SolverKernels kSolverKernels_avx2;
extern const SolverKernels kSolverKernels_avx512;
extern const SolverKernels kSolverKernels_avx512vl;
#endif

const SolverKernels& select_kernels(int width) {
  const int lanes = lanes_for(width);
#if defined(__x86_64__)
  if (lanes >= 16) return kSolverKernels_avx512;
  // Eight lanes with the instructions and the twice as many registers of a processor that has sixteen. (Asked for, eight are those of any
  // with AVX2.)
  if (width == 0 && lanes == 8 && max_lanes() == 16) return kSolverKernels_avx512vl;
  if (lanes >= 8) return kSolverKernels_avx2;
#endif
  if constexpr (kLanesOfAll >= 4) {
    if (lanes >= 4) return kSolverKernels_sse2;
  }
  return kSolverKernels_w1;
}

const SolverKernels& narrower_kernels(const SolverKernels& kernels) {
#if defined(__x86_64__)
  // Eight lanes keep half as much, and turn bodies in one register of doubles for two. (Four have other instructions.)
  if (&kernels == &kSolverKernels_avx512) return kSolverKernels_avx512vl;
#endif
  return kernels;
}

}  // namespace gyre
