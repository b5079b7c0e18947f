// Full looks, and the matching of new points with old ones. See contact_update.h.
#include "collision/contact/contact_update.h"

#include "collision/broadphase/fat_box.h"
#include "collision/contact/contact_apart_lanes.h"
#include "collision/contact/manifold_layout.h"
#include "collision/contact/match_manifold.h"
#include "geometry/manifold/manifold_box.h"
#include "geometry/manifold_mesh/manifold_mesh.h"
#include "geometry/query/surface_overlap.h"

#include <bit>

namespace gyre {
namespace {

// All lengths in sizes of the pair (the smaller shape's inner radius).
// Points farther apart than kKept beyond the speculative distance are not kept, only how near they were.
constexpr float kKept = 0.005f;
// Above a mesh a look at boxes alone comes first, as far as the pair goes in some steps: what falls need not look in each.
constexpr float kClearSteps = 4.0f;
// A new point takes over from an old one this near, whatever its feature is called, if the cosine between their normals is
// at least kSameSide.
constexpr float kMatch = 0.1f, kSameSide = 0.8f;

bool has_rim(const Shape& shape) {
  return shape.kind == ShapeKind::cylinder || shape.kind == ShapeKind::cone;
}

std::span<Manifold> manifolds_of(const PairInput& pair) {
  return {pair.manifolds, pair.contact->manifold_count};
}
// Whether the anchors lie in the frame of B's body, else A's.
bool frame_is_b(const Shape& a, const Shape& b) {
  const Roundness<1> round_a{std::int32_t(a.kind), a.radius}, round_b{std::int32_t(b.kind), b.radius};
  return any(ManifoldMatch<1>(round_a, round_b).frame_is_b);
}

// ----------------------------------------------------------------------------------------------- what the shapes tell

template <int kRoom>
struct Found {
  // Not cleared: only the counted ones are ever read. Who finds them says everything of them but the triangle, which only
  // surfaces have.
  union {
    LocalManifold manifolds[kRoom];
  };
  int count = 0;

  Found() {
    for (LocalManifold& manifold : manifolds) manifold.triangle = 0;
  }
};

// A shape in the frame in which it is seen (View).
struct SeenShape {
  Shape moved;
  const Shape* shape;
  SeenShape(const Shape& own, const Shape& other) : shape(&own) {
    if (own.kind != ShapeKind::plane || !is_convex(other.kind)) return;
    moved = own;
    moved.offset = 0.0f;
    shape = &moved;
  }
};

template <int kRoom>
void ask_shapes(const PairInput& pair, const View& view, float reach, CachedTriangles* kept,
                Found<kRoom>& found) {
  const SeenShape a(pair.shape_a->shape, pair.shape_b->shape), b(pair.shape_b->shape, pair.shape_a->shape);
  found.count = collide_shapes(*a.shape, *b.shape, view.shapes_a_from_b, reach, pair.contact->cache,
                               found.manifolds, kept);
}

// How near surfaces must be for contacts along a normal to matter. What is no farther apart than `min_near` always does.
float min_near(const View& view) { return (kSpeculativeShare + kKept) * view.size; }
float near_along(const View& view, Vec3 normal) {
  return min_near(view) + min(min(view.closing.along(normal), view.way), kMaxApproach * view.size);
}

// As ask_shapes, of two sharp boxes; but nothing is found where they do not come near enough along the axis that parts them most.
// Then nothing is nearer than they are along that axis, and that is what is returned.
float ask_boxes(const PairInput& pair, const View& view, float reach, Found<1>& found) {
  const Shape& a = pair.shape_a->shape;
  const Shape& b = pair.shape_b->shape;
  PairCache& cache = pair.contact->cache;
  const boxes::Axis axis = view.axis.number != boxes::kNoAxis
                               ? view.axis
                               : find_box_axis(a, b, view.shapes_a_from_b, reach, cache);
  if (axis.separation > min_near(view) &&
      axis.separation > near_along(view, box_axis_normal(axis, view.shapes_a_from_b))) {
    cache.words[0] = std::uint32_t(axis.number + 1);
    found.count = 0;
    return min(axis.separation, reach);
  }
  collide_boxes_along(axis, a, b, view.shapes_a_from_b, reach, cache, found.manifolds[0]);
  found.count = found.manifolds[0].count > 0 ? 1 : 0;
  return reach;
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
        if (kept != i) manifold.points[kept] = manifold.points[i];
        ++kept;
      } else {
        left_out = min(left_out, manifold.points[i].separation);
      }
    }
    manifold.count = kept;
    if (kept == 0) continue;
    if (kept_manifolds != m) found.manifolds[kept_manifolds] = manifold;
    ++kept_manifolds;
  }
  found.count = kept_manifolds;
  return left_out;
}

