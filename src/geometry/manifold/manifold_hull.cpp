// Polyhedron against polyhedron. See manifold_hull.h.
#include "geometry/manifold/manifold_hull.h"

#include "geometry/distance/closest.h"
#include "geometry/distance/separating_axis.h"
#include "geometry/manifold/clip.h"
#include "geometry/manifold/manifold_core.h"
#include "geometry/manifold/manifold_crossing.h"

namespace gyre {
namespace {

// The face around `vertex` that opposes `direction` most.
int opposing_face(const Polytope& polytope, int vertex, Vec3 direction) {
  int best = 0;
  float smallest = 2.0f;
  const auto test_face = [&](int face) {
    const float slope = dot(polytope.planes[face].normal, direction);
    if (slope < smallest || (slope == smallest && face < best)) {
      smallest = slope;
      best = face;
    }
  };
  for (int word = 0; word < polytope.edge_words; ++word) {
    for_each_edge(polytope.edges_of[vertex * polytope.edge_words + word], word, [&](int e) {
      test_face(polytope.edges[e].left);
      test_face(polytope.edges[e].right);
    });
  }
  return best;
}

struct Roles {
  const Polytope& reference;
  const Polytope& incident;
  Transform reference_from_incident;
  bool reference_is_a;
};

// Cosine below which a face is a side: it does not face the reference.
constexpr float kMinFacing = 1.0e-4f;

float allowed_miss(const Polytope& a, const Polytope& b) {
  return kMissTolerance * min(a.inner_radius, b.inner_radius);
}

// Candidate points of one reference face against several incident faces in turn.
class FacePoints {
 public:
  FacePoints(const Roles& roles, int face, float max_separation)
      : roles_(roles), outward_(roles.reference.planes[face].normal) {
    face_polygon(roles.reference, face, reference_);
    pair_.a = roles.reference_is_a ? &reference_ : &incident_;
    pair_.b = roles.reference_is_a ? &incident_ : &reference_;
    pair_.normal = roles.reference_is_a ? outward_ : -outward_;
    pair_.max_separation = max_separation;
  }

  // `separation` is that of the polytopes along the normal of the face.
  int find(float separation) {
    const Vec3 local = rotate_inverse(roles_.reference_from_incident.orientation, outward_);
    const int first = opposing_face(roles_.incident, lowest_vertex(roles_.incident, local).vertex, local);
    clip_with(first);
    if (separation > 0.0f) return count_;
    const float enough = separation + allowed_miss(roles_.reference, roles_.incident);
    if (deepest_ > enough) clip_other_faces(first, local);
    return count_;
  }
  ManifoldPoint* points() { return points_; }

 private:
  // The polytopes overlap, but not there, or not only. Every other face that faces the reference and is deeper is
  // clipped too.
  void clip_other_faces(int first, Vec3 local) {
    const Polytope& incident = roles_.incident;
    const float height = dot(outward_, reference_.vertices[0] - roles_.reference_from_incident.position);
    constexpr int kMaxPaddedVertices = 256;
    float separations[kMaxPaddedVertices];
    const Vec3W<kPolytopeLanes> direction = splat<kPolytopeLanes>(local);
    for (int i = 0; i < incident.padded_count; i += kPolytopeLanes)
      (values_along(incident, i, direction) - Wide<kPolytopeLanes>(height)).store_unaligned(separations + i);
    for (int f = 0; f < incident.face_count; f += kPolytopeLanes) {
      const Mask<kPolytopeLanes> facing_away =
          dot(load_planes(incident, f).normal, direction) > Wide<kPolytopeLanes>(-kMinFacing);
      const int end = min(f + kPolytopeLanes, incident.face_count);
      for (int k = f; k < end; ++k) {
        if (k != first && !facing_away[k - f] && lowest_of(k, separations) < deepest_) clip_with(k);
      }
    }
  }
  // The smallest of the values at the corners of a face.
  float lowest_of(int face, const float* values) const {
    const int count = face_corners(roles_.incident, face);
    float lowest = kUnbounded;
    for (int i = 0; i < count; ++i) lowest = min(lowest, values[face_corner(roles_.incident, face, i)]);
    return lowest;
  }
  void clip_with(int face) {
    face_polygon(roles_.incident, face, incident_);
    for (int i = 0; i < incident_.count; ++i) {
      incident_.vertices[i] = roles_.reference_from_incident * incident_.vertices[i];
    }
    ManifoldPoint* const found = points_ + count_;
    const int room = kMaxClipPoints - count_,
              count = min(clip_faces(pair_, roles_.reference_is_a, found), room);
    int new_count = 0;
    for (int i = 0; i < count; ++i) {
      if (is_known(found[i])) continue;
      deepest_ = min(deepest_, found[i].separation);
      found[new_count++] = found[i];
    }
    count_ += new_count;
  }
  // Faces that share a corner or an edge give the same points there.
  bool is_known(const ManifoldPoint& point) const {
    for (int i = 0; i < count_; ++i) {
      if (points_[i].feature == point.feature || points_[i].position == point.position) return true;
    }
    return false;
  }

