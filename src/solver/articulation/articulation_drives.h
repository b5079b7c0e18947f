// What acts along the axes of a linkage's joints (springs, motors, dry friction, stops that give way), solved with its equations.
//
// A sweep over an axis sees its two bodies alone. Where a light body ties heavy ones, or an arm is long, that is a thousandth of what hangs
// on the axis: a spring then finds its force some steps late, and a late spring feeds what it should hold. So what an impulse along each
// axis makes of the whole linkage is found once its equations are placed; with that a spring has the effective mass that moves,
// and what it gives leaves all equations as they are. Several axes are swept until none changes. Source: as of solver/articulation/articulation_limits.h.
#pragma once

#include "solver/articulation/articulation.h"

namespace gyre {

// Axes that are solved together, at most; others of the linkage are swept as if two bodies were alone.
constexpr std::size_t kMaxDrivenAxes = 96;

// Whether anything acts along an axis besides hard stops.
bool is_driven_axis(const AxisConstraint& axis);

// How many numbers Linkage::axis_room holds.
std::size_t drives_room(const Articulation& articulation, std::size_t axes);

// Once equations are placed and factored: responses, effective masses, what springs make of a sub-step.
void prepare_drives(const Articulation& articulation, const ArticulationSolve& solve);
// Before the impulses of the last sub-step are given once more: adds what those of the axes will do to AxisConstraint::worked.
void add_warm_start_work(const Articulation& articulation, const ArticulationSolve& solve);
// Changes velocities and impulses; equations hold as they did. soft: as solve_axis().
void solve_drives(const Articulation& articulation, const ArticulationSolve& solve, bool soft);

}  // namespace gyre
