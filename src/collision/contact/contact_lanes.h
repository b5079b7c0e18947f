// Contacts in lanes: poses and motions of their bodies and shapes. See contact_recycle.h. One template serves every
// width; lane i computes exactly what width 1 would.
#pragma once

#include "collision/broadphase/fat_box.h"
#include "collision/contact/contact_recycle.h"
#include "geometry/manifold/box_search_lanes.h"
#include "geometry/manifold/manifold_layout.h"
#include "math/wide_double.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// ------------------------------------------------------------------------------------------- between records and lanes

template <int W>
struct Placement {
  Vec3W<W> position;
  QuatW<W> orientation;
};
template <int W>
GYRE_INLINE Placement<W> inverse(const Placement<W>& t) {
  return {rotate_inverse(t.orientation, -t.position), conjugate(t.orientation)};
}
template <int W>
GYRE_INLINE Placement<W> select(Mask<W> mask, const Placement<W>& a, const Placement<W>& b) {
  return {select(mask, a.position, b.position), select(mask, a.orientation, b.orientation)};
}

// World positions; each coordinate is two halves of the lanes in double.
template <int W>
struct WidePosition {
  static constexpr int kLast = kHalves<W> - 1;
  using Half = WideDouble<kHalfLanes<W>>;
  Half x[kHalves<W>], y[kHalves<W>], z[kHalves<W>];
};
template <int W>
GYRE_INLINE void load_halves(const CollisionBody* const (&bodies)[W], double DVec3::*axis,
                             typename WidePosition<W>::Half (&out)[kHalves<W>]) {
  if constexpr (W == 1) {
    out[0].v = bodies[0]->position.*axis;
  } else {
    GYRE_UNROLL
    for (int i = 0; i < W; ++i) out[2 * i / W].v[i % (W / 2)] = bodies[i]->position.*axis;
  }
}
template <int W>
GYRE_INLINE void shift_half(typename WidePosition<W>::Half (&position)[kHalves<W>], Wide<W> by) {
  position[0] += half_of<0>(by);
  if constexpr (W > 1) position[1] += half_of<1>(by);
}
template <int W>
GYRE_INLINE WidePosition<W> operator+(WidePosition<W> position, Vec3W<W> by) {
  shift_half<W>(position.x, by.x);
  shift_half<W>(position.y, by.y);
  shift_half<W>(position.z, by.z);
  return position;
}
template <int W>
GYRE_INLINE Vec3W<W> difference(const WidePosition<W>& to, const WidePosition<W>& from) {
  constexpr int kLast = WidePosition<W>::kLast;
  return {join_halves<W>(to.x[0] - from.x[0], to.x[kLast] - from.x[kLast]),
          join_halves<W>(to.y[0] - from.y[0], to.y[kLast] - from.y[kLast]),
          join_halves<W>(to.z[0] - from.z[0], to.z[kLast] - from.z[kLast])};
}

// One of the two bodies of each contact.
template <int W>
struct Side {
  WidePosition<W> origin;
  QuatW<W> orientation;
  Vec3W<W> translation, rotation;
  Vec3W<W> center;                  // of mass, body frame
  Wide<W> bounding_radius, extent;  // m, from the centre of mass; from the origin (a bound)

  GYRE_INLINE WidePosition<W> center_of_mass() const { return origin + rotate(orientation, center); }
};

