// What moves the bodies of a batch: forces, moves and rotation, block by block of those on which constraints act. As functions of blocks,
// and as stages of programs (task/program.h), whose context is the batch's Solve.
#pragma once

#include "rigid/solve/program_writer.h"
#include "rigid/solve/solve.h"

namespace gyre {

// Of blocks [begin, end). Who watches and notes knows what contacts gave the bodies; nobody asks that of blocks that are not watched
// (Solve::watched_blocks).
void prepare_motion(const Solve& s, int begin, int end);
// By forces; warm: and by what contacts gave in the last part.
void predict_motion(const Solve& s, int begin, int end, bool warm, const LaneVelocities& lanes = {});
void watch_motion(const Solve& s, int begin, int end, const LaneVelocities& lanes = {});
void note_motion(const Solve& s, int begin, int end, const LaneVelocities& lanes = {});
// Noted: what contacts gave has been noted by now. (In lanes it must have been.)
void advance_motion(const Solve& s, int begin, int end, bool noted, const LaneVelocities& lanes = {});
// Whether some in these blocks turn alone, and their rotation.
bool has_spinners(const Solve& s, int begin, int end);
void turn_spinners(const Solve& s, int begin, int end);

void prepare_motion_stage(void* context, int begin, int end, int worker);
void predict_stage(void* context, int begin, int end, int worker);
void predict_warm_stage(void* context, int begin, int end, int worker);
void warm_motion_stage(void* context, int begin, int end, int worker);
void watch_motion_stage(void* context, int begin, int end, int worker);
void note_motion_stage(void* context, int begin, int end, int worker);
void advance_stage(void* context, int begin, int end, int worker);
void advance_noted_stage(void* context, int begin, int end, int worker);
void begin_projection_stage(void* context, int begin, int end, int worker);
void end_projection_stage(void* context, int begin, int end, int worker);

// A line for the first `blocks` of the bodies that are moved,
void add_motion(ProgramWriter& program, Solve& solve, void (*kernel)(void*, int, int, int), int blocks);
// for those that fly, for those that turn alone, and for the orientations of all as the step ends.
void add_flying(ProgramWriter& program, Solve& solve);
void add_turn_alone(ProgramWriter& program, Solve& solve);
void add_finish_turns(ProgramWriter& program, Solve& solve);

}  // namespace gyre
