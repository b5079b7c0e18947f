// A shape in the form of the inner loops: one tagged value for every kind, and the queries that need no second shape.
// Curved kinds are a core (point, segment, inner box) and a radius; polyhedral kinds have radius 0.
//
// In: the public AnyShape. Out: Shape, which borrows cooked data (the owner must keep the Geometry alive).
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
  // box: half extents of the INNER box (without the rounding); capsule, cylinder, cone: y = half height; plane: the
  // unit normal.
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
// The error of an unusable shape (radius not positive, not finite, zero normal, empty Geometry ...); code none if it is
// valid. Lengths that must not be zero are within kMinLength .. kMaxLength.
Error check_shape(const AnyShape& shape);
constexpr float kMinLength = 1.0e-9f;  // m
constexpr float kMaxLength = 1.0e9f;  // m

// True if the kind is convex and bounded: all but plane, mesh and height field.
constexpr bool is_convex(ShapeKind kind) { return kind <= ShapeKind::hull; }

// The tight axis-aligned box of the shape at pose `t`, in the outer frame of `t`. A plane's box is +-kUnbounded along
// each axis that it does not bound.
Aabb bounds(const Shape& shape, const Transform& t);
constexpr float kUnbounded = 1.0e18f;  // m
// How much too tight the box may be, relative to outer_radius(): the box of a disc seen edge-on loses half of the
// digits of a float.
constexpr float kBoundsSlack = 1.0e-3f;

// inner_radius: the radius of the largest ball inside the shape around its centre (the origin; a hull's centroid). It
// measures how far the body may move before it can pass through something. 0 for meshes and height fields, which have
// no inside; kUnbounded for planes.
// outer_radius: the largest distance of a point of the shape from `center`. kUnbounded for planes; for meshes and
// height fields that of a corner of their box, which is not smaller.
float inner_radius(const Shape& shape);
float outer_radius(const Shape& shape, Vec3 center);

}  // namespace gyre
