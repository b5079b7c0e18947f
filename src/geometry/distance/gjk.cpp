// GJK in double. See gjk.h.
#include "geometry/distance/gjk.h"

#include "geometry/distance/closest.h"
#include "geometry/shape/hull.h"
#include "math/rotation.h"
#include "math/wide.h"

namespace gyre {
namespace {

constexpr int kMaxIterations = 64;
// Relative gap of the squared distance at which the search ends: the direction is then within about 4e-5 rad on curved
// shapes far apart, better on near ones, and exact on polyhedra.
constexpr double kGap = 1.0e-9;
// Cores nearer than this part of their size touch.
constexpr double kTouch = 1.0e-10;

double core_size(const Shape& shape) {
  switch (shape.kind) {
    case ShapeKind::box:
      return double(largest(shape.extents));
    case ShapeKind::capsule:
      return double(shape.extents.y);
    case ShapeKind::cylinder:
    case ShapeKind::cone:
      return double(max(shape.radius, shape.extents.y));
    case ShapeKind::hull:
      return double(max(largest(absolute(shape.hull->box.low)), largest(absolute(shape.hull->box.high))));
    default:
      return 0.0;
  }
}

DVec3 farthest_corner(const DVec3* triangle, DVec3 direction) {
  const double a = dot(triangle[0], direction), b = dot(triangle[1], direction),
               c = dot(triangle[2], direction);
  if (a >= b && a >= c) return triangle[0];
  return b >= c ? triangle[1] : triangle[2];
}

bool same(DVec3 a, DVec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

// The simplex nearest to the origin that `near` uses, compacted.
void keep_corners(DifferencePoint* simplex, int& count, SimplexPoint& near) {
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    if (!(near.corners & (1u << i))) continue;
    if (kept != i) {
      simplex[kept] = simplex[i];
      near.weights[kept] = near.weights[i];
    }
    ++kept;
  }
  count = kept;
}

SimplexPoint nearest_to_origin(const DifferencePoint* s, int count, bool outside) {
  const DVec3 origin;
  switch (count) {
    case 1: {
      SimplexPoint out;
      out.point = s[0].way;
      out.weights[0] = 1.0;
      out.corners = 1;
      return out;
    }
    case 2: {
      const SegmentPoint near = closest_on_segment(origin, s[0].way, s[1].way);
      SimplexPoint out;
      out.point = near.point;
      out.weights[0] = 1.0 - near.t;
      out.weights[1] = near.t;
      out.corners = near.t <= 0.0 ? 1u : near.t >= 1.0 ? 2u : 3u;
      return out;
    }
    case 3:
      return closest_on_triangle(origin, s[0].way, s[1].way, s[2].way);
    default:
      if (outside) return closest_on_tetrahedron_surface(origin, s[0].way, s[1].way, s[2].way, s[3].way);
      return closest_on_tetrahedron(origin, s[0].way, s[1].way, s[2].way, s[3].way);
  }
}

// In place of a call: it is asked twice in every round.
GYRE_INLINE DVec3 support_of(const Shape& shape, DVec3 d) {
  const double h = double(shape.extents.y);
  switch (shape.kind) {
    case ShapeKind::box: {
      const DVec3 e{shape.extents};
      return {d.x < 0.0 ? -e.x : e.x, d.y < 0.0 ? -e.y : e.y, d.z < 0.0 ? -e.z : e.z};
    }
    case ShapeKind::capsule:
      return {0.0, d.y < 0.0 ? -h : h, 0.0};
    case ShapeKind::cylinder:
    case ShapeKind::cone: {
      const double radius = double(shape.radius);
      const double radial = std::sqrt(d.x * d.x + d.z * d.z);
      const double s = radial > 1.0e-150 ? radius / radial : 0.0;
      const DVec3 rim{radial > 1.0e-150 ? s * d.x : radius, -h, s * d.z};
      if (shape.kind == ShapeKind::cylinder) return {rim.x, d.y < 0.0 ? -h : h, rim.z};
      return 2.0 * h * d.y > radius * radial ? DVec3{0.0, h, 0.0} : rim;
    }
    case ShapeKind::hull:
      return DVec3(shape.hull->vertices[std::size_t(support_vertex(*shape.hull, to_float(d)))]);
    default:
      return {};
  }
}

double largest_part(DVec3 v) { return max(absolute(v.x), max(absolute(v.y), absolute(v.z))); }

}  // namespace

DVec3 core_support(const Shape& shape, DVec3 d) { return support_of(shape, d); }

// In double, from a quaternion brought to length 1: B stays the rigid body that the float quaternion means.
CorePair::CorePair(const Shape& a, const Shape& b, const Transform& a_from_b)
    : CorePair(a, b, DVec3(a_from_b.position), normalized(to_double(a_from_b.orientation))) {}

CorePair::CorePair(const Shape& a, const Shape& b, DVec3 position, DQuat orientation)
    : a_(&a), b_(&b), core_size_(max(core_size(a), core_size(b))) {
  set_orientation(orientation);
  move_b(position);
}

CorePair::CorePair(const DVec3 (&triangle)[3], const Shape& b, DVec3 position, DQuat orientation)
    : triangle_(triangle), b_(&b), core_size_(core_size(b)) {
  for (const DVec3& corner : triangle) core_size_ = max(core_size_, largest_part(corner));
  set_orientation(orientation);
  move_b(position);
}

void CorePair::set_orientation(DQuat orientation) {
  x_ = rotate(orientation, DVec3{1, 0, 0});
  y_ = rotate(orientation, DVec3{0, 1, 0});
  z_ = rotate(orientation, DVec3{0, 0, 1});
}

void CorePair::move_b(DVec3 position) {
  position_ = position;
  size_ = max(core_size_, largest_part(position));
}

DVec3 CorePair::to_b(DVec3 d) const { return {dot(x_, d), dot(y_, d), dot(z_, d)}; }
DVec3 CorePair::from_b(DVec3 d) const { return d.x * x_ + d.y * y_ + d.z * z_; }

DifferencePoint CorePair::support(DVec3 direction) const {
  DifferencePoint out;
  out.on_a = a_ != nullptr ? support_of(*a_, -direction) : farthest_corner(triangle_, -direction);
  out.on_b = from_b(support_of(*b_, to_b(direction))) + position_;
  out.way = out.on_b - out.on_a;
  return out;
}

namespace {

// A core over a face of a box, in the box's frame.
struct OverFace {
  DVec3 normal;  // of the face above which the core's middle lies highest
  DVec3 lowest;  // the core's lowest point above it,
  DVec3 foot;    // and what is below that in the face's plane
  double height = 0.0;
  bool is_within = false;  // the foot is in the face
};

// `farthest(direction)`: of the core. False if its middle is above no face.
template <class Farthest>
bool look_over_face(DVec3 half, DVec3 middle, const Farthest& farthest, OverFace& over) {
  const double x = absolute(middle.x) - half.x, y = absolute(middle.y) - half.y,
               z = absolute(middle.z) - half.z;
  if (!(max(x, max(y, z)) > 0.0)) return false;
  const bool is_x = x >= y && x >= z, is_y = !is_x && y >= z, is_z = !is_x && !is_y;
  const auto side = [](double at) { return at < 0.0 ? -1.0 : 1.0; };
  over.normal = {is_x ? side(middle.x) : 0.0, is_y ? side(middle.y) : 0.0, is_z ? side(middle.z) : 0.0};
  const DVec3 p = over.lowest = farthest(-over.normal);
  over.foot = {is_x ? over.normal.x * half.x : p.x, is_y ? over.normal.y * half.y : p.y,
               is_z ? over.normal.z * half.z : p.z};
  over.height = dot(over.normal, p - over.foot);
  over.is_within = (is_x || absolute(p.x) <= half.x) && (is_y || absolute(p.y) <= half.y) &&
                   (is_z || absolute(p.z) <= half.z);
  return true;
}

// Of a hull, what is farthest is found in float.
bool has_exact_support(const Shape& shape) { return shape.kind != ShapeKind::hull; }

}  // namespace

bool CorePair::find_over_face(double max_distance, CoreDistance& out) const {
  const double least = kTouch * size_;
  const auto tells = [&](const OverFace& over) {
    out.beyond = over.height > max_distance;
    out.distance = over.height;
    return out.beyond || (over.is_within && over.height > least);
  };
  if (a_ == nullptr) return false;
  OverFace over;
  if (b_->kind == ShapeKind::box && has_exact_support(*a_)) {
    const auto farthest = [&](DVec3 d) { return to_b(support_of(*a_, from_b(d)) - position_); };
    if (look_over_face(DVec3(b_->extents), to_b(-position_), farthest, over) && tells(over)) {
      out.normal = DVec3{} - from_b(over.normal);  // no -0
      out.on_a = from_b(over.lowest) + position_;
      out.on_b = from_b(over.foot) + position_;
      return true;
    }
  }
  if (a_->kind == ShapeKind::box && has_exact_support(*b_)) {
    const auto farthest = [&](DVec3 d) { return from_b(support_of(*b_, to_b(d))) + position_; };
    if (look_over_face(DVec3(a_->extents), position_, farthest, over) && tells(over)) {
      out.normal = over.normal;
      out.on_a = over.foot;
      out.on_b = over.lowest;
      return true;
    }
  }
  out.beyond = false;
  out.distance = 0.0;
  return false;
}

double CorePair::separation(DVec3 direction) const { return dot(support(-direction).way, direction); }

CoreDistance core_distance(const CorePair& pair, double max_distance, Vec3 guess) {
  CoreDistance out;
  if (pair.find_over_face(max_distance, out)) return out;
  DVec3 n{guess};
  if (!(length_squared(n) > 0.0)) n = pair.center_of_b();
  double n_length = length(n);
  n = n_length > 0.0 ? n / n_length : DVec3{0, 1, 0};

  // Of the directions looked at, the one along which the cores are farthest apart: their distance is not less. A sliver
  // of a simplex may name another that does not part them at all.
  DVec3 best = n;
  double best_bound = -1.0e300, bound = 0.0;
  DifferencePoint* simplex = out.simplex;
  SimplexPoint near;  // of the simplex to the origin
  double squared = 0.0;
  int count = 0;
  const double touch = kTouch * pair.size();
  for (out.iterations = 1; out.iterations <= kMaxIterations; ++out.iterations) {
    const DifferencePoint w = pair.support(-n);
    bound = dot(w.way, n);
    if (bound > best_bound) {
      best_bound = bound;
      best = n;
    }
    if (bound > max_distance) {
      out.beyond = true;
      out.distance = bound;
      break;
    }
    if (count > 0) {
      const double reached = std::sqrt(squared);
      if (reached - bound <= kGap * reached) break;
      bool known = false;
      for (int i = 0; i < count; ++i) known = known || same(simplex[i].way, w.way);
      if (known) break;
    }
    // Behind the simplex: what is not taken is not counted.
    simplex[count] = w;
    // Where some direction parts them no simplex holds the origin, whatever rounding makes of it.
    SimplexPoint next_near = nearest_to_origin(simplex, count + 1, best_bound > touch);
    const double next_squared = length_squared(next_near.point);
    // Rounding has the last word: what does not come nearer is as near as it gets.
    if (count > 0 && next_near.corners != 15 && next_squared >= squared) break;
    ++count;
    keep_corners(simplex, count, next_near);
    near = next_near;
    squared = next_squared;
    if (count == 4 || squared <= touch * touch) {
      out.overlap = true;
      break;
    }
    n = near.point / std::sqrt(squared);
  }
  out.simplex_count = count;
  out.normal = n;
  if (!out.beyond && !out.overlap) {
    out.distance = std::sqrt(squared);
    if (best_bound - bound > kGap * out.distance) out.normal = best;
  }
  for (int i = 0; i < count; ++i) {
    out.on_a += near.weights[i] * simplex[i].on_a;
    out.on_b += near.weights[i] * simplex[i].on_b;
  }
  return out;
}

}  // namespace gyre
