// Queries on the shapes of a world: rays, moving shapes, overlaps, closest points, penetrations. The functions are methods of World;
// this header has their arguments and answers.
//
// Every query sees the present poses of the shapes, changes since the last step included. Positions are double: answers a thousand
// kilometres from the origin are as precise as near it. The same world gives the same bits on every platform, with every broad phase
// and any number of threads. Answers come in a fixed order: by fraction, distance or depth, and by the shape's index where those are
// equal.
//
// Ray casts, shape casts and overlaps also find ropes, cloths and solids: `soft` then names the one that is hit, and body and shape are null.
// They come after shapes of the same fraction. Rays meet the middle surface of a cloth from both sides, moving shapes stop at half its
// thickness. A solid is hit from outside; a ray that starts within it hits at once. A moving shape that starts wholly within a solid does not
// hit it. Closest points and penetrations leave soft matter out.
//
// Convex shapes and planes are solid. Meshes and height fields are surfaces without thickness: a shape that lies wholly below a surface
// does not overlap it. Rays and moving shapes hit triangles from the front (from both sides if the mesh is double-sided or the filter
// asks for back faces).
//
// A query whose numbers are not finite or out of range, or whose shape is not convex, finds nothing. check_ray, check_shape_cast and
// check_shape_pose name the reason.
#pragma once

#include <gyre/geometry.h>
#include <gyre/ids.h>
#include <gyre/math.h>
#include <gyre/result.h>

#include <cstdint>

namespace gyre {

// The shapes that a query considers.
struct QueryFilter {
  std::uint32_t layers = 0xffffffffu;  // shapes whose Filter::layer has a bit in it
  bool sensors = false;                // sensors too
  bool back_faces = false;             // triangles are hit from behind too
  BodyId ignored{};                    // a body to leave out, mostly the body that asks
  // Called for each candidate shape; false leaves it out. In batches it is called from any thread. It must not change the world. It may
  // be called for shapes that are not hit in the end.
  bool (*accepts)(void* user, ShapeId shape, BodyId body) = nullptr;
  void* user = nullptr;
  bool soft = true;  // ropes, cloths and solids too, whose SoftSettings::filter has a layer in `layers`
  // Like `accepts`, for ropes, cloths and solids.
  bool (*accepts_soft)(void* user, SoftId soft) = nullptr;
};

// The smallest box along the world's axes around a body or a shape. Without any shape, or around a plane: low is above high.
struct WorldBounds {
  DVec3 low{1, 1, 1}, high{-1, -1, -1};  // m

  constexpr bool operator==(const WorldBounds&) const = default;
};

struct Ray {
  DVec3 origin{};
  Vec3 translation{};  // m, from the origin to the end of the ray
};

// A convex shape that moves along a line without rotating.
struct ShapeCast {
  AnyShape shape = Sphere{};
  Pose pose{};         // world_from_shape, at the start
  Vec3 translation{};  // m
  // m: an overlap at the start of at most this depth does not stop the shape, unless the translation leads deeper. For bodies that
  // rest on something and are moved along it.
  float skin = 0.0f;
};

// A convex shape and its pose.
struct ShapePose {
  AnyShape shape = Sphere{};
  Pose pose{};  // world_from_shape
};

// The first hit of a ray or a moving shape on a shape of the world, or on soft matter.
struct CastHit {
  BodyId body{};
  ShapeId shape{};
  std::int32_t shape_index = 0;  // among the body's shapes: World::shapes(body)[shape_index]
  std::int32_t triangle = -1;  // mesh: its number in the MeshDef; height field: 2 * cell, + 1 for the half away from the
                               // cell's first sample, cell = row * (columns - 1) + column; cloth and solid: of
                               // World::soft_triangles(), from 3 * triangle on; rope: the segment, from vertex
                               // `triangle` to the next; others: -1
  DVec3 point{};               // on the shape that is hit
  Vec3 normal{};               // unit, out of that shape; of a ray that starts inside: against its translation (zero if that is zero)
  double fraction = 1.0;       // of the translation, 0 to 1
  bool inside = false;         // ray: it starts inside a solid. Moving shape: it overlaps the shape at the start
  float depth = 0.0f;          // m, of a moving shape that overlaps at the start: depth * normal separates the two
  SoftId soft{};               // the rope, cloth or solid that is hit; null: a shape is
  Vec3 weights{};              // soft: the point as a mean of the vertices of its triangle or segment

  explicit operator bool() const { return bool(body) || bool(soft); }
};

struct Overlap {
  BodyId body{};
  ShapeId shape{};
  std::int32_t shape_index = 0;  // as in CastHit
  std::int32_t triangle = -1;    // the lowest overlapping one, numbered as in CastHit; -1 if the shape lies wholly within a soft solid
  SoftId soft{};                 // as in CastHit

  explicit operator bool() const { return bool(body) || bool(soft); }
};

struct ClosestPoint {
  BodyId body{};
  ShapeId shape{};
  std::int32_t shape_index = 0;
  std::int32_t triangle = -1;
  DVec3 point{};          // on the shape of the world
  DVec3 query_point{};    // on the shape of the query
  Vec3 normal{};          // unit, from `point` to `query_point`; meaningless if the shapes overlap
  double distance = 0.0;  // m; 0 if the shapes overlap

  explicit operator bool() const { return bool(body); }
};

struct Penetration {
  BodyId body{};
  ShapeId shape{};
  std::int32_t shape_index = 0;
  std::int32_t triangle = -1;
  DVec3 point{};       // midway between the surfaces, where they are deepest
  Vec3 normal{};       // unit: moving the shape of the query by depth * normal ends this contact
  float depth = 0.0f;  // m, above 0

  explicit operator bool() const { return bool(body); }
};

// The reason why a query is invalid; code none if it is valid.
Error check_ray(const Ray& ray);
Error check_shape_cast(const ShapeCast& cast);
Error check_shape_pose(const ShapePose& shape);

}  // namespace gyre
