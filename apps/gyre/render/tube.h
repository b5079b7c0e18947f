// Round bars along lines of points: rods, ropes and springs.
#pragma once

#include <gyre/math.h>

#include <vector>

namespace gyre {

// A hanging line of `length` between two points: a parabola towards `down`; straight if it is not longer than the distance.
std::vector<Vec3> hanging_line(Vec3 from, Vec3 to, float length, Vec3 down);
// A coil spring of `turns` turns and the given radius, with straight ends.
std::vector<Vec3> coil_line(Vec3 from, Vec3 to, float radius, int turns);

struct TubePoint {
  Vec3 position, normal;
};
// Rings of `sides` + 1 points around each point of the line, the last one on the first: quads between neighbouring rings make the tube.
std::vector<TubePoint> tube_rings(const std::vector<Vec3>& line, float radius, int sides);

}  // namespace gyre
