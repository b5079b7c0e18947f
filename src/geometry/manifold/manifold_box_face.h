// The face of one box cut to the face of another: the part of manifold_box that makes up to four points.
#pragma once

#include "geometry/manifold/box_pair.h"
#include "geometry/manifold/manifold.h"

namespace gyre::boxes {

// The points along a face normal, `axis`. Leaves out.count at 0 when no face of one box lies over the other's.
void collide_face(const Boxes& x, const Axis& axis, float max_separation, LocalManifold& out);

}  // namespace gyre::boxes
