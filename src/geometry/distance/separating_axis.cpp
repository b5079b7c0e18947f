// The axis search over faces and edges. See separating_axis.h.
#include "geometry/distance/separating_axis.h"

#include "geometry/distance/sat_tolerance.h"
#include "math/rotation.h"
#include "math/wide_vec.h"

#include <bit>

namespace gyre {
namespace {

// Margin of the height test of edges, relative to the size of the shapes.
constexpr float kHeightMargin = 1.0e-4f;
// How far a corner may lie beyond the outermost edge, relative to the largest coordinate.
constexpr float kOutermost = 1.0e-5f;
// Largest error of a separation from rounding, kOutermost and corners off the planes of their faces, relative to the
// sum of the sizes.
constexpr float kRounding = 3.0e-5f;

constexpr int kLanes = kPolytopeLanes;
using Floats = Wide<kLanes>;

// The best face of `reference` against `other`, in the frame of `reference`; the columns of `other` stay in its own.
// Only faces above `floor` count. Without such a face the separation is `floor`.
struct FaceQuery {
  int face = 0;
  float separation = -kUnbounded;
};
FaceQuery best_face(const Polytope& reference, const Polytope& other, const Transform& reference_from_other,
                    float max_separation, int favoured, float floor) {
  FaceQuery best{0, floor};
  const Mat3 rotation = to_matrix(reference_from_other.orientation);
  const Vec3 shift = reference_from_other.position;
  const Vec3 center = rotation * other.centroid + shift;
  // The inner ball of `other` bounds the separation along each face. A good first face excludes most of the others.
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
  const auto test_face = [&](int f) {
    const HullPlane& plane = reference.planes[f];
    const float separation = lowest_along(other, transpose_times(rotation, plane.normal)) -
                             (plane.offset - dot(plane.normal, shift));
    if (separation > best.separation) best = {f, separation};
  };
  test_face(first);
  for (int f = 0; f < count; f += kLanes) {
    const auto better = [&] { return to_bits(Floats::load_unaligned(bound + f) > Floats(best.separation)); };
    // Only faces after the last one tested.
    for (unsigned rest = better(), later = ~0u; rest != 0; rest = better() & later) {
      if (best.separation > max_separation) return best;
      const int lane = std::countr_zero(rest);
      later = ~1u << lane;
      test_face(f + lane);
    }
  }
  return best;
}

// An edge with the normals of its two faces. The normals are the ends of an arc on the unit sphere.
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

// Some edges of a polytope. Plain arrays, because most elements are never written.
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
  // The ends of each arc lie on different sides of the other, and the arcs are not on opposite sides of the sphere.
  const Floats zero(0.0f);
  return to_bits((left_b * right_b < zero) & (left_a * right_a < zero) & (left_b * right_a < zero));
}

class EdgeSearch {
 public:
  EdgeSearch(const Polytope& a, const Polytope& b, const Transform& a_from_b)
      : a_(a), b_(b), rotation_(normalized(to_double(a_from_b.orientation))), shift_(a_from_b.position) {}

  // The axis of one pair, in double, so that shallow crossings keep their direction. Returns false if the edges are
  // parallel.
  bool evaluate(int edge_a, int edge_b, Vec3 outward, EdgePair& out) const {
    const HullEdge &ea = a_.edges[edge_a], &eb = b_.edges[edge_b];
    const DVec3 pa(a_.vertices[ea.from]), pb = rotate(rotation_, DVec3(b_.vertices[eb.from])) + shift_;
    const DVec3 da = DVec3(a_.vertices[ea.to]) - pa;
    const DVec3 db = rotate(rotation_, DVec3(b_.vertices[eb.to]) - DVec3(b_.vertices[eb.from]));
    DVec3 axis = cross(da, db);
    const double squared = dot(axis, axis);
    if (!(squared > kSatParallel * dot(da, da) * dot(db, db))) return false;
    axis = axis / std::sqrt(squared);
    if (dot(axis, DVec3(outward)) < 0.0) axis = -axis;
    out = {edge_a, edge_b, to_float(axis), float(dot(axis, pb - pa))};
    return true;
  }

