// A shape as the engine's inner loops see it: one tagged value for every kind, and the few questions that need no second
// shape. Curved kinds are a core (point, segment, inner box) swept by a radius; polyhedral kinds have radius 0.
//
// In: the public AnyShape. Out: Shape, which borrows cooked data (the owner keeps the Geometry alive).
#pragma once

#include <gyre/geometry.h>

#include <cstdint>

namespace gyre {

struct Hull;
struct Mesh;
struct HeightField;

struct Shape {
  ShapeKind kind = ShapeKind::sphere;
  float radius = 0.0f;  // sphere, capsule, cylinder, cone: the radius; box: the rounding
  // box: half extents of the INNER box (rounding taken off); capsule, cylinder, cone: y = half height; plane: the unit
  // normal
  Vec3 extents;
  float offset = 0.0f;  // plane: dot(normal, p) = offset on its surface
  union {
    const Hull* hull = nullptr;
    const Mesh* mesh;
    const HeightField* field;
  };
};

// The inner form of a checked shape.
Shape make_shape(const AnyShape& shape);
// Why `shape` cannot be used (radius not positive, not finite, zero normal, empty Geometry ...); code none if it can.
// Lengths that must not be zero lie within kMinLength .. kMaxLength.
Error check_shape(const AnyShape& shape);
constexpr float kMinLength = 1.0e-9f;
constexpr float kMaxLength = 1.0e9f;

// Whether the kind is convex and bounded: everything but plane, mesh and height field.
constexpr bool is_convex(ShapeKind kind) { return kind <= ShapeKind::hull; }

// The tight axis-aligned box of the shape placed by `t`, in t's outer frame. A plane's box is +-kUnbounded on each axis
// it does not bound.
Aabb bounds(const Shape& shape, const Transform& t);
constexpr float kUnbounded = 1.0e18f;
// How much too tight the box may be, of outer_radius(): that of a disc seen from the side loses half of a float's
// digits.
constexpr float kBoundsSlack = 1.0e-3f;

// Radius of the largest ball around the shape's middle (the origin; a hull's centroid) that lies inside, a measure of how
// far the body may move before it can pass through something: 0 for meshes and height fields, which have no inside, and
// kUnbounded for planes.
// The largest distance of any point of the shape from `center`: kUnbounded for planes; for meshes and height fields that of
// a corner of their box, which is not smaller.
float inner_radius(const Shape& shape);
float outer_radius(const Shape& shape, Vec3 center);

}  // namespace gyre
