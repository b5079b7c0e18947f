// The axis search over faces and edges. See separating_axis.h.
#include "geometry/separating_axis.h"

#include "math/rotation.h"

namespace gyre {
namespace {

// How much better an axis must be to replace the favoured one: a part of the depth and of the thinner shape's inner radius.
constexpr float kDepthBias = 0.05f, kSizeBias = 1.0e-3f;
// Squared sine between two edges below which they have no axis of their own.
constexpr double kParallel = 1.0e-8;
// Tie margin of the edges' distance test, relative to the shapes' size.
constexpr float kReachMargin = 1.0e-4f;
constexpr int kMaxVertices = 255, kMaxEdges = 510;

// Separation of `other` above a plane of the reference polytope, the plane given in other's frame.
float above(const Polytope& other, Vec3 normal, float offset) { return lowest_along(other, normal) - offset; }

// The best face of `reference` against `other`, both in reference's frame except that other's columns stay its own.
struct FaceQuery {
  int face = -1;
  float separation = -kUnbounded;
};
FaceQuery best_face(const Polytope& reference, const Polytope& other, const Transform& reference_from_other,
                    float max_separation, int first) {
  FaceQuery best;
  const Mat3 turn = to_matrix(reference_from_other.orientation);
  const Vec3 shift = reference_from_other.position;
  const Vec3 center = turn * other.centroid + shift;
  const auto look = [&](int f) {
    const HullPlane& plane = reference.planes[f];
    // The other's inner ball bounds what this face can reach.
    if (dot(plane.normal, center) - plane.offset - other.inner_radius <= best.separation) return;
    const float separation =
        above(other, transpose_times(turn, plane.normal), plane.offset - dot(plane.normal, shift));
    if (separation > best.separation) best = {f, separation};
  };
  if (first >= 0) look(first);
  for (int f = 0; f < reference.face_count && best.separation <= max_separation; ++f) look(f);
  return best;
}

// Vec3 without its zeros: of these columns most entries are never written.
struct Plain3 {
  float x, y, z;

  void operator=(Vec3 v) { x = v.x, y = v.y, z = v.z; }
  operator Vec3() const { return {x, y, z}; }
};

// One edge with the normals of its two faces, in A's frame.
struct EdgeArc {
  Plain3 direction, left, right;
  int index;
};

struct EdgePair {
  int a = -1, b = -1;
  Vec3 normal;
  float separation = -kUnbounded;
};

// Whether the arc of edge a crosses the mirrored arc of edge b on the unit sphere.
bool arcs_cross(const EdgeArc& a, const EdgeArc& b) {
  const Vec3 along_a = a.direction, along_b = b.direction;
  const float left_b = -dot(b.left, along_a), right_b = -dot(b.right, along_a);
  const float left_a = dot(a.left, along_b), right_a = dot(a.right, along_b);
  return left_b * right_b < 0.0f && left_a * right_a < 0.0f && left_b * right_a > 0.0f;
}

class EdgeSearch {
 public:
  EdgeSearch(const Polytope& a, const Polytope& b, const Transform& a_from_b)
      : a_(a), b_(b), turn_(normalized(to_double(a_from_b.orientation))), shift_(a_from_b.position) {}

  // The axis of one pair, in double: shallow crossings keep their direction. False if the edges are parallel.
  bool evaluate(int edge_a, int edge_b, Vec3 outward, EdgePair& out) const {
    const HullEdge &ea = a_.edges[edge_a], &eb = b_.edges[edge_b];
    const DVec3 pa(a_.vertices[ea.from]), pb = rotate(turn_, DVec3(b_.vertices[eb.from])) + shift_;
    const DVec3 da = DVec3(a_.vertices[ea.to]) - pa;
    const DVec3 db = rotate(turn_, DVec3(b_.vertices[eb.to]) - DVec3(b_.vertices[eb.from]));
    DVec3 axis = cross(da, db);
    const double squared = dot(axis, axis);
    if (!(squared > kParallel * dot(da, da) * dot(db, db))) return false;
    axis = axis / std::sqrt(squared);
    if (dot(axis, DVec3(outward)) < 0.0) axis = -axis;
    out = {edge_a, edge_b, to_float(axis), float(dot(axis, pb - pa))};
    return true;
  }

