// Directions between a convex shape and a triangle. See mesh_axis.h.
#include "geometry/manifold_mesh/mesh_axis.h"

#include "geometry/distance/closest.h"
#include "geometry/distance/gjk.h"
#include "geometry/distance/penetration.h"
#include "geometry/distance/sphere_triangle.h"
#include "math/wide_vec.h"

#include <bit>

namespace gyre {
namespace {

// Sines: directions this near to the face's normal are the face's; how far a direction may lie outside an arc or a cone; how
// much an edge or corner may lie lower than another and still belong to the supporting feature.
constexpr float kFaceAngle = 1.0e-3f;
constexpr float kArcSlack = 1.0e-3f;
constexpr float kSliverSlack = 0.1f;
constexpr float kLevelSlack = 1.0e-3f;
// A triangle all of whose corners are level along a direction farther than this from its normal is a sliver, seen from beside.
constexpr float kBesideFace = 5.0e-3f;
// A sine too.
constexpr float kParallelEdges = 1.0e-4f;
// Cosine between the normals at the rim of a plate; and how much farther than its edge, relative to its size, a plate may reach along an
// axis of that edge.
constexpr float kRim = -0.9f;
constexpr float kRimSlack = 1.0e-5f;
// A sine that no rounding reaches.
constexpr float kOutwardSlack = 1.0e-5f;

using Floats = Wide<4>;

class DirectionSearch {
 public:
  DirectionSearch(const Surface& surface, const LocalTriangle& triangle, const LocalConvex& convex,
                  float face_separation, float max_separation, AxisScratch& scratch)
      : surface_(surface), t_(triangle), convex_(convex), max_separation_(max_separation), scratch_(scratch) {
    found_.best = face_separation;
    core_best_ = face_separation + convex.radius();
  }

  AxisSearch run_nearest() {
    nearest_by_gjk();
    return found_;
  }

  AxisSearch run() {
    if (convex_.has_vertices()) {
      polyhedron();
    } else {
      nearest_by_gjk();
    }
    return found_;
  }

 private:
  bool apart() const { return found_.best > max_separation_; }

  // Straight through the triangle from behind: never a way out.
  bool is_backwards(Vec3 d) const { return dot(d, t_.normal) < -0.99f; }
  bool is_face(Vec3 d) const { return length_squared(d - t_.normal) < kFaceAngle * kFaceAngle; }

  // Of a sliver the normal, and with it where arcs begin, is as uncertain as its corners are beside its height.
  float arc_slack() const {
    const float longest = max(t_.length[0], max(t_.length[1], t_.length[2]));
    const float double_area = t_.length[0] * length(cross(t_.along[0], t_.v[2] - t_.v[0]));
    return max(kArcSlack, min(kSliverSlack, 4.0f * t_.slack * longest / max(double_area, 1.0e-30f)));
  }

  bool is_active(int edge) const {
    return t_.edge[edge] == EdgeKind::convex || t_.edge[edge] == EdgeKind::open;
  }

  // What the separation along a direction across an edge must be better than.
  float needed_of(int edge) const { return is_active(edge) ? min(found_.best, useful()) : found_.best; }

  // What that asks of pairs of edges: of the corner where the triangle's begins, that it lies so far before the faces that
  // meet in the other, on a mean of the two. Vertices lie off the planes of their faces by far less than the part of the size
  // here.
  struct EdgeBar {
    float needed[3];
    float min_before[3];
  };
  EdgeBar edge_bar() const {
    EdgeBar bar;
    const float rounding = 20.0f * t_.slack + 0.2f * kAxisBias * convex_.size();
    for (int i = 0; i < 3; ++i) {
      bar.needed[i] = needed_of(i);
      bar.min_before[i] = min(bar.needed[i] + convex_.radius(), 0.0f) - rounding;
    }
    return bar;
  }

