// Contact recycling in lanes: tests whether the anchors of contacts are still valid and moves their points. See
// contact_recycle.h. One template serves every width; lane i computes exactly what width 1 would.
#pragma once

#include "base/prefetch.h"
#include "collision/contact/contact_apart_lanes.h"
#include "collision/contact/contact_lanes.h"
#include "collision/contact/anchor_frame.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// The largest slide (in sizes) and tilt (rad) of a recycled contact: between flat features, or a rounded core and a
// flat feature; and with other round shapes. With those the contact moves on while the points of the bodies do not, and
// a point that lags behind would brake rolling.
constexpr float kFlatSlide = 3.0e-3f, kFlatTilt = 3.0e-3f;
constexpr float kCurvedSlide = 1.0e-4f, kCurvedTilt = 1.0e-4f;
// If the rounding of the distance of the bodies is larger than this, in sizes, recycled separations would be noise.
constexpr float kMaxRounding = 1.0e-4f;

// ---------------------------------------------------------------------------------------------------------- the motion

// The motion of B in A's body frame from `seen` to `now`, of any size.
template <int W>
struct Motion {
  Vec3W<W> shift;   // of B's origin
  Vec3W<W> origin;  // B's origin at the last full update
  Vec3W<W> v;       // vector part of the rotation's quaternion: half the rotation vector for small rotations
  Wide<W> w;

  GYRE_INLINE Motion(const Placement<W>& seen, const Placement<W>& now) {
    const QuatW<W> rotation = now.orientation * conjugate(seen.orientation);
    shift = now.position - seen.position;
    origin = seen.position;
    v = {rotation.x, rotation.y, rotation.z};
    w = rotation.w;
  }
  // Approximates the angle for small rotations.
  GYRE_INLINE Wide<W> angle_bound() const { return 2.0f * length(v); }

  // The displacement of the point of B that was at `p`, computed as a difference so that small motions keep their
  // digits.
  GYRE_INLINE Vec3W<W> of(Vec3W<W> p) const {
    const Vec3W<W> t = 2.0f * cross(v, p - origin);
    return shift + w * t + cross(v, t);
  }

  // An upper bound of the approach of the surfaces: the displacement of one body's origin, and what rotation adds at
  // its farthest point. The smaller body is used, since its motion seen from the other gives the smaller bound. (A
  // rigid motion moves A's origin as far as its inverse does.)
  GYRE_INLINE Wide<W> bound(const Side<W>& a, const Side<W>& b) const {
    const Vec3W<W> of_a = of({0.0f, 0.0f, 0.0f});
    return select(b.extent <= a.extent, length(shift) + angle_bound() * b.extent,
                  length(of_a) + angle_bound() * a.extent);
  }
};

// The same motion as a matrix, for many points.
template <int W>
class PointMotion {
 public:
  GYRE_INLINE explicit PointMotion(const Motion<W>& motion) : shift_(motion.shift), origin_(motion.origin) {
    change_ = {column(motion, {1.0f, 0.0f, 0.0f}), column(motion, {0.0f, 1.0f, 0.0f}),
               column(motion, {0.0f, 0.0f, 1.0f})};
  }
  GYRE_INLINE Vec3W<W> of(Vec3W<W> p) const { return shift_ + change_ * (p - origin_); }

 private:
  // A column of R - 1.
  static GYRE_INLINE Vec3W<W> column(const Motion<W>& motion, Vec3W<W> axis) {
    const Vec3W<W> t = 2.0f * cross(motion.v, axis);
    return motion.w * t + cross(motion.v, t);
  }

  Vec3W<W> shift_, origin_;
  Mat3W<W> change_;
};

// ---------------------------------------------------------------------------------------------------------- the anchors

template <int W>
GYRE_INLINE Roundness<W> load_roundness(const Records<W>& shape) {
  static_assert(offsetof(ColliderShape, shape) == 0 && sizeof(ShapeKind) == 1);
  static_assert(GYRE_FLOATS_BEFORE(Shape, kind) == 0 && GYRE_FLOATS_BEFORE(Shape, radius) == 1);
  Wide<W> column[4];
  read_four<W>(shape, 0, column);
  // The kind is one byte.
  return {bit_pattern(column[0]) & WideInt<W>(0xff), column[1]};
}

