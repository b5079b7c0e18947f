// Manifold of two boxes with sharp edges: the axis search over their 15 axes and the clipping of their faces. It is
// specialised for boxes because most pairs of most scenes are boxes.
//
// The axis of least penetration decides. If several are nearly equal, faces win over pairs of edges, and the axis of
// the last step wins over all others, so that resting boxes keep their points. Every tolerance is relative to the
// thickness of the boxes.
//
// Sources: S. Gottschalk, M. Lin, D. Manocha, "OBBTree", 1996 (the 15 axes); geometry/manifold/clip.h for clipping and
// names.
#pragma once

#include "geometry/manifold/box_axes.h"
#include "geometry/manifold/manifold.h"

namespace gyre {

// As collide_convex, for two boxes of rounding 0. The first word of the cache is 1 more than the number of the axis
// that decided last.
void collide_boxes(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                   PairCache& cache, LocalManifold& out);
// The same in two steps. The first finds the deciding axis, or the last one if that still separates the boxes by more
// than `max_separation`; search_axes (box_search_lanes) computes the same for many pairs. It does not write `cache`.
boxes::Axis find_box_axis(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                          const PairCache& cache);
// The normal of an axis: unit, from A to B, in A's frame.
Vec3 box_axis_normal(const boxes::Axis& axis, const Transform& a_from_b);
// The second step makes the manifold along the axis.
void collide_boxes_along(const boxes::Axis& axis, const Shape& a, const Shape& b, const Transform& a_from_b,
                         float max_separation, PairCache& cache, LocalManifold& out);

}  // namespace gyre
