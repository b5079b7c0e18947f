// Bundles articulations of equal topology (solver/articulation/articulation_lanes.h): the kernels' W in a
// bundle, the rest in kernels with fewer lanes.
//
// In: the articulations of a batch (rigid/articulation/articulations.h). Out: bundles in the step's arena; at
// the end of the step, impulses in the joints.
#pragma once

#include "rigid/articulation/articulations.h"
#include "solver/kernels/solver_kernels.h"

namespace gyre {

struct BundledArticulations {
  ArticulationBundle lanes;
  std::span<const GroupedArticulation*> articulations;  // by lane
};

struct BundleSolve {
  std::span<BundledArticulations> bundles;
  LaneArrays arrays;
  LaneSettings settings;
};

// A kernel on velocities or poses.
using BundleKernel = void (*ArticulationKernels::*)(const ArticulationBundle&, const LaneArrays&,
                                                    const LaneSettings&);

BundleSolve lay_out_bundles(const Articulations& articulations, const SolverKernels& kernels,
                            const LaneArrays& arrays, const LaneSettings& settings, Arena& arena);
// For bundles [begin, end).
void begin_bundles(const BundleSolve& bundles, int begin, int end, const RigidWorld& w,
                   const LaneStart& start);
void finish_bundles(const BundleSolve& bundles, int begin, int end, RigidWorld& w);

}  // namespace gyre
