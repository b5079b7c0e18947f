// The axis search of two boxes for W pairs side by side, with the same bits as search() of manifold_box.
//
// Pairs with nearly parallel edges need doubles; they are left to manifold_box.
#pragma once

#include "geometry/manifold/box_axes.h"
#include "math/wide_vec.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// Two boxes in the frame of the first. The index of every array is an axis.
template <int W>
struct BoxPairLanes {
  Wide<W> a[3], b[3];   // half extents
  Wide<W> r[3][3];      // r[i][j]: the component of B's axis j along A's axis i
  Wide<W> abs_r[3][3];  // |r|
  Wide<W> t[3], u[3];   // B's centre in A's frame, and the same vector in B's axes

  GYRE_INLINE BoxPairLanes(Vec3W<W> half_a, Vec3W<W> half_b, Vec3W<W> position, QuatW<W> rotation) {
    fill(a, half_a), fill(b, half_b), fill(t, position);
    const Mat3W<W> s = to_matrix(rotation), rows = transpose(s);
    fill(r[0], rows.x), fill(r[1], rows.y), fill(r[2], rows.z);
    fill(u, transpose_times(s, position));
    GYRE_UNROLL
    for (int k = 0; k < 9; ++k) abs_r[k / 3][k % 3] = absolute(r[k / 3][k % 3]);
  }

 private:
  static GYRE_INLINE void fill(Wide<W> (&to)[3], Vec3W<W> v) { to[0] = v.x, to[1] = v.y, to[2] = v.z; }
};

// The deciding axis of each lane and its separation. `known` marks the lanes in which the axis is certain.
template <int W>
struct AxisLanes {
  WideInt<W> number;
  Wide<W> separation;
  Mask<W> known;

  GYRE_INLINE void replace(Mask<W> lanes, WideInt<W> other, Wide<W> its_separation) {
    number = select(lanes, other, number);
    separation = select(lanes, its_separation, separation);
  }
};

template <int W>
struct FaceLanes {
  Wide<W> separation[boxes::kFirstEdge];

  GYRE_INLINE explicit FaceLanes(const BoxPairLanes<W>& x) {
    GYRE_UNROLL
    for (int k = 0; k < 3; ++k) {
      separation[k] = absolute(x.t[k]) - x.a[k] -
                      (x.b[0] * x.abs_r[k][0] + x.b[1] * x.abs_r[k][1] + x.b[2] * x.abs_r[k][2]);
      separation[boxes::kFirstB + k] =
          absolute(x.u[k]) - x.b[k] -
          (x.a[0] * x.abs_r[0][k] + x.a[1] * x.abs_r[1][k] + x.a[2] * x.abs_r[2][k]);
    }
  }
  GYRE_INLINE Wide<W> largest() const {
    Wide<W> best[3];
    GYRE_UNROLL
    for (int k = 0; k < 3; ++k) best[k] = max(separation[boxes::kFirstB + k], separation[k]);
    return max(max(best[0], best[1]), best[2]);
  }
  // The first axis with at least this separation; one of them must have it.
  GYRE_INLINE AxisLanes<W> first(Wide<W> threshold) const {
    constexpr int kLast = boxes::kFirstEdge - 1;
    AxisLanes<W> axis{kLast, separation[kLast], Mask<W>::splat(true)};
    GYRE_UNROLL
    for (int k = kLast - 1; k >= 0; --k) axis.replace(separation[k] >= threshold, k, separation[k]);
    return axis;
  }
  GYRE_INLINE Wide<W> of(WideInt<W> number) const {
    Wide<W> own = separation[0];
    GYRE_UNROLL
    for (int k = 1; k < boxes::kFirstEdge; ++k) own = select(number == WideInt<W>(k), separation[k], own);
    return own;
  }
};

// The best axis of two edges among those above `floor`, and the separation along the favoured axis if that is one of
// two edges.
template <int W>
struct EdgeLanes {
  AxisLanes<W> best{boxes::kNoAxis, -kUnbounded, Mask<W>::splat(true)};
  AxisLanes<W> favoured{boxes::kNoAxis, -kUnbounded, Mask<W>::splat(true)};