  // How safely two edges cross: the distance of the crossing from the closest end of either edge, times the sine
  // between the edges. Negative if their lines cross beyond an end.
  float crossing_margin(int edge_a, int edge_b) const {
    const HullEdge &ea = a_.edges[edge_a], &eb = b_.edges[edge_b];
    const DVec3 pa(a_.vertices[ea.from]), pb = rotate(rotation_, DVec3(b_.vertices[eb.from])) + shift_;
    const DVec3 da(ea.direction), db = rotate(rotation_, DVec3(eb.direction)), between = pb - pa;
    const double aa = dot(da, da), bb = dot(db, db), ab = dot(da, db);
    const double determinant = aa * bb - ab * ab;
    if (!(determinant > double(kSatShallow) * aa * bb)) return -1.0f;
    const double s = (dot(between, da) * bb - dot(between, db) * ab) / determinant;
    const double t = (dot(between, da) * ab - dot(between, db) * aa) / determinant;
    const double sine = std::sqrt(determinant / (aa * bb));
    return float(sine * min(min(s, 1.0 - s) * std::sqrt(aa), min(t, 1.0 - t) * std::sqrt(bb)));
  }

 private:
  const Polytope& a_;
  const Polytope& b_;
  DQuat rotation_;
  DVec3 shift_;
};

// Writes the height of each vertex along `up`. Returns the lowest height.
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

// Edges with an end no higher than the limit.
void find_low_edges(const Polytope& p, const float* heights, float limit, EdgeList& out) {
  std::uint64_t low_edges[(kMaxHullEdges + 63) / 64] = {};
  for (int i = 0; i < p.padded_count; i += kLanes) {
    unsigned low = to_bits(Floats::load_unaligned(heights + i) <= Floats(limit));
    for (; low != 0; low &= low - 1) {
      // The padding repeats the last vertex.
      const int vertex = min(i + std::countr_zero(low), p.vertex_count - 1);
      for (int word = 0; word < p.edge_words; ++word)
        low_edges[word] |= p.edges_of[vertex * p.edge_words + word];
    }
  }
  out.count = 0;
  for (int word = 0; word < p.edge_words; ++word)
    for_each_edge(low_edges[word], word, [&](int e) { out.index[out.count++] = std::uint16_t(e); });
}

// Removes the edges whose axes cannot separate the polytope by more than `floor` from a body that contains a ball of
// this radius around `center` (in the polytope's frame). An edge stays if some normal between those of its two faces
// sees the near side of the ball that high above the edge. The centre of the ball is as high as over one of the two
// faces; if it lies between the two normals, it is as high as its distance from the edge.
void cull_by_inner_ball(const Polytope& p, Vec3 center, float radius, float floor, EdgeList& list) {
  const Floats threshold(floor + radius), zero(0.0f), one(1.0f);
  int count_left = 0;
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
    const Mask<kLanes> high_over_edge =
        (threshold < zero) | (squared > threshold * threshold * (one - cosine * cosine));
    unsigned rest = to_bits((max(over_a, over_b) > threshold) | (between & high_over_edge));
    rest &= list.count - first < kLanes ? (1u << (list.count - first)) - 1u : ~0u;
    for (; rest != 0; rest &= rest - 1) list.index[count_left++] = list.index[first + std::countr_zero(rest)];
  }
  list.count = count_left;
}

struct BestFace {
  AxisKind kind;
  int face;
  Vec3 normal;  // from A to B, A's frame
  float separation;
};

// The edges of both polytopes that can still beat the best face.
class EdgeCandidates {
 public:
  EdgeCandidates(const Polytope& a, const Polytope& b, const Transform& a_from_b) : a_(a), b_(b) {
    rotation_ = to_matrix(a_from_b.orientation);
    shift_ = a_from_b.position;
  }

