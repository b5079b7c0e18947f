// Full looks, recycling, and the matching of new points with old ones. See contact_update.h.
#include "collision/contact_update.h"

#include "collision/fat_box.h"
#include "geometry/manifold_mesh.h"
#include "geometry/support.h"
#include "geometry/surface_overlap.h"

namespace gyre {
namespace {

// All lengths in sizes of the pair (the smaller shape's inner radius).
// What comes faster than this in a step is left to the sweep (continuous.h).
constexpr float kLargestApproach = 1.0f;
// A full look reaches farther than needed, so that the contact may be recycled while the pair moves a little. Points farther
// apart than kKept beyond the speculative distance are not kept, only how near they were. Where nothing touches, and the
// pair goes less than kSlow in a step, the look reaches far: it is cheaper to look once than to look in every step.
constexpr float kKept = 0.005f, kNearSlack = 0.03f, kFarSlack = 0.25f, kSlow = 0.02f;
// Above a mesh a look at boxes alone comes first, as far as the pair goes in some steps: what falls need not look in each.
constexpr float kClearSteps = 4.0f;
// How far points may go against each other, and how far the pair may tilt (rad), before it is looked at anew: where flat
// features meet, or a core swept by a ball and a flat feature; and where something else is round. There the contact goes on
// while the bodies' points do not, and what lags behind would brake what rolls.
constexpr float kFlatSlide = 3.0e-3f, kFlatTilt = 3.0e-3f;
constexpr float kCurvedSlide = 1.0e-4f, kCurvedTilt = 1.0e-4f;
// Where a float's rounding of the distance between the bodies is more than this, a recycled separation would rattle.
constexpr float kRattle = 1.0e-4f;
// Surfaces nearer than this touch.
constexpr float kTouch = 0.005f;
// A new point takes over from an old one this near, whatever its feature is called, if the cosine between their normals is
// at least kSameSide.
constexpr float kMatch = 0.1f, kSameSide = 0.8f;

// How a pair stands and moves, as far as every look needs it.
struct View {
  Transform a_from_b;  // body frames
  float size;
  float way;          // m, the most that surfaces can come towards each other in the step
  float speculative;  // m, how far contacts matter
};

View make_view(const ContactPair& pair, float size) {
  const BodyLook& a = *pair.look_a;
  const BodyLook& b = *pair.look_b;
  View view;
  view.a_from_b = {rotate_inverse(a.orientation, difference(b.position, a.position)),
                   conjugate(a.orientation) * b.orientation};
  view.size = size;
  float lever_a = a.reach, lever_b = b.reach;
  if (lever_a != lever_b) {
    // A body that is long beyond the other one turns no faster there.
    const float apart = length(view.a_from_b.position) + (a.extent - a.reach) + (b.extent - b.reach);
    lever_a = min(a.reach, apart + b.reach);
    lever_b = min(b.reach, apart + a.reach);
  }
  view.way = length(b.way - a.way) + max(a.spin, 0.0f) * lever_a + max(b.spin, 0.0f) * lever_b;
  view.speculative = kSpeculativeShare * size + min(view.way, kLargestApproach * size);
  return view;
}

// ------------------------------------------------------------------------------------------------------- recycling

// The motion of B in A's body frame from `seen` to `now`, small or not.
struct Motion {
  Vec3 shift;   // of B's origin
  Vec3 origin;  // B's origin as seen
  Vec3 v;       // vector part of the turn's quaternion: half the rotation vector while it is small
  float w;
  float sine;  // of half the angle

  Motion(const Transform& seen, const Transform& now) {
    const Quat turn = now.orientation * conjugate(seen.orientation);
    shift = now.position - seen.position;
    origin = seen.position;
    v = {turn.x, turn.y, turn.z};
    w = turn.w;
    sine = length(v);
  }

  // How far a point of B goes that was at `p`; worked out as a difference, so that small motions keep their digits.
  Vec3 of(Vec3 p) const {
    const Vec3 t = 2.0f * cross(v, p - origin);
    return shift + w * t + cross(v, t);
  }

