// Parts that laws of ropes, cloth and solids share.
#pragma once

#include "laws/kit.h"

#include <vector>

namespace gyre::laws {

// A medium at rest takes the share `rate` (1/s) of every velocity, so that what moves comes to rest.
inline void add_brake(World& world, double rate) {
  FieldDef brake;
  brake.kind = FieldKind::drag;
  brake.drag_coefficient = 0.0f;
  brake.linear_drag = float(rate);
  world.add_field(brake);
}

// The ends of equal segments along a line, both of its ends among them.
inline std::vector<DVec3> line(DVec3 from, DVec3 to, int segments) {
  std::vector<DVec3> points;
  for (int i = 0; i <= segments; ++i) points.push_back(from + (double(i) / segments) * (to - from));
  return points;
}

}  // namespace gyre::laws
