// Which of W triangles certainly lie too far from a shape, by directions that the search for the best one (mesh_axis.h) knows
// as well: what is found apart here it would find apart too, only later.
//
// Balls and capsules: along the ways from the triangle's sides to the ends of the core; capsules also along those from its corners
// to the core, and across pairs of edges. Boxes: before their faces and across pairs of edges; hulls: before their faces. All by their
// squares, without a root.
//
// Source of the pairs of edges in the box's own frame: T. Akenine-Moeller, "Fast 3D Triangle-Box Overlap Testing", 2001.
#pragma once

#include "geometry/manifold_mesh/mesh_kernels.h"
#include "math/wide_vec.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// Seen from the shape's origin; of a double-sided surface the side on which the shape's middle lies.
template <int W>
struct TriangleLanes {
  Vec3W<W> corner[3], normal;
  Wide<W> reach;  // the largest coordinate in the surface's frame, of corners and shape
};

GYRE_INLINE Vec3 vertex_of(const ConvexColumns& convex, int i) {
  return {convex.x[i], convex.y[i], convex.z[i]};
}

// Relative to the size of the shape: more than a search asks for before it prefers one of two directions.
constexpr float kApartMargin = 2.0e-3f;
// Of the largest coordinate.
constexpr float kApartRounding = 1.0e-6f;
// A sine, squared: edges that are more nearly parallel are left to the search, which does not look at all of them.
constexpr float kApartParallel = 1.0e-6f;
// A length, squared, that nothing is divided by.
constexpr float kApartShortest = 1.0e-30f;

// Along a direction whose squared length is given.
template <int W>
GYRE_INLINE Mask<W> is_beyond(Wide<W> gap, Wide<W> squared_length, Wide<W> reach) {
  return (gap > Wide<W>(0.0f)) & (square(gap) > square(reach) * squared_length);
}

template <int W>
GYRE_INLINE Wide<W> limited(Wide<W> part) {
  return min(max(part, Wide<W>(0.0f)), Wide<W>(1.0f));
}

// The core of a ball or capsule.
template <int W>
struct SegmentLanes {
  Vec3W<W> from, to, along;
  Wide<W> share;  // of a way along the segment in its length, by length
  bool is_point;

  GYRE_INLINE explicit SegmentLanes(const ConvexColumns& convex)
      : from(splat<W>(vertex_of(convex, 0))),
        to(splat<W>(vertex_of(convex, convex.vertex_count - 1))),
        along(to - from),
        share(Wide<W>(1.0f) / max(length_squared(along), Wide<W>(kApartShortest))),
        is_point(convex.vertex_count == 1) {}

  GYRE_INLINE Vec3W<W> nearest(Vec3W<W> p) const {
    return from + limited<W>(dot(p - from, along) * share) * along;
  }
};

// Along the way to a point of the core from one of the triangle.
template <int W>
GYRE_INLINE Mask<W> is_beyond(const TriangleLanes<W>& t, const SegmentLanes<W>& core, Vec3W<W> way,
                              Wide<W> reach) {
  const Wide<W> start = dot(way, core.from), lowest = core.is_point ? start : min(start, dot(way, core.to));
  const Wide<W> highest = max(dot(way, t.corner[0]), max(dot(way, t.corner[1]), dot(way, t.corner[2])));
  return is_beyond<W>(lowest - highest, length_squared(way), reach);
}

// The shortest way to a point from a side that begins at `start`.
template <int W>
GYRE_INLINE Vec3W<W> way_from_side(Vec3W<W> start, Vec3W<W> edge, Wide<W> share, Vec3W<W> point) {
  const Vec3W<W> way = point - start;
  return way - limited<W>(dot(way, edge) * share) * edge;
}

// Along the shortest ways between the ends of the core and the triangle's sides, and between the core and its corners.
template <int W>
GYRE_INLINE Mask<W> is_beyond_sides(const TriangleLanes<W>& t, const SegmentLanes<W>& core, Wide<W> reach) {
  Mask<W> beyond = Mask<W>::splat(false);
  GYRE_UNROLL
  for (int i = 0; i < 3; ++i) {
    const Vec3W<W> start = t.corner[i], edge = t.corner[(i + 1) % 3] - start;
    const Wide<W> share = Wide<W>(1.0f) / max(length_squared(edge), Wide<W>(kApartShortest));
    beyond = beyond | is_beyond<W>(t, core, way_from_side<W>(start, edge, share, core.from), reach);
    if (core.is_point) continue;
    beyond = beyond | is_beyond<W>(t, core, way_from_side<W>(start, edge, share, core.to), reach) |
             is_beyond<W>(t, core, core.nearest(start) - start, reach);
  }
  return beyond;
}

template <int W>
GYRE_INLINE Mask<W> is_across_edge(const TriangleLanes<W>& t, const SegmentLanes<W>& core, Wide<W> reach) {
  Mask<W> across = Mask<W>::splat(false);
  GYRE_UNROLL
  for (int i = 0; i < 3; ++i) {
    const Vec3W<W> way = cross(core.along, t.corner[(i + 1) % 3] - t.corner[i]);
    const Wide<W> place = dot(way, core.from), edge = dot(way, t.corner[i]),
                  opposite = dot(way, t.corner[(i + 2) % 3]);
    const Wide<W> gap = max(place - max(edge, opposite), min(edge, opposite) - place);
    across = across | is_beyond<W>(gap, length_squared(way), reach);
  }
  return across;
}

