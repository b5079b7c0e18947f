// Full updates, and the matching of new points with old ones. See contact_update.h.
#include "collision/contact/contact_update.h"

#include "collision/broadphase/fat_box.h"
#include "collision/contact/contact_apart_lanes.h"
#include "collision/contact/anchor_frame.h"
#include "geometry/manifold/manifold_box.h"
#include "geometry/manifold/manifold_layout.h"
#include "geometry/manifold_mesh/manifold_mesh.h"
#include "geometry/query/surface_overlap.h"

#include <bit>

namespace gyre {
namespace {

// Lengths are in sizes of the pair (inner radius of the smaller shape). Points farther apart than the speculative
// distance and this margin are dropped; only their separation counts.
constexpr float kPointMargin = 0.005f;
// Above a mesh a test of boxes comes first, over the approach of this many steps; falling bodies then need no search in
// each step.
constexpr float kClearSteps = 4.0f;
// A new point without a feature match takes the impulses of the nearest old point within kMatchDistance, if the cosine
// between their normals is at least kSameSideCosine.
constexpr float kMatchDistance = 0.1f, kSameSideCosine = 0.8f;

bool has_rim(const Shape& shape) {
  return shape.kind == ShapeKind::cylinder || shape.kind == ShapeKind::cone;
}

std::span<Manifold> manifolds_of(const PairInput& pair) {
  return {pair.manifolds, pair.contact->manifold_count};
}
// True if the anchors lie in the body frame of B, false if in A's.
bool frame_is_b(const Shape& a, const Shape& b) {
  const Roundness<1> round_a{std::int32_t(a.kind), a.radius}, round_b{std::int32_t(b.kind), b.radius};
  return any(ManifoldMatch<1>(round_a, round_b).frame_is_b);
}

// ---------------------------------------------------------------------------------------------------------- the shapes

template <int kRoom>
struct Found {
  // Not cleared: only counted ones are read. The narrow phase writes all members but `triangle`, which only surfaces
  // have.
  union {
    LocalManifold manifolds[kRoom];
  };
  int count = 0;

