// The table of all kernels of one CPU target; each kernel file exports one.
#pragma once

#include "solver/articulation/articulation_kernel.h"
#include "solver/articulation/ball_kernel.h"
#include "solver/contact/moving_contact_points.h"
#include "solver/contact/contact_prepare.h"
#include "solver/contact/contact_project.h"
#include "solver/contact/contact_replace.h"
#include "solver/kernels/solver_kernels.h"
#include "solver/motion/motion_kernel.h"
#include "solver/motion/rotation_kernel.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

template <int W>
constexpr SolverKernels solver_kernels() {
  return {W,
          {sizeof(ContactBlock<W>), sizeof(ContactBlockCold<W>), prepare_blocks<W>, advance_points<W>,
           warm_start_blocks<W>, solve_blocks<W>, solve_blocks_again<W>, find_pushing_block<W>,
           solve_lane_anew<W>, relax_blocks<W>, project_blocks<W>, read_block_impulse<W>,
           write_block_impulse<W>, make_block_rigid<W>, finish_blocks<W>},
          motion_kernels<W>(),
          rotation_kernels<W>(),
          articulation_kernels<W>(),
          ball_kernels<W>()};
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
