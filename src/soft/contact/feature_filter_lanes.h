// The filter of pairs with W of them side by side. See feature_filter.h.
#pragma once

#include "math/wide_vec.h"
#include "soft/contact/feature_filter.h"

#include <bit>

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// Four vertices of W pairs, from the first of them.
template <int W>
struct PairLanes {
  Vec3W<W> p[4];  // p[0] is zero
  Vec3W<W> move[4];
  Wide<W> reach[4];

  GYRE_INLINE PairLanes(const SurfaceCandidate* pairs, int first, int count, const FilterVertex* vertices) {
    alignas(64) float lanes[4][7][W];
    for (int i = 0; i < W; ++i) {
      const SurfaceCandidate& pair = pairs[first + i < count ? first + i : count - 1];
      for (int k = 0; k < 4; ++k) {
        const FilterVertex& v = vertices[pair.vertex[k]];
        lanes[k][0][i] = v.x, lanes[k][1][i] = v.y, lanes[k][2][i] = v.z, lanes[k][3][i] = v.reach;
        lanes[k][4][i] = v.move_x, lanes[k][5][i] = v.move_y, lanes[k][6][i] = v.move_z;
      }
    }
    const Vec3W<W> origin{Wide<W>::load(lanes[0][0]), Wide<W>::load(lanes[0][1]), Wide<W>::load(lanes[0][2])};
    for (int k = 0; k < 4; ++k) {
      const Vec3W<W> at{Wide<W>::load(lanes[k][0]), Wide<W>::load(lanes[k][1]), Wide<W>::load(lanes[k][2])};
      p[k] = at - origin;
      reach[k] = Wide<W>::load(lanes[k][3]);
      move[k] = {Wide<W>::load(lanes[k][4]), Wide<W>::load(lanes[k][5]), Wide<W>::load(lanes[k][6])};
    }
  }
};

template <int W>
GYRE_INLINE Wide<W> share_on(Wide<W> part, Wide<W> whole) {
  return clamp(part / max(whole, Wide<W>(1.0e-30f)), Wide<W>(0.0f), Wide<W>(1.0f));
}

// True in lanes where A, whose least extent along `way` is `low`, and B, whose greatest is `high`, are farther apart than `reach`.
template <int W>
GYRE_INLINE Mask<W> is_apart(Vec3W<W> way, Wide<W> low, Wide<W> high, Wide<W> reach) {
  const Wide<W> gap = low - high;
  return (gap > Wide<W>(0.0f)) & (square(gap) > square(reach) * dot(way, way));
}

// Square of the difference of two moves.
template <int W>
GYRE_INLINE Wide<W> difference_of(Vec3W<W> a, Vec3W<W> b) {
  const Vec3W<W> d = a - b;
  return dot(d, d);
}
// A difference of moves adds this to the reach, with its rounding.
template <int W>
GYRE_INLINE Wide<W> reach_of_moves(Wide<W> squared) {
  return Wide<W>(1.0f + 0x1p-20f) * sqrt(squared);
}

template <int W>
GYRE_INLINE Mask<W> edges_apart(const PairLanes<W>& pair) {
  const Vec3W<W> along = pair.p[1], other = pair.p[3] - pair.p[2];
  const Wide<W> a = dot(along, along), b = dot(along, other), e = dot(other, other);
  const Wide<W> c = -dot(along, pair.p[2]), f = -dot(other, pair.p[2]);
  const Wide<W> first = share_on(b * f - c * e, a * e - b * b);
  const Wide<W> t = share_on(b * first + f, e);
  const Wide<W> s = share_on(b * t - c, a);
  const Vec3W<W> way = s * along - (pair.p[2] + t * other);
  const Wide<W> low = min(Wide<W>(0.0f), dot(way, along));
  const Wide<W> high = max(dot(way, pair.p[2]), dot(way, pair.p[3]));
  const auto& m = pair.move;
  const Wide<W> far = max(max(difference_of(m[0], m[2]), difference_of(m[0], m[3])),
                          max(difference_of(m[1], m[2]), difference_of(m[1], m[3])));
  const Wide<W> reach = max(pair.reach[0], pair.reach[1]) + max(pair.reach[2], pair.reach[3]);
  return is_apart(way, low, high, reach + reach_of_moves(far));
}

template <int W>
GYRE_INLINE Mask<W> corner_apart(const PairLanes<W>& pair) {
  const Wide<W> zero(0.0f);
  const Vec3W<W> a = pair.p[1], b = pair.p[2], c = pair.p[3];
  // From the nearest point of the boundary, or of the face where the vertex is over it.
  const auto from_edge = [&](Vec3W<W> u, Vec3W<W> w) {
    const Vec3W<W> d = w - u;
    return -(u + share_on(-dot(u, d), dot(d, d)) * d);
  };
  const auto nearer = [&](Vec3W<W> u, Vec3W<W> w) {
    const Mask<W> first = dot(u, u) < dot(w, w);
    return Vec3W<W>{select(first, u.x, w.x), select(first, u.y, w.y), select(first, u.z, w.z)};
  };
  Vec3W<W> way = nearer(nearer(from_edge(a, b), from_edge(b, c)), from_edge(c, a));
  const Vec3W<W> normal = cross(b - a, c - a);
  const Mask<W> over = (dot(normal, cross(a, b)) >= zero) & (dot(normal, cross(b, c)) >= zero) &
                       (dot(normal, cross(c, a)) >= zero);
  const Wide<W> height = dot(normal, a) / max(dot(normal, normal), Wide<W>(1.0e-30f));
  way = {select(over, -(height * normal.x), way.x), select(over, -(height * normal.y), way.y),
         select(over, -(height * normal.z), way.z)};
  const Wide<W> high = max(dot(way, a), max(dot(way, b), dot(way, c)));
  const auto& m = pair.move;
  const Wide<W> far =
      max(difference_of(m[0], m[1]), max(difference_of(m[0], m[2]), difference_of(m[0], m[3])));
  const Wide<W> reach = pair.reach[0] + max(pair.reach[1], max(pair.reach[2], pair.reach[3]));
  return is_apart(way, zero, high, reach + reach_of_moves(far));
}

template <int W, Mask<W> (*apart)(const PairLanes<W>&)>
int filter_pairs(const SurfaceCandidate* pairs, int count, const FilterVertex* vertices,
                 std::uint32_t* kept) {
  int found = 0;
  for (int first = 0; first < count; first += W) {
    std::uint32_t near = ~to_bits(apart(PairLanes<W>(pairs, first, count, vertices)));
    const int lanes = count - first < W ? count - first : W;
    near &= (1u << lanes) - 1u;
    for (; near != 0; near &= near - 1) kept[found++] = std::uint32_t(first + std::countr_zero(near));
  }
  return found;
}

template <int W>
constexpr FeatureFilters feature_filters() {
  return {filter_pairs<W, corner_apart<W>>, filter_pairs<W, edges_apart<W>>};
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
