// Two boxes in the frame of the first, for the manifold of one pair (manifold_box). The three numbers of half extents,
// axes and centres stand side by side, so one operation serves all three axes.
#pragma once

#include "geometry/manifold/box_axes.h"
#include "math/wide.h"

namespace gyre::boxes {

// Three numbers side by side, one for each axis. The fourth lane has no meaning; masks exclude it by kThree.
using Floats = Wide<4>;
constexpr std::uint32_t kThree = 7u;

inline Floats three(Vec3 v) { return Floats::of(Floats::Float{v.x, v.y, v.z, 0.0f}); }
inline Vec3 to_vec3(Floats n) { return {n[0], n[1], n[2]}; }
template <int kLane>
inline Floats spread(Floats n) {
  return Floats::of(__builtin_shufflevector(n.v, n.v, kLane, kLane, kLane, kLane));
}
// For each axis the number of the next axis, and of the one after that.
inline Floats next(Floats n) { return Floats::of(__builtin_shufflevector(n.v, n.v, 1, 2, 0, 3)); }
inline Floats after(Floats n) { return Floats::of(__builtin_shufflevector(n.v, n.v, 2, 0, 1, 3)); }
// The i-th number of the first, the j-th of the second and the k-th of the third.
template <int i, int j, int k>
inline Floats join(Floats a, Floats b, Floats c) {
  const Floats::Float ab = __builtin_shufflevector(a.v, b.v, i, i, 4 + j, 4 + j);
  return Floats::of(__builtin_shufflevector(ab, c.v, 0, 2, 4 + k, 7));
}
inline float lowest(Floats n) { return min(min(n[0], n[1]), n[2]); }
inline float highest(Floats n) { return max(max(n[0], n[1]), n[2]); }

// Both boxes in A's frame.
struct Boxes {
  alignas(16) float a[4];  // half extents
  float b[4];
  float r[3][4];  // r[i][j]: the component of B's axis j along A's axis i
  float s[3][4];  // the transpose: s[j][i]
  float t[4];     // B's centre in A's frame
  float u[4];     // the same vector in B's axes

  Boxes(const Shape& box_a, const Shape& box_b, const Transform& a_from_b);
};

inline Boxes::Boxes(const Shape& box_a, const Shape& box_b, const Transform& a_from_b) {
  three(box_a.extents).store(a);
  three(box_b.extents).store(b);
  // As to_matrix(), with equal operations side by side.
  const Quat& rotation = a_from_b.orientation;
  const Floats q = three({rotation.x, rotation.y, rotation.z}), twice = q + q;
  const Floats squares = q * twice, products = q * next(twice), with_w = Floats(rotation.w) * after(twice);
  const Floats along = Floats(1.0f) - (next(squares) + after(squares));
  const Floats sum = products + with_w, difference = products - with_w;
  join<0, 0, 2>(along, sum, difference).store(s[0]);
  join<0, 1, 1>(difference, along, sum).store(s[1]);
  join<2, 1, 2>(sum, difference, along).store(s[2]);
  const Floats r0 = join<0, 0, 2>(along, difference, sum), r1 = join<0, 1, 1>(sum, along, difference),
               r2 = join<2, 1, 2>(difference, sum, along);
  r0.store(r[0]), r1.store(r[1]), r2.store(r[2]);
  const Floats center = three(a_from_b.position);
  center.store(t);
  (r0 * spread<0>(center) + r1 * spread<1>(center) + r2 * spread<2>(center)).store(u);
}

// The smallest half extent of both boxes.
inline float thinnest(const Boxes& x) { return lowest(min(Floats::load(x.a), Floats::load(x.b))); }

// A corner is numbered by the signs of its coordinates (bit 0: x positive ...), an edge by its axis and the signs of
// the two other coordinates.
constexpr std::uint32_t edge_number(int axis, std::uint32_t corner) {
  return std::uint32_t(axis) * 4u + ((corner >> kNext[axis]) & 1u) + 2u * ((corner >> kAfter[axis]) & 1u);
}

}  // namespace gyre::boxes