  const Roles& roles_;
  Vec3 outward_;
  FacePolygon reference_, incident_;
  FacePair pair_;
  float deepest_ = kUnbounded;
  int count_ = 0;
  // The points found so far, and behind them those of one more face. Not cleared: only the counted elements are read.
  union {
    ManifoldPoint points_[2 * kMaxClipPoints];
  };
};

// Adds no point if the edges do not cross. Another feature of separated polytopes is then closer; of overlapping ones
// the faces at the nearly parallel edges were as good.
void edge_point(const Polytope& a, const Polytope& b, const Transform& a_from_b, const PolytopeAxis& axis,
                LocalManifold& out) {
  const HullEdge &ea = a.edges[axis.index_a], &eb = b.edges[axis.index_b];
  const SegmentPair near =
      closest_of_segments(DVec3(a.vertices[ea.from]), DVec3(a.vertices[ea.to]),
                          DVec3(a_from_b * b.vertices[eb.from]), DVec3(a_from_b * b.vertices[eb.to]));
  const bool at_end = near.s <= 0.0 || near.s >= 1.0 || near.t <= 0.0 || near.t >= 1.0;
  if (at_end && (axis.separation > 0.0f ||
                 length(near.on_b - near.on_a) >
                     double((1.0f + kDepthTolerance) * -axis.separation + allowed_miss(a, b))))
    return;
  out.count = 1;
  out.points[0].position = to_float(0.5 * (near.on_a + near.on_b));
  out.points[0].separation = axis.separation;
  out.points[0].feature = feature_edges(std::uint32_t(axis.index_a), std::uint32_t(axis.index_b));
}

void face_manifold(const Polytope& a, const Polytope& b, const Transform& a_from_b, const PolytopeAxis& axis,
                   float max_separation, LocalManifold& out) {
  const bool is_a = axis.kind == AxisKind::face_a;
  const Roles roles{is_a ? a : b, is_a ? b : a, is_a ? a_from_b : inverse(a_from_b), is_a};
  FacePoints candidates(roles, is_a ? axis.index_a : axis.index_b, max_separation);
  const int found = candidates.find(axis.separation);
  ManifoldPoint* const points = candidates.points();
  const Vec3 normal = is_a ? axis.normal : b.planes[axis.index_b].normal;
  out.normal = axis.normal;
  out.count = found > 0 ? reduce_points(points, found, normal) : 0;
  for (int i = 0; i < out.count; ++i) {
    out.points[i] = points[i];
    if (!is_a) out.points[i].position = a_from_b * points[i].position;
  }
}

// The face whose normal is within kNearFace of a normal from A to B; no axis if there is none.
PolytopeAxis face_near(const Polytope& a, const Polytope& b, const Transform& a_from_b, Vec3 normal) {
  PolytopeAxis best;
  float nearest = kNearFace;
  for (int k = 0; k < a.face_count; ++k) {
    const float along = dot(a.planes[k].normal, normal);
    if (along > nearest) nearest = along, best.kind = AxisKind::face_a, best.index_a = k;
  }
  const Vec3 towards_a = -rotate_inverse(a_from_b.orientation, normal);
  for (int k = 0; k < b.face_count; ++k) {
    const float along = dot(b.planes[k].normal, towards_a);
    if (along > nearest) nearest = along, best.kind = AxisKind::face_b, best.index_b = k;
  }
  if (best.kind != AxisKind::none) separation_along(a, b, a_from_b, best);
  return best;
}

// See manifold_crossing.h.
bool crossing_faces(const Polytope& a, const Polytope& b, const Transform& a_from_b,
                    const PolytopeAxis& edges, float max_separation, LocalManifold& out) {
  const PolytopeAxis face = face_near(a, b, a_from_b, edges.normal);
  if (face.kind == AxisKind::none) return false;
  face_manifold(a, b, a_from_b, face, max_separation, out);
  return replaces_crossing(out, edges.separation, min(a.inner_radius, b.inner_radius));
}

// Returns false if the polytopes are farther apart than allowed along some axis.
bool collide_polytopes(const Polytope& a, const Polytope& b, const Transform& a_from_b, float max_separation,
                       PairCache& cache, LocalManifold& out) {
  PolytopeAxis favoured = decode_axis(cache.words[0], a, b);
  if (favoured.kind != AxisKind::none && separation_along(a, b, a_from_b, favoured) > max_separation)
    return false;
  const PolytopeAxis axis = separating_axis(a, b, a_from_b, max_separation, favoured);
  cache.words[0] = encode_axis(axis);
  if (axis.separation > max_separation) return false;
  if (axis.kind != AxisKind::edges) {
    face_manifold(a, b, a_from_b, axis, max_separation, out);
    // The points miss the closest or deepest feature, which lies beside the face.
    const float excess = deepest_of(out) - axis.separation;
    if (excess > allowed_miss(a, b) + kDepthTolerance * max(-axis.separation, 0.0f)) out.count = 0;
    return true;
  }
  if (crossing_faces(a, b, a_from_b, axis, max_separation, out)) return true;
  out.normal = axis.normal;
  out.count = 0;
  edge_point(a, b, a_from_b, axis, out);
  return true;
}

}  // namespace

void collide_polyhedra(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                       PairCache& cache, LocalManifold& out) {
  out.count = 0;
  bool in_range = false;
  if (a.kind == ShapeKind::hull && b.kind == ShapeKind::hull) {
    in_range = collide_polytopes(make_polytope(*a.hull), make_polytope(*b.hull), a_from_b, max_separation,
                                 cache, out);
  } else {
    const BoxPolytope box(a.kind == ShapeKind::box ? a.extents : b.extents);
    const Polytope view_a = a.kind == ShapeKind::box ? box.view() : make_polytope(*a.hull);
    const Polytope view_b = a.kind == ShapeKind::box ? make_polytope(*b.hull) : box.view();
    in_range = collide_polytopes(view_a, view_b, a_from_b, max_separation, cache, out);
  }
  // The polyhedra are close or overlap, but no face projects onto the other.
  if (in_range && out.count == 0) collide_cores(a, b, a_from_b, max_separation, cache, out);
}

}  // namespace gyre
