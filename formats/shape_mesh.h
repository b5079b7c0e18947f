// Shapes as triangles, for pictures: positions and normals in the frame of the shape, triangles counter-clockwise seen from
// outside. Round shapes come in as many pieces as a picture needs; planes, which have no end, give no triangles.
#pragma once

#include <gyre/geometry.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gyre {

struct MeshVertex {
  Vec3 position;
  Vec3 normal;        // unit
  float tone = 1.0f;  // of the colour: round shapes have darker parts, so that one sees them turn
};

struct ShapeMesh {
  std::vector<MeshVertex> vertices;
  std::vector<std::uint32_t> indices;  // three a triangle
};

// `segments`: pieces of a full circle, rounded up to a multiple of 8.
ShapeMesh make_shape_mesh(const AnyShape& shape, int segments);

// Triangles with soft normals. A corner's normal is the mean, by area, of the triangles around the vertex whose normals differ from that
// of its own by an angle with more than this cosine.
ShapeMesh smooth_mesh(std::span<const Vec3> vertices, std::span<const std::uint32_t> indices,
                      float crease_cosine);

// The sphere around the shape's origin that holds the shape; 0 for a plane.
float bounding_radius(const AnyShape& shape);
// The box that holds the shape, in its frame; a plane's is empty (low above high).
Aabb bounding_box(const AnyShape& shape);

// The radius of the roundest part, which decides how many segments it needs; 0: all flat.
float rounding_radius(const AnyShape& shape);

}  // namespace gyre
