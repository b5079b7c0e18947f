// What the scenes are built of.
#pragma once

#include "bench/scenes/scene.h"

namespace gyre::bench {

Shape box(V3 h);
Shape sphere(double r);
Shape capsule(double r, double half_length);
Shape hull(int i);
int add(Scene& sc, Shape s, V3 p, Quat q = {}, Motion m = Motion::dynamic, double density = 1000);
void ground(Scene& sc, double half);
// A square pit: floor at y = 0, inner half width w, walls up to height h.
void pit(Scene& sc, double w, double h);
// `templates` random hulls with so many vertices, into the scene's table.
void add_hulls(Scene& sc, int templates, int vertices, double size, uint64_t seed);

}  // namespace gyre::bench