  // A bound on how far surfaces of the one come towards the other: the way of one body's origin, and what its farthest
  // point adds when it turns. Of the smaller body: its motion seen from the other is the smaller one. (A rigid motion
  // moves A's origin as far as its inverse does.)
  float bound(const BodyLook& a, const BodyLook& b) const {
    return b.extent <= a.extent ? length(shift) + 2.0f * sine * b.extent
                                : length(of({})) + 2.0f * sine * a.extent;
  }
};

// The same as a matrix, for many points.
class PointMotion {
 public:
  explicit PointMotion(const Motion& motion) : shift_(motion.shift), origin_(motion.origin) {
    // Columns of R - 1.
    const auto column = [&](Vec3 axis) {
      const Vec3 t = 2.0f * cross(motion.v, axis);
      return motion.w * t + cross(motion.v, t);
    };
    less_one_ = {column({1, 0, 0}), column({0, 1, 0}), column({0, 0, 1})};
  }
  Vec3 of(Vec3 p) const { return shift_ + less_one_ * (p - origin_); }

 private:
  Vec3 shift_, origin_;
  Mat3 less_one_;
};

bool has_rim(const Shape& shape) {
  return shape.kind == ShapeKind::cylinder || shape.kind == ShapeKind::cone;
}

bool is_flat(const Shape& shape) {
  return shape.kind >= ShapeKind::hull || (shape.kind == ShapeKind::box && shape.radius == 0.0f);
}

// How a manifold follows the bodies. Its anchors lie in the frame of one of them, and the other one's points move there.
// Where that one is a core swept by a ball on something flat, the points of its core are what counts: however it rolls,
// it touches below them.
struct Follow {
  bool frame_is_b = false;  // else A's
  bool flat = false;        // flat features on both sides
  bool round = false;       // a swept core on something flat
  float radius = 0.0f;      // of the swept core
  float side = 1.0f;        // of the moving body along the normal: 1 for B, -1 for A
};

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
    follow.side = -1.0f;
  }
  return follow;
}

Pose pose_of(const BodyLook& look) { return {look.position, look.orientation}; }
DVec3 center_of_mass(const BodyLook& look, Vec3 center) { return pose_of(look) * center; }
// The frame that anchors lie in.
const BodyLook& frame_look(const ContactPair& pair, const Follow& follow) {
  return follow.frame_is_b ? *pair.look_b : *pair.look_a;
}
Vec3 frame_center(const ContactPair& pair, const Follow& follow) {
  return follow.frame_is_b ? pair.center_b : pair.center_a;
}

// The way of the moving body's point at an anchor.
Vec3 way_of(const PointAnchor& anchor, Vec3 seen_normal, const Follow& follow, const PointMotion& motion) {
  return motion.of(anchor.position + follow.side * (0.5f * anchor.separation + follow.radius) * seen_normal);
}

// Whether the anchors of one manifold are still good.
bool anchors_hold(const Manifold& manifold, const Follow& follow, float size, float sine,
                  const PointMotion& motion) {
  const bool curved = !follow.flat && !follow.round && manifold.count < 3;
  if (2.0f * sine > (curved ? kCurvedTilt : kFlatTilt)) return false;
  const float most = square((curved ? kCurvedSlide : kFlatSlide) * size);
  for (int i = 0; i < manifold.count; ++i) {
    if (length_squared(way_of(manifold.anchors[i], manifold.seen_normal, follow, motion)) > most)
      return false;
  }
  return true;
}

// What a manifold keeps from step to step, turned into the new tangent plane.
void carry_friction(const Manifold& from, Manifold& to) {
  to.friction_impulse = from.friction_impulse - dot(from.friction_impulse, to.normal) * to.normal;
  to.rolling_impulse = from.rolling_impulse - dot(from.rolling_impulse, to.normal) * to.normal;
  to.twist_impulse = from.twist_impulse;
  to.age = from.age;
  to.sliding = from.sliding;
}