 private:
  const Polytope& a_;
  const Polytope& b_;
  DQuat turn_;
  DVec3 shift_;
};

// Edges whose nearer end lies within `limit` of the plane through `offset`; `side` is 1 for below, -1 for above.
template <class Vertices>
int near_edges(const Polytope& p, const Vertices& vertices, const float* heights, float side, float limit,
               const Mat3* turn, EdgeArc* out) {
  int count = 0;
  for (int e = 0; e < p.edge_count; ++e) {
    const HullEdge& edge = p.edges[e];
    if (min(side * heights[edge.from], side * heights[edge.to]) > limit) continue;
    EdgeArc& arc = out[count++];
    arc.direction = Vec3(vertices[edge.to]) - Vec3(vertices[edge.from]);
    arc.left = turn != nullptr ? *turn * p.planes[edge.left].normal : p.planes[edge.left].normal;
    arc.right = turn != nullptr ? *turn * p.planes[edge.right].normal : p.planes[edge.right].normal;
    arc.index = e;
  }
  return count;
}

struct BestFace {
  AxisKind kind;
  int face;
  Vec3 normal;  // from A to B, A's frame
  float separation;
};

EdgePair best_edges(const Polytope& a, const Polytope& b, const Transform& a_from_b, const BestFace& face,
                    float max_separation) {
  const Mat3 turn = to_matrix(a_from_b.orientation);
  Plain3 vertices_b[kMaxVertices];
  float heights_a[kMaxVertices], heights_b[kMaxVertices];
  // Heights over A's highest and B's lowest point along the face's normal.
  float top_a = -kUnbounded, bottom_b = kUnbounded;
  for (int i = 0; i < a.vertex_count; ++i) {
    heights_a[i] = dot(face.normal, a.vertices[i]);
    top_a = max(top_a, heights_a[i]);
  }
  for (int i = 0; i < b.vertex_count; ++i) {
    vertices_b[i] = turn * b.vertices[i] + a_from_b.position;
    heights_b[i] = dot(face.normal, Vec3(vertices_b[i]));
    bottom_b = min(bottom_b, heights_b[i]);
  }
  // An edge of B must come within reach of A, so not higher than A's top by more than that; A's edges likewise.
  const float reach =
      max(-face.separation, max_separation) + kReachMargin * (a.inner_radius + b.inner_radius);
  EdgeArc arcs_a[kMaxEdges], arcs_b[kMaxEdges];
  const int count_a = near_edges(a, a.vertices, heights_a, -1.0f, reach - bottom_b, nullptr, arcs_a);
  const int count_b = near_edges(b, vertices_b, heights_b, 1.0f, reach + top_a, &turn, arcs_b);
  const EdgeSearch search(a, b, a_from_b);
  EdgePair best;
  for (int i = 0; i < count_a; ++i) {
    for (int k = 0; k < count_b; ++k) {
      if (!arcs_cross(arcs_a[i], arcs_b[k])) continue;
      EdgePair pair;
      if (!search.evaluate(arcs_a[i].index, arcs_b[k].index, Vec3(arcs_a[i].left) + Vec3(arcs_a[i].right),
                           pair))
        continue;
      if (pair.separation > best.separation) best = pair;
    }
  }
  return best;
}

float face_separation(const Polytope& a, const Polytope& b, const Transform& a_from_b, AxisKind kind,
                      int face, Vec3& normal) {
  const Mat3 turn = to_matrix(a_from_b.orientation);
  if (kind == AxisKind::face_a) {
    const HullPlane& plane = a.planes[face];
    normal = plane.normal;
    return above(b, transpose_times(turn, plane.normal), plane.offset - dot(plane.normal, a_from_b.position));
  }
  const HullPlane& plane = b.planes[face];
  normal = normalized(-(turn * plane.normal));
  // The plane dot(n, x) = offset of B holds the points x = turn^T (p - t) of A.
  return above(a, -normal, plane.offset - dot(normal, a_from_b.position));
}

}  // namespace

std::uint32_t axis_name(const PolytopeAxis& axis) {
  return (std::uint32_t(axis.kind) << 24) | (std::uint32_t(axis.index_a) << 12) | std::uint32_t(axis.index_b);
}

PolytopeAxis axis_of_name(std::uint32_t name, const Polytope& a, const Polytope& b) {
  PolytopeAxis axis;
  const std::uint32_t kind = name >> 24;
  const int index_a = int((name >> 12) & 0xfffu), index_b = int(name & 0xfffu);
  if (kind == 0 || kind > std::uint32_t(AxisKind::edges)) return axis;
  const AxisKind meant = AxisKind(kind);
  const int limit_a = meant == AxisKind::edges ? a.edge_count : a.face_count;
  const int limit_b = meant == AxisKind::edges ? b.edge_count : b.face_count;
  if (index_a >= limit_a || index_b >= limit_b) return axis;
  axis.kind = meant;
  axis.index_a = index_a;
  axis.index_b = index_b;
  return axis;
}

float separation_along(const Polytope& a, const Polytope& b, const Transform& a_from_b, PolytopeAxis& axis) {
  switch (axis.kind) {
    case AxisKind::face_a:
      axis.separation = face_separation(a, b, a_from_b, axis.kind, axis.index_a, axis.normal);
      break;
    case AxisKind::face_b:
      axis.separation = face_separation(a, b, a_from_b, axis.kind, axis.index_b, axis.normal);
      break;
    case AxisKind::edges: {
      // Whether or not the two edges still face each other, the supports along their cross product tell the truth.
      const HullEdge& edge = a.edges[axis.index_a];
      const Vec3 outward = a.planes[edge.left].normal + a.planes[edge.right].normal;
      EdgePair pair;
      if (!EdgeSearch(a, b, a_from_b).evaluate(axis.index_a, axis.index_b, outward, pair)) {
        axis.separation = -kUnbounded;
        break;
      }
      axis.normal = pair.normal;
      axis.separation = lowest_along(b, rotate_inverse(a_from_b.orientation, pair.normal)) +
                        dot(pair.normal, a_from_b.position) - highest_along(a, pair.normal);
      break;
    }
    default:
      axis.separation = -kUnbounded;
      break;
  }
  return axis.separation;
}

PolytopeAxis separating_axis(const Polytope& a, const Polytope& b, const Transform& a_from_b,
                             float max_separation, const PolytopeAxis& favoured) {
  const FaceQuery qa =
      best_face(a, b, a_from_b, max_separation, favoured.kind == AxisKind::face_a ? favoured.index_a : -1);
  PolytopeAxis face_a{AxisKind::face_a, qa.face, 0, a.planes[qa.face].normal, qa.separation};
  if (qa.separation > max_separation) return face_a;
  const FaceQuery qb = best_face(b, a, inverse(a_from_b), max_separation,
                                 favoured.kind == AxisKind::face_b ? favoured.index_b : -1);
  PolytopeAxis face_b{AxisKind::face_b, 0, qb.face, {}, qb.separation};
  face_b.normal = normalized(-rotate(a_from_b.orientation, b.planes[qb.face].normal));
  if (qb.separation > max_separation) return face_b;

  const float best = max(qa.separation, qb.separation);
  const float bias = kDepthBias * absolute(best) + kSizeBias * min(a.inner_radius, b.inner_radius);
  const PolytopeAxis& deciding = qb.separation > qa.separation ? face_b : face_a;
  const BestFace plane{deciding.kind, deciding.kind == AxisKind::face_a ? qa.face : qb.face, deciding.normal,
                       deciding.separation};
  const EdgePair pair = best_edges(a, b, a_from_b, plane, max_separation);
  const PolytopeAxis edges{AxisKind::edges, max(pair.a, 0), max(pair.b, 0), pair.normal, pair.separation};
  if (edges.separation > max_separation) return edges;

  // Among nearly equal ones: the favoured, then A's face, then B's, then edges.
  if (favoured.kind == AxisKind::edges && pair.a == favoured.index_a && pair.b == favoured.index_b &&
      pair.separation > best + 0.5f * bias) {
    return edges;
  }
  if (favoured.kind == AxisKind::face_a || favoured.kind == AxisKind::face_b) {
    PolytopeAxis kept = favoured;
    if (edges.separation <= best + bias && separation_along(a, b, a_from_b, kept) >= best - bias) return kept;
  }
  if (edges.separation > best + bias) return edges;
  return qb.separation > qa.separation + 0.5f * bias ? face_b : face_a;
}

}  // namespace gyre