template <int W>
GYRE_INLINE ManifoldMatch<W> find_match(const Group<W>& group) {
  Records<W> a, b;
  GYRE_UNROLL
  for (int i = 0; i < W; ++i) {
    a[i] = floats(group.pairs[i]->shape_a);
    b[i] = floats(group.pairs[i]->shape_b);
  }
  return ManifoldMatch<W>(load_roundness<W>(a), load_roundness<W>(b));
}

// One point of each manifold at the last full update, and the displacement of the moving body there.
template <int W>
struct Anchor {
  Vec3W<W> position;
  Wide<W> separation;
  Vec3W<W> displacement;
};
// One manifold of each contact; lanes without one have an empty manifold.
template <int W>
struct ManifoldLanes {
  Records<W> record;
  std::int32_t counts[W];
  std::int32_t min_count, max_count;  // of the counts
  WideInt<W> count;
  Wide<W> side;  // the side of the moving body along the normal: 1 for B, -1 for A
  Vec3W<W> anchor_normal;
  Anchor<W> anchors[kMaxManifoldPoints];
};

// Loads manifold `m` of each contact; `none` stands for a missing one.
template <int W>
GYRE_INLINE void load_manifold(const Group<W>& group, int m, Manifold& none, ManifoldLanes<W>& manifold) {
  manifold.min_count = kMaxManifoldPoints;
  manifold.max_count = 0;
  GYRE_UNROLL
  for (int i = 0; i < W; ++i) {
    const PairInput& pair = *group.pairs[i];
    Manifold* const mine = m < group.counts[i] ? pair.manifolds + m : &none;
    manifold.record[i] = floats(mine);
    manifold.counts[i] = mine->count;
    manifold.min_count = mine->count < manifold.min_count ? mine->count : manifold.min_count;
    manifold.max_count = mine->count > manifold.max_count ? mine->count : manifold.max_count;
  }
  Wide<W> column[4];
  read_four<W>(manifold.record, 0, column);
  manifold.count = bit_pattern(column[3]);
  read_four<W>(manifold.record, kManifoldSliding, column);
  manifold.anchor_normal = {column[1], column[2], column[3]};
}

// Returns the lanes in which all anchors of this manifold are still valid.
template <int W>
GYRE_INLINE Mask<W> find_motions(const Group<W>& group, const ManifoldMatch<W>& match,
                                 const PointMotion<W>& motion, Wide<W> angle_bound,
                                 ManifoldLanes<W>& manifold) {
  const Mask<W> curved = and_not(manifold.count < WideInt<W>(3), match.flat | match.round);
  const Mask<W> tilts = angle_bound > select(curved, Wide<W>(kCurvedTilt), Wide<W>(kFlatTilt));
  Mask<W> fails = tilts & (manifold.count > WideInt<W>(0));
  const Wide<W> slide = select(curved, Wide<W>(kCurvedSlide), Wide<W>(kFlatSlide)) * group.size;
  manifold.side = select(match.frame_is_b, Wide<W>(-1.0f), Wide<W>(1.0f));
  for (int i = 0; i < manifold.max_count; ++i) {
    Wide<W> column[4];
    read_four<W>(manifold.record, kManifoldAnchors + 4 * i, column);
    Anchor<W>& anchor = manifold.anchors[i];
    anchor.position = {column[0], column[1], column[2]};
    anchor.separation = column[3];
    const Wide<W> lift = manifold.side * (0.5f * anchor.separation + match.radius);
    anchor.displacement = motion.of(anchor.position + lift * manifold.anchor_normal);
    const Mask<W> slides = length_squared(anchor.displacement) > square(slide);
    fails = fails | (slides & (WideInt<W>(i) < manifold.count));
  }
  return ~fails;
}

// ----------------------------------------------------------------------------------------------------------- the points

// From the frame of the anchors to world axes.
template <int W>
struct WorldFrame {
  Mat3W<W> rotation;
  Vec3W<W> center;  // centre of mass of the body whose frame it is
  Vec3W<W> other;   // the other body's centre of mass seen from that one, world axes
};

template <int W>
GYRE_INLINE WorldFrame<W> find_world_frame(const Group<W>& group, const ManifoldMatch<W>& match) {
  const Side<W>& a = group.a;
  const Side<W>& b = group.b;
  const Vec3W<W> b_from_a = difference(b.center_of_mass(), a.center_of_mass());
  return {to_matrix(select(match.frame_is_b, b.orientation, a.orientation)),
          select(match.frame_is_b, b.center, a.center), select(match.frame_is_b, -b_from_a, b_from_a)};
}

