// Measures of tetrahedra for the tests of the fill.
#pragma once

#include <gyre/math.h>

#include <algorithm>
#include <cmath>

namespace gyre {

inline double volume_of(const DVec3 (&p)[4]) {
  return dot(p[1] - p[0], cross(p[2] - p[0], p[3] - p[0])) / 6.0;
}

// Dihedral angles in degrees, and volumes.
struct TetrahedronQuality {
  double smallest_angle = 180.0, largest_angle = 0.0, smallest_volume = 1.0e300, whole_volume = 0.0;

  void add(const DVec3 (&p)[4]) {
    smallest_volume = std::min(smallest_volume, volume_of(p));
    whole_volume += volume_of(p);
    constexpr int kEdges[6][4] = {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2},
                                  {1, 2, 0, 3}, {1, 3, 0, 2}, {2, 3, 0, 1}};
    for (const auto& [a, b, c, d] : kEdges) {
      const DVec3 along = (p[b] - p[a]) / length(p[b] - p[a]);
      const DVec3 u = p[c] - p[a] - dot(p[c] - p[a], along) * along,
                  v = p[d] - p[a] - dot(p[d] - p[a], along) * along;
      const double angle = std::atan2(length(cross(u, v)), dot(u, v)) * 180.0 / kPiDouble;
      smallest_angle = std::min(smallest_angle, angle);
      largest_angle = std::max(largest_angle, angle);
    }
  }
};

}  // namespace gyre
