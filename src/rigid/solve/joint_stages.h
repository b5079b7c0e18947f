// The stages of joints. Each works on blocks [begin, end) of its kind.
//
// In: joints, laid out (rigid/solve/joint_solve.h). Out: velocities of bodies; at the end, impulses in the joints.
#pragma once

#include "rigid/solve/joint_solve.h"
#include "task/parallel.h"

namespace gyre {

constexpr int kJointsPerBlock = 16;  // whole blocks of lanes at every width

// Prepares the joints of one colour: their present geometry, their soft rows, and rigid rows with zero target speed.
void prepare_joints(const JointGroup& group, int begin, int end);
// Computes the bias from the rotation within the sub-step.
void compute_second_order_bias(const JointGroup& group, int begin, int end);
void warm_start_joints(const JointGroup& group, int begin, int end);
void solve_joints(const JointGroup& group, int begin, int end);
// Also prepares ball joints while they are in the cache. This is safe: the impulses of a colour do not change the poses that the next one
// reads, and no articulation has their bodies. prepare_other_joints prepares all others.
void relax_joints(const JointGroup& group, int begin, int end);
void prepare_other_joints(const JointGroup& group, int begin, int end);
// Copies ball joints into their lanes, and their impulses back to the joints.
void begin_ball_joints(const JointGroup& group, int begin, int end);
void finish_ball_joints(const JointGroup& group, int begin, int end);

// Runs a stage for all colours at once, if it writes only data of its own joint. A slice is the same share of each colour, so that workers
// keep to the bodies that they have in the stages of the colours.
constexpr int kJointSlices = 32;
template <void (*stage)(const JointGroup&, int, int)>
void in_joint_slices(const JointSolve& s, int begin, int end) {
  for (const JointGroup& group : s.groups) {
    const int blocks = count_blocks(int(group.count), kJointsPerBlock);
    const int first = blocks * begin / kJointSlices, last = blocks * end / kJointSlices;
    if (first < last) stage(group, first, last);
  }
}

// Runs a stage for scalar articulations [begin, end) (solver/articulation/articulation.h).
template <void (*stage)(const Articulation&, const ArticulationSolve&)>
void for_articulations(const JointSolve& s, int begin, int end, int worker) {
  ArticulationSolve own = s.articulation_solve;
  if (!s.limit_rooms.empty()) own.room = s.limit_rooms[std::size_t(worker)];
  for (int i = begin; i < end; ++i) stage(s.articulations.scalar[std::size_t(i)], own);
}

// Runs kernels for bundles [begin, end) of grouped articulations (solver/articulation/articulation_lanes.h).
template <BundleKernel... stages>
void for_simd_articulations(const JointSolve& s, int begin, int end) {
  for (int i = begin; i < end; ++i) {
    const ArticulationBundle& bundle = s.bundles.bundles[std::size_t(i)].lanes;
    ((bundle.kernels->*stages)(bundle, s.bundles.arrays, s.bundles.settings), ...);
  }
}
void begin_simd_articulations(const JointSolve& s, int begin, int end);
void finish_simd_articulations(const JointSolve& s, int begin, int end);

}  // namespace gyre
