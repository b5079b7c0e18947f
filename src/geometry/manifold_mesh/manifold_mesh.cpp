// A convex shape against a mesh or height field, without ghost collisions at internal edges. See collide_mesh in
// manifold.h.
//
// For each triangle near the shape, mesh_axis.h finds the best direction. If that is a normal of the surface, the
// contact is accepted. If it is not (it would push across a flat or concave edge), or if the centre of the shape is
// already behind the triangle, the triangle is deferred until all others are known:
// - if an accepted contact has the normal of the triangle, both belong to one piece of ground, and the triangle adds
//   its points to it;
// - if moving the shape out of an accepted contact also frees it from the triangle, the triangle is ignored (a box that
//   sank into the top of a wall must not be pushed out of its side);
// - else the shape leaves through the front of the triangle, the least deep triangle first.
// A contact at a sharp or open edge that lies below another face, level with it, is dropped: floors often consist of
// pieces that are not joined.
//
// Sources: the Voronoi regions of edges and corners after C. Ericson, "Real-Time Collision Detection", 2005, chapter 5;
// P. Terdiman, "Contact generation for meshes", 2006 (the aim: no collisions with internal edges).
#include "geometry/manifold_mesh/manifold_mesh.h"

#include "base/container/sort.h"
#include "geometry/manifold_mesh/mesh_candidates.h"
#include "geometry/manifold_mesh/mesh_cull.h"
#include "geometry/manifold_mesh/mesh_reject.h"

#include <bit>

namespace gyre {
namespace {

// By how much a direction must be better than the normal of the face to replace it, relative to the size of the shape:
// kAxisBias. The closest points of a rounded shape are exact, so it needs less.
constexpr float kRoundBias = 1.0e-6f;
// How much deeper than a contact a triangle may lie and still be covered by it, relative to the size of the shape.
constexpr float kCoverSlack = 1.0e-3f;
// Sine below which two directions are equal.
constexpr float kOneDirection = 1.0e-3f;
// Inner radius, relative to the size, below which a hull is as thin as rounding. The axes of its edges are then not
// reliable.
constexpr float kBlade = 1.0e-4f;
// Cosines: below kOpposed two normals oppose each other; below kSharp an edge is sharp.
constexpr float kOpposed = -0.1f;
constexpr float kSharp = 0.7f;

struct Accepted {
  Vec3 normal;
  float separation;
  float lowest;  // of the core, along the normal
};

struct Deferred {
  std::uint32_t id;
  int number;  // position in the order of the test
  float face_separation;
  float best;  // the separation along the best direction
  bool behind;
  bool overlaps;
};

class MeshCollider {
 public:
  MeshCollider(const Shape& mesh, const Shape& b, const Transform& a_from_b, float max_separation,
               CachedTriangles* cached)
      : surface_(mesh),
        convex_(b, a_from_b.orientation),
        position_(a_from_b.position),
        max_separation_(max_separation),
        cached_(cached),
        bias_((convex_.radius() > 0.0f ? kRoundBias : kAxisBias) * convex_.size()),
        is_blade_(b.kind == ShapeKind::hull && b.hull->inner_radius < kBlade * convex_.size()) {}

  int run(LocalManifold* out) {
    find_candidates(kernels_, surface_, convex_, position_, max_separation_, cached_, candidates_);
    test_candidates();
    resolve_deferred();
    resolve_deep_patches();
    push_out();
    if (is_corner_missing()) search_corners();
    if (groups_.empty() && rim_separation_ < kUnbounded) add_over_face(triangle(rim_triangle_), on_rim_);
    add_valley_points();
    return groups_.finish(position_, out);
  }

 private:
  void test_candidates();
  void test_triangle(const LocalTriangle& t, LocalConvex::Extent along_normal);
  void defer(const Deferred& found, const LocalTriangle& t);
  void resolve_deferred();
  void resolve_deep_patches();
  bool pierces(const LocalTriangle& t) const;
  bool has_surface_between(const LocalTriangle& t, Vec3 low, Vec3 high) const;
  void record_overlap(const Deferred& found);
  void push_out();
  void add_corner(const LocalTriangle& t, float face_separation, float best);
  bool is_corner_missing() const;
  void search_corners();
  void resolve(const Deferred& deferred);
  void resolve(const Deferred& deferred, const LocalTriangle& t);
  bool is_superseded(const LocalTriangle& t, bool behind) const;