void move_manifold(Manifold& manifold, const Follow& follow, const Mat3& world_from_frame,
                   Vec3 center_of_frame, Vec3 com_b_from_a, const PointMotion& motion) {
  manifold.normal = world_from_frame * manifold.seen_normal;
  const float share = follow.round ? 1.0f : 0.5f;
  for (int i = 0; i < manifold.count; ++i) {
    const PointAnchor& anchor = manifold.anchors[i];
    const Vec3 way = way_of(anchor, manifold.seen_normal, follow, motion);
    const Vec3 from_frame = world_from_frame * (anchor.position + share * way - center_of_frame);
    ContactPointState& point = manifold.points[i];
    point.from_a = follow.frame_is_b ? from_frame + com_b_from_a : from_frame;
    point.from_b = follow.frame_is_b ? from_frame : from_frame - com_b_from_a;
    point.separation = anchor.separation + follow.side * dot(way, manifold.seen_normal);
    point.total_impulse = 0.0f;
    point.approach_speed = 0.0f;
  }
  carry_friction(manifold, manifold);
  manifold.total_friction = {};
}

bool recycle(ContactStore& store, const Contact& contact, const ContactPair& pair, const View& view) {
  const Motion motion(contact.seen_a_from_b, view.a_from_b);
  if (!(view.speculative + motion.bound(*pair.look_a, *pair.look_b) <= contact.looked)) return false;
  if (contact.manifold_count == 0) return true;
  if (largest(absolute(view.a_from_b.position)) * 1.2e-7f > kRattle * view.size) return false;
  const std::span<Manifold> manifolds = manifolds_of(store, contact);
  const Follow follow = follow_of(pair.shape_a->shape, pair.shape_b->shape);
  const PointMotion points(follow.frame_is_b ? Motion(inverse(contact.seen_a_from_b), inverse(view.a_from_b))
                                             : motion);
  for (const Manifold& manifold : manifolds) {
    if (!anchors_hold(manifold, follow, view.size, motion.sine, points)) return false;
  }
  const Mat3 world_from_frame = to_matrix(frame_look(pair, follow).orientation);
  const Vec3 com_b_from_a =
      difference(center_of_mass(*pair.look_b, pair.center_b), center_of_mass(*pair.look_a, pair.center_a));
  for (Manifold& manifold : manifolds) {
    move_manifold(manifold, follow, world_from_frame, frame_center(pair, follow), com_b_from_a, points);
  }
  return true;
}

// ------------------------------------------------------------------------------------------------------- full looks

// A plane has no middle: its frame may lie where the other shape is, so that floats stay small and exact.
void center_plane(Shape& shape, Pose& frame, DVec3 other) {
  if (shape.kind != ShapeKind::plane) return;
  const DVec3 normal(rotate(frame.orientation, shape.extents));
  const double height = dot(normal, other - frame.position) - double(shape.offset);
  frame.position = other - height * normal;
  shape.offset = 0.0f;
}

template <int kRoom>
struct Found {
  LocalManifold manifolds[kRoom];
  int count = 0;
  Pose frame;  // world_from_a: of the manifolds
};

template <int kRoom>
void ask_shapes(const ContactPair& pair, float reach, PairCache& cache, Found<kRoom>& found) {
  Shape a = pair.shape_a->shape;
  Shape b = pair.shape_b->shape;
  found.frame = pose_of(*pair.look_a) * pair.shape_a->body_from_shape;
  Pose frame_b = pose_of(*pair.look_b) * pair.shape_b->body_from_shape;
  center_plane(a, found.frame, frame_b.position);
  center_plane(b, frame_b, found.frame.position);
  found.count = collide_shapes(a, b, inverse_times(found.frame, frame_b), reach, cache, found.manifolds);
}

