// What can be asked about the shapes of a world without stepping it: rays, moving shapes, overlaps, closest points,
// penetrations. The functions are methods of World; here is what goes in and out.
//
// Every query sees the shapes where they are now, changes since the last step included. Places are double: a thousand
// kilometres from the origin answers are as precise as near it. The same world gives the same bits on every platform, with
// every broad phase and any number of threads, and answers come in a fixed order: by fraction, distance or depth, and where
// that is equal by the shape's index.
//
// Convex shapes and planes are solid. Meshes and height fields are surfaces without thickness: what lies wholly below
// one does not overlap it, and rays and moving shapes meet its triangles from the front (both sides, if the mesh is
// double-sided or the filter asks for back faces).
//
// A query with numbers that cannot be asked (not finite, out of range, a shape that is not convex) finds nothing; check_ray,
// check_shape_cast and check_shape_place say why in words.
#pragma once

#include <gyre/geometry.h>
#include <gyre/ids.h>
#include <gyre/math.h>
#include <gyre/result.h>

#include <cstdint>

namespace gyre {

// Which shapes a query looks at.
struct QueryFilter {
  std::uint32_t layers = 0xffffffffu;  // those with a bit of their Filter::layer in it
  bool sensors = false;                // sensors too
  bool back_faces = false;             // triangles are met from behind too
  BodyId ignored{};                    // a body to be left out: mostly the one that asks
  // Called for each shape that could be met; false leaves it out. In batches from any thread. It must not change the world,
  // and may be called for shapes that in the end are not met.
  bool (*accepts)(void* user, ShapeId shape, BodyId body) = nullptr;
  void* user = nullptr;
};

struct Ray {
  DVec3 origin{};
  Vec3 way{};  // m, from the origin to the end: a ray is as long as its way
};

// A convex shape that moves along a line without turning.
struct ShapeCast {
  AnyShape shape = Sphere{};
  Pose pose{};        // world_from_shape, as it starts
  Vec3 way{};         // m
  // m: what the shape overlaps by no more than this as it starts does not stop it, unless the way leads deeper. For bodies
  // that stand on something and are to be moved along it.
  float skin = 0.0f;
};

// A convex shape at a place.
struct ShapePlace {
  AnyShape shape = Sphere{};
  Pose pose{};  // world_from_shape
};

// Where a ray or a moving shape first meets a shape.
struct CastHit {
  BodyId body{};
  ShapeId shape{};
  std::int32_t sub_shape = 0;  // which of the body's shapes: World::shapes(body)[sub_shape]
  std::int32_t triangle = -1;  // mesh: its number in the MeshDef; height field: 2 * cell, + 1 for the half away from the
                               // cell's first sample, cell = row * (columns - 1) + column; others: -1
  DVec3 point{};               // on the shape that is met
  Vec3 normal{};               // unit, out of that shape; of a ray that starts inside: against its way (zero without a way)
  double fraction = 1.0;       // of the way, 0 to 1
  bool inside = false;         // ray: it starts inside a solid. Moving shape: it overlaps the shape as it starts
  float depth = 0.0f;          // m, of a moving shape that overlaps as it starts: depth * normal parts the two

  explicit operator bool() const { return bool(body); }
};

struct Overlap {
  BodyId body{};
  ShapeId shape{};
  std::int32_t sub_shape = 0;
  std::int32_t triangle = -1;  // the lowest of those that overlap, numbered as in CastHit

  explicit operator bool() const { return bool(body); }
};

struct ClosestPoint {
  BodyId body{};
  ShapeId shape{};
  std::int32_t sub_shape = 0;
  std::int32_t triangle = -1;
  DVec3 point{};          // on the shape of the world
  DVec3 own_point{};      // on the shape that asks
  Vec3 normal{};          // unit, from the first to the second; of no use when they overlap
  double distance = 0.0;  // m; 0 when they overlap

  explicit operator bool() const { return bool(body); }
};

struct Penetration {
  BodyId body{};
  ShapeId shape{};
  std::int32_t sub_shape = 0;
  std::int32_t triangle = -1;
  DVec3 point{};      // midway between the surfaces, where they are deepest
  Vec3 normal{};      // unit: moving the shape that asks by depth * normal ends this contact
  float depth = 0.0f;  // m, above 0

  explicit operator bool() const { return bool(body); }
};

// Why a query cannot be asked; code none if it can.
Error check_ray(const Ray& ray);
Error check_shape_cast(const ShapeCast& cast);
Error check_shape_place(const ShapePlace& place);

}  // namespace gyre