  Found() {
    for (LocalManifold& manifold : manifolds) manifold.triangle = 0;
  }
};

// A shape in the frame of PairView.
struct ViewedShape {
  Shape moved;
  const Shape* shape;
  ViewedShape(const Shape& own, const Shape& other) : shape(&own) {
    if (own.kind != ShapeKind::plane || !is_convex(other.kind)) return;
    moved = own;
    moved.offset = 0.0f;
    shape = &moved;
  }
};

template <int kRoom>
void collide_in_view(const PairInput& pair, const PairView& view, float max_distance,
                     CachedTriangles* cached, Found<kRoom>& found) {
  const ViewedShape a(pair.shape_a->shape, pair.shape_b->shape), b(pair.shape_b->shape, pair.shape_a->shape);
  found.count = collide_shapes(*a.shape, *b.shape, view.shapes_a_from_b, max_distance, pair.contact->cache,
                               found.manifolds, cached);
}

// The distance below which contacts along a normal matter. Contacts within min_near() always do.
float min_near(const PairView& view) { return (kSpeculativeShare + kPointMargin) * view.size; }
float near_along(const PairView& view, Vec3 normal) {
  return min(min_near(view) + view.closing.along(normal), view.speculative + kPointMargin * view.size);
}

// As collide_in_view, for two sharp boxes. If they stay too far apart along the axis of largest separation, nothing is
// found and the result is their separation along that axis, a lower bound of the distance.
float collide_boxes_in_view(const PairInput& pair, const PairView& view, float max_distance,
                            Found<1>& found) {
  const Shape& a = pair.shape_a->shape;
  const Shape& b = pair.shape_b->shape;
  PairCache& cache = pair.contact->cache;
  const boxes::Axis axis = view.axis.number != boxes::kNoAxis
                               ? view.axis
                               : find_box_axis(a, b, view.shapes_a_from_b, max_distance, cache);
  if (axis.separation > min_near(view) &&
      axis.separation > near_along(view, box_axis_normal(axis, view.shapes_a_from_b))) {
    cache.words[0] = std::uint32_t(axis.number + 1);
    found.count = 0;
    return min(axis.separation, max_distance);
  }
  collide_boxes_along(axis, a, b, view.shapes_a_from_b, max_distance, cache, found.manifolds[0]);
  found.count = found.manifolds[0].count > 0 ? 1 : 0;
  return max_distance;
}

// Drops the points farther apart than `max_distance`. Returns the smallest separation of a dropped point.
template <int kRoom>
float remove_far_points(Found<kRoom>& found, float max_distance) {
  float left_out = kUnbounded;
  int manifold_count = 0;
  for (int m = 0; m < found.count; ++m) {
    LocalManifold& manifold = found.manifolds[m];
    int count = 0;
    for (int i = 0; i < manifold.count; ++i) {
      if (manifold.points[i].separation <= max_distance) {
        if (count != i) manifold.points[count] = manifold.points[i];
        ++count;
      } else {
        left_out = min(left_out, manifold.points[i].separation);
      }
    }
    manifold.count = count;
    if (count == 0) continue;
    if (manifold_count != m) found.manifolds[manifold_count] = manifold;
    ++manifold_count;
  }
  found.count = manifold_count;
  return left_out;
}

float farthest_of(const LocalManifold& manifold) {
  float farthest = -kUnbounded;
  for (int i = 0; i < manifold.count; ++i) farthest = max(farthest, manifold.points[i].separation);
  return farthest;
}

// True if no point is within `max_distance`.
template <int kRoom>
bool is_beyond(const Found<kRoom>& found, float max_distance) {
  for (int m = 0; m < found.count; ++m) {
    for (int i = 0; i < found.manifolds[m].count; ++i) {
      if (found.manifolds[m].points[i].separation <= max_distance) return false;
    }
  }
  return true;
}

// The state that a manifold keeps from before the update, with its points side by side. Missing points are zero.
struct FormerManifold {
  Vec3 normal, friction_impulse, rolling_impulse;
  float twist_impulse, load_age;
  std::uint32_t triangle, sliding;
  unsigned left;  // bits, by point: not yet matched
  WideInt<kMaxManifoldPoints> feature;
  float normal_impulse[kMaxManifoldPoints], mean_impulse[kMaxManifoldPoints];
  Vec3W<kMaxManifoldPoints> anchor;
};

void read_points(const Manifold& from, FormerManifold& to) {
  constexpr int W = kMaxManifoldPoints;
  Records<W> points, anchors;
  for (int k = 0; k < W; ++k) {
    points[k] = floats(&from.points[k]);
    anchors[k] = floats(&from.anchors[k]);
  }
  Wide<W> names[4], impulses[4], positions[4];
  read_four<W>(points, 4, names);
  read_four<W>(points, 8, impulses);
  read_four<W>(anchors, 0, positions);
  to.feature = bit_pattern(names[3]);
  impulses[0].store_unaligned(to.normal_impulse);
  impulses[2].store_unaligned(to.mean_impulse);
  to.anchor = {positions[0], positions[1], positions[2]};
}

void read_former(const Manifold& from, FormerManifold& to) {
  to.normal = from.normal;
  to.friction_impulse = from.friction_impulse;
  to.rolling_impulse = from.rolling_impulse;
  to.twist_impulse = from.twist_impulse;
  to.load_age = from.load_age;
  to.triangle = from.triangle;
  to.sliding = from.sliding;
  to.left = (1u << from.count) - 1u;
  read_points(from, to);
}

// Projects the impulses that a manifold carries from step to step onto the new tangent plane.
void carry_friction_impulses(const FormerManifold& from, Manifold& to) {
  to.friction_impulse = from.friction_impulse - dot(from.friction_impulse, to.normal) * to.normal;
  to.rolling_impulse = from.rolling_impulse - dot(from.rolling_impulse, to.normal) * to.normal;
  to.twist_impulse = from.twist_impulse;
  to.load_age = from.load_age;
  to.sliding = from.sliding;
}

template <int kRoom>
struct Former {
  // Not cleared: only counted ones are read.
  union {
    FormerManifold manifolds[kRoom];
  };
  int count = 0;
  bool continued[kRoom] = {};

