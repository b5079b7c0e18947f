// Distance and closest points of the cores of two convex shapes.
//
// In: two shapes and where B is in A's frame. Out: how far apart their cores are, along which direction and between which
// points, or that they overlap (then geometry/distance/penetration.h knows how deep). Add core_radius to get to the surfaces.
//
// The simplex is worked in double on float shapes. So a distance keeps its direction down to 1e-9 of the shapes' size,
// millimetre and kilometre shapes behave alike, and no tolerance is an absolute length.
//
// Sources: E. Gilbert, D. Johnson, S. Keerthi, "A Fast Procedure for Computing the Distance between Complex Objects in
// Three-Dimensional Space", 1988; G. van den Bergen, "A Fast and Robust GJK Implementation for Collision Detection of
// Convex Objects", 1999; the nearest point of the simplex by Voronoi regions (geometry/distance/closest.h).
#pragma once

#include "geometry/shape/shape.h"
#include "math/rotation.h"

namespace gyre {

// The core's farthest point along a direction (any length but zero), in the shape's frame: support.h in double. Curved cores
// need a support point that is exact to the direction, or the normal of near shapes drowns in rounding.
DVec3 core_support(const Shape& shape, DVec3 direction);

// A point of the Minkowski difference B - A, and the two points it came from; all in A's frame.
struct DifferencePoint {
  DVec3 way;  // on_b - on_a
  DVec3 on_a, on_b;
};

struct CoreDistance;

// Two cores as GJK and EPA see them: a support function of B - A.
class CorePair {
 public:
  CorePair(const Shape& a, const Shape& b, const Transform& a_from_b);
  CorePair(const Shape& a, const Shape& b, DVec3 position, DQuat orientation);  // of unit length
  // A triangle in place of A; the corners are borrowed.
  CorePair(const DVec3 (&triangle)[3], const Shape& b, DVec3 position, DQuat orientation);

  // Puts B elsewhere, turned as it was.
  void move_b(DVec3 position);

  // The point of B - A farthest along `direction` (unit, A's frame).
  DifferencePoint support(DVec3 direction) const;
  // How far the cores are apart along `direction` (unit, from A to B); negative when they overlap along it. Never more
  // than their distance.
  double separation(DVec3 direction) const;
  // Where one core is a box and the other stands over one of its faces, with its lowest point within that face: their distance,
  // exactly. Or that they are `beyond`. False: a search must tell.
  bool find_over_face(double max_distance, CoreDistance& out) const;
  // A length that is as large as the shapes: what tolerances are relative to.
  double size() const { return size_; }
  DVec3 to_b(DVec3 direction) const;    // a direction of A's frame in B's
  DVec3 from_b(DVec3 direction) const;  // and back
  DVec3 center_of_b() const { return position_; }

 private:
  void set_orientation(DQuat orientation);

  const Shape* a_ = nullptr;  // null: the triangle
  const DVec3* triangle_ = nullptr;
  const Shape* b_;
  DVec3 x_, y_, z_;  // B's axes in A's frame
  DVec3 position_;
  double core_size_;  // of the larger core
  double size_;
};

struct CoreDistance {
  bool overlap =
      false;            // the cores share a point, or touch to within 1e-10 of their size; distance is 0 then
  bool beyond = false;  // farther apart than `max_distance`; `distance` is then a lower bound along `normal`
  double distance = 0.0;
  DVec3 normal;      // unit, from A to B; the last direction looked at when they overlap
  DVec3 on_a, on_b;  // closest points, A's frame
  // Simplex around (or nearest to) the origin, where EPA starts. Not cleared: only the counted ones are ever read.
  union {
    DifferencePoint simplex[4];
  };
  int simplex_count = 0;
  int iterations = 0;

  CoreDistance() {}
};

// Distance of two cores. Gives up early once they are known to be farther apart than `max_distance`. `guess` (any length;
// zero: none) is a direction from A to B to start from: the normal of the step before makes most pairs end in two rounds.
CoreDistance core_distance(const CorePair& pair, double max_distance, Vec3 guess);

}  // namespace gyre
