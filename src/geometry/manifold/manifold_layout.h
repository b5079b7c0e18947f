// The layout of manifold records in floats, for kernels that read and write them four floats at a time, W records side by side.
// In: records of geometry/manifold/manifold.h. Out: offsets of their groups of four, and loads and stores of such a group.
#pragma once

#include "geometry/manifold/manifold.h"
#include "math/wide_vec.h"

#include <cstddef>

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// The offset of a member in its record, in floats.
#define GYRE_FLOATS_BEFORE(Record, member) int(offsetof(Record, member) / sizeof(float))

// Offsets of the groups of four in a Manifold.
constexpr int kManifoldNormal = GYRE_FLOATS_BEFORE(Manifold, normal);          // and count
constexpr int kManifoldPoints = GYRE_FLOATS_BEFORE(Manifold, points);          // three groups a point
constexpr int kManifoldFriction = GYRE_FLOATS_BEFORE(Manifold, load_age);           // age and friction_impulse
constexpr int kManifoldTwist = GYRE_FLOATS_BEFORE(Manifold, twist_impulse);    // and rolling_impulse
constexpr int kManifoldTotals = GYRE_FLOATS_BEFORE(Manifold, total_friction);  // and sliding
constexpr int kManifoldSliding = GYRE_FLOATS_BEFORE(Manifold, sliding);        // and anchor_normal
constexpr int kManifoldAnchors = GYRE_FLOATS_BEFORE(Manifold, anchors);        // one group an anchor
constexpr int kManifoldFloats = int(sizeof(Manifold) / sizeof(float));
static_assert(kManifoldNormal == 0 && GYRE_FLOATS_BEFORE(Manifold, count) == kManifoldNormal + 3);
static_assert(GYRE_FLOATS_BEFORE(Manifold, friction_impulse) == kManifoldFriction + 1);
static_assert(GYRE_FLOATS_BEFORE(Manifold, rolling_impulse) == kManifoldTwist + 1);
static_assert(kManifoldSliding == kManifoldTotals + 3);
static_assert(GYRE_FLOATS_BEFORE(Manifold, anchor_normal) == kManifoldSliding + 1);

// Offsets of the groups of four in a ContactPointState.
constexpr int kPointA = GYRE_FLOATS_BEFORE(ContactPointState, from_a);  // and separation
constexpr int kPointB = GYRE_FLOATS_BEFORE(ContactPointState, from_b);  // and feature
constexpr int kPointImpulse =
    GYRE_FLOATS_BEFORE(ContactPointState, normal_impulse);  // then total, mean, approach speed
constexpr int kPointFloats = int(sizeof(ContactPointState) / sizeof(float));
static_assert(kPointA == 0 && GYRE_FLOATS_BEFORE(ContactPointState, separation) == kPointA + 3);
static_assert(kPointB == 4 && GYRE_FLOATS_BEFORE(ContactPointState, feature) == kPointB + 3);
static_assert(kPointImpulse == 8 &&
              GYRE_FLOATS_BEFORE(ContactPointState, total_impulse) == kPointImpulse + 1);
static_assert(GYRE_FLOATS_BEFORE(ContactPointState, mean_impulse) == kPointImpulse + 2);
static_assert(GYRE_FLOATS_BEFORE(ContactPointState, approach_speed) == kPointImpulse + 3 &&
              kPointFloats == 12);

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

// Loads floats `first` to `first + 3` of each record; write_four stores the first `Count` of them.
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