// Leaves out what is farther apart than `reach`. Returns the smallest separation of what was left out.
template <int kRoom>
float keep_near(Found<kRoom>& found, float reach) {
  float left_out = kUnbounded;
  int kept_manifolds = 0;
  for (int m = 0; m < found.count; ++m) {
    LocalManifold& manifold = found.manifolds[m];
    int kept = 0;
    for (int i = 0; i < manifold.count; ++i) {
      if (manifold.points[i].separation <= reach) {
        manifold.points[kept++] = manifold.points[i];
      } else {
        left_out = min(left_out, manifold.points[i].separation);
      }
    }
    manifold.count = kept;
    if (kept > 0) found.manifolds[kept_manifolds++] = manifold;
  }
  found.count = kept_manifolds;
  return left_out;
}

// Whether no point is as near as `reach`.
template <int kRoom>
bool is_beyond(const Found<kRoom>& found, float reach) {
  for (int m = 0; m < found.count; ++m) {
    for (int i = 0; i < found.manifolds[m].count; ++i) {
      if (found.manifolds[m].points[i].separation <= reach) return false;
    }
  }
  return true;
}

// The manifolds before this look, and which of their points have found a heir.
template <int kRoom>
struct Former {
  // Not cleared: only the counted ones are ever read.
  union {
    Manifold manifolds[kRoom];
  };
  int count = 0;
  bool taken[kRoom] = {};
  bool point_taken[kRoom][kMaxManifoldPoints] = {};

  Former() {}
};

// The former manifold that goes on in the new one; -1 if none does. A single manifold always goes on.
template <int kRoom>
int find_former(const Former<kRoom>& former, const Manifold& manifold) {
  if constexpr (kRoom == 1) return former.count == 1 ? 0 : -1;
  int best = -1;
  float best_score = kSameSide;
  for (int m = 0; m < former.count; ++m) {
    if (former.taken[m]) continue;
    const float same_triangle = former.manifolds[m].triangle == manifold.triangle ? 0.5f : 0.0f;
    const float score = dot(former.manifolds[m].normal, manifold.normal) + same_triangle;
    if (score > best_score) {
      best = m;
      best_score = score;
    }
  }
  return best;
}

template <int kRoom>
void take_over(Former<kRoom>& former, int m, int i, ContactPointState& point) {
  const ContactPointState& old = former.manifolds[m].points[i];
  former.point_taken[m][i] = true;
  point.normal_impulse = old.normal_impulse;
  point.held = old.held;
}

// By name within the former manifold; bit i of the result is set for each point that found its own.
template <int kRoom>
unsigned match_by_feature(Former<kRoom>& former, int m, Manifold& manifold) {
  unsigned matched = 0;
  for (int i = 0; i < manifold.count; ++i) {
    for (int k = 0; k < former.manifolds[m].count; ++k) {
      if (former.point_taken[m][k] || former.manifolds[m].points[k].feature != manifold.points[i].feature)
        continue;
      take_over(former, m, k, manifold.points[i]);
      matched |= 1u << i;
      break;
    }
  }
  return matched;
}

// By place, among all points that are left on the same side: features get new names when another edge comes first, but
// the load stays where it was.
template <int kRoom>
void match_by_place(Former<kRoom>& former, Manifold& manifold, unsigned matched, float radius) {
  for (int i = 0; i < manifold.count; ++i) {
    if ((matched >> i & 1u) != 0) continue;
    int best_m = -1, best_k = -1;
    float nearest = square(radius);
    for (int m = 0; m < former.count; ++m) {
      if (dot(former.manifolds[m].normal, manifold.normal) < kSameSide) continue;
      for (int k = 0; k < former.manifolds[m].count; ++k) {
        if (former.point_taken[m][k]) continue;
        const float d =
            length_squared(former.manifolds[m].anchors[k].position - manifold.anchors[i].position);
        if (d < nearest) {
          nearest = d;
          best_m = m;
          best_k = k;
        }
      }
    }
    if (best_m >= 0) take_over(former, best_m, best_k, manifold.points[i]);
  }
}

