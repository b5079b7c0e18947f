// Contacts in lanes: how they stand, whether their anchors still hold, and their points moved. See contact_recycle.h.
#include "collision/contact_recycle.h"

#include "collision/fat_box.h"
#include "geometry/support.h"
#include "math/wide_double.h"
#include "math/wide_vec.h"

#include <cstddef>

namespace gyre {
namespace {

// How far points may go against each other, and how far the pair may tilt (rad), before it is looked at anew: where flat
// features meet, or a core swept by a ball and a flat feature; and where something else is round. There the contact goes on
// while the bodies' points do not, and what lags behind would brake what rolls.
constexpr float kFlatSlide = 3.0e-3f, kFlatTilt = 3.0e-3f;
constexpr float kCurvedSlide = 1.0e-4f, kCurvedTilt = 1.0e-4f;
// Where a float's rounding of the distance between the bodies is more than this, a recycled separation would rattle.
constexpr float kRattle = 1.0e-4f;

constexpr int W = kLookWidth;
using Number = Wide<W>;
using Vector = Vec3W<W>;
using Turn = QuatW<W>;
using Lane = Mask<W>;
using Half = WideDouble<W / 2>;

// ------------------------------------------------------------------------------------------- between records and lanes

// Where in a record a member lies, in floats.
#define GYRE_FLOATS_BEFORE(Record, member) int(offsetof(Record, member) / sizeof(float))

constexpr int kPointFloats = sizeof(ContactPointState) / sizeof(float);
constexpr int kManifoldFloats = sizeof(Manifold) / sizeof(float);
constexpr int kPoints = GYRE_FLOATS_BEFORE(Manifold, points);
constexpr int kAnchors = GYRE_FLOATS_BEFORE(Manifold, anchors);
// Records are read and written four floats at a time; these are the fours.
constexpr int kAge = GYRE_FLOATS_BEFORE(Manifold, age);              // and friction_impulse
constexpr int kTwist = GYRE_FLOATS_BEFORE(Manifold, twist_impulse);  // and rolling_impulse
constexpr int kTriangle = GYRE_FLOATS_BEFORE(Manifold, triangle);    // and total_friction
constexpr int kSliding = GYRE_FLOATS_BEFORE(Manifold, sliding);      // and seen_normal
static_assert(GYRE_FLOATS_BEFORE(Manifold, normal) == 0 && GYRE_FLOATS_BEFORE(Manifold, count) == 3);
static_assert(GYRE_FLOATS_BEFORE(Manifold, friction_impulse) == kAge + 1);
static_assert(GYRE_FLOATS_BEFORE(Manifold, rolling_impulse) == kTwist + 1);
static_assert(GYRE_FLOATS_BEFORE(Manifold, total_friction) == kTriangle + 1);
static_assert(GYRE_FLOATS_BEFORE(Manifold, seen_normal) == kSliding + 1);
static_assert(GYRE_FLOATS_BEFORE(ContactPointState, separation) == 3);
static_assert(GYRE_FLOATS_BEFORE(ContactPointState, from_b) == 4);
static_assert(GYRE_FLOATS_BEFORE(ContactPointState, normal_impulse) == 8);
static_assert(GYRE_FLOATS_BEFORE(ContactPointState, total_impulse) == 9);
static_assert(GYRE_FLOATS_BEFORE(ContactPointState, approach_speed) == 11);
static_assert(GYRE_FLOATS_BEFORE(PointAnchor, separation) == 3 && sizeof(PointAnchor) == 16);

using Records = const float* [W];
using Targets = float* [W];

template <class Record>
GYRE_INLINE const float* floats(const Record& record) {
  return reinterpret_cast<const float*>(&record);
}

GYRE_INLINE Number in_lanes(float v0, float v1, float v2, float v3) {
  return Number::of(Number::Float{v0, v1, v2, v3});
}

struct Placement {
  Vector position;
  Turn orientation;
};
GYRE_INLINE Placement inverse(const Placement& t) {
  return {rotate_inverse(t.orientation, -t.position), conjugate(t.orientation)};
}
GYRE_INLINE Placement select(Lane mask, const Placement& a, const Placement& b) {
  return {select(mask, a.position, b.position), select(mask, a.orientation, b.orientation)};
}

// Places in the world, each coordinate as two halves of the lanes.
struct Places {
  Half x[2], y[2], z[2];
};
GYRE_INLINE Places operator+(const Places& place, Vector v) {
  return {{place.x[0] + half_of<0>(v.x), place.x[1] + half_of<1>(v.x)},
          {place.y[0] + half_of<0>(v.y), place.y[1] + half_of<1>(v.y)},
          {place.z[0] + half_of<0>(v.z), place.z[1] + half_of<1>(v.z)}};
}
GYRE_INLINE Vector difference(const Places& to, const Places& from) {
  return {join_halves<W>(to.x[0] - from.x[0], to.x[1] - from.x[1]),
          join_halves<W>(to.y[0] - from.y[0], to.y[1] - from.y[1]),
          join_halves<W>(to.z[0] - from.z[0], to.z[1] - from.z[1])};
}

// One of the two bodies of each contact.
struct Side {
  Places origin;
  Turn orientation;
  Vector way;
  Number spin, reach, extent;
  Vector center;
};

GYRE_INLINE Side load_side(const CollideInput& input, const std::uint32_t (&bodies)[W]) {
  static_assert(GYRE_FLOATS_BEFORE(BodyLook, orientation) == 6 && GYRE_FLOATS_BEFORE(BodyLook, way) == 10);
  static_assert(GYRE_FLOATS_BEFORE(BodyLook, spin) == 13 && GYRE_FLOATS_BEFORE(BodyLook, extent) == 15);
  const BodyLook* const look[W] = {&input.looks[bodies[0]], &input.looks[bodies[1]], &input.looks[bodies[2]],
                                   &input.looks[bodies[3]]};
  const Vec3 center[W] = {input.centers[bodies[0]], input.centers[bodies[1]], input.centers[bodies[2]],
                          input.centers[bodies[3]]};
  const Records record = {floats(*look[0]), floats(*look[1]), floats(*look[2]), floats(*look[3])};
  Number column[12];
  Rows<W>::gather(record, 4, column);
  Rows<W>::gather(record, 8, column + 4);
  Rows<W>::gather(record, 12, column + 8);
  const auto halves = [&](double DVec3::*axis, Half(&out)[2]) {
    out[0] = Half::of(Half::Double{look[0]->position.*axis, look[1]->position.*axis});
    out[1] = Half::of(Half::Double{look[2]->position.*axis, look[3]->position.*axis});
  };
  Side side;
  halves(&DVec3::x, side.origin.x);
  halves(&DVec3::y, side.origin.y);
  halves(&DVec3::z, side.origin.z);
  side.orientation = {column[2], column[3], column[4], column[5]};
  side.way = {column[6], column[7], column[8]};
  side.spin = column[9];
  side.reach = column[10];
  side.extent = column[11];
  side.center = {in_lanes(center[0].x, center[1].x, center[2].x, center[3].x),
                 in_lanes(center[0].y, center[1].y, center[2].y, center[3].y),
                 in_lanes(center[0].z, center[1].z, center[2].z, center[3].z)};
  return side;
}

// The contacts of a group; lanes without one repeat the first.
struct Group {
  Contact* contacts[W];
  unsigned lanes;  // bits: those with a contact
  Side a, b;
  Number size, looked;
  Placement seen, now;      // B's body frame in A's: at the last full look, and now
  Number way, speculative;  // as in View
};

GYRE_INLINE void load_group(ContactStore& store, std::span<const std::uint32_t> slots,
                            const CollideInput& input, Group& group) {
  static_assert(GYRE_FLOATS_BEFORE(Contact, seen_a_from_b) == GYRE_FLOATS_BEFORE(Contact, size) + 1);
  static_assert(offsetof(Transform, orientation) == sizeof(Vec3));
  std::uint32_t bodies_a[W], bodies_b[W];
  Records record;
  float size[W], looked[W];
  for (int i = 0; i < W; ++i) {
    Contact& contact = store.contacts[slots[std::size_t(i) < slots.size() ? std::size_t(i) : 0]];
    group.contacts[i] = &contact;
    bodies_a[i] = contact.body_a;
    bodies_b[i] = contact.body_b;
    record[i] = floats(contact.size);
    looked[i] = contact.looked;
    size[i] = contact.looked >= 0.0f
                  ? contact.size
                  : smaller_size(input.shapes[contact.shape_a].size, input.shapes[contact.shape_b].size);
  }
  group.lanes = (1u << slots.size()) - 1u;
  group.a = load_side(input, bodies_a);
  group.b = load_side(input, bodies_b);
  Number column[8];
  Rows<W>::gather(record, 0, column);
  Rows<W>::gather(record, 4, column + 4);
  group.size = in_lanes(size[0], size[1], size[2], size[3]);
  group.looked = in_lanes(looked[0], looked[1], looked[2], looked[3]);
  group.seen = {{column[1], column[2], column[3]}, {column[4], column[5], column[6], column[7]}};
}

// ------------------------------------------------------------------------------------------------------------- the view

GYRE_INLINE void find_view(Group& group) {
  const Side& a = group.a;
  const Side& b = group.b;
  group.now = {rotate_inverse(a.orientation, difference(b.origin, a.origin)),
               conjugate(a.orientation) * b.orientation};
  // A body that is long beyond the other one turns no faster there.
  const Number apart = length(group.now.position) + (a.extent - a.reach) + (b.extent - b.reach);
  const Lane differ = a.reach != b.reach;
  const Number lever_a = select(differ, min(a.reach, apart + b.reach), a.reach);
  const Number lever_b = select(differ, min(b.reach, apart + a.reach), b.reach);
  group.way =
      length(b.way - a.way) + max(a.spin, Number(0.0f)) * lever_a + max(b.spin, Number(0.0f)) * lever_b;
  group.speculative = Number(kSpeculativeShare) * group.size + min(group.way, kLargestApproach * group.size);
}

GYRE_INLINE void write_views(const Group& group, View (&views)[W]) {
  static_assert(GYRE_FLOATS_BEFORE(View, size) == 7 && sizeof(View) == 10 * sizeof(float));
  const Targets to = {reinterpret_cast<float*>(&views[0]), reinterpret_cast<float*>(&views[1]),
                      reinterpret_cast<float*>(&views[2]), reinterpret_cast<float*>(&views[3])};
  const Vector p = group.now.position;
  const Turn q = group.now.orientation;
  const Number columns[10] = {p.x, p.y, p.z, q.x, q.y, q.z, q.w, group.size, group.way, group.speculative};
  Rows<W>::scatter<4>(to, 0, columns);
  Rows<W>::scatter<4>(to, 4, columns + 4);
  Rows<W>::scatter<2>(to, 8, columns + 8);
}

// ---------------------------------------------------------------------------------------------------------- the motion

// The motion of B in A's body frame from `seen` to `now`, small or not.
struct Motion {
  Vector shift;   // of B's origin
  Vector origin;  // B's origin as seen
  Vector v;       // vector part of the turn's quaternion: half the rotation vector while it is small
  Number w;

