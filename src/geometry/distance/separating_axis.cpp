// The axis search over faces and edges. See separating_axis.h.
#include "geometry/distance/separating_axis.h"

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

constexpr int kLanes = kPolytopeLanes;
using Floats = Wide<kLanes>;

// The best face of `reference` against `other`, both in reference's frame except that other's columns stay its own. None but
// those above `floor` count: where there are none that is what comes back.
struct FaceQuery {
  int face = 0;
  float separation = -kUnbounded;
};
FaceQuery best_face(const Polytope& reference, const Polytope& other, const Transform& reference_from_other,
                    float max_separation, int favoured, float floor) {
  FaceQuery best{0, floor};
  const Mat3 turn = to_matrix(reference_from_other.orientation);
  const Vec3 shift = reference_from_other.position;
  const Vec3 center = turn * other.centroid + shift;
  // The other's inner ball bounds what a face can reach, so a good first face spares most of the rest.
  float bound[kMaxHullFaces + 1];
  const int count = reference.face_count;
  Floats largest_bound(-kUnbounded);
  for (int f = 0; f < count; f += kLanes) {
    const PlaneLanes planes = load_planes(reference, f);
    const Floats bounds =
        dot(planes.normal, splat<kLanes>(center)) - planes.offset - Floats(other.inner_radius);
    bounds.store_unaligned(bound + f);
    largest_bound = max(bounds, largest_bound);
  }
  for (int f = count; f % kLanes != 0; ++f) bound[f] = -kUnbounded;
  int first = favoured;
  if (first < 0) {
    const float largest =
        max(max(largest_bound[0], largest_bound[1]), max(largest_bound[2], largest_bound[3]));
    first = 0;
    while (first + 1 < count && bound[first] != largest) ++first;
  }
  const auto look = [&](int f) {
    const HullPlane& plane = reference.planes[f];
    const float separation =
        lowest_along(other, transpose_times(turn, plane.normal)) - (plane.offset - dot(plane.normal, shift));
    if (separation > best.separation) best = {f, separation};
  };
  look(first);
  for (int f = 0; f < count; f += kLanes) {
    const auto better = [&] { return to_bits(Floats::load_unaligned(bound + f) > Floats(best.separation)); };
    // Those behind the last one looked at.
    for (unsigned rest = better(), left = ~0u; rest != 0; rest = better() & left) {
      if (best.separation > max_separation) return best;
      const int lane = std::countr_zero(rest);
      left = ~1u << lane;
      look(f + lane);
    }
  }
  return best;
}

// An edge with the normals of its two faces, which end an arc on the unit sphere.
template <class Vector>
struct Arc {
  Vector direction, left, right;
};
using ArcsW = Arc<Vec3W<kLanes>>;

Arc<Vec3> arc_of(const Polytope& p, const HullEdge& edge) {
  return {edge.direction, p.planes[edge.left].normal, p.planes[edge.right].normal};
}
ArcsW in_every_lane(const Arc<Vec3>& arc) {
  return {splat<kLanes>(arc.direction), splat<kLanes>(arc.left), splat<kLanes>(arc.right)};
}

// Some edges of a polytope. Plain arrays: most of them is never written.
struct EdgeList {
  static constexpr int kRoom = (kMaxHullEdges + kLanes - 1) / kLanes * kLanes;
  int count = 0;
  std::uint16_t index[kRoom];
};

struct EdgePair {
  int a = -1, b = -1;
  Vec3 normal;
  float separation = -kUnbounded;
};

