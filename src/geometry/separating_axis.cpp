// The axis search over faces and edges. See separating_axis.h.
#include "geometry/separating_axis.h"

#include "math/rotation.h"
#include "math/wide_vec.h"

#include <bit>

namespace gyre {
namespace {

// How much better an axis must be to replace the favoured one: a part of the depth and of the thinner shape's inner radius.
constexpr float kDepthBias = 0.05f, kSizeBias = 1.0e-3f;
// Squared sine between two edges below which they have no axis of their own.
constexpr double kParallel = 1.0e-8;
// Squared sine below which float rounding would show in their axis.
constexpr float kShallow = 1.0e-2f;
// Tie margin of the edges' distance test, relative to the shapes' size.
constexpr float kReachMargin = 1.0e-4f;
// How far a corner may lie beyond the edge that is outermost, of the largest coordinate.
constexpr float kOutermost = 1.0e-5f;
// What rounding, kOutermost and the corners of faces that lie off their plane add to a separation at most, of the sizes' sum.
constexpr float kRounding = 3.0e-5f;
constexpr int kMaxVertices = 255, kMaxFaces = 255, kMaxEdges = 510;

// Separation of `other` above a plane of the reference polytope, the plane given in other's frame.
float above(const Polytope& other, Vec3 normal, float offset) { return lowest_along(other, normal) - offset; }

// The best face of `reference` against `other`, both in reference's frame except that other's columns stay its own.
struct FaceQuery {
  int face = 0;
  float separation = -kUnbounded;
};
FaceQuery best_face(const Polytope& reference, const Polytope& other, const Transform& reference_from_other,
                    float max_separation, int favoured) {
  FaceQuery best;
  const Mat3 turn = to_matrix(reference_from_other.orientation);
  const Vec3 shift = reference_from_other.position;
  const Vec3 center = turn * other.centroid + shift;
  // The other's inner ball bounds what a face can reach, so a good first face spares most of the rest.
  float bound[kMaxFaces];
  float largest_bound = -kUnbounded;
  for (int f = 0; f < reference.face_count; ++f) {
    const HullPlane& plane = reference.planes[f];
    bound[f] = dot(plane.normal, center) - plane.offset - other.inner_radius;
    largest_bound = max(bound[f], largest_bound);
  }
  int first = favoured;
  if (first < 0) {
    first = 0;
    while (first + 1 < reference.face_count && bound[first] != largest_bound) ++first;
  }
  const auto look = [&](int f) {
    if (bound[f] <= best.separation) return;
    const HullPlane& plane = reference.planes[f];
    const float separation =
        above(other, transpose_times(turn, plane.normal), plane.offset - dot(plane.normal, shift));
    if (separation > best.separation) best = {f, separation};
  };
  look(first);
  for (int f = 0; f < reference.face_count && best.separation <= max_separation; ++f) look(f);
  return best;
}

// Edges with the normals of their two faces, in A's frame, as columns. Plain arrays: most of them is never written.
struct EdgeColumns {
  static constexpr int kLanes = 8;
  static constexpr int kRoom = 512;
  int count = 0;
  std::uint16_t index[kRoom];
  float x[kRoom], y[kRoom], z[kRoom];  // direction
  float left_x[kRoom], left_y[kRoom], left_z[kRoom];
  float right_x[kRoom], right_y[kRoom], right_z[kRoom];

