// Curves for path joints: centripetal Catmull-Rom splines through points, open or closed. The parameter
// counts points: 2.5 is half-way between the third and the fourth. A normal is transported along the curve
// without twist, so a body that follows the curve rotates no more than necessary, over loops too.
//
// Sources: E. Catmull and R. Rom, "A class of local interpolating splines", 1974; C. Yuksel, S. Schaefer, J.
// Keyser, "Parameterization and applications of Catmull-Rom curves", 2011; W. Wang, B. Juettler, D. Zheng, Y.
// Liu, "Computation of Rotation Minimizing Frames", ACM TOG 27, 2008 (double reflection).
#pragma once

#include "solver/joint/joint_record.h"

#include <span>

namespace gyre {

struct PathCurve {
  std::span<const PathPoint> points;
  bool closed = false;

  float end() const { return float(closed ? points.size() : points.size() - 1); }
};

// Position and its derivatives by the parameter.
struct PathSample {
  Vec3 position, first, second;
};
PathSample sample_path(const PathCurve& path, float parameter);
// x along the curve, y along the transported normal: joint's frame from curve's frame.
Quat path_frame(const PathCurve& path, float parameter);
// m along the curve from its first point.
float path_length(const PathCurve& path, float parameter);
// The parameter nearest to p, sought from a nearby parameter; may lie beyond the ends.
float nearest_on_path(const PathCurve& path, Vec3 p, float from);
// The same without a start, within the ends.
float nearest_on_path(const PathCurve& path, Vec3 p);
// Computes lengths and transported normals from the positions.
void finish_path(std::span<PathPoint> points, bool closed);

}  // namespace gyre
