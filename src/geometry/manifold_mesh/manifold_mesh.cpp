// A convex shape against a mesh or height field, without ghost collisions. See collide_mesh in manifold.h.
//
// Each triangle near the shape is asked for its best direction (mesh_axis.h). If that is a normal of the surface, the
// contact stands. If it is not, it would push across a flat or concave edge, or the shape's middle is already behind the
// triangle; then the answer waits until all others are known:
//   - if a contact that stands has the triangle's own normal, the triangle belongs to the same stretch of ground and adds
//     its points to it;
//   - if moving the shape out of a contact that stands also frees it from this triangle, the triangle has no say (a box
//     that sank into the top of a wall must not be pushed out of the wall's side);
//   - else the shape leaves through the triangle's front, the least deep first.
// A contact at a sharp or open edge that lies buried under another face, level with it, is dropped: floors are often laid
// of pieces that are not joined.
//
// Sources: the Voronoi regions of edges and corners after C. Ericson, "Real-Time Collision Detection", 2005, chapter 5; the
// aim, no collisions with inner edges, is described in P. Terdiman, "Contact generation for meshes", 2006.
#include "geometry/manifold_mesh/manifold_mesh.h"

#include "base/container/sort.h"
#include "geometry/manifold_mesh/mesh_reject.h"
#include "geometry/manifold_mesh/mesh_candidates.h"
#include "geometry/manifold_mesh/mesh_cull.h"

#include <bit>

namespace gyre {
namespace {

// Relative to the size of the shape: a direction must be better than the face's normal by kAxisBias to be preferred to it; a
// rounded shape, whose nearest points are exact, needs less favour.
constexpr float kRoundBias = 1.0e-6f;
// ... and how much deeper than a contact a triangle may lie and still be covered by it.
constexpr float kCoverSlack = 1.0e-3f;
// Sine between directions that are one.
constexpr float kOneDirection = 1.0e-3f;
// A hull whose inner radius is less of its size is as thin as rounding: which of its edges' axes there are cannot be told.
constexpr float kBlade = 1.0e-4f;
// Cosines: normals that oppose each other; sharp edges.
constexpr float kOpposed = -0.1f;
constexpr float kSharp = 0.7f;

struct Standing {
  Vec3 normal;
  float separation;
  float lowest;  // of the core along the normal
};

struct Waiting {
  std::uint32_t id;
  int number;  // in the order in which they were looked at
  float face_separation;
  float best;  // its separation along its best direction
  bool behind;
  bool overlaps;
};

class MeshCollider {
 public:
  MeshCollider(const Shape& mesh, const Shape& b, const Transform& a_from_b, float max_separation,
               CachedTriangles* kept)
      : surface_(mesh),
        convex_(b, a_from_b.orientation),
        position_(a_from_b.position),
        max_separation_(max_separation),
        kept_(kept),
        bias_((convex_.radius() > 0.0f ? kRoundBias : kAxisBias) * convex_.size()),
        is_blade_(b.kind == ShapeKind::hull && b.hull->inner_radius < kBlade * convex_.size()) {}

  int run(LocalManifold* out) {
    find_candidates(kernels_, surface_, convex_, position_, max_separation_, kept_, candidates_);
    look_at_candidates();
    settle_waiting();
    settle_deep_patches();
    push_out();
    if (is_corner_missing()) look_for_corners();
    if (groups_.empty() && rim_separation_ < kUnbounded) add_over_face(triangle(rim_triangle_), on_rim_);
    add_by_valleys();
    return groups_.finish(position_, out);
  }

 private:
  void look_at_candidates();
  void look_at(const LocalTriangle& t, LocalConvex::Extent along_normal);
  void wait(const Waiting& found, const LocalTriangle& t);
  void settle_waiting();
  void settle_deep_patches();
  bool runs_through(const LocalTriangle& t) const;
  bool is_ground_between(const LocalTriangle& t, Vec3 low, Vec3 high) const;
  void note_overlap(const Waiting& found);
  void push_out();
  void add_corner(const LocalTriangle& t, float face_separation, float best);
  bool is_corner_missing() const;
  void look_for_corners();
  void settle(const Waiting& waiting);
  void settle(const Waiting& waiting, const LocalTriangle& t);
  bool is_ruled_out(const LocalTriangle& t, bool behind) const;