  GYRE_INLINE Motion(const Placement& seen, const Placement& now) {
    const Turn turn = now.orientation * conjugate(seen.orientation);
    shift = now.position - seen.position;
    origin = seen.position;
    v = {turn.x, turn.y, turn.z};
    w = turn.w;
  }
  // Of half the angle.
  GYRE_INLINE Number sine() const { return length(v); }

  // How far a point of B goes that was at `p`; worked out as a difference, so that small motions keep their digits.
  GYRE_INLINE Vector of(Vector p) const {
    const Vector t = 2.0f * cross(v, p - origin);
    return shift + w * t + cross(v, t);
  }
};

// A bound on how far surfaces of the one come towards the other: the way of one body's origin, and what its farthest
// point adds when it turns. Of the smaller body: its motion seen from the other is the smaller one. (A rigid motion
// moves A's origin as far as its inverse does.)
GYRE_INLINE Number bound_of(const Motion& motion, Number sine, const Side& a, const Side& b) {
  const Number twice = 2.0f * sine;
  return select(b.extent <= a.extent, length(motion.shift) + twice * b.extent,
                length(motion.of(splat<W>(Vec3{}))) + twice * a.extent);
}

// The same as a matrix, for many points.
class PointMotion {
 public:
  GYRE_INLINE explicit PointMotion(const Motion& motion) : shift_(motion.shift), origin_(motion.origin) {
    // Columns of R - 1.
    const auto column = [&](Vec3 axis) {
      const Vector t = 2.0f * cross(motion.v, splat<W>(axis));
      return motion.w * t + cross(motion.v, t);
    };
    less_one_ = {column({1, 0, 0}), column({0, 1, 0}), column({0, 0, 1})};
  }
  GYRE_INLINE Vector of(Vector p) const { return shift_ + less_one_ * (p - origin_); }