// Across an edge (u, v) of the triangle and the box's axis that is left out here: the other two coordinates. What the box reaches
// there is a sum over its own two.
template <int W>
struct AcrossBox {
  Wide<W> shortest, reach;

  GYRE_INLINE Mask<W> apart(Wide<W> edge_u, Wide<W> edge_v, Wide<W> start_u, Wide<W> start_v,
                            Wide<W> opposite_u, Wide<W> opposite_v, float half_u, float half_v) const {
    const Wide<W> edge = edge_u * start_v - edge_v * start_u;
    const Wide<W> opposite = edge_u * opposite_v - edge_v * opposite_u;
    const Wide<W> box = Wide<W>(half_u) * absolute(edge_v) + Wide<W>(half_v) * absolute(edge_u);
    const Wide<W> squared = square(edge_u) + square(edge_v);
    // The edge itself must be what is nearest.
    const Mask<W> faces =
        ((edge > Wide<W>(0.0f)) & (opposite >= edge)) | ((edge < Wide<W>(0.0f)) & (opposite <= edge));
    return faces & (squared > shortest) & is_beyond<W>(absolute(edge) - box, squared, reach);
  }
};

// In the box's own frame: before its faces, and across pairs of edges.
template <int W>
GYRE_INLINE Mask<W> is_apart_from_box(const TriangleLanes<W>& t, const ConvexColumns& convex, Wide<W> reach) {
  const Vec3W<W> axes[3] = {splat<W>(convex.axes[0]), splat<W>(convex.axes[1]), splat<W>(convex.axes[2])};
  const Vec3 half = convex.half;
  Vec3W<W> corner[3];
  GYRE_UNROLL
  for (int i = 0; i < 3; ++i)
    corner[i] = {dot(axes[0], t.corner[i]), dot(axes[1], t.corner[i]), dot(axes[2], t.corner[i])};
  const Vec3W<W> low = min(corner[0], min(corner[1], corner[2])),
                 high = max(corner[0], max(corner[1], corner[2]));
  Mask<W> apart = largest(max(low, -high) - splat<W>(half)) > reach;
  GYRE_UNROLL
  for (int i = 0; i < 3; ++i) {
    const Vec3W<W> a = corner[i], b = corner[(i + 2) % 3], edge = corner[(i + 1) % 3] - a;
    const AcrossBox<W> across{Wide<W>(kApartParallel) * length_squared(edge), reach};
    apart = apart | across.apart(edge.y, edge.z, a.y, a.z, b.y, b.z, half.y, half.z) |
            across.apart(edge.z, edge.x, a.z, a.x, b.z, b.x, half.z, half.x) |
            across.apart(edge.x, edge.y, a.x, a.y, b.x, b.y, half.x, half.y);
  }
  return apart;
}

// The greatest distance at which all of a triangle lies before a face.
template <int W>
GYRE_INLINE Wide<W> before_faces(const TriangleLanes<W>& t, const ConvexColumns& convex) {
  Wide<W> most(-__builtin_huge_valf());
  for (int i = 0; i < convex.face_count; ++i) {
    const Vec3W<W> n = splat<W>(Vec3{convex.nx[i], convex.ny[i], convex.nz[i]});
    const Wide<W> lowest = min(dot(n, t.corner[0]), min(dot(n, t.corner[1]), dot(n, t.corner[2])));
    most = max(most, lowest - Wide<W>(convex.offset[i]));
  }
  return most;
}

// How far a search's own roundings may lie beside those here, and how much deeper than its lowest corner a shape may rest on a face.
template <int W>
GYRE_INLINE Wide<W> apart_slack(const TriangleLanes<W>& t, const ConvexColumns& convex) {
  return Wide<W>(kApartRounding) * t.reach + Wide<W>(kApartMargin * convex.size);
}

// Whether the surfaces lie more than `max_separation` apart; false only means that it is not known.
template <int W>
GYRE_INLINE Mask<W> is_apart(const TriangleLanes<W>& t, const ConvexColumns& convex, float max_separation) {
  const Wide<W> reach = Wide<W>(convex.radius + max_separation) + apart_slack<W>(t, convex);
  switch (convex.core) {
    case ConvexColumns::Core::box:
      return is_apart_from_box<W>(t, convex, reach);
    case ConvexColumns::Core::polyhedron:
      return before_faces<W>(t, convex) > reach;
    case ConvexColumns::Core::ball:
    case ConvexColumns::Core::segment: {
      const SegmentLanes<W> core(convex);
      const Mask<W> beyond = is_beyond_sides<W>(t, core, reach);
      return core.is_point ? beyond : beyond | is_across_edge<W>(t, core, reach);
    }
    default:
      return Mask<W>::splat(false);
  }
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
