// The stages that move bodies: forces, positions and rotations. Each works on blocks [begin, end) of its kind; blocks of bodies hold the
// constrained ones.
//
// Each half-step measures the velocity change by contacts, and the next half-step begins with it: a warm start by bodies, not by contacts.
// Blocks that are not measured do not need it.
#pragma once

#include "rigid/solve/body_motion_solve.h"

namespace gyre {

void prepare_bodies(const BodyMotionSolve& s, int begin, int end);
// Apply gravity, forces and damping. The second also applies the contact change of the last half-step. Both start to measure.
void apply_forces(const BodyMotionSolve& s, int begin, int end);
void apply_forces_and_warm_start(const BodyMotionSolve& s, int begin, int end);
void warm_start_bodies(const BodyMotionSolve& s, int begin, int end);
// The first starts to measure the velocity change by contacts. The second adds up the change so far and starts again.
void start_contact_change(const BodyMotionSolve& s, int begin, int end);
void add_contact_change(const BodyMotionSolve& s, int begin, int end);
// Integrate positions and rotations. The second also adds up the contact change, where no stage comes between.
void integrate_positions(const BodyMotionSolve& s, int begin, int end);
void add_contact_change_and_integrate(const BodyMotionSolve& s, int begin, int end);

// The same stages for bodies whose velocities are in lanes.
void apply_forces_and_warm_start_in_lanes(const BodyMotionSolve& s, int begin, int end,
                                          const LaneVelocities& lanes);
void start_contact_change_in_lanes(const BodyMotionSolve& s, int begin, int end, const LaneVelocities& lanes);
void add_contact_change_in_lanes(const BodyMotionSolve& s, int begin, int end, const LaneVelocities& lanes);
void integrate_positions_in_lanes(const BodyMotionSolve& s, int begin, int end, const LaneVelocities& lanes);

// Integrates the fast or axis-bound rotations that the stages above leave out, by blocks of bodies. has_fast_spinning tells if there are
// any.
void integrate_fast_spinning_of_blocks(const BodyMotionSolve& s, int begin, int end);
bool has_fast_spinning(const BodyMotionSolve& s, int begin, int end);
// The same in blocks of kFastSpinningPerBlock bodies.
constexpr int kFastSpinningPerBlock = 8;
void integrate_fast_spinning(const BodyMotionSolve& s, int begin, int end);

// The first saves velocities, so that pushout may use their place for displacements; the second restores them.
void begin_projection(const BodyMotionSolve& s, int begin, int end);
void end_projection(const BodyMotionSolve& s, int begin, int end);

// Moves free bodies for the whole step, in blocks of kBodiesPerBlock.
void move_free_bodies(const BodyMotionSolve& s, int begin, int end);
// Finishes orientations at the end of the step, in blocks of kBodiesPerBlock.
void finish_orientations(const BodyMotionSolve& s, int begin, int end);

}  // namespace gyre