// A bit for each of four edges of B whose mirrored arc on the unit sphere crosses the arc of an edge of A.
GYRE_INLINE unsigned arcs_cross(const ArcsW& a, const ArcsW& b) {
  const Floats left_b = dot(b.left, a.direction), right_b = dot(b.right, a.direction);
  const Floats left_a = dot(b.direction, a.left), right_a = dot(b.direction, a.right);
  // The ends of each arc lie on different sides of the other, and not on the far side of the sphere.
  const Floats zero(0.0f);
  return to_bits((left_b * right_b < zero) & (left_a * right_a < zero) & (left_b * right_a < zero));
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

  // Where the lines of two edges pass each other: how far from the nearest end of either, and the sine between them. The
  // product of the smaller of the two and the sine; negative if they pass beyond an end.
  float hold(int edge_a, int edge_b) const {
    const HullEdge &ea = a_.edges[edge_a], &eb = b_.edges[edge_b];
    const DVec3 pa(a_.vertices[ea.from]), pb = rotate(turn_, DVec3(b_.vertices[eb.from])) + shift_;
    const DVec3 da(ea.direction), db = rotate(turn_, DVec3(eb.direction)), between = pb - pa;
    const double aa = dot(da, da), bb = dot(db, db), ab = dot(da, db);
    const double determinant = aa * bb - ab * ab;
    if (!(determinant > double(kShallow) * aa * bb)) return -1.0f;
    const double s = (dot(between, da) * bb - dot(between, db) * ab) / determinant;
    const double t = (dot(between, da) * ab - dot(between, db) * aa) / determinant;
    const double sine = std::sqrt(determinant / (aa * bb));
    return float(sine * min(min(s, 1.0 - s) * std::sqrt(aa), min(t, 1.0 - t) * std::sqrt(bb)));
  }

 private:
  const Polytope& a_;
  const Polytope& b_;
  DQuat turn_;
  DVec3 shift_;
};

// How high the vertices lie along a direction; returns the lowest of them.
float find_heights(const Polytope& p, Vec3 up, float shift, float* heights) {
  const Vec3W<kLanes> direction = splat<kLanes>(up);
  Floats lowest(kUnbounded);
  for (int i = 0; i < p.padded_count; i += kLanes) {
    const Floats height = values_along(p, i, direction) + Floats(shift);
    height.store_unaligned(heights + i);
    lowest = min(height, lowest);
  }
  return min(min(lowest[0], lowest[1]), min(lowest[2], lowest[3]));
}

// Edges of which one end lies no higher than `limit`.
void near_edges(const Polytope& p, const float* heights, float limit, EdgeList& out) {
  std::uint64_t near[(kMaxHullEdges + 63) / 64] = {};
  for (int i = 0; i < p.padded_count; i += kLanes) {
    unsigned low = to_bits(Floats::load_unaligned(heights + i) <= Floats(limit));
    for (; low != 0; low &= low - 1) {
      // The padding repeats the last vertex.
      const int vertex = min(i + std::countr_zero(low), p.vertex_count - 1);
      for (int word = 0; word < p.edge_words; ++word) near[word] |= p.edges_of[vertex * p.edge_words + word];
    }
  }
  out.count = 0;
  for (int word = 0; word < p.edge_words; ++word)
    for_each_edge(near[word], word, [&](int e) { out.index[out.count++] = std::uint16_t(e); });
}

