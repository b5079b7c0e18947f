// Closest features of points, segments, triangles and tetrahedra.
//
// Everything is computed in double. The products of small differences below lose about half of their digits, so float
// coordinates stay exact, and slivers and nearly parallel segments need no tolerance in metres. Every function accepts
// degenerate input (coincident points, triangles without area, flat tetrahedra) and answers for the edge or point that
// remains.
//
// Source: C. Ericson, "Real-Time Collision Detection", 2005, chapter 5.1 (Voronoi regions by barycentric coordinates).
#pragma once

#include <gyre/math.h>

namespace gyre {

// Factor on a squared distance that no rounding error reaches.
constexpr double kSurelyFarther = 1.001;

struct SegmentPoint {
  DVec3 point;
  double t;  // 0 at a, 1 at b
};
// The point of segment a-b closest to `p`.
SegmentPoint closest_on_segment(DVec3 p, DVec3 a, DVec3 b);

struct SegmentPair {
  DVec3 on_a, on_b;
  double s, t;  // 0 at the first end of the segment, 1 at the second
  // True within about a microradian. The closest points may then be a whole stretch; these are one pair of it.
  bool parallel;
};
// The closest points of segments a0-a1 and b0-b1. Of a parallel stretch: the pair closest to a0.
SegmentPair closest_of_segments(DVec3 a0, DVec3 a1, DVec3 b0, DVec3 b1);

// The closest point of a simplex as weights of its corners. The weights are at least 0 and sum to 1. Bit i of `corners`
// is set if the closest feature (corner, edge, face, interior) uses corner i; the weights of all other corners are
// exactly 0.
struct SimplexPoint {
  DVec3 point;
  double weights[4] = {0, 0, 0, 0};
  unsigned corners = 0;
};
SimplexPoint closest_on_triangle(DVec3 p, DVec3 a, DVec3 b, DVec3 c);
// If `p` lies inside, corners = 15 and point = p.
SimplexPoint closest_on_tetrahedron(DVec3 p, DVec3 a, DVec3 b, DVec3 c, DVec3 d);
// The same for the four faces alone, one of which always has the answer. For a `p` that cannot lie inside: rounding
// would misjudge the sides of a sliver.
SimplexPoint closest_on_tetrahedron_surface(DVec3 p, DVec3 a, DVec3 b, DVec3 c, DVec3 d);

}  // namespace gyre
