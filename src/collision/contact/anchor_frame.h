// Which body carries the anchors of a recycled manifold, by the kinds of the shapes. W pairs side by side.
#pragma once

#include "geometry/shape/shape.h"
#include "math/wide.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// The kind and radius of a shape, which decide.
template <int W>
struct Roundness {
  WideInt<W> kind;  // ShapeKind
  Wide<W> radius;

  GYRE_INLINE Mask<W> is(ShapeKind other) const { return kind == WideInt<W>(std::int32_t(other)); }
  GYRE_INLINE Mask<W> is_flat() const {
    return (kind >= WideInt<W>(std::int32_t(ShapeKind::hull))) |
           (is(ShapeKind::box) & (radius == Wide<W>(0.0f)));
  }
  // As core_radius() in geometry/shape/support.h.
  GYRE_INLINE Wide<W> core_radius() const {
    return keep(is(ShapeKind::sphere) | is(ShapeKind::capsule) | is(ShapeKind::box), radius);
  }
};

// The anchors lie in the frame of one body, and the points of the other body move there. If that other shape is a
// rounded core on something flat, the points of its core count: it touches below them, however it rolls.
template <int W>
struct ManifoldMatch {
  Mask<W> frame_is_b;  // else A's
  Mask<W> flat;        // flat features on both sides
  Mask<W> round;       // a rounded core on something flat
  Wide<W> radius;      // of the rounded core

  GYRE_INLINE ManifoldMatch(const Roundness<W>& a, const Roundness<W>& b) {
    const Mask<W> flat_a = a.is_flat(), flat_b = b.is_flat();
    const Mask<W> rolls_b = flat_a & (b.core_radius() > Wide<W>(0.0f));
    flat = flat_a & flat_b;
    frame_is_b = and_not(flat_b & (a.core_radius() > Wide<W>(0.0f)), rolls_b);
    round = rolls_b | frame_is_b;
    radius = keep(round, select(frame_is_b, a.core_radius(), b.core_radius()));
  }
};

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