float farthest_of(const LocalManifold& manifold) {
  float most = -kUnbounded;
  for (int i = 0; i < manifold.count; ++i) most = max(most, manifold.points[i].separation);
  return most;
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

// What goes on of a manifold that was there before this look; its points side by side. Those that it had not are zero.
struct FormerManifold {
  Vec3 normal, friction_impulse, rolling_impulse;
  float twist_impulse, load_age;
  std::uint32_t triangle, sliding;
  unsigned left;  // bits, by point: it has found no heir yet
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
  Wide<W> names[4], impulses[4], places[4];
  read_four<W>(points, 4, names);
  read_four<W>(points, 8, impulses);
  read_four<W>(anchors, 0, places);
  to.feature = bit_pattern(names[3]);
  impulses[0].store_unaligned(to.normal_impulse);
  impulses[2].store_unaligned(to.mean_impulse);
  to.anchor = {places[0], places[1], places[2]};
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

// What a manifold keeps from step to step, turned into the new tangent plane.
void carry_friction(const FormerManifold& from, Manifold& to) {
  to.friction_impulse = from.friction_impulse - dot(from.friction_impulse, to.normal) * to.normal;
  to.rolling_impulse = from.rolling_impulse - dot(from.rolling_impulse, to.normal) * to.normal;
  to.twist_impulse = from.twist_impulse;
  to.load_age = from.load_age;
  to.sliding = from.sliding;
}

template <int kRoom>
struct Former {
  // Not cleared: only the counted ones are ever read.
  union {
    FormerManifold manifolds[kRoom];
  };
  int count = 0;
  bool taken[kRoom] = {};

  explicit Former(std::span<const Manifold> before) : count(int(before.size())) {
    for (int m = 0; m < count; ++m) read_former(before[std::size_t(m)], manifolds[m]);
  }
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

void take_over(FormerManifold& former, int k, ContactPointState& point) {
  former.left &= ~(1u << k);
  point.normal_impulse = former.normal_impulse[k];
  point.mean_impulse = former.mean_impulse[k];
}

// By name within the former manifold; bit i of the result is set for each point that found its own.
unsigned match_by_feature(FormerManifold& former, Manifold& manifold) {
  unsigned matched = 0;
  for (int i = 0; i < manifold.count; ++i) {
    const WideInt<kMaxManifoldPoints> name(std::int32_t(manifold.points[i].feature));
    const unsigned same = to_bits(former.feature == name) & former.left;
    if (same == 0) continue;
    take_over(former, std::countr_zero(same), manifold.points[i]);
    matched |= 1u << i;
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
      const FormerManifold& old = former.manifolds[m];
      if (old.left == 0 || dot(old.normal, manifold.normal) < kSameSide) continue;
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
    if (best_m >= 0) take_over(former.manifolds[best_m], best_k, manifold.points[i]);
  }
}

// Where a look's manifolds go from their frame: into world axes, and into the frame of the anchors.
struct Placing {
  const View& view;
  bool anchors_in_b;  // B's body frame, else A's
  Quat anchor_turn;
  Vec3 anchor_center;

  Placing(const PairInput& pair, const View& seen) : view(seen) {
    anchors_in_b = frame_is_b(pair.shape_a->shape, pair.shape_b->shape);
    anchor_turn = (anchors_in_b ? pair.look_b : pair.look_a)->orientation;
    anchor_center = (anchors_in_b ? pair.center_b : pair.center_a)->position;
  }
};

QuatW<4> splat(Quat q) { return {q.x, q.y, q.z, q.w}; }

// The four points of a manifold side by side; those that are not in use become zero, as all impulses do.
void write_points(const LocalManifold& local, const Placing& placing, Manifold& out) {
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
  const Vec3W<W> place = rotate(splat(placing.view.frame_turn), Vec3W<W>{found[0], found[1], found[2]});
  const Vec3W<W> a = keep(used, place + splat<W>(placing.view.frame_from_a));
  const Vec3W<W> b = keep(used, place + splat<W>(placing.view.frame_from_b));
  const Vec3W<W> arm = rotate_inverse(splat(placing.anchor_turn), placing.anchors_in_b ? b : a);
  const Vec3W<W> anchor = keep(used, arm + splat<W>(placing.anchor_center));
  const Wide<W> separation = keep(used, found[3]), zero(0.0f);
  write_four<4, W>(points, 0, {a.x, a.y, a.z, separation});
  write_four<4, W>(points, 4, {b.x, b.y, b.z, from_bit_pattern(feature & to_int(used))});
  write_four<4, W>(points, 8, {zero, zero, zero, zero});
  write_four<4, W>(anchors, 0, {anchor.x, anchor.y, anchor.z, separation});
}

// All of a manifold, as if nothing had been there before.
void write_manifold(const LocalManifold& local, const Placing& placing, Manifold& out) {
  out.normal = rotate(placing.view.frame_turn, local.normal);
  out.count = local.count;
  out.load_age = 0.0f;
  out.friction_impulse = {};
  out.twist_impulse = 0.0f;
  out.rolling_impulse = {};
  out.triangle = local.triangle;
  out.total_friction = {};
  out.sliding = 0;
  out.anchor_normal = rotate_inverse(placing.anchor_turn, out.normal);
  write_points(local, placing, out);
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
  FormerManifold& old = former.manifolds[0];
  for (int k = 0; k < kMaxManifoldPoints; ++k) {
    if ((old.left >> k & 1u) == 0 || old.normal_impulse[k] == 0.0f) continue;
    if (orphan >= 0) return;
    orphan = k;
  }
  if (lonely >= 0 && orphan >= 0 && dot(old.normal, manifold.normal) >= kSameSide)
    take_over(old, orphan, manifold.points[lonely]);
}

template <int kRoom>
void write_manifolds(const Found<kRoom>& found, const PairInput& pair, const View& view) {
  Manifold* const out = pair.manifolds;
  Former<kRoom> former(manifolds_of(pair));
  const Placing placing(pair, view);
  unsigned matched[kRoom] = {};
  for (int m = 0; m < found.count; ++m) {
    write_manifold(found.manifolds[m], placing, out[m]);
    const int old = find_former(former, out[m]);
    if (old < 0) continue;
    former.taken[old] = true;
    carry_friction(former.manifolds[old], out[m]);
    matched[m] = match_by_feature(former.manifolds[old], out[m]);
  }
  for (int m = 0; m < found.count; ++m) match_by_place(former, out[m], matched[m], kMatch * view.size);
  if (found.count == 1 && (has_rim(pair.shape_a->shape) || has_rim(pair.shape_b->shape)))
    match_rolling(former, out[0], matched[0]);
  // Nothing of the past stays behind in what is not in use.
  for (int m = found.count; m < former.count; ++m) out[m] = Manifold{};
  pair.contact->manifold_count = std::uint16_t(found.count);
}

void note_look(Contact& contact, const View& view, float looked) {
  contact.looked = looked;
  contact.size = view.size;
  contact.seen_a_from_b = view.a_from_b;
}

bool is_clear_of_surface(const PairInput& pair, const View& view, float reach) {
  const Transform a_from_b =
      inverse(pair.shape_a->body_from_shape) * view.a_from_b * pair.shape_b->body_from_shape;
  return is_clear_of_surface(pair.shape_a->shape, pair.shape_b->shape, a_from_b, reach);
}

// How far a look reached that left out everything beyond `kept`, of which the nearest is `left_out` away. Points measure separation
// along one normal, which is not always that of the nearest features: hence only a part.
float looked_as_far(float reach, float kept, float left_out) {
  return left_out < reach ? kept + 0.75f * (left_out - kept) : reach;
}

// A look at what is no mesh. Returns how far it reached.
float compute_convex_manifold(const PairInput& pair, const View& view, Found<1>& found) {
  float kept = view.speculative + kKept * view.size;
  if (pair.contact->manifold_count == 0 && view.way < kSlow * view.size) {
    const float far_reach = view.speculative + kFarSlack * view.size;
    ask_shapes(pair, view, far_reach, nullptr, found);
    // Far points may have taken the places of near ones in the manifold: then it is no good.
    if (is_beyond(found, kept)) return looked_as_far(far_reach, kept, keep_near(found, kept));
  }
  float reach = view.speculative + kNearSlack * view.size;
  if (is_sharp_box(pair.shape_a->shape) && is_sharp_box(pair.shape_b->shape)) {
    reach = ask_boxes(pair, view, reach, found);
  } else {
    ask_shapes(pair, view, reach, nullptr, found);
  }
  if (found.count > 0 && farthest_of(found.manifolds[0]) > min_near(view))
    kept = near_along(view, found.manifolds[0].normal);
  return looked_as_far(reach, kept, keep_near(found, kept));
}

// A look at a mesh or height field.
float compute_mesh_manifolds(const PairInput& pair, const View& view, CachedTriangles* kept_triangles,
                             Found<kMaxMeshManifolds>& found) {
  if (pair.contact->manifold_count == 0) {
    const float far_reach = view.speculative + kClearSteps * view.way + kFarSlack * view.size;
    if (is_clear_of_surface(pair, view, far_reach)) return far_reach;
  }
  const float kept = view.speculative + kKept * view.size, reach = view.speculative + kNearSlack * view.size;
  ask_shapes(pair, view, reach, kept_triangles, found);
  return looked_as_far(reach, kept, keep_near(found, kept));
}

// kRoom is the contact's manifold_room.
template <int kRoom>
void look_in_room(const PairInput& pair, const View& view, CachedTriangles* kept_triangles) {
  Found<kRoom> found;
  float looked = 0.0f;
  if constexpr (kRoom == 1) {
    looked = compute_convex_manifold(pair, view, found);
  } else {
    looked = compute_mesh_manifolds(pair, view, kept_triangles, found);
  }
  if (found.count > 0 || pair.contact->manifold_count > 0) write_manifolds(found, pair, view);
  note_look(*pair.contact, view, looked);
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

bool test_sensor_overlap(const PairInput& pair, const View& view) {
  const Shape& a = pair.shape_a->shape;
  const Shape& b = pair.shape_b->shape;
  if (!is_convex(a.kind) && !is_convex(b.kind)) return surfaces_overlap(a, b, view.shapes_a_from_b);
  Found<kMaxMeshManifolds> found;
  ask_shapes(pair, view, 0.0f, nullptr, found);
  keep_near(found, 0.0f);
  return found.count > 0;
}

bool compute_manifold(const PairInput& pair, const View& view, CachedTriangles* kept) {
  const bool loaded = carried_load(manifolds_of(pair));
  if (pair.contact->manifold_room == 1) {
    look_in_room<1>(pair, view, kept);
  } else {
    look_in_room<kMaxMeshManifolds>(pair, view, kept);
  }
  if (pair.contact->manifold_count == 0) return false;
  return loaded || is_near(manifolds_of(pair), kTouch * view.size);
}

}  // namespace gyre
