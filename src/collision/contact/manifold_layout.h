// Manifolds between memory and lanes: their records are read and written four floats at a time, of W records at once.
#pragma once

#include "geometry/manifold/manifold.h"
#include "math/wide_vec.h"

#include <cstddef>

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// Where in a record a member lies, in floats.
#define GYRE_FLOATS_BEFORE(Record, member) int(offsetof(Record, member) / sizeof(float))

// The fours of a manifold: its normal with the count of points, and those that begin here.
constexpr int kPoints = GYRE_FLOATS_BEFORE(Manifold, points);        // three fours each
constexpr int kAge = GYRE_FLOATS_BEFORE(Manifold, load_age);         // and friction_impulse
constexpr int kTwist = GYRE_FLOATS_BEFORE(Manifold, twist_impulse);  // and rolling_impulse
constexpr int kTotalFriction = GYRE_FLOATS_BEFORE(Manifold, total_friction);
constexpr int kSliding = GYRE_FLOATS_BEFORE(Manifold, sliding);  // and anchor_normal
constexpr int kAnchors = GYRE_FLOATS_BEFORE(Manifold, anchors);  // one four each
constexpr int kPointFloats = int(sizeof(ContactPointState) / sizeof(float));
constexpr int kManifoldFloats = int(sizeof(Manifold) / sizeof(float));
static_assert(GYRE_FLOATS_BEFORE(Manifold, normal) == 0 && GYRE_FLOATS_BEFORE(Manifold, count) == 3);
static_assert(GYRE_FLOATS_BEFORE(Manifold, friction_impulse) == kAge + 1);
static_assert(GYRE_FLOATS_BEFORE(Manifold, rolling_impulse) == kTwist + 1);
static_assert(GYRE_FLOATS_BEFORE(Manifold, anchor_normal) == kSliding + 1);
static_assert(GYRE_FLOATS_BEFORE(ContactPointState, separation) == 3);
static_assert(GYRE_FLOATS_BEFORE(ContactPointState, from_b) == 4);
static_assert(GYRE_FLOATS_BEFORE(ContactPointState, feature) == 7);
static_assert(GYRE_FLOATS_BEFORE(ContactPointState, normal_impulse) == 8);
static_assert(GYRE_FLOATS_BEFORE(ContactPointState, total_impulse) == 9);
static_assert(GYRE_FLOATS_BEFORE(ContactPointState, approach_speed) == 11);
static_assert(GYRE_FLOATS_BEFORE(PointAnchor, separation) == 3 && sizeof(PointAnchor) == 4 * sizeof(float));
static_assert(GYRE_FLOATS_BEFORE(ManifoldPoint, separation) == 3);

template <int W>
using Records = const float* [W];
template <int W>
using Targets = float* [W];

template <class Record>
GYRE_INLINE const float* floats(const Record* record) {
  return reinterpret_cast<const float*>(record);
}
template <class Record>
GYRE_INLINE float* floats(Record* record) {
  return reinterpret_cast<float*>(record);
}

// Floats `first` to `first + 3` of each record, and the way back of the first `Count` of them.
template <int W>
GYRE_INLINE void read_four(const Records<W>& record, int first, Wide<W> (&out)[4]) {
  if constexpr (W == 1) {
    for (int c = 0; c < 4; ++c) out[c].v = record[0][first + c];
  } else {
    Rows<W>::gather(record, first, out);
  }
}
template <int Count, int W>
GYRE_INLINE void write_four(const Targets<W>& record, int first, const Wide<W> (&in)[4]) {
  if constexpr (W == 1) {
    for (int c = 0; c < Count; ++c) record[0][first + c] = in[c].v;
  } else {
    Rows<W>::template scatter<Count>(record, first, in);
  }
}
// One float of each record.
template <int W>
GYRE_INLINE Wide<W> read_one(const Records<W>& record, int at) {
  Wide<W> lanes;
  GYRE_UNROLL
  for (int i = 0; i < W; ++i) lanes.set(i, record[i][at]);
  return lanes;
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
