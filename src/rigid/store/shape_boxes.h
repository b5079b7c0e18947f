// The boxes of shapes on bodies that move, four side by side: almost every step asks for those of everything that is awake.
//
// In: bodies and shapes as they are. Out: the box that holds a shape and how it moves, as collision/broadphase/fat_box.h wants them, or the
// fat boxes that follow from these. The bits do not depend on what stands beside.
#pragma once

#include "collision/broadphase/fat_box.h"
#include "rigid/store/rigid_world.h"

namespace gyre {

struct ShapeBox {
  WorldBox tight;
  BoxMotion motion;  // in a step of the length that was asked for
};
ShapeBox find_box(const RigidWorld& w, std::uint32_t shape, float seconds);

// Makes the fat boxes of the bodies' shapes anew where that must be, and marks these in refit_marks; whether there are any.
bool refit_boxes(RigidWorld& w, std::span<const std::uint32_t> bodies, float seconds);

// For each of the bodies, which move: whether all its shapes stay in their fat boxes on their way in this step. True is certain.
void find_within_fat_boxes(const RigidWorld& w, std::span<const std::uint32_t> bodies, std::span<bool> stay);

}  // namespace gyre
