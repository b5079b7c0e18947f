// Box against box. See manifold_box.h.
#include "geometry/manifold/manifold_box.h"

#include "geometry/manifold/box_pair.h"
#include "geometry/manifold/clip.h"
#include "geometry/manifold/manifold_box_face.h"
#include "geometry/manifold/manifold_core.h"
#include "geometry/manifold/manifold_crossing.h"
#include "math/rotation.h"

#include <bit>

namespace gyre {
namespace boxes {
namespace {

// Separations along the face normals of the box with half extents `own`. In its frame the centre of the other box is
// `offset`, and the axes of the other box are `axes`.
inline Floats face_separations(const float* own, const float* other, const float* offset,
                               const float (*axes)[4]) {
  const Floats h = Floats::load(other);
  return absolute(Floats::load(offset)) - Floats::load(own) -
         (spread<0>(h) * absolute(Floats::load(axes[0])) + spread<1>(h) * absolute(Floats::load(axes[1])) +
          spread<2>(h) * absolute(Floats::load(axes[2])));
}

// The separations along all six face normals.
struct FaceAxes {
  Floats of_a, of_b;

  explicit FaceAxes(const Boxes& x)
      : of_a(face_separations(x.a, x.b, x.t, x.s)), of_b(face_separations(x.b, x.a, x.u, x.r)) {}
  float operator[](int axis) const { return axis < kFirstB ? of_a[axis] : of_b[axis - kFirstB]; }
  // Never NaN, because A's separations are not.
  float largest() const { return highest(max(of_b, of_a)); }
  // The first axis with at least this separation; one of them must have it.
  int first(Floats threshold) const {
    constexpr std::uint32_t kLast = 1u << (kFirstEdge - 1);
    return std::countr_zero((to_bits(of_a >= threshold) & kThree) | to_bits(of_b >= threshold) << kFirstB |
                            kLast);
  }
};

// The edges of A's axis i with all three of B's, side by side: the separation times the length of the cross product,
// and that length squared.
struct EdgeRow {
  Floats product, squared;

