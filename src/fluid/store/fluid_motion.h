// The motion of fluids' boxes: how the axes advance, and how the fluid sees a change of their velocity.
//
// In: a frame, its change. Out: the frame of an entry, and velocities relative to it.
#pragma once

#include "fluid/grid/frame_motion.h"
#include "fluid/store/fluid_store.h"

namespace gyre {

// The frame after some seconds at its velocity.
FluidFrame advanced(const FluidFrame& frame, float seconds);
void advance_frame(FluidEntry& entry, float seconds);
// Sets the frame and leaves the fluid as it is, relative to the box.
void set_frame(FluidEntry& entry, const FluidFrame& frame);
// Adds to the velocity of the frame. The fluid keeps its velocity in the world.
void change_frame_velocity(FluidEntry& entry, Vec3 linear, Vec3 angular);
// For an entry with a frame.
FrameMotion frame_motion(const FluidEntry& entry);

}  // namespace gyre