  LocalTriangle triangle(std::uint32_t id) const {
    return measured_triangle(surface_, id, position_, convex_);
  }
  void set_side(Vec3 normal);
  void set_side(Vec3 normal, LocalConvex::Extent along_normal);
  void compute_face();
  bool has_corner_inside(const LocalTriangle& t, float face_separation);
  bool enters_through(const LocalTriangle& t, Vec3 corner) const;
  float face_separation(const LocalTriangle& t) const {
    return side_.lowest - dot(t.normal, t.v[0]) - convex_.radius();
  }

  bool is_accepted(Vec3 normal) const;
  bool accept(Vec3 normal, float separation);
  void add_face(const LocalTriangle& t, float deepest = -kUnbounded);
  void add_over_face(const LocalTriangle& t, Vec3 on_core);
  void record_valley(const LocalTriangle& t);
  void add_valley_points();
  bool add_deep_corners(const LocalTriangle& t);
  void add_feature(const LocalTriangle& t, const FeatureAxis& axis);
  bool are_at_sharp_edge(const LocalTriangle& t, Vec3 direction) const;
  bool is_buried(const LocalTriangle& t, Vec3 direction) const;
  bool covers(const LocalTriangle& other, const LocalTriangle& t, Vec3 direction) const;

  const MeshKernels& kernels_ = select_mesh_kernels();
  Surface surface_;
  LocalConvex convex_;
  Vec3 position_;
  float max_separation_;
  CachedTriangles* cached_;
  float bias_;
  bool is_blade_;

