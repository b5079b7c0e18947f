// Clips the face of one box to the face of another, which gives up to four points: a part of manifold_box.
#pragma once

#include "geometry/manifold/box_pair.h"
#include "geometry/manifold/manifold.h"

namespace gyre::boxes {

// The points along a face normal, `axis`. Leaves out.count at 0 if no faces overlap.
void collide_face(const Boxes& x, const Axis& axis, float max_separation, LocalManifold& out);

}  // namespace gyre::boxes