  void collect(const BestFace& face, float max_separation, float floor) {
    float heights_a[kMaxHullVertices + 1], heights_b[kMaxHullVertices + 1];
    // A's vertices are mirrored, so that low means close for both.
    const float bottom_a = find_heights(a_, -face.normal, 0.0f, heights_a);
    const float bottom_b =
        find_heights(b_, transpose_times(rotation_, face.normal), dot(face.normal, shift_), heights_b);
    // An edge of B can be no higher above A's top than the allowed gap. The same holds for A's edges.
    const float margin = kHeightMargin * (a_.inner_radius + b_.inner_radius);
    const float max_height = max(-face.separation, max_separation) + margin;
    find_low_edges(a_, heights_a, max_height - bottom_b, edges_a);
    find_low_edges(b_, heights_b, max_height - bottom_a, edges_b);
    const float certain = floor - kRounding * (a_.size + b_.size);
    cull_by_inner_ball(a_, rotation_ * b_.centroid + shift_, b_.inner_radius, certain, edges_a);
    if (edges_a.count == 0) return;
    cull_by_inner_ball(b_, transpose_times(rotation_, a_.centroid - shift_), a_.inner_radius, certain,
                       edges_b);
    const Mat3W<kLanes> rotation{splat<kLanes>(rotation_.x), splat<kLanes>(rotation_.y),
                                 splat<kLanes>(rotation_.z)};
    for (int first = 0; first < edges_b.count; first += kLanes) {
      const float *edges[kLanes], *left[kLanes], *right[kLanes];
      Vec3W<kLanes> from;
      for (int lane = 0; lane < kLanes; ++lane) {
        const HullEdge& edge = b_.edges[edges_b.index[min(first + lane, edges_b.count - 1)]];
        edges[lane] = reinterpret_cast<const float*>(&edge);
        left[lane] = &b_.planes[edge.left].normal.x;
        right[lane] = &b_.planes[edge.right].normal.x;
        from.x.set(lane, b_.x[edge.from]), from.y.set(lane, b_.y[edge.from]),
            from.z.set(lane, b_.z[edge.from]);
      }
      Floats columns[4];
      Rows<kLanes>::gather(edges, 0, columns);
      ArcsW& arcs = arcs_b_[first / kLanes];
      arcs.direction = rotation * Vec3W<kLanes>{columns[1], columns[2], columns[3]};
      Rows<kLanes>::gather(left, 0, columns);
      arcs.left = rotation * Vec3W<kLanes>{columns[0], columns[1], columns[2]};
      Rows<kLanes>::gather(right, 0, columns);
      arcs.right = rotation * Vec3W<kLanes>{columns[0], columns[1], columns[2]};
      from_b_[first / kLanes] = rotation * from + splat<kLanes>(shift_);
    }
    // An edge without length crosses no arc. Such edges fill the lanes after the last edge.
    for (int i = edges_b.count; i % kLanes != 0; ++i) {
      Vec3W<kLanes>& direction = arcs_b_[i / kLanes].direction;
      direction.x.set(i % kLanes, 0.0f), direction.y.set(i % kLanes, 0.0f), direction.z.set(i % kLanes, 0.0f);
    }
  }

  // A bit for each of the four edges of B from `first` on whose arc crosses that of A's edge.
  unsigned crossing(const ArcsW& arc, int first) const { return arcs_cross(arc, arcs_b_[first / kLanes]); }

  // A bit for each of the four edges of B whose separation from A's edge, along the cross product of both, may be above
  // `floor`. Computed in float without the root. The bit is also set if the edges are too nearly parallel to decide.
  unsigned exceeding(int i, const ArcsW& arc, int first, float floor) const {
    const Vec3W<kLanes> da = arc.direction, db = arcs_b_[first / kLanes].direction, axis = cross(da, db);
    const Floats squared = dot(axis, axis);
    const Mask<kLanes> undecided = squared < Floats(kSatShallow) * dot(da, da) * dot(db, db);
    const Vec3W<kLanes> from_a = splat<kLanes>(a_.vertices[a_.edges[edges_a.index[i]].from]);
    const Floats along = dot(axis, from_b_[first / kLanes] - from_a);
    const Floats product = select(dot(axis, arc.left + arc.right) < Floats(0.0f), -along, along);
    return to_bits(undecided | (product * absolute(product) > Floats(floor * absolute(floor)) * squared));
  }