// Of these edges the ones along whose axes a body with a ball of this radius around `center`, in the polytope's frame, can be
// farther away than `floor`: some normal between those of the edge's two faces sees the near side of the ball that high above
// the edge. It sees the middle as high as the one face or the other does, or, where the middle lies between the two normals,
// as far as it is from the edge.
void keep_reaching(const Polytope& p, Vec3 center, float radius, float floor, EdgeList& list) {
  const Floats least(floor + radius), zero(0.0f), one(1.0f);
  int kept = 0;
  for (int first = 0; first < list.count; first += kLanes) {
    const float *left[kLanes], *right[kLanes];
    for (int lane = 0; lane < kLanes; ++lane) {
      const HullEdge& edge = p.edges[list.index[min(first + lane, list.count - 1)]];
      left[lane] = &p.planes[edge.left].normal.x;
      right[lane] = &p.planes[edge.right].normal.x;
    }
    const PlaneLanes a = gather_planes(left), b = gather_planes(right);
    const Floats over_a = dot(a.normal, splat<kLanes>(center)) - a.offset;
    const Floats over_b = dot(b.normal, splat<kLanes>(center)) - b.offset;
    const Floats cosine = dot(a.normal, b.normal);
    const Mask<kLanes> between = (over_a > over_b * cosine) & (over_b > over_a * cosine);
    const Floats squared = over_a * over_a + over_b * over_b - Floats(2.0f) * over_a * over_b * cosine;
    const Mask<kLanes> far = (least < zero) | (squared > least * least * (one - cosine * cosine));
    unsigned rest = to_bits((max(over_a, over_b) > least) | (between & far));
    rest &= list.count - first < kLanes ? (1u << (list.count - first)) - 1u : ~0u;
    for (; rest != 0; rest &= rest - 1) list.index[kept++] = list.index[first + std::countr_zero(rest)];
  }
  list.count = kept;
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

  void collect(const BestFace& face, float max_separation, float floor) {
    float heights_a[kMaxHullVertices + 1], heights_b[kMaxHullVertices + 1];
    // A's vertices upside down, so that low means near for both.
    const float bottom_a = find_heights(a_, -face.normal, 0.0f, heights_a);
    const float bottom_b =
        find_heights(b_, transpose_times(turn_, face.normal), dot(face.normal, shift_), heights_b);
    // An edge of B must come within reach of A, so not higher than A's top by more than that; A's edges likewise.
    const float margin = kReachMargin * (a_.inner_radius + b_.inner_radius);
    const float reach = max(-face.separation, max_separation) + margin;
    near_edges(a_, heights_a, reach - bottom_b, near_a);
    near_edges(b_, heights_b, reach - bottom_a, near_b);
    const float certain = floor - kRounding * (a_.size + b_.size);
    keep_reaching(a_, turn_ * b_.centroid + shift_, b_.inner_radius, certain, near_a);
    if (near_a.count == 0) return;
    keep_reaching(b_, transpose_times(turn_, a_.centroid - shift_), a_.inner_radius, certain, near_b);
    const Mat3W<kLanes> turn{splat<kLanes>(turn_.x), splat<kLanes>(turn_.y), splat<kLanes>(turn_.z)};
    for (int first = 0; first < near_b.count; first += kLanes) {
      const float *edges[kLanes], *left[kLanes], *right[kLanes];
      Vec3W<kLanes> from;
      for (int lane = 0; lane < kLanes; ++lane) {
        const HullEdge& edge = b_.edges[near_b.index[min(first + lane, near_b.count - 1)]];
        edges[lane] = reinterpret_cast<const float*>(&edge);
        left[lane] = &b_.planes[edge.left].normal.x;
        right[lane] = &b_.planes[edge.right].normal.x;
        from.x.set(lane, b_.x[edge.from]), from.y.set(lane, b_.y[edge.from]),
            from.z.set(lane, b_.z[edge.from]);
      }
      Floats columns[4];
      Rows<kLanes>::gather(edges, 0, columns);
      ArcsW& arcs = arcs_b_[first / kLanes];
      arcs.direction = turn * Vec3W<kLanes>{columns[1], columns[2], columns[3]};
      Rows<kLanes>::gather(left, 0, columns);
      arcs.left = turn * Vec3W<kLanes>{columns[0], columns[1], columns[2]};
      Rows<kLanes>::gather(right, 0, columns);
      arcs.right = turn * Vec3W<kLanes>{columns[0], columns[1], columns[2]};
      from_b_[first / kLanes] = turn * from + splat<kLanes>(shift_);
    }
    // No arc crosses that of an edge without length, which those behind the last are.
    for (int i = near_b.count; i % kLanes != 0; ++i) {
      Vec3W<kLanes>& direction = arcs_b_[i / kLanes].direction;
      direction.x.set(i % kLanes, 0.0f), direction.y.set(i % kLanes, 0.0f), direction.z.set(i % kLanes, 0.0f);
    }
  }

  // A bit for each of the four edges of B from `first` on whose arc crosses that of A's.
  unsigned crossing(const ArcsW& arc, int first) const { return arcs_cross(arc, arcs_b_[first / kLanes]); }

  // A bit for each of the four whose separation from A's edge, along the cross product of the two, can be above `floor`: in
  // float, without the root, and undecided (set) where the edges are nearly parallel.
  unsigned may_exceed(int i, const ArcsW& arc, int first, float floor) const {
    const Vec3W<kLanes> da = arc.direction, db = arcs_b_[first / kLanes].direction, axis = cross(da, db);
    const Floats squared = dot(axis, axis);
    const Mask<kLanes> undecided = squared < Floats(kShallow) * dot(da, da) * dot(db, db);
    const Vec3W<kLanes> from_a = splat<kLanes>(a_.vertices[a_.edges[near_a.index[i]].from]);
    const Floats along = dot(axis, from_b_[first / kLanes] - from_a);
    const Floats product = select(dot(axis, arc.left + arc.right) < Floats(0.0f), -along, along);
    return to_bits(undecided | (product * absolute(product) > Floats(floor * absolute(floor)) * squared));
  }

  // Whether no corner of A lies beyond its edge along the axis, and none of B before its own. Beside an edge as sharp as a
  // knife two normals all but oppose each other, so that which way is out, and whether arcs cross, is of rounding.
  bool is_outermost(int i, int k, Vec3 normal) const {
    const Vec3 from_a = a_.vertices[a_.edges[near_a.index[i]].from];
    const Vec3 from_b = b_.vertices[b_.edges[near_b.index[k]].from];
    const Vec3 down = transpose_times(turn_, normal);
    return highest_along(a_, normal) - dot(normal, from_a) <= kOutermost * a_.size &&
           dot(down, from_b) - lowest_along(b_, down) <= kOutermost * b_.size;
  }

  EdgeList near_a, near_b;

 private:
  const Polytope& a_;
  const Polytope& b_;
  Mat3 turn_;
  Vec3 shift_;
  // Of B's near edges, in A's frame.
  ArcsW arcs_b_[EdgeList::kRoom / kLanes];
  Vec3W<kLanes> from_b_[EdgeList::kRoom / kLanes];
};