  bool edge_allows(int edge, Vec3 d) const {
    if (!is_active(edge)) return false;
    const float outward = dot(d, t_.outward[edge]);
    if (outward < -kArcSlack && outward < -arc_slack()) return false;
    const float front = dot(d, t_.normal);
    // The border of a surface that is solid from both sides is the rim of a plate.
    if (t_.edge[edge] == EdgeKind::open) return surface_.double_sided() || front >= -kArcSlack;
    const Vec3 other = t_.neighbor_normal[edge];
    return dot(d, cross(other, t_.along[edge])) >= -kArcSlack &&
           (front >= -kArcSlack || dot(d, other) >= -kArcSlack);
  }

  bool corner_allows(int corner, Vec3 d) const {
    if ((t_.flat_corners >> corner & 1) != 0) return false;
    if (!surface_.double_sided() && dot(d, t_.normal) < -kArcSlack) return false;
    const int own = t_.turned && corner != 0 ? 3 - corner : corner;
    return surface_.in_normal_cone(t_.id, own, d, kArcSlack);
  }

  bool allows(unsigned corners, Vec3 d) const {
    switch (corners) {
      case 1:
        return corner_allows(0, d);
      case 2:
        return corner_allows(1, d);
      case 4:
        return corner_allows(2, d);
      case 3:
        return edge_allows(0, d);
      case 6:
        return edge_allows(1, d);
      case 5:
        return edge_allows(2, d);
      default:
        return false;
    }
  }

  // The corners that are highest along `d`: one, the two of an edge, or all three.
  unsigned supporting_corners(Vec3 d) const {
    float height[3];
    for (int i = 0; i < 3; ++i) height[i] = dot(d, t_.v[i]);
    int top = 0;
    for (int i = 1; i < 3; ++i) {
      if (height[i] > height[top]) top = i;
    }
    const int after = next_corner(top), before = next_corner(after);
    unsigned corners = 1u << top;
    if (height[top] - height[after] <= kLevelSlack * t_.length[top]) corners |= 1u << after;
    if (height[top] - height[before] <= kLevelSlack * t_.length[before]) corners |= 1u << before;
    return corners;
  }

  // Of a sliver seen from beside, which is no more than an edge: the edge that looks along `d`; of two the one nearer to
  // `p`.
  unsigned supporting_edge(Vec3 d, Vec3 p) const {
    unsigned corners = 7;
    float least = __builtin_huge_valf();
    for (int i = 0; i < 3; ++i) {
      if (!(dot(d, t_.outward[i]) > 0.0f)) continue;
      const Vec3 way = p - t_.v[i];
      const float squared =
          length_squared(way - clamp(dot(way, t_.along[i]), 0.0f, t_.length[i]) * t_.along[i]);
      if (squared < least) least = squared, corners = 1u << i | 1u << next_corner(i);
    }
    return corners;
  }

  // An allowed direction must be better than this to matter.
  float useful() const { return max(found_.feature.separation, found_.best - kAxisBias * convex_.size()); }

  // Returns whether the direction is the best allowed one so far.
  bool offer(Vec3 d, float separation, unsigned corners, AxisSource source) {
    core_best_ = max(core_best_, separation + convex_.radius());
    if (is_backwards(d)) {
      // As a separating direction it still counts.
      if (separation > 0.0f) found_.best = max(found_.best, separation);
      return false;
    }
    found_.best = max(found_.best, separation);
    // Nearest points beside the face are exact, however little their direction leans.
    if (is_face(d) && source != AxisSource::nearest_pair) return false;
    if (!(separation > useful()) || !allows(corners, d)) return false;
    found_.feature.separation = separation;
    found_.feature.direction = d;
    found_.feature.corners = corners;
    found_.feature.source = source;
    return true;
  }

  void polyhedron();
  void face_axes();
  void edge_axes();
  bool axes_across(const HullEdge& edge, unsigned rest, const EdgeBar& bar);
  void edge_axis(const HullEdge& edge, int i);
  void segment_axes();
  bool is_pierced() const;
  bool is_overlap() const;
  void nearest_of_sphere();
  void nearest_pair();
  void nearest_of_vertices(double& best, SimplexPoint& on_triangle, DVec3& on_convex) const;
  bool nearest_by_gjk();
  void deepest_way_out(const CorePair& pair, const CoreDistance& found);