  bool side_known_ = false;
  PlaneSide side_;
  int accepted_count_ = 0;
  static constexpr int kAcceptedRoom = 32;
  // Not cleared, like the deferred ones: only the counted elements are read.
  union {
    Accepted accepted_[kAcceptedRoom];
  };
  int deferred_count_ = 0;
  Deferred deferred_[MeshCandidates::kRoom];
  // The first deferred triangles, in the form in which they were tested.
  static constexpr int kLocalRoom = 32;
  union {
    LocalTriangle local_triangles_[kLocalRoom];
  };
  // Of all triangles that the shape certainly overlaps, the one through whose front it leaves first. Triangles with the
  // centre of the shape before them take precedence.
  Deferred exit_{0, 0, -__builtin_huge_valf(), 0.0f, true, false};
  // Triangles beyond valleys that the shape may reach. If there are too many, the last and deepest ones stay.
  static constexpr int kValleyRoom = 8;
  int valley_count_ = 0;
  std::uint32_t valleys_[kValleyRoom];
  // The closest triangle that has a point of a curved shape over it, although no point of the shape's facing polygon
  // is.
  float rim_separation_ = kUnbounded;
  std::uint32_t rim_triangle_ = 0;
  Vec3 on_rim_;
  // The largest penetration of the shape in one triangle, along the best direction, allowed or not.
  float overlap_ = 0.0f;
  // The smallest separation of one triangle, along its best direction.
  float nearest_ = kUnbounded;
  MeshCandidates candidates_;
  // By groups of candidates: bits of those that are certainly too far away.
  static_assert(MeshCandidates::kRoom % TriangleBatch::kCount == 0 && TriangleBatch::kCount == 8);
  std::uint8_t apart_[MeshCandidates::kRoom / TriangleBatch::kCount];
  MeshPoints points_;
  AxisScratch scratch_;
  ManifoldGroups groups_{convex_.size()};
};

void MeshCollider::set_side(Vec3 normal) {
  if (!side_known_ || !(side_.normal == normal)) set_side(normal, convex_.extent(normal));
}

void MeshCollider::set_side(Vec3 normal, LocalConvex::Extent along_normal) {
  if (side_known_ && side_.normal == normal) return;
  side_.normal = normal;
  side_.lowest = along_normal.low;
  side_.highest = along_normal.high;
  side_.has_face = false;
  side_known_ = true;
}

void MeshCollider::compute_face() {
  if (side_.has_face) return;
  convex_.face_towards(-side_.normal, side_.face);
  side_.has_face = true;
}

bool MeshCollider::is_accepted(Vec3 normal) const {
  for (int i = 0; i < accepted_count_; ++i) {
    if (accepted_[i].normal == normal) return true;
  }
  return false;
}

// Returns true if this is the first contact with the normal.
bool MeshCollider::accept(Vec3 normal, float separation) {
  for (int i = 0; i < accepted_count_; ++i) {
    if (dot(accepted_[i].normal, normal) <= kSameNormal) continue;
    accepted_[i].separation = min(accepted_[i].separation, separation);
    return false;
  }
  if (accepted_count_ == kAcceptedRoom) return false;
  set_side(normal);
  accepted_[accepted_count_++] = {normal, separation, side_.lowest};
  return true;
}

void MeshCollider::add_face(const LocalTriangle& t, float deepest) {
  points_.count = 0;
  for (int i = 0; i < 3; ++i) {
    if (convex_.lies_outside(t.outward[i], t.v[i], t.slack)) return record_valley(t);
  }
  set_side(t.normal);
  compute_face();
  face_points(t, convex_, side_, max_separation_, points_);
  points_.drop_below(deepest);
  if (is_buried(t, t.normal)) points_.count = 0;
  groups_.add(t.normal, t.id, points_);
}

// The lowest corners of a tilted, deeply sunk shape may lie under triangles that the shape itself does not touch,
// because the ground continues there in the same plane. Returns true if a point was added.
bool MeshCollider::add_deep_corners(const LocalTriangle& t) {
  set_side(t.normal);
  // No corner is lower than the lowest.
  const float height = dot(t.normal, t.v[0]), enough = -0.9f * max_separation_;
  if (side_.lowest - height - convex_.radius() > enough + kCoverSlack * convex_.size() + t.slack)
    return false;
  compute_face();
  const FacePolygon face = side_.face;
  const float search_radius = kCoverSlack * convex_.size();
  const Vec3 lowest = convex_.support(-t.normal);
  bool added = false;
  for (int k = -1; k < face.count; ++k) {
    const Vec3 corner = k < 0 ? lowest : face.vertices[k];
    const float above = dot(t.normal, corner) - height;
    // Triangles under less deep corners have all been tested.
    if (above - convex_.radius() > enough) continue;
    const Vec3 foot = corner - above * t.normal + position_;
    std::uint32_t ids[16];
    const int count = find_triangles(surface_, grow({foot, foot}, search_radius), ids);
    for (int i = 0; i < count; ++i) {
      const LocalTriangle under = triangle(ids[i]);
      if (dot(under.normal, t.normal) <= kSameNormal) continue;
      add_face(under);
      added = added || points_.count > 0;
    }
  }
  return added;
}

// Adds one point of the shape over a triangle where its facing polygon has none: a cap is a polygon a little inside its
// rim, and the lowest corner may hang beside the border while another lies over the face.
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

// True if the face `other` continues, level, where the contact of `t` would stop the shape: `t` is nowhere above it,
// the contact points lie on it, and a step against the contact direction stays above it.
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
    // From the midpoint of the two surfaces to the surface of the triangle, then a step in the direction of the push.
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

// True if all points lie along one sharp or open edge of the triangle.
bool MeshCollider::are_at_sharp_edge(const LocalTriangle& t, Vec3 direction) const {
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
  if (points_.count == 0 || !are_at_sharp_edge(t, direction)) return false;
  const Vec3 p = points_.points[0].position - 0.5f * points_.points[0].separation * direction + position_;
  const Aabb near = grow({p, p}, kCoverSlack * convex_.size());
  for (int i = 0; i < candidates_.count; ++i) {
    const std::uint32_t id = candidates_.ids[i];
    if (id != t.id && overlap(surface_.box(id), near) && covers(triangle(id), t, direction)) return true;
  }
  return false;
}

// True if a lowest corner of the shape is so far inside the sides of the triangle that no direction can beat the normal
// of the face: a disc around its foot, as wide as the corner is deep, belongs to the triangle. A needle may have come
// to such a place beside the triangle, so the segment from the corner to the centre must pass through the triangle.
bool MeshCollider::has_corner_inside(const LocalTriangle& t, float face_separation) {
  const float room = max(-face_separation - convex_.radius(), 0.0f) + t.slack;
  if (convex_.has_vertices() &&
      !convex_.has_low_vertex_inside(t.normal, side_.lowest + bias_, t.outward, t.v, room))
    return false;
  compute_face();
  for (int k = 0; k < side_.face.count; ++k) {
    const Vec3 corner = side_.face.vertices[k];
    if (dot(t.normal, corner) > side_.lowest + bias_) continue;
    bool inside = true;
    for (int i = 0; i < 3; ++i) inside = inside && dot(t.outward[i], corner - t.v[i]) < -room;
    if (inside && enters_through(t, corner)) return true;
  }
  return false;
}

bool MeshCollider::enters_through(const LocalTriangle& t, Vec3 corner) const {
  const float below = dot(t.normal, t.v[0] - corner);
  if (below < kCoverSlack * convex_.size()) return true;
  const float above = dot(t.normal, convex_.center() - t.v[0]);
  const Vec3 crossing = lerp(corner, convex_.center(), below / (below + above));
  bool inside = true;
  for (int i = 0; i < 3; ++i) inside = inside && dot(t.outward[i], crossing - t.v[i]) <= t.slack;
  return inside;
}

void MeshCollider::test_candidates() {
  TriangleBatch batch;
  for (int i = 0; i < candidates_.count; i += TriangleBatch::kCount) {
    const std::uint32_t* ids = candidates_.ids + i;
    const int count = min(candidates_.count - i, TriangleBatch::kCount);
    load_triangles(kernels_, surface_, ids, count, position_, convex_, max_separation_, batch);
    apart_[i / TriangleBatch::kCount] = std::uint8_t(batch.apart);
    for (unsigned rest = batch.touchable; rest != 0; rest &= rest - 1) {
      const int lane = std::countr_zero(rest);
      test_triangle(batch_triangle(surface_, ids[lane], batch, lane), {batch.low[lane], batch.high[lane]});
    }
  }
}

void MeshCollider::test_triangle(const LocalTriangle& t, LocalConvex::Extent along_normal) {
  set_side(t.normal, along_normal);
  const float height = dot(t.normal, t.v[0]);
  const float face = face_separation(t);
  const bool inside_patch = t.flat_corners == 7 && t.edge[0] == EdgeKind::flat &&
                            t.edge[1] == EdgeKind::flat && t.edge[2] == EdgeKind::flat;
  // This ground is known to carry the shape. A triangle without real edges can give no other direction.
  if (inside_patch && is_accepted(t.normal)) return add_face(t);
  const bool behind = dot(t.normal, convex_.center()) < height;
  if (!behind && has_corner_inside(t, face)) {
    add_face(t);
    if (accept(t.normal, face)) add_deep_corners(t);
    return;
  }
  if (!behind && is_round_rejected(surface_, t, convex_, face)) {
    if (has_valley_points(t, convex_, max_separation_))
      defer({t.id, deferred_count_, face, face, behind, false}, t);
    return;
  }
  AxisSearch axes = search_axes(surface_, t, convex_, face, max_separation_, scratch_);
  if (axes.best <= 0.0f && is_blade_) {
    const AxisSearch nearest = search_nearest(surface_, t, convex_, face, max_separation_, scratch_);
    if (nearest.best > 0.0f) axes = nearest;
  }
  if (axes.best > max_separation_) return;
  if (!behind) nearest_ = min(nearest_, axes.best);
  const Deferred found{t.id, deferred_count_, face, axes.best, behind, axes.best <= 0.0f};
  record_overlap(found);
  const float allowed = max(face, axes.feature.separation);
  if (behind || allowed < axes.best - kAxisBias * convex_.size()) return defer(found, t);
  if (face >= axes.feature.separation - bias_) {
    add_face(t);
    if (points_.count == 0 && axes.over_face && face < rim_separation_) {
      rim_separation_ = face;
      rim_triangle_ = t.id;
      on_rim_ = axes.on_core;
    }
    // Beside an edge, the face alone may give no point, or none that is deep enough.
    const float required = axes.feature.separation + 0.1f * kAxisBias * convex_.size();
    if (axes.feature.separation < axes.best - kAxisBias * convex_.size() || points_.deepest() <= required) {
      if (!inside_patch && axes.best > 0.0f) add_corner(t, face, axes.best);
      if (accept(t.normal, face)) add_deep_corners(t);
      return;
    }
  }
  accept(axes.feature.direction, axes.feature.separation);
  add_feature(t, axes.feature);
}

void MeshCollider::record_valley(const LocalTriangle& t) {
  if (has_valley_points(t, convex_, max_separation_)) valleys_[valley_count_++ % kValleyRoom] = t.id;
}

// A rolling shape comes from one slope onto the next within a step, and would sink into it before it lies over it. Its
// points are added after all others and are never closer, because they are not closest points.
void MeshCollider::add_valley_points() {
  const float nearest = groups_.deepest();
  for (int i = 0; i < min(valley_count_, kValleyRoom); ++i) {
    const LocalTriangle t = triangle(valleys_[i]);
    points_.count = 0;
    valley_points(t, convex_, max_separation_, points_);
    points_.drop_below(nearest);
    groups_.add(t.normal, t.id, points_);
  }
}

void MeshCollider::defer(const Deferred& found, const LocalTriangle& t) {
  if (deferred_count_ < kLocalRoom) local_triangles_[deferred_count_] = t;
  deferred_[deferred_count_++] = found;
}

void MeshCollider::resolve(const Deferred& deferred) {
  if (deferred.number < kLocalRoom) return resolve(deferred, local_triangles_[deferred.number]);
  resolve(deferred, triangle(deferred.id));
}

void MeshCollider::resolve(const Deferred& deferred, const LocalTriangle& t) {
  for (int i = 0; i < accepted_count_; ++i) {
    if (dot(accepted_[i].normal, t.normal) > kSameNormal) return add_face(t);
  }
  if (is_superseded(t, deferred.behind)) return;
  // A shape apart from the triangle may still be below its plane, beside it or under its edge. It must not be pushed
  // out.
  add_face(t, deferred.overlaps ? -kUnbounded : -kCoverSlack * convex_.size());
  if (!deferred.overlaps && !deferred.behind) add_corner(t, deferred.face_separation, deferred.best);
  bool added = points_.count > 0;
  if ((added || deferred.overlaps) && add_deep_corners(t)) added = true;
  if (added) accept(t.normal, deferred.face_separation);
}

// True if an accepted contact already resolves the triangle.
bool MeshCollider::is_superseded(const LocalTriangle& t, bool behind) const {
  const float slack = kCoverSlack * convex_.size();
  for (int i = 0; i < accepted_count_; ++i) {
    const Accepted& accepted = accepted_[i];
    if (behind && dot(accepted.normal, t.normal) < kOpposed) return true;
    const float highest =
        max(dot(accepted.normal, t.v[0]), max(dot(accepted.normal, t.v[1]), dot(accepted.normal, t.v[2])));
    const float separation = accepted.lowest - highest - convex_.radius();
    if (separation >= accepted.separation - slack) return true;
  }
  return false;
}

void MeshCollider::resolve_deferred() {
  Deferred scratch[MeshCandidates::kRoom];
  // The least deep first. Candidates are in the order of their numbers, and the sort is stable.
  merge_sort(std::span<Deferred>(deferred_, std::size_t(deferred_count_)), std::span<Deferred>(scratch),
             [](const Deferred& a, const Deferred& b) { return a.face_separation > b.face_separation; });
  for (int i = 0; i < deferred_count_; ++i) resolve(deferred_[i]);
}

// True if the shape passes through the surface there, and not beside its border: a segment from its lowest point to its
// highest point, or to its centre, must cross the plane inside a triangle.
bool MeshCollider::pierces(const LocalTriangle& t) const {
  const Vec3 low = convex_.support(-t.normal);
  return has_surface_between(t, low, convex_.support(t.normal)) ||
         has_surface_between(t, low, convex_.center());
}

bool MeshCollider::has_surface_between(const LocalTriangle& t, Vec3 low, Vec3 high) const {
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

// A tilted shape that pierces a large flat patch may have neither a corner above it nor a tested triangle below.
void MeshCollider::resolve_deep_patches() {
  for (int i = 0; i < candidates_.deep_patch_count; ++i) {
    const LocalTriangle t = triangle(candidates_.deep_patches[i]);
    set_side(t.normal);
    const bool behind = dot(t.normal, convex_.center() - t.v[0]) < 0.0f;
    if (is_superseded(t, behind) || !pierces(t)) continue;
    if (add_deep_corners(t)) accept(t.normal, face_separation(t));
  }
}

void MeshCollider::record_overlap(const Deferred& found) {
  if (!found.overlaps) return;
  if (!found.behind) overlap_ = min(overlap_, found.best);
  const bool better =
      exit_.behind == found.behind ? found.face_separation > exit_.face_separation : exit_.behind;
  if (better) exit_ = found;
}

// The shape overlaps triangles, but none of them is under one of its corners, as when a blunt hull sank across a small
// hill. It leaves through the front of one triangle, pushed at its lowest point.
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

// If the lowest corner of a polyhedron is slightly beside the triangle, all points over its face are farther than its
// edge. The axis search does not know the direction between that corner and the edge. Preserves `points_`.
void MeshCollider::add_corner(const LocalTriangle& t, float face_separation, float best) {
  const float slack = kAxisBias * convex_.size();
  // No separation is below that of a separating direction, so no search is needed.
  if (points_.deepest() <= best + 0.9f * slack) return;
  if (points_.count == 0 || convex_.face_count() == 0 || points_.deepest() <= face_separation + slack) return;
  const AxisSearch axes = search_nearest(surface_, t, convex_, face_separation, max_separation_, scratch_);
  if (axes.best > max_separation_ || axes.feature.separation < axes.best ||
      points_.deepest() <= axes.best + slack)
    return;
  const MeshPoints saved = points_;
  add_feature(t, axes.feature);
  points_ = saved;
}

// True if nothing was found, or if the closest triangle is closer than all contacts.
bool MeshCollider::is_corner_missing() const {
  if (groups_.empty()) return true;
  return convex_.vertex_count() > 2 && nearest_ > 0.0f &&
         nearest_ < groups_.deepest() - kAxisBias * convex_.size();
}

// Finds contacts that the axis search misses, such as a corner of a polyhedron beside an edge: it knows faces and pairs
// of edges only, so a triangle may be closer than all points along its directions.
void MeshCollider::search_corners() {
  for (int i = 0; i < candidates_.count; ++i) {
    if ((apart_[i / TriangleBatch::kCount] >> i % TriangleBatch::kCount & 1) != 0) continue;
    LocalTriangle t = local_triangle(surface_, candidates_.ids[i], position_, convex_);
    set_side(t.normal);
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
                 LocalManifold* out, CachedTriangles* cached) {
  if (!is_convex(b.kind)) return 0;
  return MeshCollider(mesh, b, a_from_b, max_separation, cached).run(out);
}

bool is_clear_of_surface(const Shape& a, const Shape& b, const Transform& a_from_b, float max_distance) {
  const bool swapped = is_convex(a.kind);
  const Shape& convex = swapped ? a : b;
  const Shape& other = swapped ? b : a;
  if (!is_convex(convex.kind) || other.kind < ShapeKind::mesh) return false;
  const Aabb box = bounds(convex, swapped ? inverse(a_from_b) : a_from_b);
  const float rounding = 1.0e-6f * max(largest(absolute(box.low)), largest(absolute(box.high)));
  return !has_triangle(Surface(other), grow(box, max_distance + rounding));
}

}  // namespace gyre