  // True if no corner of A lies beyond its edge along the axis, and no corner of B before its own. At a razor-sharp
  // edge two normals nearly oppose each other; rounding then decides the sign of the axis and whether arcs cross.
  bool is_outermost(int i, int k, Vec3 normal) const {
    const Vec3 from_a = a_.vertices[a_.edges[edges_a.index[i]].from];
    const Vec3 from_b = b_.vertices[b_.edges[edges_b.index[k]].from];
    const Vec3 down = transpose_times(rotation_, normal);
    return highest_along(a_, normal) - dot(normal, from_a) <= kOutermost * a_.size &&
           dot(down, from_b) - lowest_along(b_, down) <= kOutermost * b_.size;
  }

  EdgeList edges_a, edges_b;

 private:
  const Polytope& a_;
  const Polytope& b_;
  Mat3 rotation_;
  Vec3 shift_;
  // Of the candidate edges of B, in A's frame.
  ArcsW arcs_b_[EdgeList::kRoom / kLanes];
  Vec3W<kLanes> from_b_[EdgeList::kRoom / kLanes];
};

// The pair of edges with the largest separation above `floor`; a = -1 if there is none.
EdgePair best_edges(const Polytope& a, const Polytope& b, const Transform& a_from_b, const BestFace& face,
                    float max_separation, float floor) {
  EdgeCandidates candidates(a, b, a_from_b);
  candidates.collect(face, max_separation, floor);
  const EdgeSearch search(a, b, a_from_b);
  EdgePair best;
  best.separation = floor;
  for (int i = 0; i < candidates.edges_a.count; ++i) {
    const Arc<Vec3> arc = arc_of(a, a.edges[candidates.edges_a.index[i]]);
    const ArcsW arcs = in_every_lane(arc);
    for (int first = 0; first < candidates.edges_b.count; first += kLanes) {
      unsigned rest = candidates.crossing(arcs, first);
      if (rest != 0) rest &= candidates.exceeding(i, arcs, first, best.separation);
      while (rest != 0) {
        const int k = first + std::countr_zero(rest);
        rest &= rest - 1;
        EdgePair pair;
        if (!search.evaluate(candidates.edges_a.index[i], candidates.edges_b.index[k], arc.left + arc.right,
                             pair))
          continue;
        if (!(pair.separation > best.separation)) continue;
        if (!candidates.is_outermost(i, k, pair.normal)) {
          pair.normal = -pair.normal;
          pair.separation = -pair.separation;
          if (!(pair.separation > best.separation) || !candidates.is_outermost(i, k, pair.normal)) continue;
        }
        best = pair;
        if (rest != 0) rest &= candidates.exceeding(i, arcs, first, best.separation);
      }
    }
  }
  return best;
}

void face_separation(const Polytope& a, const Polytope& b, const Transform& a_from_b, PolytopeAxis& axis) {
  const Mat3 rotation = to_matrix(a_from_b.orientation);
  if (axis.kind == AxisKind::face_a) {
    const HullPlane& plane = a.planes[axis.index_a];
    const LowestVertex lowest = lowest_vertex(b, transpose_times(rotation, plane.normal));
    axis.normal = plane.normal;
    axis.vertex = lowest.vertex;
    axis.separation = lowest.value - (plane.offset - dot(plane.normal, a_from_b.position));
    return;
  }
  const HullPlane& plane = b.planes[axis.index_b];
  axis.normal = normalized(-(rotation * plane.normal));
  // The plane dot(n, x) = offset of B contains the points x = rotation^T (p - t) of A.
  const LowestVertex lowest = lowest_vertex(a, -axis.normal);
  axis.vertex = lowest.vertex;
  axis.separation = lowest.value - (plane.offset - dot(axis.normal, a_from_b.position));
}