  const Surface& surface_;
  const LocalTriangle& t_;
  const LocalConvex& convex_;
  float max_separation_;
  AxisScratch& scratch_;
  float core_best_;  // the largest separation of core and triangle along any direction, also backwards
  AxisSearch found_;
};

void DirectionSearch::face_axes() {
  for (int first = 0; first < convex_.face_count(); first += LocalConvex::kLanes) {
    const Floats separations =
        Floats::load_unaligned(scratch_.before_face + first) - Floats(convex_.radius());
    // Behind the last face its copies stand: they are no better than it is.
    for (unsigned rest = to_bits(separations > Floats(useful())); rest != 0; rest &= rest - 1) {
      const int i = first + std::countr_zero(rest);
      const float separation = scratch_.before_face[i] - convex_.radius();
      if (separation <= useful()) continue;
      const Vec3 d = -convex_.face_normal(i);
      offer(d, separation, supporting_corners(d), AxisSource::shape_face);
      if (apart()) return;
    }
  }
}

// An edge of the triangle and one of the polyhedron make a face of their Minkowski difference where their arcs on the
// sphere of normals cross: the triangle's runs from its normal through `outward` to the other side. The direction there
// is a sum of the two faces' normals, and what it is worth, all but for rounding, the same sum of what the normals are
// worth, which serve all edges of their faces. So most pairs are known to be in vain by their faces' marks.
void DirectionSearch::edge_axes() {
  float outward[3][LocalConvex::kMaxVertices];
  std::int32_t marks[LocalConvex::kMaxVertices];
  EdgeBar bar = edge_bar();
  convex_.dot_faces(t_.along, scratch_.along);
  convex_.dot_faces(t_.outward, outward);
  for (int f = 0; f < convex_.face_count(); f += LocalConvex::kLanes) {
    WideInt<4> mark(0);
    for (int i = 0; i < 3; ++i) {
      const Mask<4> backwards = Floats::load_unaligned(scratch_.along[i] + f) < Floats(0.0f);
      const Mask<4> beyond = Floats::load_unaligned(outward[i] + f) < Floats(kOutwardSlack);
      const Mask<4> hopeless = Floats::load_unaligned(scratch_.before[i] + f) < Floats(bar.min_before[i]);
      mark = mark | (to_int(backwards) & 1 << i) | (to_int(beyond) & 8 << i) | (to_int(~hopeless) & 64 << i);
    }
    mark.store_unaligned(marks + f);
  }
  for (const HullEdge& edge : convex_.edges()) {
    const std::int32_t left = marks[edge.left], right = marks[edge.right], either = left | right;
    const unsigned rest = unsigned((left ^ right) & either >> 3 & either >> 6 & 7);
    if (rest == 0 || !axes_across(edge, rest, bar)) continue;
    if (apart()) return;
    bar = edge_bar();
  }
}

// The edges of the triangle in `rest` across one of the polyhedron. Returns whether any was worth a look.
bool DirectionSearch::axes_across(const HullEdge& edge, unsigned rest, const EdgeBar& bar) {
  bool looked = false;
  for (; rest != 0; rest &= rest - 1) {
    const int i = std::countr_zero(rest);
    const float left = scratch_.along[i][edge.left], right = scratch_.along[i][edge.right];
    const float left_part = absolute(left), right_part = absolute(right), longest = left_part + right_part;
    const float before =
        right_part * scratch_.before[i][edge.left] + left_part * scratch_.before[i][edge.right];
    if (!(left * right < 0.0f) || before < bar.min_before[i] * longest) continue;
    const Vec3 crossing =
        right_part * convex_.face_normal(edge.left) + left_part * convex_.face_normal(edge.right);
    if (!(dot(crossing, t_.outward[i]) < 0.0f)) continue;
    // `crossing` is at most as long as the two parts together: most overlapping pairs are known to be no better without
    // a root.
    const float scaled = dot(crossing, t_.v[i] - convex_.vertex(edge.from));
    if (scaled < 0.0f && scaled - convex_.radius() * longest < bar.needed[i] * longest) continue;
    edge_axis(edge, i);
    looked = true;
  }
  return looked;
}

void DirectionSearch::edge_axis(const HullEdge& edge, int i) {
  const float needed = needed_of(i);
  // Not from the faces' normals, which all but cancel each other at the rim of a plate.
  const Vec3 edge_along = convex_.vertex(edge.to) - convex_.vertex(edge.from);
  Vec3 d = cross(edge_along, t_.along[i]);
  const float size = length(d);
  // Edges that are all but parallel: the nearest faces' axes serve.
  if (!(size > kParallelEdges * length(edge_along))) return;
  d = d / (dot(d, t_.outward[i]) < 0.0f ? -size : size);
  const float separation = dot(d, convex_.vertex(edge.from) - t_.v[i]) - convex_.radius();
  if (separation <= needed) return;
  // At the rim of a plate normals all but oppose each other, so that whether arcs cross is of rounding.
  if (dot(convex_.face_normal(edge.left), convex_.face_normal(edge.right)) < kRim &&
      convex_.lowest(d) < dot(d, convex_.vertex(edge.from)) - kRimSlack * convex_.size())
    return;
  if (offer(d, separation, 1u << i | 1u << next_corner(i), AxisSource::shape_edge)) {
    found_.feature.from = edge.from;
    found_.feature.to = edge.to;
  }
}

// The one edge of a capsule has normals all around it.
void DirectionSearch::segment_axes() {
  const Vec3 axis = convex_.vertex(1) - convex_.vertex(0);
  const float length_of_axis = length(axis);
  for (int i = 0; i < 3; ++i) {
    Vec3 d = cross(axis, t_.along[i]);
    const float size = length(d);
    if (!(size > 1.0e-4f * length_of_axis) || size == 0.0f) continue;
    d = d / size;
    if (dot(d, t_.outward[i]) < 0.0f) d = -d;
    const float separation = dot(d, convex_.vertex(0) - t_.v[i]) - convex_.radius();
    if (offer(d, separation, 1u << i | 1u << next_corner(i), AxisSource::shape_edge)) {
      found_.feature.from = 0;
      found_.feature.to = 1;
    }
  }
}

void DirectionSearch::nearest_of_vertices(double& best, SimplexPoint& on_triangle, DVec3& on_convex) const {
  const DVec3 a(t_.v[0]), b(t_.v[1]), c(t_.v[2]);
  for (int i = 0; i < convex_.vertex_count(); ++i) {
    const DVec3 p(convex_.vertex(i));
    const SimplexPoint found = closest_on_triangle(p, a, b, c);
    const double distance = length_squared(p - found.point);
    if (distance >= best) continue;
    best = distance;
    on_triangle = found;
    on_convex = p;
  }
}

void DirectionSearch::nearest_of_sphere() {
  const DVec3 middle(convex_.vertex(0));
  const SphereTriangle found =
      sphere_triangle(middle, double(convex_.radius()), DVec3(t_.v[0]), DVec3(t_.v[1]), DVec3(t_.v[2]));
  if (!(found.distance > 1.0e-6 * double(convex_.size()))) return;
  if (offer(to_float(found.normal), float(found.distance) - convex_.radius(), found.corners,
            AxisSource::nearest_pair)) {
    found_.feature.on_core = to_float(middle);
  }
}

// Whether the segment runs through the triangle. (All cross products of a sliver's edges may lie too near to each other for
// an axis search to tell.)
bool DirectionSearch::is_pierced() const {
  const DVec3 a(t_.v[0]), b(t_.v[1]), c(t_.v[2]), from(convex_.vertex(0)), to(convex_.vertex(1));
  const DVec3 front = cross(b - a, c - a);
  const double start = dot(front, from - a), end = dot(front, to - a);
  if ((start > 0.0 && end > 0.0) || (start < 0.0 && end < 0.0)) return false;
  // On which side of each edge the segment's line passes, seen along it.
  const DVec3 way = to - from;
  const double ab = dot(cross(b - a, way), from - a), bc = dot(cross(c - b, way), from - b),
               ca = dot(cross(a - c, way), from - c);
  return (ab >= 0.0 && bc >= 0.0 && ca >= 0.0) || (ab <= 0.0 && bc <= 0.0 && ca <= 0.0);
}

// Whether no direction that was looked at, the one from behind the triangle among them, parts it from the core.
bool DirectionSearch::is_overlap() const {
  const float behind = dot(t_.normal, t_.v[0]) - convex_.highest(t_.normal);
  return !(max(core_best_, behind) > 1.0e-6f * convex_.size());
}

// A segment that does not cross the triangle: the true direction is that between the nearest points.
void DirectionSearch::nearest_pair() {
  double best = __builtin_huge_val();
  SimplexPoint on_triangle;
  DVec3 on_convex;
  nearest_of_vertices(best, on_triangle, on_convex);
  const auto try_edge = [&](Vec3 from, Vec3 to) {
    for (int i = 0; i < 3; ++i) {
      const int k = next_corner(i);
      const SegmentPair pair = closest_of_segments(DVec3(t_.v[i]), DVec3(t_.v[k]), DVec3(from), DVec3(to));
      const double distance = length_squared(pair.on_b - pair.on_a);
      // Ends were looked at with the vertices and win ties.
      if (!(distance < best * (1.0 - 1.0e-9)) || pair.s <= 0.0 || pair.s >= 1.0) continue;
      best = distance;
      on_triangle.point = pair.on_a;
      on_triangle.corners = 1u << i | 1u << k;
      on_convex = pair.on_b;
    }
  };
  try_edge(convex_.vertex(0), convex_.vertex(1));
  // Corners of the triangle beside the segment.
  const Vec3 inset{convex_.radius(), convex_.radius(), convex_.radius()};
  const Aabb core{convex_.local_box().low + inset, convex_.local_box().high - inset};
  for (int i = 0; i < 3; ++i) {
    const Vec3 nearest = convex_.from_local(max(core.low, min(convex_.to_local(t_.v[i]), core.high)));
    const double distance = length_squared(DVec3(nearest) - DVec3(t_.v[i]));
    if (!(distance < best * (1.0 - 1.0e-6))) continue;
    best = distance;
    on_triangle.point = DVec3(t_.v[i]);
    on_triangle.corners = 1u << i;
    on_convex = DVec3(nearest);
  }
  const double distance = std::sqrt(best);
  if (!(distance > 1.0e-6 * double(convex_.size()))) return;
  const Vec3 d = to_float((on_convex - on_triangle.point) / distance);
  if (offer(d, float(distance) - convex_.radius(), on_triangle.corners, AxisSource::nearest_pair)) {
    found_.feature.on_core = to_float(on_convex);
  }
}

void DirectionSearch::polyhedron() {
  if (convex_.face_count() > 0) convex_.face_separations(t_.v, scratch_.before, scratch_.before_face);
  face_axes();
  if (apart()) return;
  if (convex_.face_count() > 0) {
    edge_axes();
  } else if (convex_.vertex_count() == 2) {
    segment_axes();
  }
  if (convex_.radius() == 0.0f || apart()) return;
  // The features of overlapping cores have distances too, but those mean nothing.
  if (convex_.vertex_count() == 2 ? is_pierced() : convex_.vertex_count() > 2 && is_overlap()) return;
  if (convex_.vertex_count() == 1) {
    nearest_of_sphere();
  } else if (convex_.vertex_count() == 2) {
    nearest_pair();
  } else {
    nearest_by_gjk();
  }
}

// Out of an overlap with a curved shape, by EPA.
void DirectionSearch::deepest_way_out(const CorePair& pair, const CoreDistance& found) {
  const CorePenetration out = core_penetration(pair, found);
  const Vec3 d = to_float(out.normal);
  unsigned corners = supporting_corners(d);
  if (corners == 7 && length_squared(d - t_.normal) > kBesideFace * kBesideFace)
    corners = supporting_edge(d, to_float(out.on_a));
  if (offer(d, float(-out.depth), corners, AxisSource::nearest_pair)) {
    found_.feature.on_core = to_float(out.on_b);
  }
}

// Whether triangle and core are apart: then GJK knows the direction.
bool DirectionSearch::nearest_by_gjk() {
  Hull& hull = scratch_.triangle;
  hull.vertices.assign(t_.v, t_.v + 3);
  hull.x.resize(Hull::kPad);
  hull.y.resize(Hull::kPad);
  hull.z.resize(Hull::kPad);
  for (int i = 0; i < Hull::kPad; ++i) {
    const Vec3 v = t_.v[min(i, 2)];
    hull.x[std::size_t(i)] = v.x;
    hull.y[std::size_t(i)] = v.y;
    hull.z[std::size_t(i)] = v.z;
  }
  hull.box = bounds(t_);
  Shape flat;
  flat.kind = ShapeKind::hull;
  flat.hull = &hull;
  const CorePair pair(flat, convex_.shape(), {{0, 0, 0}, convex_.orientation()});
  const CoreDistance found = core_distance(pair, double(max_separation_ + convex_.radius()), t_.normal);
  if (found.beyond) {
    found_.best = __builtin_huge_valf();
    return true;
  }
  if (found.overlap || !(found.distance > 1.0e-6 * double(convex_.size()))) {
    if (!convex_.has_vertices()) deepest_way_out(pair, found);
    return false;
  }
  const SimplexPoint near = closest_on_triangle(found.on_b, DVec3(t_.v[0]), DVec3(t_.v[1]), DVec3(t_.v[2]));
  const float separation = float(found.distance) - convex_.radius();
  // Of parallel faces any points are nearest, also such over inner edges.
  if (near.corners == 7 || is_face(to_float(found.normal))) {
    found_.over_face = true;
    found_.on_core = to_float(found.on_b);
  }
  if (offer(to_float(found.normal), separation, near.corners, AxisSource::nearest_pair)) {
    found_.feature.on_core = to_float(found.on_b);
  }
  return true;
}

}  // namespace

Surface::Surface(const Shape& shape) {
  if (shape.kind == ShapeKind::mesh) mesh = shape.mesh;
  if (shape.kind == ShapeKind::height_field) field = shape.field;
}

LocalTriangle local_triangle(const Surface& surface, std::uint32_t id, Vec3 position,
                            const LocalConvex& convex) {
  LocalTriangle t;
  if (surface.mesh != nullptr) {
    view_triangle(*surface.mesh, id, t);
  } else {
    static_cast<TriangleView&>(t) = view_triangle(*surface.field, id);
  }
  if (surface.double_sided() && dot(t.normal, convex.center() + position - t.v[0]) < 0.0f) {
    static_cast<TriangleView&>(t) = back_view(t);
    t.turned = true;
  }
  // The largest coordinate, from both its ends: cheaper than the size of each.
  const Vec3 low = min(min(position, t.v[0]), min(t.v[1], t.v[2])),
             high = max(max(position, t.v[0]), max(t.v[1], t.v[2]));
  const float reach = max(largest(high), -smallest(low));
  for (Vec3& corner : t.v) corner = corner - position;
  t.slack = 1.2e-7f * reach + 1.0e-6f * convex.size();
  return t;
}

void measure_edges(LocalTriangle& t) {
  for (int i = 0; i < 3; ++i) {
    const Vec3 edge = t.v[next_corner(i)] - t.v[i];
    t.length[i] = max(length(edge), 1.0e-30f);
    t.along[i] = edge / t.length[i];
    t.outward[i] = cross(t.along[i], t.normal);
  }
}

AxisSearch search_axes(const Surface& surface, const LocalTriangle& triangle, const LocalConvex& convex,
                       float face_separation, float max_separation, AxisScratch& scratch) {
  return DirectionSearch(surface, triangle, convex, face_separation, max_separation, scratch).run();
}

AxisSearch search_nearest(const Surface& surface, const LocalTriangle& triangle, const LocalConvex& convex,
                          float face_separation, float max_separation, AxisScratch& scratch) {
  return DirectionSearch(surface, triangle, convex, face_separation, max_separation, scratch).run_nearest();
}

}  // namespace gyre
