// Curves that a body may be bound to: centripetal Catmull-Rom through points, open or closed. Places on it are counted in points: 2.5 is
// half-way between the third and the fourth. Across the curve goes a direction that is carried along without twist, so a
// body that follows the curve turns no more than it must, over loops too.
//
// Sources: E. Catmull and R. Rom, "A class of local interpolating splines", 1974; C. Yuksel, S. Schaefer, J. Keyser,
// "Parameterization and applications of Catmull-Rom curves", 2011; W. Wang, B. Juettler, D. Zheng, Y. Liu,
// "Computation of Rotation Minimizing Frames", ACM TOG 27, 2008 (double reflection).
#pragma once

#include "solver/joint/joint_record.h"

#include <span>

namespace gyre {

struct PathCurve {
  std::span<const PathPoint> points;
  bool closed = false;

  float end() const { return float(closed ? points.size() : points.size() - 1); }
};

// Position and its derivatives by place.
struct PathSample {
  Vec3 position, first, second;
};
PathSample sample_path(const PathCurve& path, float parameter);
// x along the curve, y along the direction that is carried: joint's frame from curve's.
Quat path_frame(const PathCurve& path, float parameter);
// m along the curve from its first point.
float path_length(const PathCurve& path, float parameter);
// The place nearest to p, sought from a place nearby; where the curve ends, it.
float nearest_on_path(const PathCurve& path, Vec3 p, float from);
// The same without a place to begin with.
float nearest_on_path(const PathCurve& path, Vec3 p);
// Lengths and carried directions, from the positions.
void finish_path(std::span<PathPoint> points, bool closed);

}  // namespace gyre