template <int W>
GYRE_INLINE Side<W> load_side(const CollisionBody* const (&bodies)[W], const Records<W>& centers) {
  static_assert(GYRE_FLOATS_BEFORE(CollisionBody, orientation) == 6 &&
                GYRE_FLOATS_BEFORE(CollisionBody, translation) == 10);
  static_assert(GYRE_FLOATS_BEFORE(CollisionBody, rotation) == 13 &&
                GYRE_FLOATS_BEFORE(BodyCenter, bounding_radius) == 3);
  Records<W> record;
  GYRE_UNROLL
  for (int i = 0; i < W; ++i) record[i] = floats(bodies[i]);
  Wide<W> xy[4], zw[4], rest[4];
  read_four<W>(record, 4, xy);
  read_four<W>(record, 8, zw);
  read_four<W>(record, 12, rest);
  Side<W> side;
  load_halves<W>(bodies, &DVec3::x, side.origin.x);
  load_halves<W>(bodies, &DVec3::y, side.origin.y);
  load_halves<W>(bodies, &DVec3::z, side.origin.z);
  side.orientation = {xy[2], xy[3], zw[0], zw[1]};
  side.translation = {zw[2], zw[3], rest[0]};
  side.rotation = {rest[1], rest[2], rest[3]};
  Wide<W> center[4];
  read_four<W>(centers, 0, center);
  side.center = {center[0], center[1], center[2]};
  side.bounding_radius = center[3];
  side.extent = side.bounding_radius + length(side.center);
  return side;
}

// Offset in a contact of what the last full update cached, in floats.
constexpr int kCachedDistance = GYRE_FLOATS_BEFORE(Contact, cached_distance);

// A group of W contacts; lanes without a contact repeat the last one.
template <int W>
struct Group {
  const PairInput* pairs[W];
  std::int32_t counts[W];  // of manifolds
  Side<W> a, b;
  Wide<W> size, cached_distance;
  Placement<W> seen, now;             // B's body frame in A's at the last full update, and now
  Wide<W> max_approach, speculative;  // as in PairView
  // As in Closing, in world axes.
  Vec3W<W> closing_translation, closing_rotation;
  Wide<W> lever, arc_deviation;
  Wide<W> max_sizes;  // the largest approach that is seen ahead, in sizes
};

template <int W>
GYRE_INLINE void load_group(const PairInput* pairs, int count, Group<W>& group) {
  static_assert(GYRE_FLOATS_BEFORE(Contact, size) == kCachedDistance + 1);
  static_assert(GYRE_FLOATS_BEFORE(Contact, seen_a_from_b) == kCachedDistance + 2);
  static_assert(offsetof(Transform, orientation) == sizeof(Vec3));
  const CollisionBody *bodies_a[W], *bodies_b[W];
  Records<W> record, centers_a, centers_b;
  GYRE_UNROLL
  for (int i = 0; i < W; ++i) {
    const PairInput& pair = pairs[i < count ? i : count - 1];
    group.pairs[i] = &pair;
    bodies_a[i] = pair.body_a;
    bodies_b[i] = pair.body_b;
    centers_a[i] = floats(pair.center_a);
    centers_b[i] = floats(pair.center_b);
    record[i] = floats(pair.contact);
    group.counts[i] = pair.contact->manifold_count;
    const bool bounces = pair.contact->manifold_room == 1 && pair.contact->surface.restitution > 0.0f;
    group.max_sizes.set(i, bounces ? kMaxBounceApproach : kMaxApproach);
  }
  group.a = load_side<W>(bodies_a, centers_a);
  group.b = load_side<W>(bodies_b, centers_b);
  Wide<W> first[4], second[4];
  read_four<W>(record, kCachedDistance, first);
  read_four<W>(record, kCachedDistance + 4, second);
  group.cached_distance = first[0];
  group.size = first[1];
  group.seen = {{first[2], first[3], second[0]},
                {second[1], second[2], second[3], read_one<W>(record, kCachedDistance + 8)}};
}

// ------------------------------------------------------------------------------------------------------------- the view

// m^2: below any squared distance of two bodies that are apart.
constexpr float kMinLength = 1.0e-30f;