  void set(int i, Vec3 direction, Vec3 left, Vec3 right) {
    x[i] = direction.x, y[i] = direction.y, z[i] = direction.z;
    left_x[i] = left.x, left_y[i] = left.y, left_z[i] = left.z;
    right_x[i] = right.x, right_y[i] = right.y, right_z[i] = right.z;
  }
  Vec3 direction(int i) const { return {x[i], y[i], z[i]}; }
  Vec3 left(int i) const { return {left_x[i], left_y[i], left_z[i]}; }
  Vec3 right(int i) const { return {right_x[i], right_y[i], right_z[i]}; }
  // Edges without length behind the last: no arc crosses theirs.
  void pad() {
    for (int i = count; i % kLanes != 0; ++i) set(i, {}, {}, {});
  }
};
static_assert(EdgeColumns::kRoom >=
              kMaxEdges + EdgeColumns::kLanes - 1 - (kMaxEdges - 1) % EdgeColumns::kLanes);

struct EdgePair {
  int a = -1, b = -1;
  Vec3 normal;
  float separation = -kUnbounded;
};

// A bit for each of eight edges of b whose mirrored arc on the unit sphere crosses the arc of edge i of a.
unsigned arcs_cross(const EdgeColumns& a, int i, const EdgeColumns& b, int first) {
  constexpr int kHalf = 4;  // every x86-64, 64-bit ARM and WebAssembly has registers of four
  using Floats = Wide<kHalf>;
  const auto load = [](const float* x, const float* y, const float* z) {
    return Vec3W<kHalf>{Floats::load_unaligned(x), Floats::load_unaligned(y), Floats::load_unaligned(z)};
  };
  const Vec3W<kHalf> d = splat<kHalf>(a.direction(i)), l = splat<kHalf>(a.left(i)),
                     r = splat<kHalf>(a.right(i));
  const Floats zero(0.0f);
  unsigned crossing = 0;
  for (int half = 0; half < EdgeColumns::kLanes; half += kHalf) {
    const int k = first + half;
    const Vec3W<kHalf> along = load(b.x + k, b.y + k, b.z + k);
    const Floats left_b = dot(load(b.left_x + k, b.left_y + k, b.left_z + k), d);
    const Floats right_b = dot(load(b.right_x + k, b.right_y + k, b.right_z + k), d);
    const Floats left_a = dot(along, l), right_a = dot(along, r);
    // The ends of each arc lie on different sides of the other, and not on the far side of the sphere.
    const Mask<kHalf> cross =
        (left_b * right_b < zero) & (left_a * right_a < zero) & (left_b * right_a < zero);
    crossing |= to_bits(cross) << half;
  }
  return crossing;
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

// Edges of which one end lies no higher than `limit`.
void near_edges(const Polytope& p, const float* heights, float limit, EdgeColumns& out) {
  int count = 0;
  for (int e = 0; e < p.edge_count; ++e) {
    out.index[count] = std::uint16_t(e);
    count += min(heights[p.edges[e].from], heights[p.edges[e].to]) <= limit ? 1 : 0;
  }
  out.count = count;
}

struct BestFace {
  AxisKind kind;
  int face;
  Vec3 normal;  // from A to B, A's frame
  float separation;
};

// Both polytopes' edges that can still beat the best face.
class EdgeCandidates {
 public:
  EdgeCandidates(const Polytope& a, const Polytope& b, const Transform& a_from_b) : a_(a), b_(b) {
    turn_ = to_matrix(a_from_b.orientation);
    shift_ = a_from_b.position;
  }

  void collect(const BestFace& face, float max_separation) {
    float heights_a[kMaxVertices + 1], heights_b[kMaxVertices + 1];
    // A's vertices upside down, so that low means near for both.
    const Vec3 down_b = transpose_times(turn_, face.normal);
    const float shift = dot(face.normal, shift_);
    float top_a = -kUnbounded, bottom_b = kUnbounded;
    for (int i = 0; i < a_.vertex_count; ++i) {
      const float height = dot(face.normal, a_.vertices[i]);
      heights_a[i] = -height;
      top_a = max(top_a, height);
    }
    for (int i = 0; i < b_.vertex_count; ++i) {
      heights_b[i] = dot(down_b, b_.vertices[i]) + shift;
      bottom_b = min(bottom_b, heights_b[i]);
    }
    // An edge of B must come within reach of A, so not higher than A's top by more than that; A's edges likewise.
    const float margin = kReachMargin * (a_.inner_radius + b_.inner_radius);
    const float reach = max(-face.separation, max_separation) + margin;
    near_edges(a_, heights_a, reach - bottom_b, arcs_a);
    near_edges(b_, heights_b, reach + top_a, arcs_b);
    for (int i = 0; i < arcs_a.count; ++i) {
      const HullEdge& edge = a_.edges[arcs_a.index[i]];
      arcs_a.set(i, a_.vertices[edge.to] - a_.vertices[edge.from], a_.planes[edge.left].normal,
                 a_.planes[edge.right].normal);
    }
    for (int i = 0; i < arcs_b.count; ++i) {
      const HullEdge& edge = b_.edges[arcs_b.index[i]];
      arcs_b.set(i, turn_ * (b_.vertices[edge.to] - b_.vertices[edge.from]),
                 turn_ * b_.planes[edge.left].normal, turn_ * b_.planes[edge.right].normal);
    }
    arcs_b.pad();
  }

  // Whether the separation along the cross product of two edges can be above `floor`: in float, without the root, and
  // undecided (true) where the edges are nearly parallel.
  bool may_exceed(int i, int k, float floor) const {
    const Vec3 da = arcs_a.direction(i), db = arcs_b.direction(k), axis = cross(da, db);
    const float squared = dot(axis, axis);
    if (squared < kShallow * dot(da, da) * dot(db, db)) return true;
    const Vec3 pa = a_.vertices[a_.edges[arcs_a.index[i]].from];
    const Vec3 pb = turn_ * b_.vertices[b_.edges[arcs_b.index[k]].from] + shift_;
    const float along = dot(axis, pb - pa);
    const float product = dot(axis, arcs_a.left(i) + arcs_a.right(i)) < 0.0f ? -along : along;
    const float bound = floor * absolute(floor) * squared;
    return product * absolute(product) > bound;
  }

  // Whether no corner of A lies beyond its edge along the axis, and none of B before its own. Beside an edge as sharp as a
  // knife two normals all but oppose each other, so that which way is out, and whether arcs cross, is of rounding.
  bool is_outermost(int i, int k, Vec3 normal) const {
    const Vec3 from_a = a_.vertices[a_.edges[arcs_a.index[i]].from];
    const Vec3 from_b = b_.vertices[b_.edges[arcs_b.index[k]].from];
    const Vec3 down = transpose_times(turn_, normal);
    return highest_along(a_, normal) - dot(normal, from_a) <= kOutermost * a_.size &&
           dot(down, from_b) - lowest_along(b_, down) <= kOutermost * b_.size;
  }

  EdgeColumns arcs_a, arcs_b;

 private:
  const Polytope& a_;
  const Polytope& b_;
  Mat3 turn_;
  Vec3 shift_;
};

// The pair of edges of largest separation, if that is above `floor`; a = -1 if none is.
EdgePair best_edges(const Polytope& a, const Polytope& b, const Transform& a_from_b, const BestFace& face,
                    float max_separation, float floor) {
  EdgeCandidates near(a, b, a_from_b);
  near.collect(face, max_separation);
  const EdgeSearch search(a, b, a_from_b);
  EdgePair best;
  best.separation = floor;
  for (int i = 0; i < near.arcs_a.count; ++i) {
    for (int first = 0; first < near.arcs_b.count; first += EdgeColumns::kLanes) {
      for (unsigned rest = arcs_cross(near.arcs_a, i, near.arcs_b, first); rest != 0; rest &= rest - 1) {
        const int k = first + std::countr_zero(rest);
        if (!near.may_exceed(i, k, best.separation)) continue;
        EdgePair pair;
        const Vec3 outward = near.arcs_a.left(i) + near.arcs_a.right(i);
        if (!search.evaluate(near.arcs_a.index[i], near.arcs_b.index[k], outward, pair)) continue;
        if (!(pair.separation > best.separation)) continue;
        if (!near.is_outermost(i, k, pair.normal)) {
          pair.normal = -pair.normal;
          pair.separation = -pair.separation;
          if (!(pair.separation > best.separation) || !near.is_outermost(i, k, pair.normal)) continue;
        }
        best = pair;
      }
    }
  }
  return best;
}

void face_separation(const Polytope& a, const Polytope& b, const Transform& a_from_b, PolytopeAxis& axis) {
  const Mat3 turn = to_matrix(a_from_b.orientation);
  if (axis.kind == AxisKind::face_a) {
    const HullPlane& plane = a.planes[axis.index_a];
    const LowestVertex lowest = lowest_vertex(b, transpose_times(turn, plane.normal));
    axis.normal = plane.normal;
    axis.vertex = lowest.vertex;
    axis.separation = lowest.value - (plane.offset - dot(plane.normal, a_from_b.position));
    return;
  }
  const HullPlane& plane = b.planes[axis.index_b];
  axis.normal = normalized(-(turn * plane.normal));
  // The plane dot(n, x) = offset of B holds the points x = turn^T (p - t) of A.
  const LowestVertex lowest = lowest_vertex(a, -axis.normal);
  axis.vertex = lowest.vertex;
  axis.separation = lowest.value - (plane.offset - dot(axis.normal, a_from_b.position));
}

// By how much an axis must be better to take the place of one of this separation.
float bias_of(const Polytope& a, const Polytope& b, float separation) {
  return kDepthBias * absolute(separation) + kSizeBias * min(a.inner_radius, b.inner_radius);
}

// Whether `point` lies within the sides of a face by at least `margin`.
bool lies_over(const Polytope& p, int face, Vec3 point, float margin) {
  const Vec3 normal = p.planes[face].normal;
  const std::uint8_t* const first = p.face_vertices + p.face_offsets[face];
  const std::uint8_t* const last = p.face_vertices + p.face_offsets[face + 1] - 1;
  Vec3 from = p.vertices[*last];
  for (const std::uint8_t* corner = first; corner <= last; ++corner) {
    const Vec3 to = p.vertices[*corner], outward = cross(to - from, normal);
    const float inside = dot(outward, from - point);
    if (!(inside >= 0.0f) || inside * inside < square(margin) * length_squared(outward)) return false;
    from = to;
  }
  return true;
}

// Whether no axis parts the two by more than this face does, rounding aside. Let the nearest vertex lie over the face.
// Apart, it and the point below it are as near to each other as the face says. Overlapping, let the face reach farther from
// that point, by m, than the vertex lies deep, by d: along a direction that leans by t from the normal the vertex and the
// rim of that circle overlap by d cos t + m sin t, not less than d; and along those that look the other way the balls in
// the two overlap by that much, whose middles lie one before the other.
bool is_unbeaten(const Polytope& a, const Polytope& b, const Transform& a_from_b, const PolytopeAxis& axis) {
  const bool is_a = axis.kind == AxisKind::face_a;
  const Mat3 turn = to_matrix(a_from_b.orientation);
  const Vec3 shift = a_from_b.position;
  const float depth = max(-axis.separation, 0.0f);
  if (depth > 0.0f) {
    const Vec3 between = turn * b.centroid + shift - a.centroid;
    const float along = dot(between, axis.normal), room = a.inner_radius + b.inner_radius - depth;
    if (!(along >= 0.0f) || !(room >= 0.0f) || length_squared(between - along * axis.normal) > square(room))
      return false;
  }
  const Vec3 nearest =
      is_a ? turn * b.vertices[axis.vertex] + shift : transpose_times(turn, a.vertices[axis.vertex] - shift);
  return lies_over(is_a ? a : b, is_a ? axis.index_a : axis.index_b, nearest, depth);
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
    case AxisKind::face_b:
      face_separation(a, b, a_from_b, axis);
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
  const bool favours_face = favoured.kind == AxisKind::face_a || favoured.kind == AxisKind::face_b;
  const float rounding = kRounding * (a.size + b.size);
  if (favours_face && 2.0f * rounding <= bias_of(a, b, favoured.separation) &&
      favoured.separation + rounding <= max_separation && is_unbeaten(a, b, a_from_b, favoured))
    return favoured;
  const FaceQuery qa =
      best_face(a, b, a_from_b, max_separation, favoured.kind == AxisKind::face_a ? favoured.index_a : -1);
  PolytopeAxis face_a{AxisKind::face_a, qa.face, 0, 0, a.planes[qa.face].normal, qa.separation};
  if (qa.separation > max_separation) return face_a;
  const FaceQuery qb = best_face(b, a, inverse(a_from_b), max_separation,
                                 favoured.kind == AxisKind::face_b ? favoured.index_b : -1);
  PolytopeAxis face_b{AxisKind::face_b, 0, qb.face, 0, {}, qb.separation};
  face_b.normal = normalized(-rotate(a_from_b.orientation, b.planes[qb.face].normal));
  if (qb.separation > max_separation) return face_b;

  const float best = max(qa.separation, qb.separation), bias = bias_of(a, b, best);
  const PolytopeAxis& deciding = qb.separation > qa.separation ? face_b : face_a;
  EdgePair pair;
  if (PolytopeAxis face = deciding; separation_along(a, b, a_from_b, face) == -kUnbounded ||
                                    2.0f * rounding > bias || !is_unbeaten(a, b, a_from_b, face)) {
    const BestFace plane{deciding.kind, deciding.kind == AxisKind::face_a ? qa.face : qb.face,
                         deciding.normal, deciding.separation};
    pair = best_edges(a, b, a_from_b, plane, max_separation, best + 0.5f * bias);
  }
  const PolytopeAxis edges{AxisKind::edges, max(pair.a, 0),
                           max(pair.b, 0),  0,
                           pair.normal,     pair.a < 0 ? -kUnbounded : pair.separation};
  if (edges.separation > max_separation) return edges;

  // Among nearly equal ones: the favoured, then A's face, then B's, then edges.
  if (favoured.kind == AxisKind::edges && pair.a == favoured.index_a && pair.b == favoured.index_b &&
      pair.separation > best + 0.5f * bias) {
    return edges;
  }
  if (favours_face && edges.separation <= best + bias && favoured.separation >= best - bias) return favoured;
  if (edges.separation > best + bias) return edges;
  return qb.separation > qa.separation + 0.5f * bias ? face_b : face_a;
}

}  // namespace gyre