// From the frame of shape A into world axes, and into the body frame for anchors. Impulses are zero.
Manifold to_world(const LocalManifold& local, const Pose& frame, const ContactPair& pair) {
  const Follow follow = follow_of(pair.shape_a->shape, pair.shape_b->shape);
  const Quat frame_turn = frame_look(pair, follow).orientation;
  // Each side by itself: one of the two may be far away (a plane's body), and floats with it.
  const Vec3 frame_from_a = difference(frame.position, center_of_mass(*pair.look_a, pair.center_a));
  const Vec3 frame_from_b = difference(frame.position, center_of_mass(*pair.look_b, pair.center_b));
  Manifold out;
  out.normal = rotate(frame.orientation, local.normal);
  out.count = local.count;
  out.triangle = local.triangle;
  out.seen_normal = rotate_inverse(frame_turn, out.normal);
  for (int i = 0; i < local.count; ++i) {
    ContactPointState& point = out.points[i];
    const Vec3 place = rotate(frame.orientation, local.points[i].position);
    point.from_a = place + frame_from_a;
    point.from_b = place + frame_from_b;
    point.separation = local.points[i].separation;
    point.feature = local.points[i].feature;
    out.anchors[i].position = rotate_inverse(frame_turn, follow.frame_is_b ? point.from_b : point.from_a) +
                              frame_center(pair, follow);
    out.anchors[i].separation = point.separation;
  }
  return out;
}

// What rolls on a rim may go farther in a step than any point goes with its load, and the lowest point of a rim changes its name
// where it passes a corner. If one point is left over on either side, it is the same.
template <int kRoom>
void match_rolling(Former<kRoom>& former, Manifold& manifold, unsigned matched_before) {
  if (former.count != 1) return;
  int lonely = -1, orphan = -1;
  for (int i = 0; i < manifold.count; ++i) {
    if ((matched_before >> i & 1u) != 0 || manifold.points[i].normal_impulse != 0.0f) continue;
    if (lonely >= 0) return;
    lonely = i;
  }
  for (int k = 0; k < former.manifolds[0].count; ++k) {
    if (former.point_taken[0][k] || former.manifolds[0].points[k].normal_impulse == 0.0f) continue;
    if (orphan >= 0) return;
    orphan = k;
  }
  if (lonely >= 0 && orphan >= 0 && dot(former.manifolds[0].normal, manifold.normal) >= kSameSide)
    take_over(former, 0, orphan, manifold.points[lonely]);
}

template <int kRoom>
void write_manifolds(ContactStore& store, Contact& contact, const Found<kRoom>& found,
                     const ContactPair& pair, float size) {
  Manifold* const out = &store.manifolds[contact.first_manifold];
  Former<kRoom> former;
  former.count = contact.manifold_count;
  for (int m = 0; m < former.count; ++m) former.manifolds[m] = out[m];
  unsigned matched[kRoom] = {};
  for (int m = 0; m < found.count; ++m) {
    out[m] = to_world(found.manifolds[m], found.frame, pair);
    const int old = find_former(former, out[m]);
    if (old < 0) continue;
    former.taken[old] = true;
    carry_friction(former.manifolds[old], out[m]);
    matched[m] = match_by_feature(former, old, out[m]);
  }
  for (int m = 0; m < found.count; ++m) match_by_place(former, out[m], matched[m], kMatch * size);
  if (found.count == 1 && (has_rim(pair.shape_a->shape) || has_rim(pair.shape_b->shape)))
    match_rolling(former, out[0], matched[0]);
  // Nothing of the past stays behind in what is not in use.
  for (int m = found.count; m < former.count; ++m) out[m] = Manifold{};
  contact.manifold_count = std::uint16_t(found.count);
}

void note_look(Contact& contact, const View& view, float looked) {
  contact.looked = looked;
  contact.size = view.size;
  contact.seen_a_from_b = view.a_from_b;
}

bool is_clear_of_surface(const ContactPair& pair, const View& view, float reach) {
  const Transform a_from_b =
      inverse(pair.shape_a->body_from_shape) * view.a_from_b * pair.shape_b->body_from_shape;
  return is_clear_of_surface(pair.shape_a->shape, pair.shape_b->shape, a_from_b, reach);
}

