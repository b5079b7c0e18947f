// CCD of a moving convex shape against the triangles of a mesh or height field.
#pragma once

#include "collision/continuous/time_of_impact.h"
#include "geometry/shape/hull.h"

namespace gyre {

// A triangle as a flat hull, for GJK. Made once and set for each triangle.
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

// A convex shape with about half of its inner radius removed all around: a thinner rod, a smaller plate. A hull leaves
// a box in its axes, or a ball if that is larger.
struct Core {
  Shape shape;
  Transform body_from_core;
};
Core make_core(const Shape& shape, const Transform& body_from_shape);

// Distances of CCD in metres, from the size of the moving shape.
struct ImpactScale {
  double target;              // distance that an impact leaves between two shapes
  double touching;            // if they start nearer than this, only the core is swept
  double core_target;         // distance that an impact leaves to the core
  double min_fraction = 0.0;  // fraction of its motion that the shape keeps in any case, if its core is free
  // the shape slides along what it touches: only approach halts it, and it does not rotate
  bool slides = false;
};

// The time of impact of a body that must halt, and the impact there.
struct TimeOfImpact {
  double time = 1.0;
  bool hit = false;
  bool by_core = false;  // only the core was blocked
  DVec3 normal;          // unit, from the shape to what it met
  DVec3 point;           // if by_core: the point of the core that would have entered, world axes
};
// The first time before `end` at which `a` must halt in front of `b`, both convex (or b a plane).
TimeOfImpact convex_time_of_impact(const SweptShape& a, const SweptShape& core, const SweptShape& b,
                                   double start, double end, const ImpactScale& scale);

// The same for a surface `b` (a mesh or height field; its radius is not used).
TimeOfImpact surface_time_of_impact(const SweptShape& a, const SweptShape& core, const SweptShape& b,
                                    double end, const ImpactScale& scale, TriangleHull& triangle);

// The first time at which `a` comes within `target` (m) of a triangle of the surface `b`, from either side.
Impact first_meeting(const SweptShape& a, const SweptShape& b, double target, TriangleHull& triangle);

// True if `a` meets the surface `b` before `end`, from either side, and is farther than `clear` (m) from it at `end`.
bool crosses_surface(const SweptShape& a, const SweptShape& b, double end, double clear,
                     const ImpactScale& scale, TriangleHull& triangle);

}  // namespace gyre
