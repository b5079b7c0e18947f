// Bounding boxes of shapes on moving bodies, four shapes in SIMD lanes; most steps compute the boxes of all awake
// bodies.
//
// In: bodies and shapes. Out: the box of a shape and its motion, as collision/broadphase/fat_box.h takes them, or new
// fat boxes. The result of a shape does not depend on its neighbours in the lanes.
#pragma once

#include "collision/broadphase/fat_box.h"
#include "rigid/store/rigid_world.h"

namespace gyre {

struct ShapeBox {
  WorldBox tight;
  BoxMotion motion;  // in a step of the given length
};
ShapeBox find_box(const RigidWorld& w, std::uint32_t shape, float seconds);

// Refits the fat boxes of the shapes of these bodies if necessary, and marks the refitted shapes in refit_marks. True
// if any was refitted.
bool refit_boxes(RigidWorld& w, std::span<const std::uint32_t> bodies, float seconds);

// For each of the moving bodies: true if all its shapes certainly stay within their fat boxes during this step.
void find_within_fat_boxes(const RigidWorld& w, std::span<const std::uint32_t> bodies, std::span<bool> stay);

}  // namespace gyre
