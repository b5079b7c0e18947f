// Springs, motors, dry friction and soft limits along the axes of an articulation, solved with its equations.
//
// An iteration over a joint sees its two bodies alone. Where a light body connects heavy ones, or an arm is
// long, their mass is a thousandth of the mass on the axis: a spring then finds its force some steps late,
// and a late spring adds energy. So the response of the whole articulation to an impulse along each axis is
// found once its equations are prepared. With it a spring has the true effective mass, and its impulse leaves
// all equations as they are. Several axes are iterated until none changes. Sources as of
// solver/articulation/articulation_limits.h.
#pragma once

#include "solver/articulation/articulation.h"

namespace gyre {

// Largest number of axes that are solved together; others are iterated as if two bodies were alone.
constexpr std::size_t kMaxDrivenAxes = 96;

// True if anything acts along an axis besides hard limits.
bool is_driven_axis(const AxisConstraint& axis);

// Size of Articulation::axis_room, in numbers.
std::size_t drives_room(const Articulation& articulation, std::size_t axes);

// After preparation and factorisation: computes responses, effective masses and spring coefficients.
void prepare_drives(const Articulation& articulation, const ArticulationSolve& solve);
// Before the warm start: adds the work of the axes' accumulated impulses to AxisConstraint::drive_work.
void add_warm_start_work(const Articulation& articulation, const ArticulationSolve& solve);
// Changes velocities and impulses without violating equations. soft: as solve_axis().
void solve_drives(const Articulation& articulation, const ArticulationSolve& solve, bool soft);

}  // namespace gyre
