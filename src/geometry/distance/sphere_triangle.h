// Sphere against triangle by the seven features of the triangle: three corners, three edges and the face.
//
// In: the sphere and the corners of the triangle, in one frame. Out: the feature whose Voronoi region contains the
// centre, the closest point of the triangle, the separation of the surfaces and its direction. Triangles without area
// answer with an edge or a corner.
//
// Source: C. Ericson, "Real-Time Collision Detection", 2005, sections 5.1.5 (regions by barycentric coordinates) and
// 5.2.7 (the test).
#pragma once

#include <gyre/math.h>

#include <cstdint>

namespace gyre {

enum class TriangleFeature : std::uint8_t {
  corner_a,
  corner_b,
  corner_c,
  edge_ab,
  edge_bc,
  edge_ca,
  face,
};
const char* to_string(TriangleFeature feature);

struct SphereTriangle {
  TriangleFeature feature = TriangleFeature::face;
  unsigned corners = 7;  // bits of the corners that the feature uses
  DVec3 on_triangle;
  double distance = 0.0;    // from the triangle to the centre of the sphere
  double separation = 0.0;  // of the surfaces; negative when they overlap
  DVec3 normal;  // unit, from the triangle to the centre; the front of the triangle if the centre lies on it
};
SphereTriangle sphere_triangle(DVec3 middle, double radius, DVec3 a, DVec3 b, DVec3 c);

}  // namespace gyre
