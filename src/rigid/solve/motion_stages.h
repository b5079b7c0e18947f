// What moves the bodies of a batch: forces, moves and rotation, block by block of those on which constraints act. As functions of blocks,
// and as stages of programs (task/program.h), whose context is the batch's Solve.
#pragma once

#include "rigid/solve/program_writer.h"
#include "rigid/solve/solve.h"

namespace gyre {

// Of blocks [begin, end). Who watches and notes knows what contacts gave the bodies; nobody asks that of blocks that are not watched
// (Solve::recorded_blocks).
void prepare_motion(const BatchContext& s, int begin, int end);
// By forces; warm: and by what contacts gave in the last part.
void predict_motion(const BatchContext& s, int begin, int end, bool warm, const LaneVelocities& lanes = {});
void record_velocities(const BatchContext& s, int begin, int end, const LaneVelocities& lanes = {});
void record_velocity_change(const BatchContext& s, int begin, int end, const LaneVelocities& lanes = {});
// Noted: what contacts gave has been noted by now. (In lanes it must have been.)
void advance_motion(const BatchContext& s, int begin, int end, bool noted, const LaneVelocities& lanes = {});
// Whether some in these blocks turn alone, and their rotation.
bool has_fast_spinning(const BatchContext& s, int begin, int end);
void rotate_fast_spinning(const BatchContext& s, int begin, int end);

void prepare_motion_stage(void* context, int begin, int end, int worker);
void predict_stage(void* context, int begin, int end, int worker);
void predict_warm_stage(void* context, int begin, int end, int worker);
void warm_motion_stage(void* context, int begin, int end, int worker);
void record_velocities_stage(void* context, int begin, int end, int worker);
void record_velocity_change_stage(void* context, int begin, int end, int worker);
void advance_stage(void* context, int begin, int end, int worker);
void advance_recorded_stage(void* context, int begin, int end, int worker);
void begin_projection_stage(void* context, int begin, int end, int worker);
void end_projection_stage(void* context, int begin, int end, int worker);

// A line for the first `blocks` of the bodies that are moved,
void add_motion(ProgramWriter& program, BatchContext& solve, void (*kernel)(void*, int, int, int),
                int blocks);
// for those that fly, for those that turn alone, and for the orientations of all as the step ends.
void add_free_bodies(ProgramWriter& program, BatchContext& solve);
void add_exact_rotation(ProgramWriter& program, BatchContext& solve);
void add_apply_rotations(ProgramWriter& program, BatchContext& solve);

}  // namespace gyre