  explicit Former(std::span<const Manifold> before) : count(int(before.size())) {
    for (int m = 0; m < count; ++m) read_former(before[std::size_t(m)], manifolds[m]);
  }
};

// The old manifold that continues in the new one, or -1. A single manifold always continues.
template <int kRoom>
int find_former(const Former<kRoom>& former, const Manifold& manifold) {
  if constexpr (kRoom == 1) return former.count == 1 ? 0 : -1;
  int best = -1;
  float best_score = kSameSideCosine;
  for (int m = 0; m < former.count; ++m) {
    if (former.continued[m]) continue;
    const float same_triangle = former.manifolds[m].triangle == manifold.triangle ? 0.5f : 0.0f;
    const float score = dot(former.manifolds[m].normal, manifold.normal) + same_triangle;
    if (score > best_score) {
      best = m;
      best_score = score;
    }
  }
  return best;
}

void inherit_impulses(FormerManifold& former, int k, ContactPointState& point) {
  former.left &= ~(1u << k);
  point.normal_impulse = former.normal_impulse[k];
  point.mean_impulse = former.mean_impulse[k];
}

// Matches points by feature within the old manifold. Returns the matched points as bits.
unsigned match_by_feature(FormerManifold& former, Manifold& manifold) {
  unsigned matched = 0;
  for (int i = 0; i < manifold.count; ++i) {
    const WideInt<kMaxManifoldPoints> name(std::int32_t(manifold.points[i].feature));
    const unsigned same = to_bits(former.feature == name) & former.left;
    if (same == 0) continue;
    inherit_impulses(former, std::countr_zero(same), manifold.points[i]);
    matched |= 1u << i;
  }
  return matched;
}

// Matches the remaining points by position, among all points on the same side: features change their names when another
// edge comes first, but the load stays where it was.
template <int kRoom>
void match_by_position(Former<kRoom>& former, Manifold& manifold, unsigned matched, float radius) {
  for (int i = 0; i < manifold.count; ++i) {
    if ((matched >> i & 1u) != 0) continue;
    int best_m = -1, best_k = -1;
    float nearest = square(radius);
    for (int m = 0; m < former.count; ++m) {
      const FormerManifold& old = former.manifolds[m];
      if (old.left == 0 || dot(old.normal, manifold.normal) < kSameSideCosine) continue;
      const Wide<kMaxManifoldPoints> away =
          length_squared(old.anchor - splat<kMaxManifoldPoints>(manifold.anchors[i].position));
      unsigned near = to_bits(away < Wide<kMaxManifoldPoints>(nearest)) & old.left;
      for (; near != 0; near &= near - 1) {
        const int k = std::countr_zero(near);
        if (!(away[k] < nearest)) continue;
        nearest = away[k];
        best_m = m;
        best_k = k;
      }
    }
    if (best_m >= 0) inherit_impulses(former.manifolds[best_m], best_k, manifold.points[i]);
  }
}

// From the frame of an update to world axes and to the frame of the anchors.
struct OutputFrames {
  const PairView& view;
  bool anchors_in_b;  // B's body frame, else A's
  Quat anchor_orientation;
  Vec3 anchor_center;