// kRoom is the contact's manifold_room.
template <int kRoom>
void look_anew(ContactStore& store, Contact& contact, const ContactPair& pair, const View& view) {
  const float kept = view.speculative + kKept * view.size;
  float reach = view.speculative + kNearSlack * view.size;
  if (kRoom > 1 && contact.manifold_count == 0) {
    const float far_reach = view.speculative + kClearSteps * view.way + kFarSlack * view.size;
    if (is_clear_of_surface(pair, view, far_reach)) return note_look(contact, view, far_reach);
  }
  Found<kRoom> found;
  bool clear = false;
  if (kRoom == 1 && contact.manifold_count == 0 && view.way < kSlow * view.size) {
    const float far_reach = view.speculative + kFarSlack * view.size;
    ask_shapes(pair, far_reach, contact.cache, found);
    // Far points may have taken the places of near ones in the manifold: then it is no good.
    clear = is_beyond(found, kept);
    if (clear) reach = far_reach;
  }
  if (!clear) ask_shapes(pair, reach, contact.cache, found);
  const float left_out = min(keep_near(found, kept), reach);
  if (found.count > 0 || contact.manifold_count > 0) write_manifolds(store, contact, found, pair, view.size);
  // Points measure separation along one normal, which is not always that of the nearest features: hence only a part.
  note_look(contact, view, left_out < reach ? kept + 0.75f * (left_out - kept) : reach);
}

bool carried_load(std::span<const Manifold> manifolds) {
  for (const Manifold& manifold : manifolds) {
    for (int i = 0; i < manifold.count; ++i) {
      if (manifold.points[i].total_impulse > 0.0f) return true;
    }
  }
  return false;
}

bool is_near(std::span<const Manifold> manifolds, float distance) {
  for (const Manifold& manifold : manifolds) {
    for (int i = 0; i < manifold.count; ++i) {
      if (manifold.points[i].separation <= distance) return true;
    }
  }
  return false;
}

}  // namespace

float smaller_size(float a, float b) {
  const bool has_a = a > 0.0f && a < kUnboundedSide;
  const bool has_b = b > 0.0f && b < kUnboundedSide;
  return has_a && has_b ? min(a, b) : has_a ? a : has_b ? b : 0.0f;
}

bool look_at_sensor(Contact& contact, const ContactPair& pair) {
  const Shape& a = pair.shape_a->shape;
  const Shape& b = pair.shape_b->shape;
  if (!is_convex(a.kind) && !is_convex(b.kind)) {
    const Pose frame_a = pose_of(*pair.look_a) * pair.shape_a->body_from_shape;
    return surfaces_overlap(a, b,
                            inverse_times(frame_a, pose_of(*pair.look_b) * pair.shape_b->body_from_shape));
  }
  Found<kMaxMeshManifolds> found;
  ask_shapes(pair, 0.0f, contact.cache, found);
  keep_near(found, 0.0f);
  return found.count > 0;
}

BodyLook make_body_look(const ColliderBody& body, float seconds) {
  BodyLook look;
  look.position = body.pose.position;
  look.orientation = body.pose.orientation;
  look.way = seconds * body.linear_velocity;
  look.spin = body.awake ? seconds * length(body.angular_velocity) : -1.0f;
  look.reach = body.reach;
  look.extent = body.reach + length(body.center);
  return look;
}

bool update_contact(ContactStore& store, Contact& contact, const ContactPair& pair, bool may_recycle) {
  const bool looked = contact.looked >= 0.0f;
  const View view =
      make_view(pair, looked ? contact.size : smaller_size(pair.shape_a->size, pair.shape_b->size));
  const bool loaded = carried_load(manifolds_of(store, contact));
  contact.recycled = may_recycle && looked && recycle(store, contact, pair, view) ? 1 : 0;
  if (contact.recycled == 0) {
    if (contact.manifold_room == 1) {
      look_anew<1>(store, contact, pair, view);
    } else {
      look_anew<kMaxMeshManifolds>(store, contact, pair, view);
    }
  }
  if (contact.manifold_count == 0) return false;
  return loaded || is_near(manifolds_of(store, contact), kTouch * view.size);
}

}  // namespace gyre
