// The set of friction impulses that a load allows at a point: Coulomb's disc, or a regular polygon within it.
// Over all loads it is the friction cone, or a pyramid.
//
// The corners of the polygon lie on the disc, so friction never exceeds Coulomb's, and is at least cos(pi /
// sides) of it. With four sides the sides are parallel to the two tangents, and each has a bound of its own.
#pragma once

namespace gyre {

constexpr int kMinSides = 4, kMaxSides = 32;  // even numbers

struct FrictionSet {
  int sides = 0;       // 0: the disc
  double inner = 1.0;  // distance of the sides from the centre, for radius one
  double half_side = 0.0;
  double corner[kMaxSides][2] = {};  // for radius one
  double side[kMaxSides][2] = {};    // unit normal of the side from corner i to i + 1
};

// `sides`: 0, or an even number within kMinSides and kMaxSides.
FrictionSet make_friction_set(int sides);

// The region of a set that holds the nearest point.
enum class FrictionRegion : unsigned char { inside, side, corner, rim };

struct FrictionPoint {
  double x = 0.0, y = 0.0;
  FrictionRegion region = FrictionRegion::inside;
  int index = 0;  // of the side or corner
};

// The nearest point of the set with this radius to (x, y).
FrictionPoint nearest_friction(const FrictionSet& set, double radius, double x, double y);

}  // namespace gyre
