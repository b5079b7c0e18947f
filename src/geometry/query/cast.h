// Rays and moving convex shapes against one shape of any kind.
//
// In: a shape, and a ray or a moving shape in its frame. Out: the fraction of the way at which they first meet, where, with
// which outward normal of the shape, and on which triangle. All in double: a ray may start a thousand kilometres away, and
// what is asked of a large mesh is answered to the precision of its vertices.
//
// What a hit is:
// - Convex shapes and planes are solid and closed: a ray that starts inside is met at fraction 0 (`inside`), one that
//   starts on the surface and leaves is not, one that only touches is.
// - Meshes and height fields are surfaces without thickness, met from the front only, or from both sides if the mesh is
//   double-sided or the caller asks for it. A ray within a triangle's plane does not meet the triangle. Rays do not slip
//   between triangles that share an edge or a corner.
//
// Sources: rays on quadrics and polyhedra as intervals: E. Haines, "Essential Ray Tracing Algorithms", in "An Introduction
// to Ray Tracing", 1989; triangles: S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", 2013; moving
// shapes: Newton's method on the distance as a function of the way, which is convex, so that it never passes the impact
// (B. Mirtich, "Impulse-based Dynamic Simulation of Rigid Body Systems", 1996, calls it conservative advancement); balls
// against balls, capsules, boxes and triangles: cast_ball.h.
#pragma once

#include "geometry/distance/gjk.h"
#include "geometry/shape/shape.h"
#include "math/rotation.h"

namespace gyre {

constexpr std::uint32_t kNoTriangle = 0xffffffffu;

struct LocalRay {
  DVec3 origin;
  DVec3 way;  // from the origin to the end: fractions count along it
};

struct LocalHit {
  double fraction = 0.0;
  DVec3 point;   // on the surface of the shape that is hit, in its frame
  DVec3 normal;  // unit, outward; of a ray that starts inside: against its way (zero if it has no length)
  bool inside = false;  // the two overlapped at the start
  double depth = 0.0;   // m, of a moving shape that overlapped at the start
  std::uint32_t triangle =
      kNoTriangle;  // of a mesh its number in the MeshDef, of a height field as in height_field.h
};

// Whether `hit` at the same or a lesser fraction comes before `other`, where both are of one shape.
inline bool comes_before(const LocalHit& hit, const LocalHit& other) {
  return hit.fraction < other.fraction || (hit.fraction == other.fraction && hit.triangle < other.triangle);
}

// The first hit at a fraction of at most `reach`.
bool cast_ray(const Shape& shape, const LocalRay& ray, double reach, bool back_faces, LocalHit& hit);

// A convex shape that moves without turning.
struct MovingShape {
  const Shape* shape = nullptr;
  DVec3 position;  // of its origin, in the frame of the shape it may hit
  DQuat orientation;
  DVec3 way;
  float skin = 0.0f;  // m: an overlap no deeper than this at the start is no hit unless the way leads deeper
};

// The first hit at a fraction of at most `reach`; its point lies on `target`. A hit is found where the surfaces are
// kCastTolerance of the moving shape's size apart, and then taken to where they meet.
bool cast_shape(const Shape& target, const MovingShape& moving, double reach, bool back_faces, LocalHit& hit);
constexpr double kCastTolerance = 1.0e-6;

}  // namespace gyre
