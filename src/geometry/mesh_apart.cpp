// Triangles apart from a shape, side by side. See mesh_apart.h.
//
// Source of the pairs of edges in the box's own frame: T. Akenine-Moeller, "Fast 3D Triangle-Box Overlap Testing", 2001.
#include "geometry/mesh_apart.h"

namespace gyre {
namespace {

constexpr int kLanes = TriangleLanes::kLanes;
using Floats = Wide<kLanes>;
using Vectors = Vec3W<kLanes>;
using Marks = Mask<kLanes>;

// Relative to the size of the shape: more than a search asks for before it prefers one of two directions.
constexpr float kMargin = 2.0e-3f;
// Of the largest coordinate.
constexpr float kRounding = 1.0e-6f;
// A sine, squared: edges that are more nearly parallel are left to the search, which does not look at all of them.
constexpr float kParallel = 1.0e-6f;
// A length, squared, that nothing is divided by.
constexpr float kShortest = 1.0e-30f;

// Along a direction whose squared length is given.
Marks is_beyond(Floats gap, Floats squared_length, Floats reach) {
  return (gap > Floats(0.0f)) & (square(gap) > square(reach) * squared_length);
}

// The core of a ball or capsule.
struct Segment {
  Vectors from, to, along;
  Floats share;  // of a way along the segment in its length, by length
  bool is_point;

  explicit Segment(const PlacedConvex& convex)
      : from(splat<kLanes>(convex.vertex(0))),
        to(splat<kLanes>(convex.vertex(convex.vertex_count() - 1))),
        along(to - from),
        share(Floats(1.0f) / max(length_squared(along), Floats(kShortest))),
        is_point(convex.vertex_count() == 1) {}

  Vectors nearest(Vectors p) const { return from + limited(dot(p - from, along) * share) * along; }
  static Floats limited(Floats part) { return min(max(part, Floats(0.0f)), Floats(1.0f)); }
};

// Along the way to a point of the core from one of the triangle.
Marks is_beyond(const TriangleLanes& t, const Segment& core, Vectors way, Floats reach) {
  const Floats start = dot(way, core.from), lowest = core.is_point ? start : min(start, dot(way, core.to));
  const Floats highest = max(dot(way, t.corner[0]), max(dot(way, t.corner[1]), dot(way, t.corner[2])));
  return is_beyond(lowest - highest, length_squared(way), reach);
}

// Along the shortest ways between the ends of the core and the triangle's sides, and between the core and its corners.
Marks is_beyond_sides(const TriangleLanes& t, const Segment& core, Floats reach) {
  Marks beyond = Marks::splat(false);
  for (int i = 0; i < 3; ++i) {
    const Vectors start = t.corner[i], edge = t.corner[next_corner(i)] - start;
    const Floats share = Floats(1.0f) / max(length_squared(edge), Floats(kShortest));
    const auto from_side = [&](Vectors end) {
      const Vectors way = end - start;
      return way - Segment::limited(dot(way, edge) * share) * edge;
    };
    beyond = beyond | is_beyond(t, core, from_side(core.from), reach);
    if (core.is_point) continue;
    beyond = beyond | is_beyond(t, core, from_side(core.to), reach) |
             is_beyond(t, core, core.nearest(start) - start, reach);
  }
  return beyond;
}

Marks is_across_edge(const TriangleLanes& t, const Segment& core, Floats reach) {
  Marks across = Marks::splat(false);
  for (int i = 0; i < 3; ++i) {
    const Vectors way = cross(core.along, t.corner[next_corner(i)] - t.corner[i]);
    const Floats place = dot(way, core.from), edge = dot(way, t.corner[i]),
                 opposite = dot(way, t.corner[next_corner(next_corner(i))]);
    const Floats gap = max(place - max(edge, opposite), min(edge, opposite) - place);
    across = across | is_beyond(gap, length_squared(way), reach);
  }
  return across;
}

// Across an edge (u, v) of the triangle and the box's axis that is left out here: the other two coordinates. What the box reaches
// there is a sum over its own two.
Marks is_across(Floats edge_u, Floats edge_v, Floats start_u, Floats start_v, Floats opposite_u,
                Floats opposite_v, float half_u, float half_v, Floats shortest, Floats reach) {
  const Floats edge = edge_u * start_v - edge_v * start_u;
  const Floats opposite = edge_u * opposite_v - edge_v * opposite_u;
  const Floats box = Floats(half_u) * absolute(edge_v) + Floats(half_v) * absolute(edge_u);
  const Floats squared = square(edge_u) + square(edge_v);
  // The edge itself must be what is nearest.
  const Marks faces =
      ((edge > Floats(0.0f)) & (opposite >= edge)) | ((edge < Floats(0.0f)) & (opposite <= edge));
  return faces & (squared > shortest) & is_beyond(absolute(edge) - box, squared, reach);
}

// In the box's own frame: before its faces, and across pairs of edges.
Marks is_apart_from_box(const TriangleLanes& t, const PlacedConvex& convex, Floats reach) {
  const Vectors axes[3] = {splat<kLanes>(convex.from_local({1, 0, 0})),
                           splat<kLanes>(convex.from_local({0, 1, 0})),
                           splat<kLanes>(convex.from_local({0, 0, 1}))};
  const Vec3 half = convex.shape().extents;
  Vectors corner[3];
  for (int i = 0; i < 3; ++i)
    corner[i] = {dot(axes[0], t.corner[i]), dot(axes[1], t.corner[i]), dot(axes[2], t.corner[i])};
  const Vectors low = min(corner[0], min(corner[1], corner[2])),
                high = max(corner[0], max(corner[1], corner[2]));
  Marks apart = largest(max(low, -high) - splat<kLanes>(half)) > reach;
  for (int i = 0; i < 3; ++i) {
    const Vectors start = corner[i], opposite = corner[next_corner(next_corner(i))];
    const Vectors edge = corner[next_corner(i)] - start;
    const Floats shortest = Floats(kParallel) * length_squared(edge);
    apart =
        apart |
        is_across(edge.y, edge.z, start.y, start.z, opposite.y, opposite.z, half.y, half.z, shortest, reach) |
        is_across(edge.z, edge.x, start.z, start.x, opposite.z, opposite.x, half.z, half.x, shortest, reach) |
        is_across(edge.x, edge.y, start.x, start.y, opposite.x, opposite.y, half.x, half.y, shortest, reach);
  }
  return apart;
}

}  // namespace

Wide<kLanes> apart_slack(const TriangleLanes& t, const PlacedConvex& convex) {
  return Floats(kRounding) * t.reach + Floats(kMargin * convex.size());
}

Mask<kLanes> is_apart(const TriangleLanes& t, const PlacedConvex& convex, float max_separation) {
  const Floats reach = Floats(convex.radius() + max_separation) + apart_slack(t, convex);
  if (convex.shape().kind == ShapeKind::box) return is_apart_from_box(t, convex, reach);
  if (convex.face_count() > 0) return convex.face_separations(t.corner) > reach;
  if (!convex.has_vertices()) return Marks::splat(false);
  const Segment core(convex);
  const Marks beyond = is_beyond_sides(t, core, reach);
  return core.is_point ? beyond : beyond | is_across_edge(t, core, reach);
}

}  // namespace gyre
