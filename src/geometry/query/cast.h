// Rays and moving convex shapes against one shape of any kind.
//
// In: a shape, and a ray or a moving shape in its frame. Out: the fraction of the translation at which they first meet,
// the point, the outward normal of the shape, and the triangle. Everything is computed in double: a ray may start a
// thousand kilometres away, and hits on a large mesh are as precise as its vertices.
//
// Definition of a hit:
// - Convex shapes and planes are solid and closed. A ray that starts inside hits at fraction 0 (`inside`). A ray that
// starts on the surface and leaves does not hit. A ray that only touches hits.
// - Meshes and height fields are surfaces without thickness. They are hit from the front only, or from both sides if
// the mesh is double-sided or the caller asks for it. A ray within the plane of a triangle does not hit it. No ray
// passes between triangles that share an edge or a corner.
//
// Sources: rays on quadrics and polyhedra as intervals: E. Haines, "Essential Ray Tracing Algorithms", in "An
// Introduction to Ray Tracing", 1989; triangles: S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection",
// 2013; moving shapes: Newton's method on the distance as a function of the translation, which is convex, so a step
// never passes the impact (conservative advancement: B. Mirtich, "Impulse-based Dynamic Simulation of Rigid Body
// Systems", 1996); balls: cast_ball.h.
#pragma once

#include "geometry/distance/gjk.h"
#include "geometry/shape/shape.h"
#include "math/rotation.h"

namespace gyre {

constexpr std::uint32_t kNoTriangle = 0xffffffffu;

struct LocalRay {
  DVec3 origin;
  DVec3 translation;  // from the origin to the end; fractions are relative to it
};

struct LocalHit {
  double fraction = 0.0;
  DVec3 point;  // on the surface of the shape that is hit, in its frame
  // unit, outward; of a ray that starts inside: opposite to the ray (zero if its length is zero)
  DVec3 normal;
  bool inside = false;  // the two overlap at the start
  double depth = 0.0;   // m, penetration at the start, of a moving shape
  // Of a mesh: the number in the MeshDef; of a height field: as in height_field.h.
  std::uint32_t triangle = kNoTriangle;
};

// True if `hit` comes before `other`. Both are of one shape, and the fraction of `hit` is not larger.
inline bool comes_before(const LocalHit& hit, const LocalHit& other) {
  return hit.fraction < other.fraction || (hit.fraction == other.fraction && hit.triangle < other.triangle);
}

// The first hit at a fraction of at most `max_fraction`.
bool cast_ray(const Shape& shape, const LocalRay& ray, double max_fraction, bool back_faces, LocalHit& hit);

// A convex shape that moves without rotation.
struct MovingShape {
  const Shape* shape = nullptr;
  DVec3 position;  // of its origin, in the frame of the shape it may hit
  DQuat orientation;
  DVec3 translation;
  // m; an overlap at the start no deeper than this is no hit unless the translation leads deeper
  float skin = 0.0f;
};

// The first hit at a fraction of at most `max_fraction`, with a point on `target`. The search stops when the surfaces
// are kCastTolerance of the moving shape's size apart, and then moves the hit to where they meet.
bool cast_shape(const Shape& target, const MovingShape& moving, double max_fraction, bool back_faces,
                LocalHit& hit);
constexpr double kCastTolerance = 1.0e-6;  // of the moving shape's size
// The same against a triangle whose surface is rounded by `radius`, hit from its front or from both sides. The hit names no triangle.
bool cast_shape_at_triangle(const DVec3 (&triangle)[3], double radius, const MovingShape& moving, double max_fraction,
                            bool both_sides, LocalHit& hit);

}  // namespace gyre
