// Closest features by Voronoi regions. See closest.h.
#include "geometry/distance/closest.h"

namespace gyre {
namespace {

// Squared sine below which two segments count as parallel. Above it, double locates their crossing to 1e-4 of their
// length; below it, their ends give a better answer.
constexpr double kParallelSegments = 1.0e-12;
// Squared sine of the smallest angle of a triangle that still has a plane.
constexpr double kFlatTriangle = 1.0e-24;
// Squared sine below which a triangle needs care: the cross product of its sides has lost the digits of its
// orientation.
constexpr double kSliverTriangle = 1.0e-8;

SimplexPoint at_corner(DVec3 a, int corner) {
  SimplexPoint out;
  out.point = a;
  out.weights[corner] = 1.0;
  out.corners = 1u << corner;
  return out;
}

SimplexPoint on_edge(DVec3 p, DVec3 a, DVec3 b, int corner_a, int corner_b) {
  const SegmentPoint near = closest_on_segment(p, a, b);
  if (near.t <= 0.0) return at_corner(a, corner_a);
  if (near.t >= 1.0) return at_corner(b, corner_b);
  SimplexPoint out;
  out.point = near.point;
  out.weights[corner_a] = 1.0 - near.t;
  out.weights[corner_b] = near.t;
  out.corners = (1u << corner_a) | (1u << corner_b);
  return out;
}

const SimplexPoint& nearer(DVec3 p, const SimplexPoint& a, const SimplexPoint& b) {
  return length_squared(b.point - p) < length_squared(a.point - p) ? b : a;
}

SimplexPoint best_edge(DVec3 p, DVec3 a, DVec3 b, DVec3 c) {
  const SimplexPoint ab = on_edge(p, a, b, 0, 1), bc = on_edge(p, b, c, 1, 2), ca = on_edge(p, c, a, 2, 0);
  return nearer(p, nearer(p, ab, bc), ca);
}

// A face of the tetrahedron. Its corners have the numbers i, j and k there.
SimplexPoint on_face(DVec3 p, const DVec3* q, int i, int j, int k) {
  const SimplexPoint local = closest_on_triangle(p, q[i], q[j], q[k]);
  const int corner[3] = {i, j, k};
  SimplexPoint out;
  out.point = local.point;
  for (int m = 0; m < 3; ++m) {
    out.weights[corner[m]] = local.weights[m];
    if (local.corners & (1u << m)) out.corners |= 1u << corner[m];
  }
  return out;
}

// A triangle with a tiny angle, measured along its longest side and perpendicular to it. Errors along and across that
// side stay as small as those of the coordinates.
SimplexPoint closest_on_sliver(DVec3 p, DVec3 a, DVec3 b, DVec3 c) {
  const DVec3 q[3] = {a, b, c};
  const double ab = length_squared(b - a), bc = length_squared(c - b), ca = length_squared(a - c);
  // The longest side runs from `o` to `u`. Corner `w` is off it and closer to `o`.
  int w = ab >= bc && ab >= ca ? 2 : bc >= ca ? 0 : 1;
  int o = (w + 1) % 3, u = (w + 2) % 3;
  if (length_squared(q[w] - q[u]) < length_squared(q[w] - q[o])) {
    const int swapped = o;
    o = u;
    u = swapped;
  }
  const DVec3 side = q[u] - q[o], other = q[w] - q[o], from = p - q[o];
  const double side_squared = length_squared(side), slope = dot(other, side) / side_squared;
  const DVec3 across = other - slope * side;
  const double t = dot(from, across) / length_squared(across);
  const double s = dot(from, side) / side_squared - t * slope;
  if (!(s > 0.0) || !(t > 0.0) || !(s + t < 1.0)) return best_edge(p, a, b, c);
  const DVec3 normal = cross(side, across);
  SimplexPoint out;
  out.weights[o] = 1.0 - s - t;
  out.weights[u] = s;
  out.weights[w] = t;
  out.point = p - (dot(from, normal) / dot(normal, normal)) * normal;
  out.corners = 7;
  return out;
}

// True if the plane of the triangle is certainly farther away than a distance. False if the triangle has no reliable
// plane.
bool has_plane_beyond(DVec3 p, DVec3 a, DVec3 b, DVec3 c, double squared) {
  const DVec3 ab = b - a, ac = c - a, normal = cross(ab, ac);
  const double nn = dot(normal, normal);
  const double longest = max(dot(ab, ab), max(dot(ac, ac), length_squared(c - b)));
  return nn > kSliverTriangle * longest * longest &&
         square(dot(a - p, normal)) > kSurelyFarther * squared * nn;
}

// Faces of a tetrahedron: three corners, then the opposite one.
constexpr int kTetrahedronFaces[4][4] = {{0, 1, 2, 3}, {0, 3, 1, 2}, {0, 2, 3, 1}, {1, 3, 2, 0}};

}  // namespace

SegmentPoint closest_on_segment(DVec3 p, DVec3 a, DVec3 b) {
  const DVec3 ab = b - a;
  const double along = dot(p - a, ab), ab_squared = dot(ab, ab);
  if (!(along > 0.0)) return {a, 0.0};
  if (along >= ab_squared) return {b, 1.0};
  const double t = along / ab_squared;
  return {a + t * ab, t};
}

SegmentPair closest_of_segments(DVec3 a0, DVec3 a1, DVec3 b0, DVec3 b1) {
  const DVec3 da = a1 - a0, db = b1 - b0, between = b0 - a0;
  const double aa = dot(da, da), bb = dot(db, db), ab = dot(da, db);
  const double scale = aa * bb;
  const double det = scale - ab * ab;
  SegmentPair out;
  out.parallel = !(det > kParallelSegments * scale);
  double s = 0.0;
  if (!out.parallel) {
    s = clamp((dot(between, da) * bb - dot(between, db) * ab) / det, 0.0, 1.0);
  } else if (aa > 0.0) {
    // The closest stretch begins where the closer end of b projects, or at a0.
    const double first = dot(between, da) / aa, last = dot(b1 - a0, da) / aa;
    s = clamp(min(first, last), 0.0, 1.0);
  }
  // Alternating projections are exact once one of the two points is clamped, and harmless otherwise.
  const SegmentPoint on_b = closest_on_segment(a0 + s * da, b0, b1);
  const SegmentPoint on_a = closest_on_segment(on_b.point, a0, a1);
  out.on_a = on_a.point;
  out.on_b = on_b.point;
  out.s = on_a.t;
  out.t = on_b.t;
  return out;
}

SimplexPoint closest_on_triangle(DVec3 p, DVec3 a, DVec3 b, DVec3 c) {
  const DVec3 ab = b - a, ac = c - a, normal = cross(ab, ac);
  const double nn = dot(normal, normal);
  const double longest = max(dot(ab, ab), max(dot(ac, ac), length_squared(c - b)));
  if (!(nn > kFlatTriangle * longest * longest)) return best_edge(p, a, b, c);
  if (!(nn > kSliverTriangle * longest * longest)) return closest_on_sliver(p, a, b, c);
  // Signed areas of the three triangles that the projection of p spans with the edges.
  const DVec3 pa = a - p, pb = b - p, pc = c - p;
  const double wa = dot(cross(pb, pc), normal), wb = dot(cross(pc, pa), normal),
               wc = dot(cross(pa, pb), normal);
  if (wa > 0.0 && wb > 0.0 && wc > 0.0) {
    const double sum = wa + wb + wc;
    SimplexPoint out;
    out.weights[0] = wa / sum;
    out.weights[1] = wb / sum;
    out.weights[2] = wc / sum;
    // The foot of the perpendicular is better than the weighted sum: its error does not grow with the distance of the
    // corners.
    out.point = p + (dot(pa, normal) / nn) * normal;
    out.corners = 7;
    return out;
  }
  // The point lies outside at least one edge. The closest point is on one of those edges.
  SimplexPoint best;
  bool found = false;
  const auto consider = [&](const SimplexPoint& candidate) {
    best = found ? nearer(p, best, candidate) : candidate;
    found = true;
  };
  if (!(wc > 0.0)) consider(on_edge(p, a, b, 0, 1));
  if (!(wa > 0.0)) consider(on_edge(p, b, c, 1, 2));
  if (!(wb > 0.0)) consider(on_edge(p, c, a, 2, 0));
  return best;
}

SimplexPoint closest_on_tetrahedron(DVec3 p, DVec3 a, DVec3 b, DVec3 c, DVec3 d) {
  const DVec3 q[4] = {a, b, c, d};
  double side[4], weight_sum = 0.0;
  bool flat = false;
  SimplexPoint inside;
  int outside_count = 0;
  bool is_outside[4];
  for (int f = 0; f < 4; ++f) {
    const DVec3 origin = q[kTetrahedronFaces[f][0]];
    const DVec3 u = q[kTetrahedronFaces[f][1]] - origin, v = q[kTetrahedronFaces[f][2]] - origin,
                w = q[kTetrahedronFaces[f][3]] - origin;
    const DVec3 normal = cross(u, v);
    const double opposite = dot(w, normal);
    side[f] = dot(p - origin, normal);
    // The volume, against its rounding error.
    if (opposite * opposite <= 1.0e-26 * dot(normal, normal) * dot(w, w)) flat = true;
    is_outside[f] = opposite > 0.0 ? side[f] <= 0.0 : side[f] >= 0.0;
    outside_count += is_outside[f] ? 1 : 0;
    inside.weights[kTetrahedronFaces[f][3]] = absolute(side[f]);
    weight_sum += absolute(side[f]);
  }
  if (outside_count == 0 && !flat) {
    for (double& weight : inside.weights) weight = weight / weight_sum;
    inside.point = p;
    inside.corners = 15;
    return inside;
  }
  SimplexPoint best;
  bool found = false;
  for (int f = 0; f < 4; ++f) {
    if (!is_outside[f] && !flat) continue;
    const SimplexPoint candidate =
        on_face(p, q, kTetrahedronFaces[f][0], kTetrahedronFaces[f][1], kTetrahedronFaces[f][2]);
    best = found ? nearer(p, best, candidate) : candidate;
    found = true;
  }
  return best;
}

SimplexPoint closest_on_tetrahedron_surface(DVec3 p, DVec3 a, DVec3 b, DVec3 c, DVec3 d) {
  const DVec3 q[4] = {a, b, c, d};
  SimplexPoint best =
      on_face(p, q, kTetrahedronFaces[0][0], kTetrahedronFaces[0][1], kTetrahedronFaces[0][2]);
  for (int f = 1; f < 4; ++f) {
    const int i = kTetrahedronFaces[f][0], j = kTetrahedronFaces[f][1], k = kTetrahedronFaces[f][2];
    if (!has_plane_beyond(p, q[i], q[j], q[k], length_squared(best.point - p)))
      best = nearer(p, best, on_face(p, q, i, j, k));
  }
  return best;
}

}  // namespace gyre
