// Kernel: which of W triangles are certainly too far from a shape. It tests directions that the search for the best one
// (mesh_axis.h) tests too, so that search would find the same triangles apart, only later.
//
// Balls and capsules: the directions from the sides of the triangle to the ends of the core; capsules also those from
// its corners to the core, and the cross products of edges. Boxes: face normals and cross products of edges. Hulls:
// face normals. All comparisons use squares, without a root.
//
// Source of the pairs of edges in the box's own frame: T. Akenine-Moeller, "Fast 3D Triangle-Box Overlap Testing",
// 2001.
#pragma once

#include "geometry/manifold_mesh/mesh_kernels.h"
#include "math/wide_vec.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// Triangles relative to the origin of the shape; of a double-sided surface, the side on which the centre of the shape
// lies.
template <int W>
struct TriangleLanes {
  Vec3W<W> corner[3], normal;
  Wide<W> max_coordinate;  // the largest coordinate of corners and shape in the surface's frame
};

GYRE_INLINE Vec3 vertex_of(const ConvexColumns& convex, int i) {
  return {convex.x[i], convex.y[i], convex.z[i]};
}

// Relative to the size of the shape: more than a search requires to prefer one of two directions.
constexpr float kApartMargin = 2.0e-3f;
// Relative to the largest coordinate.
constexpr float kApartRounding = 1.0e-6f;
// Squared sine below which edges are nearly parallel and left to the search, which does not test all of them.
constexpr float kApartParallel = 1.0e-6f;
// The smallest squared length that is a divisor.
constexpr float kApartShortest = 1.0e-30f;

// True if a gap along a direction of the given squared length is above `limit`.
template <int W>
GYRE_INLINE Mask<W> is_beyond(Wide<W> gap, Wide<W> squared_length, Wide<W> limit) {
  return (gap > Wide<W>(0.0f)) & (square(gap) > square(limit) * squared_length);
}

template <int W>
GYRE_INLINE Wide<W> clamp01(Wide<W> fraction) {
  return min(max(fraction, Wide<W>(0.0f)), Wide<W>(1.0f));
}

// The core of a ball or capsule.
template <int W>
struct SegmentLanes {
  Vec3W<W> from, to, along;
  Wide<W> inverse_squared;  // 1 / length^2 of the segment
  bool is_point;

  GYRE_INLINE explicit SegmentLanes(const ConvexColumns& convex)
      : from(splat<W>(vertex_of(convex, 0))),
        to(splat<W>(vertex_of(convex, convex.vertex_count - 1))),
        along(to - from),
        inverse_squared(Wide<W>(1.0f) / max(length_squared(along), Wide<W>(kApartShortest))),
        is_point(convex.vertex_count == 1) {}

  GYRE_INLINE Vec3W<W> nearest(Vec3W<W> p) const {
    return from + clamp01<W>(dot(p - from, along) * inverse_squared) * along;
  }
};

// Along the direction from a point of the triangle to a point of the core.
template <int W>
GYRE_INLINE Mask<W> is_beyond(const TriangleLanes<W>& t, const SegmentLanes<W>& core, Vec3W<W> axis,
                              Wide<W> limit) {
  const Wide<W> start = dot(axis, core.from), lowest = core.is_point ? start : min(start, dot(axis, core.to));
  const Wide<W> highest = max(dot(axis, t.corner[0]), max(dot(axis, t.corner[1]), dot(axis, t.corner[2])));
  return is_beyond<W>(lowest - highest, length_squared(axis), limit);
}

// The shortest vector from a side, which begins at `start`, to a point.
template <int W>
GYRE_INLINE Vec3W<W> from_side(Vec3W<W> start, Vec3W<W> edge, Wide<W> inverse_squared, Vec3W<W> point) {
  const Vec3W<W> axis = point - start;
  return axis - clamp01<W>(dot(axis, edge) * inverse_squared) * edge;
}

// Along the shortest vectors between the ends of the core and the sides of the triangle, and between the core and the
// corners.
template <int W>
GYRE_INLINE Mask<W> is_beyond_sides(const TriangleLanes<W>& t, const SegmentLanes<W>& core, Wide<W> limit) {
  Mask<W> beyond = Mask<W>::splat(false);
  GYRE_UNROLL
  for (int i = 0; i < 3; ++i) {
    const Vec3W<W> start = t.corner[i], edge = t.corner[(i + 1) % 3] - start;
    const Wide<W> inverse_squared = Wide<W>(1.0f) / max(length_squared(edge), Wide<W>(kApartShortest));
    beyond = beyond | is_beyond<W>(t, core, from_side<W>(start, edge, inverse_squared, core.from), limit);
    if (core.is_point) continue;
    beyond = beyond | is_beyond<W>(t, core, from_side<W>(start, edge, inverse_squared, core.to), limit) |
             is_beyond<W>(t, core, core.nearest(start) - start, limit);
  }
  return beyond;
}