  LocalTriangle triangle(std::uint32_t id) const { return measured_triangle(surface_, id, position_, convex_); }
  void know_side(Vec3 normal);
  void know_side(Vec3 normal, LocalConvex::Extent along_normal);
  void know_face();
  bool rests_inside(const LocalTriangle& t, float face_separation);
  bool comes_through(const LocalTriangle& t, Vec3 corner) const;
  float face_separation(const LocalTriangle& t) const {
    return side_.lowest - dot(t.normal, t.v[0]) - convex_.radius();
  }

  bool stands_already(Vec3 normal) const;
  bool stand(Vec3 normal, float separation);
  void add_face(const LocalTriangle& t, float deepest = -kUnbounded);
  void add_over_face(const LocalTriangle& t, Vec3 on_core);
  void note_valley(const LocalTriangle& t);
  void add_by_valleys();
  bool add_deep_corners(const LocalTriangle& t);
  void add_feature(const LocalTriangle& t, const FeatureAxis& axis);
  bool lie_at_sharp_edge(const LocalTriangle& t, Vec3 direction) const;
  bool is_buried(const LocalTriangle& t, Vec3 direction) const;
  bool covers(const LocalTriangle& other, const LocalTriangle& t, Vec3 direction) const;

  const MeshKernels& kernels_ = select_mesh_kernels();
  Surface surface_;
  LocalConvex convex_;
  Vec3 position_;
  float max_separation_;
  CachedTriangles* kept_;
  float bias_;
  bool is_blade_;

