// The kernels of all constraints and motion for one CPU target, W lanes wide, as one table. A world chooses its table once.
#pragma once

#include "solver/articulation/ball_joint_simd.h"
#include "solver/articulation/articulation_lanes.h"
#include "solver/contact/contact_block.h"
#include "solver/motion/motion_block.h"
#include "solver/motion/rotation_block.h"

namespace gyre {

struct SolverKernels {
  int width;  // lanes
  ContactKernels contacts;
  MotionKernels motion;
  RotationKernels rotation;
  ArticulationKernels articulations;
  BallKernels balls;
};

// The widest kernels that this machine runs well and that have at most `width` lanes (0: any). Same bits whichever.
const SolverKernels& select_kernels(int width);
// Those of half as many lanes, for what would leave the others idle; `kernels` itself where there are none of the same instructions.
const SolverKernels& narrower_kernels(const SolverKernels& kernels);

}  // namespace gyre