  EdgeRow(const Boxes& x, int i) {
    const int i1 = kNext[i], i2 = kAfter[i];
    const Floats r1 = Floats::load(x.r[i1]), r2 = Floats::load(x.r[i2]), b = Floats::load(x.b);
    const Floats c = absolute(Floats::load(x.r[i]));
    const Floats apart = absolute(Floats(x.t[i2]) * r1 - Floats(x.t[i1]) * r2);
    const Floats radius_a = Floats(x.a[i1]) * absolute(r2) + Floats(x.a[i2]) * absolute(r1);
    const Floats radius_b = next(b) * after(c) + after(b) * next(c);
    product = apart - radius_a - radius_b;
    squared = r1 * r1 + r2 * r2;
  }
};

// Separation along the cross product of two nearly parallel edges, free of cancellation.
float shallow_edge(const Boxes& x, const Transform& a_from_b, int i, int j) {
  const DQuat q = normalized(to_double(a_from_b.orientation));
  const DVec3 columns[3] = {rotate(q, DVec3{1, 0, 0}), rotate(q, DVec3{0, 1, 0}), rotate(q, DVec3{0, 0, 1})};
  const DVec3 edge_a{i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
  const DVec3 axis = cross(edge_a, columns[j]);
  double radius = 0.0;
  for (int k = 0; k < 3; ++k) {
    radius += double(x.a[k]) * absolute(axis[k]) + double(x.b[k]) * absolute(dot(columns[k], axis));
  }
  const double n = length(axis);
  return n > 0.0 ? float((absolute(dot(DVec3(a_from_b.position), axis)) - radius) / n) : -kUnbounded;
}

float edge_separation(const Boxes& x, const Transform& a_from_b, int i, int j) {
  const EdgeRow row(x, i);
  const float squared = row.squared[j];
  if (squared <= kParallel) return -kUnbounded;
  if (squared < kShallow) return shallow_edge(x, a_from_b, i, j);
  return row.product[j] / std::sqrt(squared);
}

// The best axis of two edges among those that beat `floor`.
Axis search_edges(const Boxes& x, const Transform& a_from_b, float floor) {
  // The rounding error of a product. It matters only for nearly parallel edges.
  const Floats extents = Floats::load(x.a) + Floats::load(x.b) + absolute(Floats::load(x.t));
  const Floats rounding(kRounding * (extents[0] + extents[1] + extents[2]));
  alignas(16) float product[3][4], length[3][4];
  std::uint32_t remaining = 0, steep = 0;  // four bits for each row
  for (int i = 0; i < 3; ++i) {
    const EdgeRow row(x, i);
    const Floats root = sqrt(row.squared);
    const Mask<4> is_steep = row.squared >= kShallow;
    // Steep edges between 0 and the floor stay, because they may be farther apart than allowed.
    const Floats threshold = select(is_steep, Floats(min(floor, 0.0f)), Floats(floor)) * root;
    const Mask<4> hopeless =
        (row.product + keep(~is_steep, rounding) <= threshold) | (row.squared <= kParallel);
    remaining |= (to_bits(~hopeless) & kThree) << 4 * i;
    steep |= to_bits(is_steep) << 4 * i;
    row.product.store(product[i]), root.store(length[i]);
  }
  Axis best;
  for (; remaining != 0; remaining &= remaining - 1) {
    const int lane = std::countr_zero(remaining), i = lane / 4, j = lane % 4;
    const float separation =
        (steep >> lane & 1u) != 0 ? product[i][j] / length[i][j] : shallow_edge(x, a_from_b, i, j);
    if (separation > best.separation) best = {kFirstEdge + 3 * i + j, separation};
  }
  return best;
}

// The deciding axis. Stops at the first one along which the boxes are farther apart than allowed.
Axis search(const Boxes& x, const FaceAxes& faces, const Transform& a_from_b, float max_separation,
            const Axis& favoured) {
  Axis face;
  face.separation = faces.largest();
  face.number = faces.first(face.separation);
  if (face.separation > max_separation) return face;
  const float bias = kDepthBias * absolute(face.separation) + kSizeBias * thinnest(x);

  // Edges matter only if they beat the face by more than half of the bias.
  const float floor = face.separation + 0.5f * bias;
  const Axis edge = search_edges(x, a_from_b, floor);
  if (edge.separation > max_separation) return edge;

  // Among nearly equal axes: the favoured one, then the face with the lowest number, then edges.
  if (favoured.number >= kFirstEdge) {
    if (favoured.separation > floor && favoured.separation >= edge.separation - bias) return favoured;
  } else if (favoured.number >= 0 && favoured.separation >= face.separation - bias &&
             edge.separation <= face.separation + bias) {
    return favoured;
  }
  if (edge.number != kNoAxis && edge.separation > face.separation + bias) return edge;
  const int first = faces.first(face.separation - 0.5f * bias);
  return {first, faces[first]};
}

// Float serves for edges that cross at an angle. Nearly parallel edges need double: their crossing and their normal
// come from small differences.
struct FloatEdges {
  using Real = float;
  using Vector = Vec3;
  Vector columns[3];  // B's axes in A's frame
  Vector normal;      // along the cross product of both edges
  FloatEdges(const Boxes& x, const Transform&, const Axis&, Vec3 n)
      : columns{to_vec3(Floats::load(x.s[0])), to_vec3(Floats::load(x.s[1])), to_vec3(Floats::load(x.s[2]))},
        normal(n) {}
  static Vec3 to_float(Vec3 v) { return v; }
};
struct DoubleEdges {
  using Real = double;
  using Vector = DVec3;
  Vector columns[3];
  Vector normal;
  DoubleEdges(const Boxes&, const Transform& a_from_b, const Axis& edges, Vec3) {
    const DQuat q = normalized(to_double(a_from_b.orientation));
    const auto axis = [](int k) { return DVec3{k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0}; };
    for (int k = 0; k < 3; ++k) columns[k] = rotate(q, axis(k));
    const DVec3 across = cross(axis(edges.edge_a()), columns[edges.edge_b()]);
    normal = across / length(across);
  }
  static Vec3 to_float(DVec3 v) { return gyre::to_float(v); }
};

// Leaves out.count at 0 if the edges do not cross. Another feature of separated boxes is then closer; of overlapping
// boxes the faces at the nearly parallel edges were as good.
template <class Edges>
void collide_edges(const Boxes& x, const Transform& a_from_b, const Axis& found, Vec3 along,
                   LocalManifold& out) {
  using Real = typename Edges::Real;
  using Vector = typename Edges::Vector;
  const Edges edges(x, a_from_b, found, along);
  const int i = found.edge_a(), j = found.edge_b();
  const Vector edge_a{Real(i == 0), Real(i == 1), Real(i == 2)};
  const Vector edge_b = edges.columns[j];
  const Vector across = cross(edge_a, edge_b);
  Vector normal = edges.normal;
  const Vector t{Real(a_from_b.position.x), Real(a_from_b.position.y), Real(a_from_b.position.z)};
  if (dot(normal, t) < Real(0)) normal = -normal;
  // The edge of each box that is farthest along the normal towards the other.
  Real on_a[3], on_b_local[3];
  std::uint32_t corner_a = 0, corner_b = 0;
  for (int k = 0; k < 3; ++k) {
    const bool up_a = normal[k] > Real(0);
    on_a[k] = k == i ? Real(0) : Real(up_a ? x.a[k] : -x.a[k]);
    corner_a |= up_a ? 1u << k : 0u;
    const bool up_b = dot(normal, edges.columns[k]) < Real(0);
    on_b_local[k] = k == j ? Real(0) : Real(up_b ? x.b[k] : -x.b[k]);
    corner_b |= up_b ? 1u << k : 0u;
  }
  const Vector pa{on_a[0], on_a[1], on_a[2]};
  Vector pb = t;
  for (int k = 0; k < 3; ++k) pb += on_b_local[k] * edges.columns[k];
  // Closest points of the two lines. Both directions are unit vectors and not parallel.
  const Vector d = pb - pa;
  const Real c = dot(edge_a, edge_b), da = dot(d, edge_a), db = dot(d, edge_b);
  const Real det = across[kNext[i]] * across[kNext[i]] + across[kAfter[i]] * across[kAfter[i]];
  const Real along_a = (da - c * db) / det, along_b = (c * da - db) / det;
  const Real end_a = clamp(along_a, Real(-x.a[i]), Real(x.a[i])),
             end_b = clamp(along_b, Real(-x.b[j]), Real(x.b[j]));
  const Vector on_edge_a = pa + end_a * edge_a, on_edge_b = pb + end_b * edge_b;
  // The edges do not cross: an end is closest.
  if ((end_a != along_a || end_b != along_b) &&
      (found.separation > 0.0f ||
       length(on_edge_b - on_edge_a) >
           Real((1.0f + kDepthTolerance) * -found.separation + kMissTolerance * thinnest(x))))
    return;
  out.normal = Edges::to_float(normal);
  out.count = 1;
  out.points[0].position = Edges::to_float(Real(0.5) * (on_edge_a + on_edge_b));
  out.points[0].separation = found.separation;
  out.points[0].feature = feature_edges(edge_number(i, corner_a), edge_number(j, corner_b));
}

// The face whose normal is within kNearFace of `normal`, the axis of two edges; no axis if there is none.
Axis face_near_edges(const Boxes& x, Vec3 normal) {
  const Floats along_a = absolute(three(normal));
  const Floats along_b = absolute(normal.x * Floats::load(x.r[0]) + normal.y * Floats::load(x.r[1]) +
                                  normal.z * Floats::load(x.r[2]));
  Axis best;
  const Floats nearest_of_all(kNearFace);
  if (((to_bits(along_a > nearest_of_all) | to_bits(along_b > nearest_of_all)) & kThree) == 0) return best;
  const FaceAxes faces(x);
  float nearest = kNearFace;
  for (int k = 0; k < 3; ++k) {
    if (along_a[k] > nearest) nearest = along_a[k], best = {k, faces.of_a[k]};
    if (along_b[k] > nearest) nearest = along_b[k], best = {kFirstB + k, faces.of_b[k]};
  }
  return best;
}

// See manifold_crossing.h.
void collide_crossing(const Boxes& x, const Transform& a_from_b, const Axis& edges, float max_separation,
                      LocalManifold& out) {
  const int i = edges.edge_a();
  const Vec3 edge_a{i == 0 ? 1.0f : 0.0f, i == 1 ? 1.0f : 0.0f, i == 2 ? 1.0f : 0.0f};
  const Vec3 normal = normalized(cross(edge_a, to_vec3(Floats::load(x.s[edges.edge_b()]))));
  const Axis face = face_near_edges(x, normal);
  if (face.number != kNoAxis) {
    collide_face(x, face, max_separation, out);
    if (replaces_crossing(out, edges.separation, thinnest(x))) return;
    out.count = 0;
  }
  if (EdgeRow(x, i).squared[edges.edge_b()] < kShallow) {
    collide_edges<DoubleEdges>(x, a_from_b, edges, normal, out);
  } else {
    collide_edges<FloatEdges>(x, a_from_b, edges, normal, out);
  }
}

// The deciding axis, or the last one if it still separates the boxes by more than allowed: most pairs that did not
// touch last time do not touch now.
Axis find_axis(const Boxes& x, const Transform& a_from_b, float max_separation, const PairCache& cache) {
  const FaceAxes faces(x);
  Axis favoured;
  if (cache.words[0] - 1u < std::uint32_t(kAxisCount)) {
    favoured.number = int(cache.words[0]) - 1;
    favoured.separation = favoured.number < kFirstEdge
                              ? faces[favoured.number]
                              : edge_separation(x, a_from_b, favoured.edge_a(), favoured.edge_b());
    if (favoured.separation > max_separation) return favoured;
  }
  return search(x, faces, a_from_b, max_separation, favoured);
}

struct Pair {
  const Shape& a;
  const Shape& b;
  const Transform& a_from_b;
  float max_separation;
};

// A place at an edge of a box along one axis, within `reach`. It is given in the frame of the box.
bool is_at_edge(const float* half, Vec3 place, int along, float reach) {
  for (const int k : {kNext[along], kAfter[along]})
    if (absolute(absolute(place[k]) - half[k]) > reach) return false;
  return true;
}
Vec3 onto_edge(const float* half, Vec3 place, int along) {
  const auto at = [&](int k) { return k == along ? place[k] : place[k] < 0.0f ? -half[k] : half[k]; };
  return {at(0), at(1), at(2)};
}
// The sum of the normals of both faces at an edge.
Vec3 out_of_edge(Vec3 place, int along) {
  const auto at = [&](int k) { return k == along ? 0.0f : place[k] < 0.0f ? -1.0f : 1.0f; };
  return {at(0), at(1), at(2)};
}

// Boxes that lean on each other with two parallel edges touch at these edges alone. All normals between those of the faces around the
// edges are as good, and that of one face would ask for friction which neither box needs: the normal halves the angle. Faces that are
// nearly parallel keep theirs.
void lean_on_edges(const Boxes& x, LocalManifold& out) {
  constexpr float kReach = 0.02f;                // of the thinnest half extent
  constexpr float kAlong = 0.9999f;              // cosine of parallel edges
  constexpr float kLow = 0.26f, kHigh = 0.966f;  // cosines of 75 and 15 degrees, between the faces of the two
  const float reach = kReach * thinnest(x);
  const Vec3 axes_b[3] = {to_vec3(Floats::load(x.s[0])), to_vec3(Floats::load(x.s[1])),
                          to_vec3(Floats::load(x.s[2]))};
  const Vec3 center_b = to_vec3(Floats::load(x.t));
  const auto in_b = [&](Vec3 p) {
    const Vec3 d = p - center_b;
    return Vec3{dot(d, axes_b[0]), dot(d, axes_b[1]), dot(d, axes_b[2])};
  };
  const auto turned = [&](Vec3 v) { return v.x * axes_b[0] + v.y * axes_b[1] + v.z * axes_b[2]; };
  int deepest = 0;
  for (int k = 1; k < out.count; ++k)
    if (out.points[k].separation < out.points[deepest].separation) deepest = k;
  const Vec3 on_a = out.points[deepest].position, on_b = in_b(on_a);
  for (int i = 0; i < 3; ++i) {
    if (!is_at_edge(x.a, on_a, i, reach)) continue;
    int j = 0;
    while (j < 3 && !(absolute(x.r[i][j]) > kAlong)) ++j;
    if (j == 3 || !is_at_edge(x.b, on_b, j, reach)) continue;
    const Vec3 out_of_a = out_of_edge(on_a, i), facing = turned(out_of_edge(on_b, j));
    const float cosine = -0.5f * dot(out_of_a, facing);
    if (!(cosine > kLow && cosine < kHigh)) return;
    out.normal = normalized(out_of_a - facing);
    int kept = 0;
    for (int k = 0; k < out.count; ++k) {
      const Vec3 place = out.points[k].position, place_b = in_b(place);
      if (!is_at_edge(x.a, place, i, reach) || !is_at_edge(x.b, place_b, j, reach)) continue;
      const Vec3 edge_a = onto_edge(x.a, place, i), edge_b = center_b + turned(onto_edge(x.b, place_b, j));
      out.points[k].position = 0.5f * (edge_a + edge_b);
      out.points[k].separation = dot(edge_b - edge_a, out.normal);
      out.points[kept++] = out.points[k];
    }
    out.count = kept;
    return;
  }
}

// The manifold along the deciding axis, whose separation is within the allowed one. out.count must be 0.
void collide_along(const Boxes& x, const Axis& found, const Pair& pair, PairCache& cache,
                   LocalManifold& out) {
  if (found.number >= kFirstEdge) {
    collide_crossing(x, pair.a_from_b, found, pair.max_separation, out);
  } else {
    collide_face(x, found, pair.max_separation, out);
    // The points miss the closest or deepest feature, which lies beside the face.
    const float excess = deepest_of(out) - found.separation;
    if (excess > kMissTolerance * thinnest(x) + kDepthTolerance * max(-found.separation, 0.0f)) out.count = 0;
  }
  // The boxes are close or overlap, but no face projects onto the other.
  if (out.count == 0) collide_cores(pair.a, pair.b, pair.a_from_b, pair.max_separation, cache, out);
  if (out.count > 0) lean_on_edges(x, out);
}

}  // namespace
}  // namespace boxes

boxes::Axis find_box_axis(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                          const PairCache& cache) {
  // Bodies that are about to be removed from the world.
  if (!is_finite(a_from_b.position) || !is_finite(a_from_b.orientation)) return {0, kUnbounded};
  return boxes::find_axis(boxes::Boxes(a, b, a_from_b), a_from_b, max_separation, cache);
}

Vec3 box_axis_normal(const boxes::Axis& axis, const Transform& a_from_b) {
  const Mat3 rotation = to_matrix(a_from_b.orientation);
  const Vec3 columns[3] = {rotation.x, rotation.y, rotation.z};
  const auto own = [](int k) {
    return Vec3{k == 0 ? 1.0f : 0.0f, k == 1 ? 1.0f : 0.0f, k == 2 ? 1.0f : 0.0f};
  };
  const Vec3 normal = axis.number < boxes::kFirstB ? own(axis.number)
                      : axis.number < boxes::kFirstEdge
                          ? columns[axis.number - boxes::kFirstB]
                          : normalized(cross(own(axis.edge_a()), columns[axis.edge_b()]));
  return dot(normal, a_from_b.position) < 0.0f ? -normal : normal;
}

void collide_boxes(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                   PairCache& cache, LocalManifold& out) {
  out.count = 0;
  const boxes::Boxes x(a, b, a_from_b);
  const boxes::Axis found = boxes::find_axis(x, a_from_b, max_separation, cache);
  cache.words[0] = std::uint32_t(found.number + 1);
  if (found.separation <= max_separation)
    boxes::collide_along(x, found, boxes::Pair{a, b, a_from_b, max_separation}, cache, out);
}

void collide_boxes_along(const boxes::Axis& axis, const Shape& a, const Shape& b, const Transform& a_from_b,
                         float max_separation, PairCache& cache, LocalManifold& out) {
  out.count = 0;
  cache.words[0] = std::uint32_t(axis.number + 1);
  if (axis.separation <= max_separation)
    boxes::collide_along(boxes::Boxes(a, b, a_from_b), axis, boxes::Pair{a, b, a_from_b, max_separation},
                         cache, out);
}

}  // namespace gyre