  bool side_known_ = false;
  PlaneSide side_;
  int standing_count_ = 0;
  static constexpr int kStandingRoom = 32;
  // Not cleared, like those that wait: only the counted ones are ever read.
  union {
    Standing standing_[kStandingRoom];
  };
  int waiting_count_ = 0;
  Waiting waiting_[MeshCandidates::kRoom];
  // The first of those that wait, as they were placed when they were looked at.
  static constexpr int kPlacedRoom = 32;
  union {
    LocalTriangle placed_[kPlacedRoom];
  };
  // Of the triangles that the shape certainly overlaps, the one through whose front it leaves first; those with the
  // shape's middle before them first of all.
  Waiting exit_{0, 0, -__builtin_huge_valf(), 0.0f, true, false};
  // Triangles beyond valleys that the shape may reach; of more the last, which are the deepest.
  static constexpr int kValleyRoom = 8;
  int valley_count_ = 0;
  std::uint32_t valleys_[kValleyRoom];
  // The nearest triangle over which a point of a curved shape lies, although none of its facing polygon's does.
  float rim_separation_ = kUnbounded;
  std::uint32_t rim_triangle_ = 0;
  Vec3 on_rim_;
  // How deep the shape sits in the triangle that holds it most, by its best direction out, allowed or not.
  float overlap_ = 0.0f;
  // How near the nearest triangle is at least, by its best direction.
  float nearest_ = kUnbounded;
  MeshCandidates candidates_;
  // By groups of candidates: bits of those that are known to be out of reach.
  static_assert(MeshCandidates::kRoom % TriangleBatch::kCount == 0 && TriangleBatch::kCount == 8);
  std::uint8_t apart_[MeshCandidates::kRoom / TriangleBatch::kCount];
  MeshPoints points_;
  AxisScratch scratch_;
  ManifoldGroups groups_;
};

void MeshCollider::know_side(Vec3 normal) {
  if (!side_known_ || !(side_.normal == normal)) know_side(normal, convex_.extent(normal));
}

void MeshCollider::know_side(Vec3 normal, LocalConvex::Extent along_normal) {
  if (side_known_ && side_.normal == normal) return;
  side_.normal = normal;
  side_.lowest = along_normal.low;
  side_.highest = along_normal.high;
  side_.has_face = false;
  side_known_ = true;
}

void MeshCollider::know_face() {
  if (side_.has_face) return;
  convex_.face_towards(-side_.normal, side_.face);
  side_.has_face = true;
}

bool MeshCollider::stands_already(Vec3 normal) const {
  for (int i = 0; i < standing_count_; ++i) {
    if (standing_[i].normal == normal) return true;
  }
  return false;
}

// Returns whether it is the first with this normal.
bool MeshCollider::stand(Vec3 normal, float separation) {
  for (int i = 0; i < standing_count_; ++i) {
    if (dot(standing_[i].normal, normal) <= kSameNormal) continue;
    standing_[i].separation = min(standing_[i].separation, separation);
    return false;
  }
  if (standing_count_ == kStandingRoom) return false;
  know_side(normal);
  standing_[standing_count_++] = {normal, separation, side_.lowest};
  return true;
}

void MeshCollider::add_face(const LocalTriangle& t, float deepest) {
  points_.count = 0;
  for (int i = 0; i < 3; ++i) {
    if (convex_.lies_outside(t.outward[i], t.v[i], t.slack)) return note_valley(t);
  }
  know_side(t.normal);
  know_face();
  face_points(t, convex_, side_, max_separation_, points_);
  points_.drop_below(deepest);
  if (is_buried(t, t.normal)) points_.count = 0;
  groups_.add(t.normal, t.id, points_);
}

// The lowest corners of a shape that leans and has sunk deep lie under triangles that the shape itself does not touch: the
// ground goes on there in the same plane. Returns whether any point was added.
bool MeshCollider::add_deep_corners(const LocalTriangle& t) {
  know_side(t.normal);
  // No corner lies lower than the lowest.
  const float height = dot(t.normal, t.v[0]), enough = -0.9f * max_separation_;
  if (side_.lowest - height - convex_.radius() > enough + kCoverSlack * convex_.size() + t.slack)
    return false;
  know_face();
  const FacePolygon face = side_.face;
  const float reach = kCoverSlack * convex_.size();
  const Vec3 lowest = convex_.support(-t.normal);
  bool added = false;
  for (int k = -1; k < face.count; ++k) {
    const Vec3 corner = k < 0 ? lowest : face.vertices[k];
    const float above = dot(t.normal, corner) - height;
    // Triangles under less deep corners have all been looked at.
    if (above - convex_.radius() > enough) continue;
    const Vec3 foot = corner - above * t.normal + position_;
    std::uint32_t ids[16];
    const int count = find_triangles(surface_, grow({foot, foot}, reach), ids);
    for (int i = 0; i < count; ++i) {
      const LocalTriangle under = triangle(ids[i]);
      if (dot(under.normal, t.normal) <= kSameNormal) continue;
      add_face(under);
      added = added || points_.count > 0;
    }
  }
  return added;
}

// One point of the shape over a triangle, where its facing polygon has none: a cap is cut a little inside of its rim; the lowest corner may
// hang beside the border while another one lies over the face.
void MeshCollider::add_over_face(const LocalTriangle& t, Vec3 on_core) {
  const float separation = dot(t.normal, on_core - t.v[0]) - convex_.radius();
  if (separation > max_separation_) return;
  points_.count = 0;
  points_.add(on_core - (convex_.radius() + 0.5f * separation) * t.normal, separation, t.id);
  groups_.add(t.normal, t.id, points_);
}

void MeshCollider::add_feature(const LocalTriangle& t, const FeatureAxis& axis) {
  points_.count = 0;
  feature_points(t, convex_, axis, max_separation_, points_);
  if (is_buried(t, axis.direction)) points_.count = 0;
  groups_.add(axis.direction, t.id, points_);
}

// Whether the face `other` goes on, level, where the contact of `t` would stop the shape: `t` lies nowhere above it, the
// contact points lie on it, and going against the contact's direction one stays above it.
bool MeshCollider::covers(const LocalTriangle& other, const LocalTriangle& t, Vec3 direction) const {
  const float slack = kCoverSlack * convex_.size();
  const Vec3 sideways = direction - dot(direction, other.normal) * other.normal;
  if (length_squared(sideways) < kOneDirection * kOneDirection ||
      dot(other.normal, convex_.center() - other.v[0]) < 0.0f)
    return false;
  for (int i = 0; i < 3; ++i) {
    if (dot(other.normal, t.v[i] - other.v[0]) > slack) return false;
  }
  const Vec3 step = normalized(sideways);
  for (int k = 0; k < points_.count; ++k) {
    // From the middle of the two surfaces down to the triangle's, then a step to where the contact would push.
    const ManifoldPoint& point = points_.points[k];
    const Vec3 p = point.position - 0.5f * point.separation * direction;
    if (absolute(dot(other.normal, p - other.v[0])) > slack) return false;
    const Vec3 ahead = p + slack * step;
    for (int i = 0; i < 3; ++i) {
      if (dot(other.outward[i], ahead - other.v[i]) > 0.0f) return false;
    }
  }
  return true;
}

// Whether all points lie along one sharp or open edge of the triangle.
bool MeshCollider::lie_at_sharp_edge(const LocalTriangle& t, Vec3 direction) const {
  const float slack = 2.0f * kCoverSlack * convex_.size();
  for (int i = 0; i < 3; ++i) {
    if (t.edge[i] != EdgeKind::open &&
        !(t.edge[i] == EdgeKind::convex && dot(t.normal, t.neighbor_normal[i]) < kSharp))
      continue;
    bool all = true;
    for (int k = 0; k < points_.count; ++k) {
      const Vec3 p = points_.points[k].position - 0.5f * points_.points[k].separation * direction;
      all = all && dot(t.outward[i], p - t.v[i]) > -slack;
    }
    if (all) return true;
  }
  return false;
}

bool MeshCollider::is_buried(const LocalTriangle& t, Vec3 direction) const {
  if (points_.count == 0 || !lie_at_sharp_edge(t, direction)) return false;
  const Vec3 p = points_.points[0].position - 0.5f * points_.points[0].separation * direction + position_;
  const Aabb near = grow({p, p}, kCoverSlack * convex_.size());
  for (int i = 0; i < candidates_.count; ++i) {
    const std::uint32_t id = candidates_.ids[i];
    if (id != t.id && overlap(surface_.box(id), near) && covers(triangle(id), t, direction)) return true;
  }
  return false;
}

// Whether a lowest corner of the shape lies so far inside the triangle's sides that no direction but the face's normal can be
// better: a disc around its foot, as wide as the corner is deep, belongs to the triangle. A needle whose end is deep below may have come
// there beside the triangle: on its way to the middle it must pass through.
bool MeshCollider::rests_inside(const LocalTriangle& t, float face_separation) {
  const float room = max(-face_separation - convex_.radius(), 0.0f) + t.slack;
  if (convex_.has_vertices() &&
      !convex_.has_low_vertex_inside(t.normal, side_.lowest + bias_, t.outward, t.v, room))
    return false;
  know_face();
  for (int k = 0; k < side_.face.count; ++k) {
    const Vec3 corner = side_.face.vertices[k];
    if (dot(t.normal, corner) > side_.lowest + bias_) continue;
    bool inside = true;
    for (int i = 0; i < 3; ++i) inside = inside && dot(t.outward[i], corner - t.v[i]) < -room;
    if (inside && comes_through(t, corner)) return true;
  }
  return false;
}

bool MeshCollider::comes_through(const LocalTriangle& t, Vec3 corner) const {
  const float below = dot(t.normal, t.v[0] - corner);
  if (below < kCoverSlack * convex_.size()) return true;
  const float above = dot(t.normal, convex_.center() - t.v[0]);
  const Vec3 crossing = lerp(corner, convex_.center(), below / (below + above));
  bool inside = true;
  for (int i = 0; i < 3; ++i) inside = inside && dot(t.outward[i], crossing - t.v[i]) <= t.slack;
  return inside;
}

void MeshCollider::look_at_candidates() {
  TriangleBatch placed;
  for (int i = 0; i < candidates_.count; i += TriangleBatch::kCount) {
    const std::uint32_t* ids = candidates_.ids + i;
    const int count = min(candidates_.count - i, TriangleBatch::kCount);
    load_triangles(kernels_, surface_, ids, count, position_, convex_, max_separation_, placed);
    apart_[i / TriangleBatch::kCount] = std::uint8_t(placed.apart);
    for (unsigned rest = placed.touchable; rest != 0; rest &= rest - 1) {
      const int lane = std::countr_zero(rest);
      look_at(batch_triangle(surface_, ids[lane], placed, lane), {placed.low[lane], placed.high[lane]});
    }
  }
}

void MeshCollider::look_at(const LocalTriangle& t, LocalConvex::Extent along_normal) {
  know_side(t.normal, along_normal);
  const float height = dot(t.normal, t.v[0]);
  const float face = face_separation(t);
  const bool inside_patch = t.flat_corners == 7 && t.edge[0] == EdgeKind::flat &&
                            t.edge[1] == EdgeKind::flat && t.edge[2] == EdgeKind::flat;
  // Ground that is known to carry the shape: no other direction can come of a triangle without real edges.
  if (inside_patch && stands_already(t.normal)) return add_face(t);
  const bool behind = dot(t.normal, convex_.center()) < height;
  if (!behind && rests_inside(t, face)) {
    add_face(t);
    if (stand(t.normal, face)) add_deep_corners(t);
    return;
  }
  if (!behind && is_round_rejected(surface_, t, convex_, face)) {
    if (has_valley_points(t, convex_, max_separation_))
      wait({t.id, waiting_count_, face, face, behind, false}, t);
    return;
  }
  AxisSearch axes = search_axes(surface_, t, convex_, face, max_separation_, scratch_);
  if (axes.best <= 0.0f && is_blade_) {
    const AxisSearch nearest = search_nearest(surface_, t, convex_, face, max_separation_, scratch_);
    if (nearest.best > 0.0f) axes = nearest;
  }
  if (axes.best > max_separation_) return;
  if (!behind) nearest_ = min(nearest_, axes.best);
  const Waiting found{t.id, waiting_count_, face, axes.best, behind, axes.best <= 0.0f};
  note_overlap(found);
  const float allowed = max(face, axes.feature.separation);
  if (behind || allowed < axes.best - kAxisBias * convex_.size()) return wait(found, t);
  if (face >= axes.feature.separation - bias_) {
    add_face(t);
    if (points_.count == 0 && axes.over_face && face < rim_separation_) {
      rim_separation_ = face;
      rim_triangle_ = t.id;
      on_rim_ = axes.on_core;
    }
    // Beside an edge the face alone may have no point, or none that is deep enough.
    const float wanted = axes.feature.separation + 0.1f * kAxisBias * convex_.size();
    if (axes.feature.separation < axes.best - kAxisBias * convex_.size() || points_.deepest() <= wanted) {
      if (!inside_patch && axes.best > 0.0f) add_corner(t, face, axes.best);
      if (stand(t.normal, face)) add_deep_corners(t);
      return;
    }
  }
  stand(axes.feature.direction, axes.feature.separation);
  add_feature(t, axes.feature);
}

void MeshCollider::note_valley(const LocalTriangle& t) {
  if (has_valley_points(t, convex_, max_separation_)) valleys_[valley_count_++ % kValleyRoom] = t.id;
}

// What rolls comes from one slope onto the next within a step, and would sink into it before it lies over it. After all others, and never
// nearer than they are: such points are no nearest ones.
void MeshCollider::add_by_valleys() {
  const float nearest = groups_.deepest();
  for (int i = 0; i < min(valley_count_, kValleyRoom); ++i) {
    const LocalTriangle t = triangle(valleys_[i]);
    points_.count = 0;
    valley_points(t, convex_, max_separation_, points_);
    points_.drop_below(nearest);
    groups_.add(t.normal, t.id, points_);
  }
}

void MeshCollider::wait(const Waiting& found, const LocalTriangle& t) {
  if (waiting_count_ < kPlacedRoom) placed_[waiting_count_] = t;
  waiting_[waiting_count_++] = found;
}

void MeshCollider::settle(const Waiting& waiting) {
  if (waiting.number < kPlacedRoom) return settle(waiting, placed_[waiting.number]);
  settle(waiting, triangle(waiting.id));
}

void MeshCollider::settle(const Waiting& waiting, const LocalTriangle& t) {
  for (int i = 0; i < standing_count_; ++i) {
    if (dot(standing_[i].normal, t.normal) > kSameNormal) return add_face(t);
  }
  if (is_ruled_out(t, waiting.behind)) return;
  // What is apart from the triangle may still reach below its plane, beside it or under its edge: nothing to be pushed out.
  add_face(t, waiting.overlaps ? -kUnbounded : -kCoverSlack * convex_.size());
  if (!waiting.overlaps && !waiting.behind) add_corner(t, waiting.face_separation, waiting.best);
  bool added = points_.count > 0;
  if ((added || waiting.overlaps) && add_deep_corners(t)) added = true;
  if (added) stand(t.normal, waiting.face_separation);
}

// Whether a contact that stands says better what to do about the triangle.
bool MeshCollider::is_ruled_out(const LocalTriangle& t, bool behind) const {
  const float slack = kCoverSlack * convex_.size();
  for (int i = 0; i < standing_count_; ++i) {
    const Standing& standing = standing_[i];
    if (behind && dot(standing.normal, t.normal) < kOpposed) return true;
    const float highest =
        max(dot(standing.normal, t.v[0]), max(dot(standing.normal, t.v[1]), dot(standing.normal, t.v[2])));
    const float separation = standing.lowest - highest - convex_.radius();
    if (separation >= standing.separation - slack) return true;
  }
  return false;
}

void MeshCollider::settle_waiting() {
  Waiting scratch[MeshCandidates::kRoom];
  // The least deep first; candidates came in the order of their numbers, and the sort keeps that.
  merge_sort(std::span<Waiting>(waiting_, std::size_t(waiting_count_)), std::span<Waiting>(scratch),
             [](const Waiting& a, const Waiting& b) { return a.face_separation > b.face_separation; });
  for (int i = 0; i < waiting_count_; ++i) settle(waiting_[i]);
}

// Whether the shape comes through the surface there, and not beside its border: where a line from its lowest point, to its highest or to
// its middle if that lies in front, crosses the plane there must be ground.
bool MeshCollider::runs_through(const LocalTriangle& t) const {
  const Vec3 low = convex_.support(-t.normal);
  return is_ground_between(t, low, convex_.support(t.normal)) || is_ground_between(t, low, convex_.center());
}

bool MeshCollider::is_ground_between(const LocalTriangle& t, Vec3 low, Vec3 high) const {
  const float below = dot(t.normal, t.v[0] - low), above = dot(t.normal, high - t.v[0]);
  if (!(below > 0.0f && above > 0.0f)) return false;
  const Vec3 crossing = lerp(low, high, below / (below + above)) + position_;
  const float slack = kCoverSlack * convex_.size();
  std::uint32_t ids[16];
  const int count = find_triangles(surface_, grow({crossing, crossing}, slack), ids);
  for (int i = 0; i < count; ++i) {
    const LocalTriangle other = triangle(ids[i]);
    const Vec3 p = crossing - position_;
    bool inside = dot(other.normal, t.normal) > kSameNormal;
    for (int k = 0; k < 3; ++k) inside = inside && dot(other.outward[k], p - other.v[k]) <= slack;
    if (inside) return true;
  }
  return false;
}

// A shape that leans and pierces a large flat patch may have neither a corner above nor a triangle in question below.
void MeshCollider::settle_deep_patches() {
  for (int i = 0; i < candidates_.deep_patch_count; ++i) {
    const LocalTriangle t = triangle(candidates_.deep_patches[i]);
    know_side(t.normal);
    const bool behind = dot(t.normal, convex_.center() - t.v[0]) < 0.0f;
    if (is_ruled_out(t, behind) || !runs_through(t)) continue;
    if (add_deep_corners(t)) stand(t.normal, face_separation(t));
  }
}

void MeshCollider::note_overlap(const Waiting& found) {
  if (!found.overlaps) return;
  if (!found.behind) overlap_ = min(overlap_, found.best);
  const bool better =
      exit_.behind == found.behind ? found.face_separation > exit_.face_separation : exit_.behind;
  if (better) exit_ = found;
}

// The shape overlaps triangles, but none of them lies under one of its corners, as when a blunt hull has sunk across a small
// hill: it leaves through the front of one, pushed at its lowest point.
void MeshCollider::push_out() {
  const bool in_question =
      overlap_ < -2.0f * kAxisBias * convex_.size() && groups_.deepest() > 0.1f * overlap_;
  if (!exit_.overlaps || !(in_question || groups_.empty())) return;
  const LocalTriangle t = triangle(exit_.id);
  const Vec3 lowest = convex_.support(-t.normal);
  const float separation = dot(t.normal, lowest - t.v[0]) - convex_.radius();
  points_.count = 0;
  points_.add(lowest - (convex_.radius() + 0.5f * separation) * t.normal, separation, t.id);
  groups_.add(t.normal, t.id, points_);
}

// Where the lowest corner of a polyhedron lies a little beside the triangle, the points above its face are all farther than
// the edge is, and an axis search does not know the direction between that corner and the edge. Keeps `points_`.
void MeshCollider::add_corner(const LocalTriangle& t, float face_separation, float best) {
  const float slack = kAxisBias * convex_.size();
  // What lies apart along some direction is no nearer than that, so that no search need tell.
  if (points_.deepest() <= best + 0.9f * slack) return;
  if (points_.count == 0 || convex_.face_count() == 0 || points_.deepest() <= face_separation + slack) return;
  const AxisSearch axes = search_nearest(surface_, t, convex_, face_separation, max_separation_, scratch_);
  if (axes.best > max_separation_ || axes.feature.separation < axes.best ||
      points_.deepest() <= axes.best + slack)
    return;
  const MeshPoints kept = points_;
  add_feature(t, axes.feature);
  points_ = kept;
}

// Whether nothing was found, or the nearest triangle is nearer than all that was.
bool MeshCollider::is_corner_missing() const {
  if (groups_.empty()) return true;
  return convex_.vertex_count() > 2 && nearest_ > 0.0f &&
         nearest_ < groups_.deepest() - kAxisBias * convex_.size();
}

// What comes near where no contact was found, such as a polyhedron with a corner beside an edge: axis searches know faces and pairs
// of edges only, so what they tell may be nearer than any point that was found along their directions.
void MeshCollider::look_for_corners() {
  for (int i = 0; i < candidates_.count; ++i) {
    if ((apart_[i / TriangleBatch::kCount] >> i % TriangleBatch::kCount & 1) != 0) continue;
    LocalTriangle t = local_triangle(surface_, candidates_.ids[i], position_, convex_);
    know_side(t.normal);
    const float face = face_separation(t);
    if (face > max_separation_) continue;
    measure_edges(t);
    const AxisSearch axes = search_nearest(surface_, t, convex_, face, max_separation_, scratch_);
    if (axes.best > min(max_separation_, groups_.deepest())) continue;
    if (axes.over_face && dot(t.normal, axes.on_core - t.v[0]) > 0.0f) add_over_face(t, axes.on_core);
    if (axes.feature.separation >= axes.best - t.slack) add_feature(t, axes.feature);
  }
}

}  // namespace

int collide_mesh(const Shape& mesh, const Shape& b, const Transform& a_from_b, float max_separation,
                 LocalManifold* out, CachedTriangles* kept) {
  if (!is_convex(b.kind)) return 0;
  return MeshCollider(mesh, b, a_from_b, max_separation, kept).run(out);
}

bool is_clear_of_surface(const Shape& a, const Shape& b, const Transform& a_from_b, float reach) {
  const bool swapped = is_convex(a.kind);
  const Shape& convex = swapped ? a : b;
  const Shape& other = swapped ? b : a;
  if (!is_convex(convex.kind) || other.kind < ShapeKind::mesh) return false;
  const Aabb box = bounds(convex, swapped ? inverse(a_from_b) : a_from_b);
  const float rounding = 1.0e-6f * max(largest(absolute(box.low)), largest(absolute(box.high)));
  return !has_triangle(Surface(other), grow(box, reach + rounding));
}

}  // namespace gyre