// Writes point `i` of each manifold. Returns the lanes in which the point carried load in the last step or touches.
template <int W>
GYRE_INLINE Mask<W> move_point(const Group<W>& group, const ManifoldMatch<W>& match,
                               const WorldFrame<W>& frame, const ManifoldLanes<W>& manifold, int i,
                               const Targets<W>& to) {
  const Anchor<W>& anchor = manifold.anchors[i];
  const Wide<W> share = select(match.round, Wide<W>(1.0f), Wide<W>(0.5f));
  const Vec3W<W> own = frame.rotation * (anchor.position + share * anchor.displacement - frame.center);
  const Vec3W<W> other = own - frame.other;
  const Vec3W<W> from_a = select(match.frame_is_b, other, own);
  const Vec3W<W> from_b = select(match.frame_is_b, own, other);
  const Wide<W> separation =
      anchor.separation + manifold.side * dot(anchor.displacement, manifold.anchor_normal);
  const int first = kManifoldPoints + kPointFloats * i;
  Wide<W> impulses[4];
  read_four<W>(manifold.record, first + 8, impulses);
  const Mask<W> loaded = impulses[1] > Wide<W>(0.0f);
  const Wide<W> zero(0.0f);
  write_four<4, W>(to, first, {from_a.x, from_a.y, from_a.z, separation});
  write_four<3, W>(to, first + 4, {from_b.x, from_b.y, from_b.z});
  // The sums over a step and the approach speed start at zero.
  write_four<4, W>(to, first + 8, {impulses[0], zero, impulses[2], zero});
  return (loaded | (separation <= Wide<W>(kTouch) * group.size)) & (WideInt<W>(i) < manifold.count);
}

// Projects the impulses that a manifold carries from step to step onto the new tangent plane.
template <int W>
GYRE_INLINE void carry_friction_impulses(const ManifoldLanes<W>& manifold, int first, Vec3W<W> normal,
                                         const Targets<W>& to) {
  Wide<W> column[4];
  read_four<W>(manifold.record, first, column);
  const Vec3W<W> before{column[1], column[2], column[3]};
  const Vec3W<W> after = before - dot(before, normal) * normal;
  write_four<4, W>(to, first, {column[0], after.x, after.y, after.z});
}

// Writes the manifolds of the given lanes (bits). Returns the lanes in which the shapes touch.
template <int W>
GYRE_INLINE Mask<W> move_manifold(const Group<W>& group, const ManifoldMatch<W>& match,
                                  const WorldFrame<W>& frame, const ManifoldLanes<W>& manifold,
                                  unsigned lanes) {
  alignas(16) float discarded[kManifoldFloats];
  Targets<W> to;
  GYRE_UNROLL
  for (int i = 0; i < W; ++i)
    to[i] = (lanes >> i & 1u) != 0 ? const_cast<float*>(manifold.record[i]) : discarded;
  const Vec3W<W> normal = frame.rotation * manifold.anchor_normal;
  write_four<3, W>(to, 0, {normal.x, normal.y, normal.z});
  carry_friction_impulses<W>(manifold, kManifoldFriction, normal, to);
  carry_friction_impulses<W>(manifold, kManifoldTwist, normal, to);
  GYRE_UNROLL
  for (int i = 0; i < W; ++i) {
    float* const total_friction = to[i] + kManifoldTotals;
    total_friction[0] = total_friction[1] = total_friction[2] = 0.0f;
  }
  Mask<W> touching = Mask<W>::splat(false);
  for (int i = 0; i < manifold.max_count; ++i) {
    if (i >= manifold.min_count) {
      GYRE_UNROLL
      for (int lane = 0; lane < W; ++lane) to[lane] = i < manifold.counts[lane] ? to[lane] : discarded;
    }
    touching = touching | move_point<W>(group, match, frame, manifold, i, to);
  }
  return touching;
}

