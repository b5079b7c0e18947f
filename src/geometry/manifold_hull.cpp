// Polyhedron against polyhedron. See manifold_hull.h.
#include "geometry/manifold_hull.h"

#include "geometry/clip.h"
#include "geometry/closest.h"
#include "geometry/manifold_core.h"
#include "geometry/manifold_crossing.h"
#include "geometry/separating_axis.h"

namespace gyre {
namespace {

// The face around `vertex` that opposes `direction` most.
int opposing_face(const Polytope& polytope, int vertex, Vec3 direction) {
  int best = 0;
  float least = 2.0f;
  const auto look = [&](int face) {
    const float slope = dot(polytope.planes[face].normal, direction);
    if (slope < least || (slope == least && face < best)) {
      least = slope;
      best = face;
    }
  };
  for (int e = 0; e < polytope.edge_count; ++e) {
    const HullEdge& edge = polytope.edges[e];
    if (edge.from != vertex && edge.to != vertex) continue;
    look(edge.left);
    look(edge.right);
  }
  return best;
}

// The face that opposes `direction` most among those that oppose it less than `limit`; -1 if none faces that way.
int next_opposing_face(const Polytope& polytope, Vec3 direction, float limit) {
  int best = -1;
  float least = -0.05f;
  for (int f = 0; f < polytope.face_count; ++f) {
    const float slope = dot(polytope.planes[f].normal, direction);
    if (slope < least && slope > limit) {
      least = slope;
      best = f;
    }
  }
  return best;
}

struct Roles {
  const Polytope& reference;
  const Polytope& incident;
  Transform reference_from_incident;
  bool reference_is_a;
};

// Points of the reference's face against the incident's faces, in the reference's frame.
int face_points(const Roles& roles, int face, float separation, float max_separation, ManifoldPoint* points) {
  FacePolygon reference, incident;
  face_polygon(roles.reference, face, reference);
  const Vec3 outward = reference.normal;
  const Vec3 local = rotate_inverse(roles.reference_from_incident.orientation, outward);
  FacePair pair;
  pair.a = roles.reference_is_a ? &reference : &incident;
  pair.b = roles.reference_is_a ? &incident : &reference;
  pair.normal = roles.reference_is_a ? outward : -outward;
  pair.max_separation = max_separation;
  const auto clip_with = [&](int other) {
    face_polygon(roles.incident, other, incident);
    for (int i = 0; i < incident.count; ++i) {
      incident.vertices[i] = roles.reference_from_incident * incident.vertices[i];
    }
    return clip_faces(pair, roles.reference_is_a, points);
  };
  const int deepest = lowest_vertex(roles.incident, local);
  int count = clip_with(opposing_face(roles.incident, deepest, local));
  if (count > 0 || separation > 0.0f) return count;
  // They overlap, but not there: other faces that look this way, the most opposed first.
  float slope = -2.0f;
  for (int tries = 0; tries < 8; ++tries) {
    const int other = next_opposing_face(roles.incident, local, slope);
    if (other < 0) break;
    slope = dot(roles.incident.planes[other].normal, local);
    count = clip_with(other);
    if (count > 0) return count;
  }
  return 0;
}

// None when the polytopes are apart and the edges pass beside each other.
void edge_point(const Polytope& a, const Polytope& b, const Transform& a_from_b, const PolytopeAxis& axis,
                LocalManifold& out) {
  const HullEdge &ea = a.edges[axis.index_a], &eb = b.edges[axis.index_b];
  const SegmentPair near =
      closest_of_segments(DVec3(a.vertices[ea.from]), DVec3(a.vertices[ea.to]),
                          DVec3(a_from_b * b.vertices[eb.from]), DVec3(a_from_b * b.vertices[eb.to]));
  const bool at_end = near.s <= 0.0 || near.s >= 1.0 || near.t <= 0.0 || near.t >= 1.0;
  if (axis.separation > 0.0f && at_end) return;
  out.count = 1;
  out.points[0].position = to_float(0.5 * (near.on_a + near.on_b));
  out.points[0].separation = axis.separation;
  out.points[0].feature = feature_edges(std::uint32_t(axis.index_a), std::uint32_t(axis.index_b));
}

void face_manifold(const Polytope& a, const Polytope& b, const Transform& a_from_b, const PolytopeAxis& axis,
                   float max_separation, LocalManifold& out) {
  const bool is_a = axis.kind == AxisKind::face_a;
  ManifoldPoint points[kMaxClipPoints];
  const Roles roles{is_a ? a : b, is_a ? b : a, is_a ? a_from_b : inverse(a_from_b), is_a};
  const int found =
      face_points(roles, is_a ? axis.index_a : axis.index_b, axis.separation, max_separation, points);
  const Vec3 normal = is_a ? axis.normal : b.planes[axis.index_b].normal;
  out.normal = axis.normal;
  out.count = found > 0 ? reduce_points(points, found, normal) : 0;
  for (int i = 0; i < out.count; ++i) {
    out.points[i] = points[i];
    if (!is_a) out.points[i].position = a_from_b * points[i].position;
  }
}

// The face whose normal is within kNearFace of a normal from A to B; none if there is none.
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
  return stands_for_crossing(out, edges.separation, min(a.inner_radius, b.inner_radius));
}

// False when they are farther apart than allowed along some axis.
bool collide_polytopes(const Polytope& a, const Polytope& b, const Transform& a_from_b, float max_separation,
                       PairCache& cache, LocalManifold& out) {
  PolytopeAxis favoured = axis_of_name(cache.words[0], a, b);
  if (favoured.kind != AxisKind::none && separation_along(a, b, a_from_b, favoured) > max_separation)
    return false;
  const PolytopeAxis axis = separating_axis(a, b, a_from_b, max_separation, favoured);
  cache.words[0] = axis_name(axis);
  if (axis.separation > max_separation) return false;
  if (axis.kind != AxisKind::edges) {
    face_manifold(a, b, a_from_b, axis, max_separation, out);
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
  bool near = false;
  if (a.kind == ShapeKind::hull && b.kind == ShapeKind::hull) {
    near = collide_polytopes(make_polytope(*a.hull), make_polytope(*b.hull), a_from_b, max_separation, cache,
                             out);
  } else {
    const BoxPolytope box(a.kind == ShapeKind::box ? a.extents : b.extents);
    const Polytope view_a = a.kind == ShapeKind::box ? box.view() : make_polytope(*a.hull);
    const Polytope view_b = a.kind == ShapeKind::box ? make_polytope(*b.hull) : box.view();
    near = collide_polytopes(view_a, view_b, a_from_b, max_separation, cache, out);
  }
  // Near, or even overlapping, but beside each other's faces.
  if (near && out.count == 0) collide_cores(a, b, a_from_b, max_separation, cache, out);
}

}  // namespace gyre