// An upper bound of the approach of the two surfaces in the step, from the rotation of each body about its own centre
// of mass. The lever of a body is at most the distance to the far side of the other body.
template <int W>
GYRE_INLINE Wide<W> approach_bound(const Group<W>& group, Wide<W> spin_a, Wide<W> spin_b) {
  const Side<W>& a = group.a;
  const Side<W>& b = group.b;
  const Wide<W> apart =
      length(group.now.position) + (a.extent - a.bounding_radius) + (b.extent - b.bounding_radius);
  const Mask<W> differ = a.bounding_radius != b.bounding_radius;
  const Wide<W> lever_a =
      select(differ, min(a.bounding_radius, apart + b.bounding_radius), a.bounding_radius);
  const Wide<W> lever_b =
      select(differ, min(b.bounding_radius, apart + a.bounding_radius), b.bounding_radius);
  return length(b.translation - a.translation) + spin_a * lever_a + spin_b * lever_b;
}

// The relative motion of the two bodies where they can meet: in the intersection of two balls around their centres of
// mass, each enlarged by half of `gap`. `lever` is the radius of that intersection about its middle. Each point is
// taken to move straight with its present velocity; its arc deviates by at most half the squared angle times its
// distance.
template <int W>
GYRE_INLINE void find_closing(Vec3W<W> b_from_a, Wide<W> gap, Wide<W> spin_a, Wide<W> spin_b,
                              Group<W>& group) {
  const Side<W>& a = group.a;
  const Side<W>& b = group.b;
  const Wide<W> zero(0.0f), one(1.0f), radius_a = a.bounding_radius + 0.5f * gap,
                                       radius_b = b.bounding_radius + 0.5f * gap;
  const Wide<W> squared = length_squared(b_from_a), apart = sqrt(squared);
  // Position between the centres of the plane of the circle in which the two balls intersect, as a share.
  const Wide<W> share = min(
      max((squared + (radius_a - radius_b) * (radius_a + radius_b)) / (2.0f * squared + Wide<W>(kMinLength)),
          zero),
      one);
  const Wide<W> from_a = share * apart, from_b = (one - share) * apart;
  group.lever = min(sqrt(max((radius_a - from_a) * (radius_a + from_a), zero)), min(radius_a, radius_b));
  group.closing_rotation = b.rotation - a.rotation;
  group.closing_translation =
      b.translation - a.translation - cross(share * a.rotation + (one - share) * b.rotation, b_from_a);
  group.arc_deviation =
      0.5f * (square(spin_a) * (from_a + group.lever) + square(spin_b) * (from_b + group.lever));
}

template <int W>
GYRE_INLINE void find_view(Group<W>& group) {
  const Side<W>& a = group.a;
  const Side<W>& b = group.b;
  const Vec3W<W> b_origin_from_a = difference(b.origin, a.origin);
  group.now = {rotate_inverse(a.orientation, b_origin_from_a), conjugate(a.orientation) * b.orientation};
  const Wide<W> spin_a = length(a.rotation), spin_b = length(b.rotation);
  const Vec3W<W> b_from_a =
      b_origin_from_a + rotate(b.orientation, b.center) - rotate(a.orientation, a.center);
  const Wide<W> by_own_rotation = approach_bound<W>(group, spin_a, spin_b);
  const Wide<W> margin = Wide<W>(kSpeculativeShare) * group.size,
                approach_limit = group.max_sizes * group.size;
  find_closing<W>(b_from_a, margin + min(by_own_rotation, approach_limit), spin_a, spin_b, group);
  group.max_approach =
      min(by_own_rotation, length(group.closing_translation) + length(group.closing_rotation) * group.lever +
                               group.arc_deviation);
  group.speculative = margin + min(group.max_approach, approach_limit);
}

// ----------------------------------------------------------------------------------------------------------- the shapes

template <int W>
struct ShapeFrame {
  WidePosition<W> origin;
  QuatW<W> orientation;
};

template <int W>
GYRE_INLINE ShapeFrame<W> find_frame(const Side<W>& side, const Records<W>& shape) {
  constexpr int kFramePosition = GYRE_FLOATS_BEFORE(ColliderShape, body_from_shape);
  Wide<W> p[4], q[4];
  read_four<W>(shape, kFramePosition, p);
  read_four<W>(shape, kFramePosition + 3, q);
  return {side.origin + rotate(side.orientation, Vec3W<W>{p[0], p[1], p[2]}),
          side.orientation * QuatW<W>{q[0], q[1], q[2], q[3]}};
}

