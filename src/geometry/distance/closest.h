// Closest features of points, segments, triangles and tetrahedra.
//
// Worked in double: the products of small differences below lose about half the digits of what goes in, so float
// coordinates keep all of theirs, and slivers and nearly parallel segments need no special tolerances in metres. Every
// function accepts degenerate input (points that coincide, triangles without area, flat tetrahedra) and then answers for
// the edge or point that is left.
//
// Source: C. Ericson, "Real-Time Collision Detection", 2005, chapter 5.1 (Voronoi regions by barycentric coordinates).
#pragma once

#include <gyre/math.h>

namespace gyre {

struct SegmentPoint {
  DVec3 point;
  double t;  // 0 at a, 1 at b
};
// The point of segment a-b nearest to `p`.
SegmentPoint closest_on_segment(DVec3 p, DVec3 a, DVec3 b);

struct SegmentPair {
  DVec3 on_a, on_b;
  double s, t;  // 0 at the first, 1 at the second end of the segment
  bool
      parallel;  // within about a microradian: then the nearest points may be a whole stretch, and these are one pair of it
};
// The nearest points of segments a0-a1 and b0-b1. Of a parallel stretch the pair nearest to a0.
SegmentPair closest_of_segments(DVec3 a0, DVec3 a1, DVec3 b0, DVec3 b1);

// The nearest point of a simplex as weights of its corners: they sum to 1 and are at least 0. `corners` has bit i set
// where the nearest feature (corner, edge, face, inside) uses corner i; the weights of the others are exactly 0.
struct SimplexPoint {
  DVec3 point;
  double weights[4] = {0, 0, 0, 0};
  unsigned corners = 0;
};
SimplexPoint closest_on_triangle(DVec3 p, DVec3 a, DVec3 b, DVec3 c);
// corners = 15 and point = p when `p` lies inside.
SimplexPoint closest_on_tetrahedron(DVec3 p, DVec3 a, DVec3 b, DVec3 c, DVec3 d);
// The same for its four faces alone, of which one always is the answer: for a `p` that cannot lie inside, where the sides
// of a sliver would say so by rounding.
SimplexPoint closest_on_tetrahedron_surface(DVec3 p, DVec3 a, DVec3 b, DVec3 c, DVec3 d);

}  // namespace gyre