 private:
  Vector shift_, origin_;
  Mat3W<W> less_one_;
};

// ---------------------------------------------------------------------------------------------------------- the anchors

bool is_flat(const Shape& shape) {
  return shape.kind >= ShapeKind::hull || (shape.kind == ShapeKind::box && shape.radius == 0.0f);
}

struct FollowLanes {
  Lane frame_is_b, curved, round;
  Number radius;
  Number side;  // of the moving body along the normal: 1 for B, -1 for A
};

GYRE_INLINE FollowLanes find_follow(const Group& group, const CollideInput& input) {
  unsigned frame_is_b = 0, curved = 0, round = 0;
  float radius[W];
  for (int i = 0; i < W; ++i) {
    const Contact& contact = *group.contacts[i];
    const Follow follow = follow_of(input.shapes[contact.shape_a].shape, input.shapes[contact.shape_b].shape);
    frame_is_b |= unsigned(follow.frame_is_b) << i;
    curved |= unsigned(!follow.flat && !follow.round) << i;
    round |= unsigned(follow.round) << i;
    radius[i] = follow.radius;
  }
  FollowLanes lanes;
  lanes.frame_is_b = Lane::of_bits(frame_is_b);
  lanes.curved = Lane::of_bits(curved);
  lanes.round = Lane::of_bits(round);
  lanes.radius = in_lanes(radius[0], radius[1], radius[2], radius[3]);
  lanes.side = select(lanes.frame_is_b, Number(-1.0f), Number(1.0f));
  return lanes;
}

// One point of each manifold as the last full look found it, and how far the moving body's point there has gone.
struct Anchor {
  Vector position;
  Number separation;
  Vector way;
};
// One manifold of each contact; those without one have no points.
struct ManifoldLanes {
  Records record;
  WideInt<W> count;
  int most;  // points of any
  Vector seen_normal;
  Anchor anchors[kMaxManifoldPoints];
};

constexpr Manifold kNoManifold;

// Returns in which lanes the anchors of this manifold are still good.
GYRE_INLINE Lane try_manifold(const Group& group, const FollowLanes& follow, const PointMotion& motion,
                              Number twice_sine, ManifoldLanes& manifold) {
  Number column[4];
  Rows<W>::gather(manifold.record, 0, column);
  manifold.count = bit_pattern(column[3]);
  Rows<W>::gather(manifold.record, kSliding, column);
  manifold.seen_normal = {column[1], column[2], column[3]};
  const Lane curved = follow.curved & (manifold.count < WideInt<W>(3));
  const Lane some = manifold.count > WideInt<W>(0);
  Lane fails = some & (twice_sine > select(curved, Number(kCurvedTilt), Number(kFlatTilt)));
  const Number most = square(select(curved, Number(kCurvedSlide), Number(kFlatSlide)) * group.size);
  for (int i = 0; i < manifold.most; ++i) {
    Rows<W>::gather(manifold.record, kAnchors + 4 * i, column);
    Anchor& anchor = manifold.anchors[i];
    anchor.position = {column[0], column[1], column[2]};
    anchor.separation = column[3];
    const Number lift = follow.side * (0.5f * anchor.separation + follow.radius);
    anchor.way = motion.of(anchor.position + lift * manifold.seen_normal);
    fails = fails | ((WideInt<W>(i) < manifold.count) & (length_squared(anchor.way) > most));
  }
  return ~fails;
}

// ----------------------------------------------------------------------------------------------------------- the points

// From the frame of the anchors into the world's axes.
struct WorldFrame {
  Mat3W<W> turn;
  Vector center;        // of mass, of the body whose frame it is
  Vector other_center;  // of mass: the other body's seen from that one, world axes
};

GYRE_INLINE WorldFrame find_frame(const Group& group, const FollowLanes& follow) {
  const Side& a = group.a;
  const Side& b = group.b;
  const Vector b_from_a =
      difference(b.origin + rotate(b.orientation, b.center), a.origin + rotate(a.orientation, a.center));
  return {to_matrix(select(follow.frame_is_b, b.orientation, a.orientation)),
          select(follow.frame_is_b, b.center, a.center), select(follow.frame_is_b, -b_from_a, b_from_a)};
}

// Writes point `i` of each manifold. Returns in which lanes the point carried load in the last step, or the surfaces touch.
GYRE_INLINE Lane move_point(const Group& group, const FollowLanes& follow, const WorldFrame& frame,
                            const ManifoldLanes& manifold, int i, const Records& from, const Targets& to) {
  const Anchor& anchor = manifold.anchors[i];
  const Number share = select(follow.round, Number(1.0f), Number(0.5f));
  const Vector own = frame.turn * (anchor.position + share * anchor.way - frame.center);
  const Vector other = own - frame.other_center;
  const Vector from_a = select(follow.frame_is_b, other, own);
  const Vector from_b = select(follow.frame_is_b, own, other);
  const Number separation = anchor.separation + follow.side * dot(anchor.way, manifold.seen_normal);
  Number impulses[4];
  Rows<W>::gather(from, 8, impulses);
  const Lane loaded = impulses[1] > Number(0.0f);
  impulses[1] = Number(0.0f);  // total_impulse
  impulses[3] = Number(0.0f);  // approach_speed
  const Number near_a[4] = {from_a.x, from_a.y, from_a.z, separation};
  const Number near_b[3] = {from_b.x, from_b.y, from_b.z};
  Rows<W>::scatter<4>(to, 0, near_a);
  Rows<W>::scatter<3>(to, 4, near_b);
  Rows<W>::scatter<4>(to, 8, impulses);
  return (loaded | (separation <= kTouch * group.size)) & (WideInt<W>(i) < manifold.count);
}

// Writes the manifolds of those lanes whose bits are set. Returns in which lanes the shapes touch.
GYRE_INLINE Lane move_manifold(const Group& group, const FollowLanes& follow, const WorldFrame& frame,
                               const ManifoldLanes& manifold, unsigned lanes) {
  alignas(16) float nowhere[kManifoldFloats];
  Targets to;
  for (int i = 0; i < W; ++i)
    to[i] = (lanes >> i & 1u) != 0 ? const_cast<float*>(manifold.record[i]) : nowhere;
  const Vector normal = frame.turn * manifold.seen_normal;
  const auto into_plane = [&](int first) {
    Number column[4];
    Rows<W>::gather(manifold.record, first, column);
    const Vector impulse{column[1], column[2], column[3]};
    const Vector turned = impulse - dot(impulse, normal) * normal;
    const Number turned_column[4] = {column[0], turned.x, turned.y, turned.z};
    Rows<W>::scatter<4>(to, first, turned_column);
  };
  into_plane(kAge);
  into_plane(kTwist);
  const Number normal_column[3] = {normal.x, normal.y, normal.z};
  Rows<W>::scatter<3>(to, 0, normal_column);
  for (float* const manifold_floats : to) {
    float* const total_friction = manifold_floats + kTriangle + 1;
    total_friction[0] = total_friction[1] = total_friction[2] = 0.0f;
  }
  Lane touching = Lane::splat(false);
  for (int i = 0; i < manifold.most; ++i) {
    Records from_point;
    Targets to_point;
    for (int lane = 0; lane < W; ++lane) {
      from_point[lane] = manifold.record[lane] + kPoints + kPointFloats * i;
      to_point[lane] = (i < manifold.count[lane] ? to[lane] : nowhere) + kPoints + kPointFloats * i;
    }
    touching = touching | move_point(group, follow, frame, manifold, i, from_point, to_point);
  }
  return touching;
}

// Those lanes of `near` whose anchors hold get their manifolds written; returns their bits, and sets those that touch.
unsigned move_contacts(ContactStore& store, const Group& group, const CollideInput& input,
                       const Motion& motion, Number sine, unsigned near, unsigned& touching) {
  const FollowLanes follow = find_follow(group, input);
  Motion seen_from_frame = motion;
  if (any(follow.frame_is_b)) {
    const Placement seen = select(follow.frame_is_b, inverse(group.seen), group.seen);
    seen_from_frame = Motion(seen, select(follow.frame_is_b, inverse(group.now), group.now));
  }
  const PointMotion points(seen_from_frame);
  int manifold_count = 0;
  for (int i = 0; i < W; ++i) manifold_count = max(manifold_count, int(group.contacts[i]->manifold_count));
  ManifoldLanes manifolds[kMaxMeshManifolds];
  Lane hold = Lane::of_bits(near);
  for (int m = 0; m < manifold_count; ++m) {
    ManifoldLanes& manifold = manifolds[m];
    manifold.most = 0;
    for (int i = 0; i < W; ++i) {
      const std::span<const Manifold> own = manifolds_of(store, *group.contacts[i]);
      const Manifold& mine = std::size_t(m) < own.size() ? own[std::size_t(m)] : kNoManifold;
      manifold.record[i] = floats(mine);
      manifold.most = max(manifold.most, mine.count);
    }
    hold = hold & try_manifold(group, follow, points, 2.0f * sine, manifold);
    if (none(hold)) return 0;
  }
  const unsigned held = to_bits(hold);
  const WorldFrame frame = find_frame(group, follow);
  for (int m = 0; m < manifold_count; ++m) {
    unsigned lanes = 0;
    for (int i = 0; i < W; ++i) lanes |= unsigned(m < int(group.contacts[i]->manifold_count)) << i;
    touching |= held & to_bits(move_manifold(group, follow, frame, manifolds[m], held & lanes));
  }
  return held;
}

}  // namespace

float smaller_size(float a, float b) {
  const bool has_a = a > 0.0f && a < kUnboundedSide;
  const bool has_b = b > 0.0f && b < kUnboundedSide;
  return has_a && has_b ? min(a, b) : has_a ? a : has_b ? b : 0.0f;
}

Follow follow_of(const Shape& a, const Shape& b) {
  Follow follow;
  const bool flat_a = is_flat(a), flat_b = is_flat(b);
  follow.flat = flat_a && flat_b;
  if (flat_a && core_radius(b) > 0.0f) {
    follow.round = true;
    follow.radius = core_radius(b);
  } else if (flat_b && core_radius(a) > 0.0f) {
    follow.round = true;
    follow.radius = core_radius(a);
    follow.frame_is_b = true;
  }
  return follow;
}

Recycled recycle_contacts(ContactStore& store, std::span<const std::uint32_t> slots,
                          const CollideInput& input) {
  Group group;
  load_group(store, slots, input, group);
  find_view(group);
  Recycled recycled;
  if (input.recycle) {
    const Motion motion(group.seen, group.now);
    const Number sine = motion.sine();
    const Number reach = group.speculative + bound_of(motion, sine, group.a, group.b);
    const Lane near = Lane::of_bits(group.lanes) & (group.looked >= Number(0.0f)) & (reach <= group.looked);
    unsigned empty = 0;
    for (int i = 0; i < W; ++i) empty |= unsigned(group.contacts[i]->manifold_count == 0) << i;
    const Lane rattles =
        largest(absolute(group.now.position)) * Number(1.2e-7f) > Number(kRattle) * group.size;
    recycled.contacts = to_bits(near) & empty;
    const unsigned to_move = to_bits(and_not(near, rattles)) & ~empty;
    if (to_move != 0)
      recycled.contacts |= move_contacts(store, group, input, motion, sine, to_move, recycled.touching);
  }
  if (recycled.contacts != group.lanes) write_views(group, recycled.views);
  return recycled;
}

}  // namespace gyre