template <int W>
GYRE_INLINE WideInt<W> load_kinds(const Records<W>& shape) {
  static_assert(offsetof(ColliderShape, shape) == 0 && offsetof(Shape, kind) == 0 && sizeof(ShapeKind) == 1);
  return bit_pattern(read_one<W>(shape, 0)) & WideInt<W>(0xff);
}

// Moves points `position` of planes with these normals and offsets, in half `Half` of the lanes, to the feet of the
// perpendiculars from `other`.
template <int Half, int W>
GYRE_INLINE void center_half(Vec3W<W> normal, Wide<W> offset, const WidePosition<W>& other,
                             WidePosition<W>& position) {
  const auto x = half_of<Half>(normal.x), y = half_of<Half>(normal.y), z = half_of<Half>(normal.z);
  const auto height = x * (other.x[Half] - position.x[Half]) + y * (other.y[Half] - position.y[Half]) +
                      z * (other.z[Half] - position.z[Half]) - half_of<Half>(offset);
  position.x[Half] = other.x[Half] - height * x;
  position.y[Half] = other.y[Half] - height * y;
  position.z[Half] = other.z[Half] - height * z;
}

// A plane has no middle, so its frame may move to the point nearest to the other shape; floats then stay small and
// exact. Its offset in the new frame is 0.
template <int W>
GYRE_INLINE void center_planes(Mask<W> planes, const Records<W>& shape, const WidePosition<W>& other,
                               ShapeFrame<W>& frame) {
  static_assert(GYRE_FLOATS_BEFORE(Shape, offset) == GYRE_FLOATS_BEFORE(Shape, extents) + 3);
  Wide<W> plane[4];
  read_four<W>(shape, GYRE_FLOATS_BEFORE(Shape, extents), plane);
  const Vec3W<W> normal = rotate(frame.orientation, Vec3W<W>{plane[0], plane[1], plane[2]});
  WidePosition<W> centered = frame.origin;
  center_half<0, W>(normal, plane[3], other, centered);
  if constexpr (W > 1) center_half<1, W>(normal, plane[3], other, centered);
  for (int i = 0; i < W; ++i) {
    if (!planes[i]) continue;
    __builtin_memcpy(reinterpret_cast<double*>(frame.origin.x) + i, reinterpret_cast<double*>(centered.x) + i,
                     8);
    __builtin_memcpy(reinterpret_cast<double*>(frame.origin.y) + i, reinterpret_cast<double*>(centered.y) + i,
                     8);
    __builtin_memcpy(reinterpret_cast<double*>(frame.origin.z) + i, reinterpret_cast<double*>(centered.z) + i,
                     8);
  }
}

// Bits of the lanes whose contacts have no manifold.
template <int W>
GYRE_INLINE unsigned empty_lanes(const Group<W>& group) {
  unsigned empty = 0;
  GYRE_UNROLL
  for (int i = 0; i < W; ++i) empty |= unsigned(group.counts[i] == 0) << i;
  return empty;
}

// The shapes of a group in the frame of their manifolds (PairView).
template <int W>
struct ShapesInView {
  Records<W> records_a, records_b;  // ColliderShape
  ShapeFrame<W> frame;
  Placement<W> a_from_b;
};

