// Two boxes with sharp edges: the axis search over their 15 axes and the clipping of their faces, written out for boxes
// because this is the pair that most scenes are made of.
//
// The depth of the best axis decides; faces win over pairs of edges, and the axis of the step before over others, when
// nearly equal, so that resting boxes keep their points. Every comparison is relative to the boxes' thickness.
//
// Sources: S. Gottschalk, M. Lin, D. Manocha, "OBBTree", 1996 (the 15 axes); geometry/manifold/clip.h for clipping and names.
#pragma once

#include "geometry/manifold/box_axes.h"
#include "geometry/manifold/manifold.h"

namespace gyre {

// Two boxes of rounding 0, as collide_convex. What the cache holds first is 1 more than the number of the axis that decided last.
void collide_boxes(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                   PairCache& cache, LocalManifold& out);
// The same in two parts. First the axis that decides, or the one that decided last if it parts the boxes by more than
// `max_separation`: what search_axes (box_search_lanes) tells of many pairs. `cache` is left to the second part.
boxes::Axis find_box_axis(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                          const PairCache& cache);
// Unit, from A to B, in A's frame.
Vec3 box_axis_normal(const boxes::Axis& axis, const Transform& a_from_b);
// Then what meets along it.
void collide_boxes_along(const boxes::Axis& axis, const Shape& a, const Shape& b, const Transform& a_from_b,
                         float max_separation, PairCache& cache, LocalManifold& out);

}  // namespace gyre
