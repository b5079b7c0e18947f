// The judge's own geometry: convex shapes in world space and the gap between two of them, by brute force and in double. It shares
// nothing with any engine.
#pragma once

#include <vector>

#include "bench/scenes/scene.h"

namespace gyre::bench {

// A convex shape in world space: a polytope, segment or point, swelled by a radius.
struct Core {
  std::vector<V3> v, normals, edges;
  double r = 0;
  V3 lo, hi;
  int body = 0;
};

Core make_core(const Scene& sc, const Shape& s, const Pose& t, int body);
// Signed gap between two convex shapes: negative is penetration depth. Exact up to 2 cm, a lower bound beyond.
double gap(const Core& a, const Core& b);

}  // namespace gyre::bench
