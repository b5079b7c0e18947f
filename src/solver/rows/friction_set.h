// The set of friction impulses that a load allows at a point: Coulomb's disc, or a regular polygon within it. The cone of all
// loads is then a cone, or a pyramid with so many sides.
//
// The polygon's corners lie on the disc, so friction is never more than Coulomb's, and in the worst direction cos(pi / sides)
// of it. With four sides the sides are parallel to the two tangents: each has a limit of its own.
#pragma once

namespace gyre {

constexpr int kMinSides = 4, kMaxSides = 32;  // even numbers

struct FrictionSet {
  int sides = 0;       // 0: the disc
  double inner = 1.0;  // distance of the sides from the middle, of a set with radius one
  double half_side = 0.0;
  double corner[kMaxSides][2] = {};  // of a set with radius one
  double side[kMaxSides][2] = {};    // unit, across: the side from corner i to i + 1
};

// `sides`: 0, or an even number within kMinSides and kMaxSides.
FrictionSet make_friction_set(int sides);

// Where the nearest point of a set lies.
enum class FrictionRegion : unsigned char { inside, side, corner, rim };

struct FrictionPoint {
  double x = 0.0, y = 0.0;
  FrictionRegion region = FrictionRegion::inside;
  int index = 0;  // of the side or corner
};

// The point of the set with this radius that is nearest to (x, y).
FrictionPoint nearest_friction(const FrictionSet& set, double radius, double x, double y);

}  // namespace gyre
