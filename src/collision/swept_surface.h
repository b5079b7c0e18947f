// A moving convex shape against the triangles of a mesh or height field: part of continuous collision.
#pragma once

#include "collision/time_of_impact.h"
#include "geometry/hull.h"

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

// A ball well inside a convex shape, as a shape of its own.
struct Core {
  Shape ball;
  Transform body_from_ball;
};
Core make_core(const Shape& shape, const Transform& body_from_shape, float share);

// How near is near, in metres: set from the moving shape's size.
struct ImpactScale {
  double target;       // how far from each other two shapes are left
  double touching;     // nearer than this as the step begins: only the core is swept
  double core_target;  // the core is left this far
};

// First time before `end` at which `a` must stop in front of the surface `b` (a mesh or height field; its radius is not
// used); `end` if it need not.
double impact_with_surface(const SweptShape& a, const SweptShape& core, const SweptShape& b, double end,
                           const ImpactScale& scale, TriangleHull& triangle);

}  // namespace gyre
