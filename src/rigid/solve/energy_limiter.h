// What joints that are swept, or in linkages that are solved alone, give of energy and of angular momentum. Joints that only tie do no work;
// where bodies turn far within a sub-step their rows, linear in what turns, do all the same, and what they give in one they give again in
// the next: nets of rods went faster without end; where a light body with long arms strikes a stop between heavy ones, at once. As
// solver/articulation/articulation_energy_kernel.h does it for linkages side by side, what joints have given in a sub-step is taken away as it ends,
// by slowing all inner motion alike. And where inertia against joints is raised (solver/articulation/articulation.cpp, rigid/solve/geometric_stiffness.h) a body does not
// take all of a turn that others gave: what hangs on nothing gets it back, as one rigid body (docs/decisions/joint-trees.md).
#pragma once

#include "rigid/solve/solve.h"

namespace gyre {

// Those of the batch: bodies that hang together by joints, some of them swept or in linkages that are solved alone; of those that are
// swept, where a body turns far. What springs, motors and drives do is told apart (rigid/solve/actuated_rows.h). What a
// kinematic body holds is seen from that. Not where several that move hold it, where a body is bound to axes of the world, or where a linkage
// in lanes is driven. Where contacts or fields act, gains are taken away only beside what turns far: they may answer between two stages what
// joints seem to give in one.
std::span<JointIsland> find_joint_islands(const BatchContext& solve, Arena& arena);

// Stages, whose blocks are islands: before what joints change of velocities, and after it. Warm: where impulses are given once more.
void begin_warm_work(const BatchContext& solve, int begin, int end);
void begin_joint_work(const BatchContext& solve, int begin, int end);
void end_joint_work(const BatchContext& solve, int begin, int end);
// Before bodies move.
void limit_gain(const BatchContext& solve, int begin, int end);
// After each part.
void remove_gain(const BatchContext& solve, int begin, int end);

// As the step ends: where speeds were bounded before bodies moved, the next one does not begin with the impulses that gave them.
void drop_limited_impulses(const BatchContext& solve);

}  // namespace gyre
