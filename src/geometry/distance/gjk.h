// Distance and closest points of the cores of two convex shapes, by GJK.
//
// In: two shapes and the pose of B in A's frame. Out: the distance of the cores, its direction and the closest points,
// or that the cores overlap (penetration.h then computes the depth). Add core_radius to get to the surfaces.
//
// The simplex is computed in double from float shapes. So a distance keeps its direction down to 1e-9 of the size of
// the shapes, millimetre and kilometre shapes behave alike, and no tolerance is an absolute length.
//
// Sources: E. Gilbert, D. Johnson, S. Keerthi, "A Fast Procedure for Computing the Distance between Complex Objects in
// Three-Dimensional Space", 1988; G. van den Bergen, "A Fast and Robust GJK Implementation for Collision Detection of
// Convex Objects", 1999; the closest point of the simplex by Voronoi regions (geometry/distance/closest.h).
#pragma once

#include "geometry/shape/shape.h"
#include "math/rotation.h"

namespace gyre {

// The farthest point of the core along a direction of any length but zero, in the shape's frame: support.h in double.
// Curved cores need an exact support point, or rounding drowns the normal of close shapes.
DVec3 core_support(const Shape& shape, DVec3 direction);

// A point of the Minkowski difference B - A, and the two points that it came from, all in A's frame.
struct DifferencePoint {
  DVec3 difference;  // on_b - on_a
  DVec3 on_a, on_b;
};

struct CoreDistance;

// Two cores as GJK and EPA use them: the support function of B - A.
class CorePair {
 public:
  CorePair(const Shape& a, const Shape& b, const Transform& a_from_b);
  // the orientation has unit length
  CorePair(const Shape& a, const Shape& b, DVec3 position, DQuat orientation);
  // A triangle instead of A. The corners are borrowed.
  CorePair(const DVec3 (&triangle)[3], const Shape& b, DVec3 position, DQuat orientation);

  // Moves B and keeps its orientation.
  void move_b(DVec3 position);

  // The point of B - A farthest along `direction` (unit, A's frame).
  DifferencePoint support(DVec3 direction) const;
  // The separation of the cores along `direction` (unit, from A to B); negative if they overlap along it. Never more
  // than their distance.
  double separation(DVec3 direction) const;
  // The exact distance if one core is a box, and the lowest point of the other core over one of its faces projects into
  // that face; or that the distance is above `max_distance`. Returns false if only a search can tell.
  bool find_over_face(double max_distance, CoreDistance& out) const;
  // A length of the order of the shapes. Tolerances are relative to it.
  double size() const { return size_; }
  DVec3 to_b(DVec3 direction) const;    // turns a direction of A's frame into B's
  DVec3 from_b(DVec3 direction) const;  // the inverse of to_b
  DVec3 center_of_b() const { return position_; }

 private:
  void set_orientation(DQuat orientation);

  const Shape* a_ = nullptr;  // null if a triangle takes its place
  const DVec3* triangle_ = nullptr;
  const Shape* b_;
  DVec3 x_, y_, z_;  // B's axes in A's frame
  DVec3 position_;
  double core_size_;  // of the larger core
  double size_;
};

struct CoreDistance {
  // The cores share a point, or touch to within 1e-10 of their size. The distance is then 0.
  bool overlap = false;
  bool beyond = false;  // farther apart than `max_distance`; `distance` is then a lower bound along `normal`
  double distance = 0.0;
  DVec3 normal;      // unit, from A to B; of an overlap: the last direction that was tested
  DVec3 on_a, on_b;  // closest points, in A's frame
  // The simplex around the origin, or closest to it; EPA starts from it. Not cleared: only the counted elements are
  // read.
  union {
    DifferencePoint simplex[4];
  };
  int simplex_count = 0;
  int iterations = 0;

  CoreDistance() {}
};

// Distance of two cores. Ends early once the cores are known to be farther apart than `max_distance`. The search starts
// from `guess`, a direction from A to B of any length (zero: no guess). The normal of the last step lets most pairs end
// in two iterations.
CoreDistance core_distance(const CorePair& pair, double max_distance, Vec3 guess);

}  // namespace gyre
