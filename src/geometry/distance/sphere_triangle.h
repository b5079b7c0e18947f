// Sphere against triangle by its seven features: three corners, three edges and the face.
//
// In: the sphere's middle and radius, the triangle's corners, in one frame. Out: the feature in whose Voronoi region the middle
// lies, the triangle's nearest point, how far the surfaces are apart, and along which direction. Triangles without area
// answer with an edge or a corner.
//
// Source: C. Ericson, "Real-Time Collision Detection", 2005, section 5.1.5 (the regions by barycentric coordinates) and 5.2.7
// (the test).
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
  unsigned corners = 7;  // of the feature, as bits
  DVec3 on_triangle;
  double distance = 0.0;    // from the triangle to the sphere's middle
  double separation = 0.0;  // of the surfaces; negative when they overlap
  DVec3 normal;             // unit, from the triangle to the middle; on the triangle itself: its front
};
SphereTriangle sphere_triangle(DVec3 middle, double radius, DVec3 a, DVec3 b, DVec3 c);

}  // namespace gyre