template <int W>
GYRE_INLINE Mask<W> is_across_edge(const TriangleLanes<W>& t, const SegmentLanes<W>& core, Wide<W> limit) {
  Mask<W> across = Mask<W>::splat(false);
  GYRE_UNROLL
  for (int i = 0; i < 3; ++i) {
    const Vec3W<W> axis = cross(core.along, t.corner[(i + 1) % 3] - t.corner[i]);
    const Wide<W> on_core = dot(axis, core.from), edge = dot(axis, t.corner[i]),
                  opposite = dot(axis, t.corner[(i + 2) % 3]);
    const Wide<W> gap = max(on_core - max(edge, opposite), min(edge, opposite) - on_core);
    across = across | is_beyond<W>(gap, length_squared(axis), limit);
  }
  return across;
}

// The cross product of an edge (u, v) of the triangle and the axis of the box that is not passed: only the other two
// coordinates matter. The extent of the box along it is a sum over these two.
template <int W>
struct AcrossBox {
  Wide<W> shortest, limit;

  GYRE_INLINE Mask<W> apart(Wide<W> edge_u, Wide<W> edge_v, Wide<W> start_u, Wide<W> start_v,
                            Wide<W> opposite_u, Wide<W> opposite_v, float half_u, float half_v) const {
    const Wide<W> edge = edge_u * start_v - edge_v * start_u;
    const Wide<W> opposite = edge_u * opposite_v - edge_v * opposite_u;
    const Wide<W> box = Wide<W>(half_u) * absolute(edge_v) + Wide<W>(half_v) * absolute(edge_u);
    const Wide<W> squared = square(edge_u) + square(edge_v);
    // The edge itself must be closest.
    const Mask<W> faces =
        ((edge > Wide<W>(0.0f)) & (opposite >= edge)) | ((edge < Wide<W>(0.0f)) & (opposite <= edge));
    return faces & (squared > shortest) & is_beyond<W>(absolute(edge) - box, squared, limit);
  }
};

// In the frame of the box: along its face normals and the cross products of edges.
template <int W>
GYRE_INLINE Mask<W> is_apart_from_box(const TriangleLanes<W>& t, const ConvexColumns& convex, Wide<W> limit) {
  const Vec3W<W> axes[3] = {splat<W>(convex.axes[0]), splat<W>(convex.axes[1]), splat<W>(convex.axes[2])};
  const Vec3 half = convex.half;
  Vec3W<W> corner[3];
  GYRE_UNROLL
  for (int i = 0; i < 3; ++i)
    corner[i] = {dot(axes[0], t.corner[i]), dot(axes[1], t.corner[i]), dot(axes[2], t.corner[i])};
  const Vec3W<W> low = min(corner[0], min(corner[1], corner[2])),
                 high = max(corner[0], max(corner[1], corner[2]));
  Mask<W> apart = largest(max(low, -high) - splat<W>(half)) > limit;
  GYRE_UNROLL
  for (int i = 0; i < 3; ++i) {
    const Vec3W<W> a = corner[i], b = corner[(i + 2) % 3], edge = corner[(i + 1) % 3] - a;
    const AcrossBox<W> across{Wide<W>(kApartParallel) * length_squared(edge), limit};
    apart = apart | across.apart(edge.y, edge.z, a.y, a.z, b.y, b.z, half.y, half.z) |
            across.apart(edge.z, edge.x, a.z, a.x, b.z, b.x, half.z, half.x) |
            across.apart(edge.x, edge.y, a.x, a.y, b.x, b.y, half.x, half.y);
  }
  return apart;
}

// The largest distance at which all of a triangle lies before one face.
template <int W>
GYRE_INLINE Wide<W> before_faces(const TriangleLanes<W>& t, const ConvexColumns& convex) {
  Wide<W> largest_gap(-__builtin_huge_valf());
  for (int i = 0; i < convex.face_count; ++i) {
    const Vec3W<W> n = splat<W>(Vec3{convex.nx[i], convex.ny[i], convex.nz[i]});
    const Wide<W> lowest = min(dot(n, t.corner[0]), min(dot(n, t.corner[1]), dot(n, t.corner[2])));
    largest_gap = max(largest_gap, lowest - Wide<W>(convex.offset[i]));
  }
  return largest_gap;
}

// The difference of rounding between the search and this kernel, and how much deeper than its lowest corner a shape may
// rest on a face.
template <int W>
GYRE_INLINE Wide<W> apart_slack(const TriangleLanes<W>& t, const ConvexColumns& convex) {
  return Wide<W>(kApartRounding) * t.max_coordinate + Wide<W>(kApartMargin * convex.size);
}

// True if the surfaces are certainly more than `max_separation` apart.
template <int W>
GYRE_INLINE Mask<W> is_apart(const TriangleLanes<W>& t, const ConvexColumns& convex, float max_separation) {
  const Wide<W> limit = Wide<W>(convex.radius + max_separation) + apart_slack<W>(t, convex);
  switch (convex.core) {
    case ConvexColumns::Core::box:
      return is_apart_from_box<W>(t, convex, limit);
    case ConvexColumns::Core::polyhedron:
      return before_faces<W>(t, convex) > limit;
    case ConvexColumns::Core::ball:
    case ConvexColumns::Core::segment: {
      const SegmentLanes<W> core(convex);
      const Mask<W> beyond = is_beyond_sides<W>(t, core, limit);
      return core.is_point ? beyond : beyond | is_across_edge<W>(t, core, limit);
    }
    default:
      return Mask<W>::splat(false);
  }
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