// By how much an axis must be better to replace one of this separation.
float bias_of(const Polytope& a, const Polytope& b, float separation) {
  return kSatDepthBias * absolute(separation) + kSatSizeBias * min(a.inner_radius, b.inner_radius);
}

// True if `point` projects into a face, at least `margin` inside its sides.
bool projects_into(const Polytope& p, int face, Vec3 point, float margin) {
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

// True if no axis can beat this face by more than rounding. The closest vertex must project into the face. If the
// polytopes are apart, the vertex and its projection are as close as the face says. If they overlap, let the vertex lie
// d deep, and let the face extend by m > d around the projection. Along a direction that leans by t from the normal,
// the vertex and the rim of that circle overlap by d cos t + m sin t >= d. Along directions of the opposite half, the
// inner balls overlap by that much, because their centres lie one before the other.
bool is_best_face(const Polytope& a, const Polytope& b, const Transform& a_from_b, const PolytopeAxis& axis) {
  const bool is_a = axis.kind == AxisKind::face_a;
  const Mat3 rotation = to_matrix(a_from_b.orientation);
  const Vec3 shift = a_from_b.position;
  const float depth = max(-axis.separation, 0.0f);
  if (depth > 0.0f) {
    const Vec3 between = rotation * b.centroid + shift - a.centroid;
    const float along = dot(between, axis.normal), room = a.inner_radius + b.inner_radius - depth;
    if (!(along >= 0.0f) || !(room >= 0.0f) || length_squared(between - along * axis.normal) > square(room))
      return false;
  }
  const Vec3 nearest = is_a ? rotation * b.vertices[axis.vertex] + shift
                            : transpose_times(rotation, a.vertices[axis.vertex] - shift);
  return projects_into(is_a ? a : b, is_a ? axis.index_a : axis.index_b, nearest, depth);
}

// The cosine between a direction and the closest face normal.
float nearest_normal(const Polytope& p, Vec3 direction) {
  Floats nearest(-1.0f);
  for (int f = 0; f < p.face_count; f += kLanes)
    nearest = max(dot(load_planes(p, f).normal, splat<kLanes>(direction)), nearest);
  return max(max(nearest[0], nearest[1]), max(nearest[2], nearest[3]));
}

// True if both ends of an edge are lower along `up` than all other vertices by more than `gap`.
bool is_lowest_alone(const Polytope& p, const HullEdge& edge, Vec3 up, float gap) {
  const Floats max_height(dot(p.vertices[edge.from], up) + gap);
  const WideInt<kLanes> from(edge.from), to(edge.to), last(p.vertex_count - 1);
  constexpr std::int32_t kOwn[kLanes] = {0, 1, 2, 3};
  WideInt<kLanes> index = WideInt<kLanes>::load_unaligned(kOwn);
  for (int i = 0; i < p.padded_count; i += kLanes) {
    const WideInt<kLanes> vertex = min(index, last);
    const Mask<kLanes> low = values_along(p, i, splat<kLanes>(up)) <= max_height;
    if (any(and_not(and_not(low, vertex == from), vertex == to))) return false;
    index = index + WideInt<kLanes>(kLanes);
  }
  return true;
}

// True if a full search would also choose the favoured edges: no face is nearly as good, and no other pair of edges is
// as good. The two must cross well inside both; let h be how far the edges extend beyond the crossing, and s the
// separation along their axis. Along a direction that leans by t from that axis, points of the two edges are apart by s
// cos t - h sin t at most. In the opposite half the argument of is_best_face about inner balls holds. So faces are
// worse by the lean of their normals. Other edges are worse beyond rounding from some lean on, and no pair that leans
// less is outermost if all other vertices lie lower.
bool is_best_edge_pair(const Polytope& a, const Polytope& b, const Transform& a_from_b,
                       const PolytopeAxis& axis, float rounding) {
  const float s = axis.edge_separation,
              h = EdgeSearch(a, b, a_from_b).crossing_margin(axis.index_a, axis.index_b);
  const float lean = 8.0f * rounding / h;
  if (!(h > 0.0f) || !(lean <= 0.5f) || -s > h) return false;

  const Mat3 rotation = to_matrix(a_from_b.orientation);
  const Vec3 between = rotation * b.centroid + a_from_b.position - a.centroid;
  const float along = dot(between, axis.normal);
  if (!(along >= 0.0f)) return false;
  const Vec3 down = transpose_times(rotation, axis.normal);
  const float cosine = max(nearest_normal(a, axis.normal), nearest_normal(b, -down));
  const float sine = std::sqrt(max(1.0f - cosine * cosine - 1.0e-6f, 0.0f));
  const float bound_of_others = max(max(s * cosine - h * sine, -h),
                                    length(between - along * axis.normal) - a.inner_radius - b.inner_radius);
  if (!(s > bound_of_others + 0.5f * bias_of(a, b, bound_of_others) + 2.0f * rounding)) return false;

  const HullEdge &edge_a = a.edges[axis.index_a], &edge_b = b.edges[axis.index_b];
  // The extent of a polytope is at most 2 sqrt(3) times its size.
  const float gap = kOutermost + 3.5f * lean;
  if (!is_lowest_alone(a, edge_a, -axis.normal, gap * a.size) ||
      !is_lowest_alone(b, edge_b, down, gap * b.size))
    return false;
  const Arc<Vec3> arc_b{rotation * edge_b.direction, rotation * b.planes[edge_b.left].normal,
                        rotation * b.planes[edge_b.right].normal};
  return arcs_cross(in_every_lane(arc_of(a, edge_a)), in_every_lane(arc_b)) != 0;
}

}  // namespace

