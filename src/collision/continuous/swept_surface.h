// A moving convex shape against the triangles of a mesh or height field: part of continuous collision.
#pragma once

#include "collision/continuous/time_of_impact.h"
#include "geometry/shape/hull.h"

namespace gyre {

// One triangle in the guise of a flat hull, so that GJK takes it. Made once and set again for each triangle.
class TriangleHull {
 public:
  TriangleHull();
  void set(Vec3 a, Vec3 b, Vec3 c);
  const Shape& shape() const { return shape_; }
  TriangleHull(const TriangleHull&) = delete;
  TriangleHull& operator=(const TriangleHull&) = delete;

 private:
  Hull hull_;
  Shape shape_;
};

// What is left of a convex shape when about half of its inner radius is taken off all around, as a shape of its own: a
// thinner rod of a rod, a smaller plate of a plate. A hull leaves a box in its axes, or a ball where that is larger.
struct Core {
  Shape shape;
  Transform body_from_core;
};
Core make_core(const Shape& shape, const Transform& body_from_shape);

// How near is near, in metres: set from the moving shape's size.
struct ImpactScale {
  double target;        // how far from each other two shapes are left
  double touching;      // nearer than this as the step begins: only the core is swept
  double core_target;   // the core is left this far
  double min_fraction = 0.0;  // part of its way that the shape keeps in any case, if its core can
  bool slides = false;  // what it touches it slides along: only what closes in stops it, and it does not turn
};

// Where a shape must stop.
struct TimeOfImpact {
  double time = 1.0;
  bool hit = false;
  bool by_core = false;  // only the core was in the way
  DVec3 normal;          // unit, from the shape to what it met
  DVec3 point;           // of the core if that was in the way: where it would have gone in, world axes
};
// First time before `end` at which `a` must stop in front of `b`, both convex (or b a plane).
TimeOfImpact convex_time_of_impact(const SweptShape& a, const SweptShape& core, const SweptShape& b,
                                   double start, double end, const ImpactScale& scale);

// The same for the surface `b` (a mesh or height field; its radius is not used).
TimeOfImpact surface_time_of_impact(const SweptShape& a, const SweptShape& core, const SweptShape& b,
                                    double end, const ImpactScale& scale, TriangleHull& triangle);

// Whether `a` comes onto the surface `b` before `end`, from either side, and is farther than `clear` (m) from it at `end`.
bool crosses_surface(const SweptShape& a, const SweptShape& b, double end, double clear,
                     const ImpactScale& scale, TriangleHull& triangle);

}  // namespace gyre
