// Lays linkages that hang together alike side by side (solver/articulation/articulation_lanes.h): the kernels' W to a bundle, what is left over
// in kernels of fewer lanes.
//
// In: the linkages of a batch (rigid/articulation/articulations.h). Out: bundles in the step's arena; as the step ends, impulses in the joints.
#pragma once

#include "rigid/articulation/articulations.h"
#include "solver/contact/contact_block.h"

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

// One of the kernels that work on velocities or places.
using BundleKernel = void (*ArticulationKernels::*)(const ArticulationBundle&, const LaneArrays&,
                                                    const LaneSettings&);

BundleSolve lay_out_bundles(const Articulations& linkages, const ContactKernels& kernels,
                            const LaneArrays& arrays, const LaneSettings& settings, Arena& arena);
// Of bundles [begin, end).
void begin_bundles(const BundleSolve& bundles, int begin, int end, const RigidWorld& w,
                   const LaneStart& start);
void finish_bundles(const BundleSolve& bundles, int begin, int end, RigidWorld& w);

}  // namespace gyre