  OutputFrames(const PairInput& pair, const PairView& seen) : view(seen) {
    anchors_in_b = frame_is_b(pair.shape_a->shape, pair.shape_b->shape);
    anchor_orientation = (anchors_in_b ? pair.body_b : pair.body_a)->orientation;
    anchor_center = (anchors_in_b ? pair.center_b : pair.center_a)->position;
  }
};

QuatW<4> splat(Quat q) { return {q.x, q.y, q.z, q.w}; }

// Writes the four points of a manifold side by side. Unused points and all impulses become zero.
void write_points(const LocalManifold& local, const OutputFrames& frames, Manifold& out) {
  constexpr int W = kMaxManifoldPoints;
  Records<W> from;
  Targets<W> points, anchors;
  WideInt<W> feature;
  for (int i = 0; i < W; ++i) {
    from[i] = floats(&local.points[i]);
    feature.set(i, std::int32_t(local.points[i].feature));
    points[i] = floats(&out.points[i]);
    anchors[i] = floats(&out.anchors[i]);
  }
  const Mask<W> used = Mask<W>::of_bits((1u << local.count) - 1u);
  Wide<W> found[4];
  read_four<W>(from, 0, found);
  const Vec3W<W> position =
      rotate(splat(frames.view.frame_orientation), Vec3W<W>{found[0], found[1], found[2]});
  const Vec3W<W> a = keep(used, position + splat<W>(frames.view.frame_from_a));
  const Vec3W<W> b = keep(used, position + splat<W>(frames.view.frame_from_b));
  const Vec3W<W> arm = rotate_inverse(splat(frames.anchor_orientation), frames.anchors_in_b ? b : a);
  const Vec3W<W> anchor = keep(used, arm + splat<W>(frames.anchor_center));
  const Wide<W> separation = keep(used, found[3]), zero(0.0f);
  write_four<4, W>(points, 0, {a.x, a.y, a.z, separation});
  write_four<4, W>(points, 4, {b.x, b.y, b.z, from_bit_pattern(feature & to_int(used))});
  write_four<4, W>(points, 8, {zero, zero, zero, zero});
  write_four<4, W>(anchors, 0, {anchor.x, anchor.y, anchor.z, separation});
}

// Writes a whole manifold without history.
void write_manifold(const LocalManifold& local, const OutputFrames& frames, Manifold& out) {
  out.normal = rotate(frames.view.frame_orientation, local.normal);
  out.count = local.count;
  out.load_age = 0.0f;
  out.friction_impulse = {};
  out.twist_impulse = 0.0f;
  out.rolling_impulse = {};
  out.triangle = local.triangle;
  out.total_friction = {};
  out.sliding = 0;
  out.anchor_normal = rotate_inverse(frames.anchor_orientation, out.normal);
  write_points(local, frames, out);
}

// A contact that rolls on a rim may move farther in a step than any match allows, and the lowest point of a rim changes
// its feature at a corner. If exactly one point is unmatched on each side, the two are the same point.
template <int kRoom>
void match_rolling(Former<kRoom>& former, Manifold& manifold, unsigned matched_before) {
  if (former.count != 1) return;
  int unmatched = -1, unmatched_old = -1;
  for (int i = 0; i < manifold.count; ++i) {
    if ((matched_before >> i & 1u) != 0 || manifold.points[i].normal_impulse != 0.0f) continue;
    if (unmatched >= 0) return;
    unmatched = i;
  }
  FormerManifold& old = former.manifolds[0];
  for (int k = 0; k < kMaxManifoldPoints; ++k) {
    if ((old.left >> k & 1u) == 0 || old.normal_impulse[k] == 0.0f) continue;
    if (unmatched_old >= 0) return;
    unmatched_old = k;
  }
  if (unmatched >= 0 && unmatched_old >= 0 && dot(old.normal, manifold.normal) >= kSameSideCosine)
    inherit_impulses(old, unmatched_old, manifold.points[unmatched]);
}

template <int kRoom>
void write_manifolds(const Found<kRoom>& found, const PairInput& pair, const PairView& view) {
  Manifold* const out = pair.manifolds;
  Former<kRoom> former(manifolds_of(pair));
  const OutputFrames frames(pair, view);
  unsigned matched[kRoom] = {};
  for (int m = 0; m < found.count; ++m) {
    write_manifold(found.manifolds[m], frames, out[m]);
    const int old = find_former(former, out[m]);
    if (old < 0) continue;
    former.continued[old] = true;
    carry_friction_impulses(former.manifolds[old], out[m]);
    matched[m] = match_by_feature(former.manifolds[old], out[m]);
  }
  for (int m = 0; m < found.count; ++m)
    match_by_position(former, out[m], matched[m], kMatchDistance * view.size);
  if (found.count == 1 && (has_rim(pair.shape_a->shape) || has_rim(pair.shape_b->shape)))
    match_rolling(former, out[0], matched[0]);
  // Unused manifolds keep nothing of the past.
  for (int m = found.count; m < former.count; ++m) out[m] = Manifold{};
  pair.contact->manifold_count = std::uint16_t(found.count);
}

void save_view(Contact& contact, const PairView& view, float cached_distance) {
  contact.cached_distance = cached_distance;
  contact.size = view.size;
  contact.seen_a_from_b = view.a_from_b;
}

bool is_clear_of_surface(const PairInput& pair, const PairView& view, float max_distance) {
  const Transform a_from_b =
      inverse(pair.shape_a->body_from_shape) * view.a_from_b * pair.shape_b->body_from_shape;
  return is_clear_of_surface(pair.shape_a->shape, pair.shape_b->shape, a_from_b, max_distance);
}

// The distance that an update searched, if it dropped all points beyond `point_limit` and the nearest of those is at
// `left_out`. Separations are measured along one normal, which is not always that of the nearest features; hence the
// factor.
float searched_distance(float max_distance, float point_limit, float left_out) {
  return left_out < max_distance ? point_limit + 0.75f * (left_out - point_limit) : max_distance;
}

// Updates a contact of two convex shapes, or a plane and a convex shape. Returns the distance that it searched.
float compute_convex_manifold(const PairInput& pair, const PairView& view, Found<1>& found) {
  float point_limit = view.speculative + kPointMargin * view.size;
  if (pair.contact->manifold_count == 0 && view.max_approach < kSlow * view.size) {
    const float far_distance = view.speculative + kFarSlack * view.size;
    collide_in_view(pair, view, far_distance, nullptr, found);
    // Far points may have displaced near ones in the manifold, which is then useless.
    if (is_beyond(found, point_limit))
      return searched_distance(far_distance, point_limit, remove_far_points(found, point_limit));
  }
  float max_distance = view.speculative + kNearSlack * view.size;
  if (is_sharp_box(pair.shape_a->shape) && is_sharp_box(pair.shape_b->shape)) {
    max_distance = collide_boxes_in_view(pair, view, max_distance, found);
  } else {
    collide_in_view(pair, view, max_distance, nullptr, found);
  }
  if (found.count > 0 && farthest_of(found.manifolds[0]) > min_near(view))
    point_limit = near_along(view, found.manifolds[0].normal);
  return searched_distance(max_distance, point_limit, remove_far_points(found, point_limit));
}

// Updates a contact with a mesh or height field. Returns the distance that it searched.
float compute_mesh_manifolds(const PairInput& pair, const PairView& view, CachedTriangles* cached_triangles,
                             Found<kMaxMeshManifolds>& found) {
  if (pair.contact->manifold_count == 0) {
    const float far_distance = view.speculative + kClearSteps * view.max_approach + kFarSlack * view.size;
    if (is_clear_of_surface(pair, view, far_distance)) return far_distance;
  }
  const float point_limit = view.speculative + kPointMargin * view.size,
              max_distance = view.speculative + kNearSlack * view.size;
  collide_in_view(pair, view, max_distance, cached_triangles, found);
  return searched_distance(max_distance, point_limit, remove_far_points(found, point_limit));
}

// kRoom is the contact's manifold_room.
template <int kRoom>
void update_in_room(const PairInput& pair, const PairView& view, CachedTriangles* cached_triangles) {
  Found<kRoom> found;
  float cached_distance = 0.0f;
  if constexpr (kRoom == 1) {
    cached_distance = compute_convex_manifold(pair, view, found);
  } else {
    cached_distance = compute_mesh_manifolds(pair, view, cached_triangles, found);
  }
  if (found.count > 0 || pair.contact->manifold_count > 0) write_manifolds(found, pair, view);
  save_view(*pair.contact, view, cached_distance);
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

bool test_sensor_overlap(const PairInput& pair, const PairView& view) {
  const Shape& a = pair.shape_a->shape;
  const Shape& b = pair.shape_b->shape;
  if (!is_convex(a.kind) && !is_convex(b.kind)) return surfaces_overlap(a, b, view.shapes_a_from_b);
  Found<kMaxMeshManifolds> found;
  collide_in_view(pair, view, 0.0f, nullptr, found);
  remove_far_points(found, 0.0f);
  return found.count > 0;
}

bool compute_manifold(const PairInput& pair, const PairView& view, CachedTriangles* cached) {
  const bool loaded = carried_load(manifolds_of(pair));
  if (pair.contact->manifold_room == 1) {
    update_in_room<1>(pair, view, cached);
  } else {
    update_in_room<kMaxMeshManifolds>(pair, view, cached);
  }
  if (pair.contact->manifold_count == 0) return false;
  return loaded || is_near(manifolds_of(pair), kTouch * view.size);
}

}  // namespace gyre