  GYRE_INLINE EdgeLanes(const BoxPairLanes<W>& x, Wide<W> floor, WideInt<W> favoured_number) {
    Wide<W> extents[3];
    GYRE_UNROLL
    for (int k = 0; k < 3; ++k) extents[k] = x.a[k] + x.b[k] + absolute(x.t[k]);
    const Wide<W> rounding = Wide<W>(boxes::kRounding) * (extents[0] + extents[1] + extents[2]);
    const Wide<W> steep_floor = min(floor, Wide<W>(0.0f));
    favoured.number = favoured_number;
    GYRE_UNROLL
    for (int k = 0; k < 9; ++k) test_edges(x, k / 3, k % 3, floor, steep_floor, rounding);
  }

 private:
  GYRE_INLINE void test_edges(const BoxPairLanes<W>& x, int i, int j, Wide<W> floor, Wide<W> steep_floor,
                              Wide<W> rounding) {
    const int i1 = boxes::kNext[i], i2 = boxes::kAfter[i], j1 = boxes::kNext[j], j2 = boxes::kAfter[j];
    const Wide<W> r1 = x.r[i1][j], r2 = x.r[i2][j];
    const Wide<W> apart = absolute(x.t[i2] * r1 - x.t[i1] * r2);
    const Wide<W> radius_a = x.a[i1] * x.abs_r[i2][j] + x.a[i2] * x.abs_r[i1][j];
    const Wide<W> radius_b = x.b[j1] * x.abs_r[i][j2] + x.b[j2] * x.abs_r[i][j1];
    const Wide<W> product = apart - radius_a - radius_b, squared = r1 * r1 + r2 * r2, root = sqrt(squared);
    const Mask<W> steep = squared >= Wide<W>(boxes::kShallow),
                  parallel = squared <= Wide<W>(boxes::kParallel);
    const Wide<W> threshold = select(steep, steep_floor, floor) * root;
    const Mask<W> hopeless = (product + keep(~steep, rounding) <= threshold) | parallel;
    const Wide<W> separation = product / root;
    const WideInt<W> number(boxes::kFirstEdge + 3 * i + j);
    best.known = best.known & (steep | hopeless);
    best.replace(and_not(steep, hopeless) & (separation > best.separation), number, separation);
    const Mask<W> own = favoured.number == number;
    favoured.known = favoured.known & ~and_not(own, steep | parallel);
    favoured.separation = select(and_not(own, parallel), separation, favoured.separation);
  }
};

// `favoured` is the axis that decided last time, or kNoAxis.
template <int W>
GYRE_INLINE AxisLanes<W> search_axes(const BoxPairLanes<W>& x, Wide<W> max_separation, WideInt<W> favoured) {
  using namespace boxes;
  const FaceLanes<W> faces(x);
  const Wide<W> face = faces.largest();
  Wide<W> thin[3];
  GYRE_UNROLL
  for (int k = 0; k < 3; ++k) thin[k] = min(x.a[k], x.b[k]);
  const Wide<W> bias =
      Wide<W>(kDepthBias) * absolute(face) + Wide<W>(kSizeBias) * min(min(thin[0], thin[1]), thin[2]);
  const Wide<W> floor = face + Wide<W>(0.5f) * bias;
  const EdgeLanes<W> edges(x, floor, favoured);
  const AxisLanes<W>& edge = edges.best;
  const Mask<W> favours_edge = favoured >= WideInt<W>(kFirstEdge),
                favours_face = and_not(favoured >= WideInt<W>(0), favours_edge);
  const Wide<W> own = select(favours_edge, edges.favoured.separation,
                             select(favours_face, faces.of(favoured), Wide<W>(-kUnbounded)));

  // In ascending order of precedence.
  AxisLanes<W> found = faces.first(face - Wide<W>(0.5f) * bias);
  found.replace((edge.number > WideInt<W>(kNoAxis)) & (edge.separation > face + bias), edge.number,
                edge.separation);
  const Mask<W> keeps_edge = favours_edge & (own > floor) & (own >= edge.separation - bias);
  const Mask<W> keeps_face = favours_face & (own >= face - bias) & (edge.separation <= face + bias);
  found.replace(keeps_edge | keeps_face, favoured, own);
  found.replace(edge.separation > max_separation, edge.number, edge.separation);
  const Mask<W> face_separates = face > max_separation, own_separates = own > max_separation;
  const AxisLanes<W> first = faces.first(face);
  found.replace(face_separates, first.number, face);
  found.replace(own_separates, favoured, own);
  const Mask<W> finite = face - face == Wide<W>(0.0f);
  found.known = finite & edges.favoured.known & (edge.known | face_separates | own_separates);
  return found;
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
