// The stages of joints. Each works on blocks [begin, end) of what it names.
//
// In: joints, laid out (rigid/solve/joint_solve.h). Out: velocities of bodies; at the end impulses in the joints.
#pragma once

#include "rigid/solve/joint_solve.h"
#include "task/parallel.h"

namespace gyre {

constexpr int kJointsPerBlock = 16;  // whole blocks of lanes at every width

// Joints of one colour: where they are, soft rows, and no speed along rigid rows.
void prepare_joints(const JointGroup& group, int begin, int end);
// How joints turn within the sub-step.
void compute_second_order_bias(const JointGroup& group, int begin, int end);
void warm_start_joints(const JointGroup& group, int begin, int end);
void solve_joints(const JointGroup& group, int begin, int end);
// Ball joints are prepared here, while they are in the cache: nothing that one colour gives changes where the next one stands, and no
// articulation has their bodies. The others are by prepare_other_joints.
void relax_joints(const JointGroup& group, int begin, int end);
void prepare_other_joints(const JointGroup& group, int begin, int end);
// Ball joints into their lanes, and what they gave back into the joints.
void begin_ball_joints(const JointGroup& group, int begin, int end);
void finish_ball_joints(const JointGroup& group, int begin, int end);

// Of all colours in one stage: for stages that write nothing but what is a joint's own. A slice is the same share of each colour, so that
// workers keep to the bodies that they have in the colours' own stages.
constexpr int kJointSlices = 32;
template <void (*stage)(const JointGroup&, int, int)>
void in_joint_slices(const JointSolve& s, int begin, int end) {
  for (const JointGroup& group : s.groups) {
    const int blocks = count_blocks(int(group.count), kJointsPerBlock);
    const int first = blocks * begin / kJointSlices, last = blocks * end / kJointSlices;
    if (first < last) stage(group, first, last);
  }
}

// Articulations [begin, end), each solved by itself (solver/articulation/articulation.h).
template <void (*stage)(const Articulation&, const ArticulationSolve&)>
void for_articulations(const JointSolve& s, int begin, int end, int worker) {
  ArticulationSolve own = s.articulation_solve;
  if (!s.limit_rooms.empty()) own.room = s.limit_rooms[std::size_t(worker)];
  for (int i = begin; i < end; ++i) stage(s.articulations.scalar[std::size_t(i)], own);
}

// Articulations that hang together alike, side by side (solver/articulation/articulation_lanes.h).
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
