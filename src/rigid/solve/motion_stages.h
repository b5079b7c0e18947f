// The stages that move bodies: forces, positions and rotations. Each works on blocks [begin, end) of what it names; blocks of bodies are
// those that constraints act on.
//
// The velocity change by contacts is measured in each half-step, from where it is started to where it is added up: the next one
// begins with it (a warm start by bodies, not by contacts). Nobody asks for it in blocks that are not measured.
#pragma once

#include "rigid/solve/body_motion_solve.h"

namespace gyre {

void prepare_bodies(const BodyMotionSolve& s, int begin, int end);
// By gravity, forces and damping; and, with the warm start, by what contacts changed in the last half-step. Starts to measure.
void apply_forces(const BodyMotionSolve& s, int begin, int end);
void apply_forces_and_warm_start(const BodyMotionSolve& s, int begin, int end);
void warm_start_bodies(const BodyMotionSolve& s, int begin, int end);
// The velocity change by contacts: from here on; and up to here, and on from here.
void start_contact_change(const BodyMotionSolve& s, int begin, int end);
void add_contact_change(const BodyMotionSolve& s, int begin, int end);
// Positions and rotations; where nothing came between, the change by contacts is added up in passing.
void integrate_positions(const BodyMotionSolve& s, int begin, int end);
void add_contact_change_and_integrate(const BodyMotionSolve& s, int begin, int end);

// The same of bodies whose velocities are in lanes.
void apply_forces_and_warm_start_in_lanes(const BodyMotionSolve& s, int begin, int end,
                                          const LaneVelocities& lanes);
void start_contact_change_in_lanes(const BodyMotionSolve& s, int begin, int end, const LaneVelocities& lanes);
void add_contact_change_in_lanes(const BodyMotionSolve& s, int begin, int end, const LaneVelocities& lanes);
void integrate_positions_in_lanes(const BodyMotionSolve& s, int begin, int end, const LaneVelocities& lanes);

// Rotations that are fast or bound to axes, which the above leave alone: of blocks of bodies, and whether there are any.
void integrate_fast_spinning_of_blocks(const BodyMotionSolve& s, int begin, int end);
bool has_fast_spinning(const BodyMotionSolve& s, int begin, int end);
// And in blocks of kFastSpinningPerBlock of them.
constexpr int kFastSpinningPerBlock = 8;
void integrate_fast_spinning(const BodyMotionSolve& s, int begin, int end);

// Velocities are saved, overlap is pushed apart by displacements in their place, and velocities are restored.
void begin_projection(const BodyMotionSolve& s, int begin, int end);
void end_projection(const BodyMotionSolve& s, int begin, int end);

// The whole step of free bodies, in blocks of kBodiesPerBlock.
void move_free_bodies(const BodyMotionSolve& s, int begin, int end);
// Orientations as the step ends, in blocks of kBodiesPerBlock.
void finish_orientations(const BodyMotionSolve& s, int begin, int end);

}  // namespace gyre