template <int W>
GYRE_INLINE void find_shapes(const Group<W>& group, ShapesInView<W>& shapes) {
  Records<W>& shapes_a = shapes.records_a;
  Records<W>& shapes_b = shapes.records_b;
  GYRE_UNROLL
  for (int i = 0; i < W; ++i) {
    shapes_a[i] = floats(group.pairs[i]->shape_a);
    shapes_b[i] = floats(group.pairs[i]->shape_b);
  }
  ShapeFrame<W> a = find_frame<W>(group.a, shapes_a), b = find_frame<W>(group.b, shapes_b);
  const WideInt<W> kinds_a = load_kinds<W>(shapes_a), kinds_b = load_kinds<W>(shapes_b);
  const WideInt<W> plane = std::int32_t(ShapeKind::plane);
  const Mask<W> plane_a = (kinds_a == plane) & (kinds_b < plane);
  const Mask<W> plane_b = (kinds_b == plane) & (kinds_a < plane);
  if (any(plane_a)) center_planes<W>(plane_a, shapes_a, b.origin, a);
  if (any(plane_b)) center_planes<W>(plane_b, shapes_b, a.origin, b);
  shapes.frame = a;
  shapes.a_from_b = {rotate_inverse(a.orientation, difference(b.origin, a.origin)),
                     conjugate(a.orientation) * b.orientation};
}

template <int W>
GYRE_INLINE void write_views(const Group<W>& group, const ShapesInView<W>& shapes, const AxisLanes<W>& axis,
                             int count, PairView* views) {
  static_assert(GYRE_FLOATS_BEFORE(PairView, size) == 7 &&
                GYRE_FLOATS_BEFORE(PairView, shapes_a_from_b) == 10);
  static_assert(GYRE_FLOATS_BEFORE(PairView, frame_orientation) == 17 &&
                GYRE_FLOATS_BEFORE(PairView, frame_from_a) == 21);
  static_assert(GYRE_FLOATS_BEFORE(PairView, frame_from_b) == 24 &&
                GYRE_FLOATS_BEFORE(PairView, closing) == 27);
  static_assert(GYRE_FLOATS_BEFORE(Closing, rotation) == 4 && GYRE_FLOATS_BEFORE(PairView, axis) == 35);
  static_assert(offsetof(boxes::Axis, number) == 0 && offsetof(boxes::Axis, separation) == 4);
  Targets<W> to;
  GYRE_UNROLL
  for (int i = 0; i < W; ++i) to[i] = floats(views + (i < count ? i : count - 1));
  const Vec3W<W> p = group.now.position, shape_p = shapes.a_from_b.position;
  const QuatW<W> q = group.now.orientation, shape_q = shapes.a_from_b.orientation;
  const QuatW<W> frame_orientation = shapes.frame.orientation;
  const Vec3W<W> from_a = difference(shapes.frame.origin, group.a.center_of_mass());
  const Vec3W<W> from_b = difference(shapes.frame.origin, group.b.center_of_mass());
  const Vec3W<W> closing_translation = rotate_inverse(frame_orientation, group.closing_translation),
                 closing_rotation = rotate_inverse(frame_orientation, group.closing_rotation);
  write_four<4, W>(to, 0, {p.x, p.y, p.z, q.x});
  write_four<4, W>(to, 4, {q.y, q.z, q.w, group.size});
  write_four<4, W>(to, 8, {group.max_approach, group.speculative, shape_p.x, shape_p.y});
  write_four<4, W>(to, 12, {shape_p.z, shape_q.x, shape_q.y, shape_q.z});
  write_four<4, W>(to, 16, {shape_q.w, frame_orientation.x, frame_orientation.y, frame_orientation.z});
  write_four<4, W>(to, 20, {frame_orientation.w, from_a.x, from_a.y, from_a.z});
  write_four<4, W>(to, 24, {from_b.x, from_b.y, from_b.z, closing_translation.x});
  write_four<4, W>(to, 28, {closing_translation.y, closing_translation.z, group.lever, closing_rotation.x});
  write_four<3, W>(to, 32, {closing_rotation.y, closing_rotation.z, group.arc_deviation, Wide<W>(0.0f)});
  // Lanes that repeat the last contact know no axis.
  for (int i = 0; i < count; ++i) {
    to[i][35] = __builtin_bit_cast(float, axis.number[i]);
    to[i][36] = axis.separation[i];
  }
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