// Writes the manifolds of those lanes in `near` (bits) whose anchors are all valid. Returns these lanes, and adds those
// that touch to `touching`.
template <int W>
unsigned move_contacts(const Group<W>& group, const Motion<W>& motion, unsigned near, Manifold& none,
                       unsigned& touching) {
  const ManifoldMatch<W> match = find_match<W>(group);
  Placement<W> seen = group.seen, now = group.now;
  if (any(match.frame_is_b)) {
    seen = select(match.frame_is_b, inverse(seen), seen);
    now = select(match.frame_is_b, inverse(now), now);
  }
  const PointMotion<W> points(Motion<W>(seen, now));
  int max_count = 0;
  for (int i = 0; i < W; ++i) max_count = group.counts[i] > max_count ? group.counts[i] : max_count;
  ManifoldLanes<W> manifolds[kMaxMeshManifolds];
  unsigned valid = near;
  for (int m = 0; m < max_count; ++m) {
    load_manifold<W>(group, m, none, manifolds[m]);
    valid &= to_bits(find_motions<W>(group, match, points, motion.angle_bound(), manifolds[m]));
    if (valid == 0) return 0;
  }
  const WorldFrame<W> frame = find_world_frame<W>(group, match);
  for (int m = 0; m < max_count; ++m) {
    touching |= valid & to_bits(move_manifold<W>(group, match, frame, manifolds[m], valid));
  }
  return valid;
}

// `none`: an empty manifold for lanes without one.
template <int W>
GYRE_INLINE unsigned recycle_group(const Group<W>& group, unsigned lanes, Manifold& none,
                                   unsigned& touching) {
  const Motion<W> motion(group.seen, group.now);
  const Wide<W> needed_distance = group.speculative + motion.bound(group.a, group.b);
  const unsigned near =
      lanes & to_bits((group.cached_distance >= Wide<W>(0.0f)) & (needed_distance <= group.cached_distance));
  const unsigned empty = empty_lanes<W>(group);
  const Wide<W> rounding = largest(absolute(group.now.position)) * Wide<W>(1.2e-7f);
  const unsigned imprecise = to_bits(rounding > Wide<W>(kMaxRounding) * group.size);
  // Beyond the tilt of any manifold; the manifolds need not be read.
  const unsigned tilts = to_bits(motion.angle_bound() > Wide<W>(kFlatTilt));
  const unsigned to_move = near & ~(imprecise | tilts | empty);
  return (near & empty) | (to_move != 0 ? move_contacts<W>(group, motion, to_move, none, touching) : 0u);
}

// How many contacts ahead manifolds are prefetched, since they lie anywhere in memory.
constexpr int kAhead = 8;

GYRE_INLINE void fetch_manifolds(const PairInput* pairs, int begin, int end) {
  for (int i = begin; i < end; ++i) {
    if (pairs[i].contact->manifold_count == 0) continue;
    const char* const manifold = reinterpret_cast<const char*>(pairs[i].manifolds);
    for (std::size_t line = 0; line < sizeof(Manifold); line += kCacheLine)
      __builtin_prefetch(manifold + line);
  }
}

// See RecycleContacts.
template <int W>
void recycle_contacts(const PairInput* pairs, int begin, int end, bool allow_recycling,
                      Recycled& recycled) {
  Manifold none;
  fetch_manifolds(pairs, begin, begin + kAhead < end ? begin + kAhead : end);
  for (int first = begin; first < end; first += W) {
    const int ahead = first + kAhead, left = end - first;
    fetch_manifolds(pairs, ahead, ahead + W < end ? ahead + W : end);
    const int used = left < W ? left : W;
    const unsigned lanes = (1u << used) - 1u;
    Group<W> group;
    load_group<W>(pairs + first, used, group);
    find_view<W>(group);
    unsigned touching = 0;
    const unsigned done = allow_recycling ? recycle_group<W>(group, lanes, none, touching) : 0u;
    recycled.contacts |= std::uint64_t(done) << first;
    recycled.touching |= std::uint64_t(touching) << first;
    if (done == lanes) continue;
    ShapesInView<W> shapes;
    find_shapes<W>(group, shapes);
    AxisLanes<W> axis{boxes::kNoAxis, 0.0f, Mask<W>::splat(false)};
    const unsigned apart = allow_recycling ? separate_boxes<W>(group, shapes, lanes & ~done, axis) : 0u;
    recycled.apart |= std::uint64_t(apart) << first;
    if ((done | apart) != lanes) write_views<W>(group, shapes, axis, used, recycled.views + first);
  }
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