std::uint32_t encode_axis(const PolytopeAxis& axis) {
  return (std::uint32_t(axis.kind) << 24) | (std::uint32_t(axis.index_a) << 12) | std::uint32_t(axis.index_b);
}

PolytopeAxis decode_axis(std::uint32_t name, const Polytope& a, const Polytope& b) {
  PolytopeAxis axis;
  const std::uint32_t kind = name >> 24;
  const int index_a = int((name >> 12) & 0xfffu), index_b = int(name & 0xfffu);
  if (kind == 0 || kind > std::uint32_t(AxisKind::edges)) return axis;
  const AxisKind decoded = AxisKind(kind);
  const int limit_a = decoded == AxisKind::edges ? a.edge_count : a.face_count;
  const int limit_b = decoded == AxisKind::edges ? b.edge_count : b.face_count;
  if (index_a >= limit_a || index_b >= limit_b) return axis;
  axis.kind = decoded;
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
      // The edges may no longer face each other. The support points along their cross product are exact in any case.
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
      favoured.separation + rounding <= max_separation && is_best_face(a, b, a_from_b, favoured))
    return favoured;
  if (favoured.kind == AxisKind::edges && favoured.edge_separation + rounding <= max_separation &&
      is_best_edge_pair(a, b, a_from_b, favoured, rounding)) {
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
                                    2.0f * rounding > bias || !is_best_face(a, b, a_from_b, face)) {
    const BestFace plane{deciding.kind, deciding.kind == AxisKind::face_a ? qa.face : qb.face,
                         deciding.normal, deciding.separation};
    pair = best_edges(a, b, a_from_b, plane, max_separation, best + 0.5f * bias);
  }
  const PolytopeAxis edges{AxisKind::edges, max(pair.a, 0),
                           max(pair.b, 0),  0,
                           pair.normal,     pair.a < 0 ? -kUnbounded : pair.separation};
  if (edges.separation > max_separation) return edges;

  // Among nearly equal axes: the favoured one, then A's face, then B's, then edges.
  if (favoured.kind == AxisKind::edges && pair.a == favoured.index_a && pair.b == favoured.index_b &&
      pair.separation > best + 0.5f * bias) {
    return edges;
  }
  if (favours_face && edges.separation <= best + bias && favoured.separation >= best - bias) return favoured;
  if (edges.separation > best + bias) return edges;
  return qb.separation > qa.separation + 0.5f * bias ? face_b : face_a;
}

}  // namespace gyre