// The pair of edges of largest separation, if that is above `floor`; a = -1 if none is.
EdgePair best_edges(const Polytope& a, const Polytope& b, const Transform& a_from_b, const BestFace& face,
                    float max_separation, float floor) {
  EdgeCandidates near(a, b, a_from_b);
  near.collect(face, max_separation, floor);
  const EdgeSearch search(a, b, a_from_b);
  EdgePair best;
  best.separation = floor;
  for (int i = 0; i < near.near_a.count; ++i) {
    const Arc<Vec3> arc = arc_of(a, a.edges[near.near_a.index[i]]);
    const ArcsW arcs = in_every_lane(arc);
    for (int first = 0; first < near.near_b.count; first += kLanes) {
      unsigned rest = near.crossing(arcs, first);
      if (rest != 0) rest &= near.may_exceed(i, arcs, first, best.separation);
      while (rest != 0) {
        const int k = first + std::countr_zero(rest);
        rest &= rest - 1;
        EdgePair pair;
        if (!search.evaluate(near.near_a.index[i], near.near_b.index[k], arc.left + arc.right, pair))
          continue;
        if (!(pair.separation > best.separation)) continue;
        if (!near.is_outermost(i, k, pair.normal)) {
          pair.normal = -pair.normal;
          pair.separation = -pair.separation;
          if (!(pair.separation > best.separation) || !near.is_outermost(i, k, pair.normal)) continue;
        }
        best = pair;
        if (rest != 0) rest &= near.may_exceed(i, arcs, first, best.separation);
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

// The cosine between a direction and the normal of the face that is nearest to it.
float nearest_normal(const Polytope& p, Vec3 direction) {
  Floats nearest(-1.0f);
  for (int f = 0; f < p.face_count; f += kLanes)
    nearest = max(dot(load_planes(p, f).normal, splat<kLanes>(direction)), nearest);
  return max(max(nearest[0], nearest[1]), max(nearest[2], nearest[3]));
}

// Whether the two ends of an edge lie lower along `up` than all other vertices by more than `gap`.
bool is_lowest_alone(const Polytope& p, const HullEdge& edge, Vec3 up, float gap) {
  const Floats limit(dot(p.vertices[edge.from], up) + gap);
  const WideInt<kLanes> from(edge.from), to(edge.to), last(p.vertex_count - 1);
  constexpr std::int32_t kOwn[kLanes] = {0, 1, 2, 3};
  WideInt<kLanes> index = WideInt<kLanes>::load_unaligned(kOwn);
  for (int i = 0; i < p.padded_count; i += kLanes) {
    const WideInt<kLanes> vertex = min(index, last);
    const Mask<kLanes> low = values_along(p, i, splat<kLanes>(up)) <= limit;
    if (any(and_not(and_not(low, vertex == from), vertex == to))) return false;
    index = index + WideInt<kLanes>(kLanes);
  }
  return true;
}

// Whether a search would come to the favoured edges: no face parts the two by nearly as much, and no other pair of edges
// does as well. Let the two cross amid both, and `hold` be how far the edges reach beyond the crossing, h. Along a direction
// that leans by t from their axis, of separation s, points of the two edges are apart by s cos t - h sin t at most; along
// those that look the other way what is_unbeaten says of the balls holds. So faces are worse by what their normals lean.
// Other edges are worse beyond rounding from some lean on, and none that leans less is outermost where all other vertices
// lie lower.
bool is_unbeaten_pair(const Polytope& a, const Polytope& b, const Transform& a_from_b,
                      const PolytopeAxis& axis, float rounding) {
  const float s = axis.edge_separation, h = EdgeSearch(a, b, a_from_b).hold(axis.index_a, axis.index_b);
  const float lean = 8.0f * rounding / h;
  if (!(h > 0.0f) || !(lean <= 0.5f) || -s > h) return false;

  const Mat3 turn = to_matrix(a_from_b.orientation);
  const Vec3 between = turn * b.centroid + a_from_b.position - a.centroid;
  const float along = dot(between, axis.normal);
  if (!(along >= 0.0f)) return false;
  const Vec3 down = transpose_times(turn, axis.normal);
  const float cosine = max(nearest_normal(a, axis.normal), nearest_normal(b, -down));
  const float sine = std::sqrt(max(1.0f - cosine * cosine - 1.0e-6f, 0.0f));
  const float others = max(max(s * cosine - h * sine, -h),
                           length(between - along * axis.normal) - a.inner_radius - b.inner_radius);
  if (!(s > others + 0.5f * bias_of(a, b, others) + 2.0f * rounding)) return false;

  const HullEdge &edge_a = a.edges[axis.index_a], &edge_b = b.edges[axis.index_b];
  // The widest that a polytope can be for its size is 2 sqrt(3).
  const float gap = kOutermost + 3.5f * lean;
  if (!is_lowest_alone(a, edge_a, -axis.normal, gap * a.size) ||
      !is_lowest_alone(b, edge_b, down, gap * b.size))
    return false;
  const Arc<Vec3> arc_b{turn * edge_b.direction, turn * b.planes[edge_b.left].normal,
                        turn * b.planes[edge_b.right].normal};
  return arcs_cross(in_every_lane(arc_of(a, edge_a)), in_every_lane(arc_b)) != 0;
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
      axis.edge_separation = pair.separation;
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
  if (favoured.kind == AxisKind::edges && favoured.edge_separation + rounding <= max_separation &&
      is_unbeaten_pair(a, b, a_from_b, favoured, rounding)) {
    PolytopeAxis edges = favoured;
    edges.separation = favoured.edge_separation;
    return edges;
  }
  const FaceQuery qa = best_face(a, b, a_from_b, max_separation,
                                 favoured.kind == AxisKind::face_a ? favoured.index_a : -1, -kUnbounded);
  PolytopeAxis face_a{AxisKind::face_a, qa.face, 0, 0, a.planes[qa.face].normal, qa.separation};
  if (qa.separation > max_separation) return face_a;
  const FaceQuery qb = best_face(b, a, inverse(a_from_b), max_separation,
                                 favoured.kind == AxisKind::face_b ? favoured.index_b : -1, qa.separation);
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
