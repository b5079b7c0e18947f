// A convex shape as a mesh sees it: turned into the mesh's axes, with the origin at the shape's own, so that all numbers
// near the contact are small whatever the place in the mesh.
//
// In: a convex Shape and its orientation. Out: vertices, face planes and edges for axis searches (polyhedra, capsules and
// spheres), support points for the rest, and what one plane after the other has to know. As in support.h everything is of
// the core; the surface lies `radius` farther out.
#pragma once

#include "geometry/shape/hull.h"
#include "geometry/manifold_mesh/mesh_kernels.h"
#include "geometry/shape/support.h"
#include "math/wide_vec.h"

#include <span>

namespace gyre {

// A box with an axis a lane, and one lane that is not used.
class AxisBox {
 public:
  AxisBox(Wide<4> low, Wide<4> high) : low_(low), high_(high) {}
  explicit AxisBox(const Aabb& box) : low_(lanes(box.low)), high_(lanes(box.high)) {}
  Wide<4> low() const { return low_; }
  Wide<4> high() const { return high_; }
  bool overlaps(const AxisBox& other) const { return all((low_ <= other.high_) & (other.low_ <= high_)); }
  AxisBox operator-(Vec3 way) const { return {low_ - lanes(way), high_ - lanes(way)}; }
  Aabb box() const { return {{low_[0], low_[1], low_[2]}, {high_[0], high_[1], high_[2]}}; }

  static Wide<4> lanes(Vec3 v) {
    // Not by way of an array: GCC would build that on the stack, part by part.
    typedef float Quad __attribute__((vector_size(16)));
    return Wide<4>::of(Quad{v.x, v.y, v.z, 0.0f});
  }

 private:
  Wide<4> low_, high_;
};

class LocalConvex {
 public:
  static constexpr int kMaxVertices = 256;
  // Columns are searched four at a time: behind the last of them its copies stand.
  static constexpr int kLanes = 4;

  LocalConvex(const Shape& shape, Quat orientation);
  LocalConvex(const LocalConvex&) = delete;
  LocalConvex& operator=(const LocalConvex&) = delete;

  const Shape& shape() const { return *shape_; }
  Quat orientation() const { return orientation_; }
  float radius() const { return radius_; }
  // Largest distance of a surface point from the origin of the shape: what tolerances are relative to.
  float size() const { return size_; }
  // A point well inside.
  Vec3 center() const { return center_; }
  // Whether the core is a polyhedron, segment or point, with the columns below; else only support points are known.
  bool has_vertices() const { return vertex_count_ > 0; }

  int vertex_count() const { return vertex_count_; }
  Vec3 vertex(int i) const { return {x_[i], y_[i], z_[i]}; }
  int face_count() const { return face_count_; }
  Vec3 face_normal(int i) const { return {nx_[i], ny_[i], nz_[i]}; }
  float face_offset(int i) const { return offset_[i]; }  // dot(normal, p) = offset on the face
  // What the faces' normals have along each of three directions, into padded(face_count()) floats.
  void dot_faces(const Vec3* directions, float (*out)[kMaxVertices]) const;
  // How far each corner of a triangle lies before each face, and how far the lowest does.
  void face_separations(const Vec3* corners, float (*each)[kMaxVertices], float* lowest) const;
  // Edges between two faces; empty for capsules, whose one edge has no faces (vertex 0 to vertex 1).
  std::span<const HullEdge> edges() const { return edges_; }

  // The core's extent along `direction`: the least and the greatest dot product of it with any of its points.
  float lowest(Vec3 direction) const { return extent(direction).low; }
  float highest(Vec3 direction) const { return extent(direction).high; }
  struct Extent {
    float low, high;
  };
  Extent extent(Vec3 direction) const;
  // The core's box in the mesh's axes.
  Aabb box() const;
  Vec3 support(Vec3 direction) const;
  // The feature that faces `direction`, in the mesh's axes. FacePolygon ids keep their meaning.
  void face_towards(Vec3 direction, FacePolygon& out) const;
  // The vertex of the core farthest against `direction`; only if has_vertices().
  int lowest_vertex(Vec3 direction) const;
  // Whether all vertices lie more than `room` outside of a plane through a point; false without vertices.
  bool lies_outside(Vec3 outward, Vec3 point, float room) const;
  // Whether any vertex not higher than `height` along `direction` lies more than `room` inside of each of three planes
  // through points; only if has_vertices().
  bool has_low_vertex_inside(Vec3 direction, float height, const Vec3* outward, const Vec3* points,
                             float room) const;

  // Whether anything within `reach` of the surface may lie in the box: false only if certainly nothing does.
  bool can_touch(const AxisBox& box, float reach) const;
  // How far a point lies outside the shape's local box; negative inside. And the local box itself.
  float box_distance(Vec3 point) const;
  Vec3 to_local(Vec3 v) const { return transpose_times(rotation_, v); }
  Vec3 from_local(Vec3 v) const { return rotation_ * v; }
  const Aabb& local_box() const { return local_box_; }
  const ConvexColumns& columns() const { return columns_; }

  static constexpr int padded(int count) { return (count + kLanes - 1) / kLanes * kLanes; }

 private:
  void place_vertices(const float* x, const float* y, const float* z, int count);
  void place_faces(const float* x, const float* y, const float* z, const float* offsets, int count);
  void place_hull(const Hull& hull);
  void show_columns();

  const Shape* shape_;
  Quat orientation_;
  Mat3 rotation_;
  float radius_ = 0.0f, size_ = 0.0f;
  Vec3 center_;
  Aabb local_box_;  // of the surface, in the shape's frame
  // The turn's rows, of the turn itself and without signs, and the local box, one axis of the shape a lane.
  alignas(16) float row_[3][4], row_size_[3][4];
  alignas(16) float local_low_[4], local_high_[4];
  int vertex_count_ = 0, face_count_ = 0;
  std::span<const HullEdge> edges_;
  ConvexColumns columns_;
  // Columns, not cleared: only the counted ones are ever read.
  alignas(16) float x_[kMaxVertices], y_[kMaxVertices], z_[kMaxVertices];
  alignas(16) float nx_[kMaxVertices], ny_[kMaxVertices], nz_[kMaxVertices], offset_[kMaxVertices];
};

// What a shape has to say about the planes with one normal. Neighbouring triangles mostly share it, so it is asked once.
struct PlaneSide {
  Vec3 normal;
  float lowest = 0.0f, highest = 0.0f;  // of the core along the normal
  bool has_face = false;
  FacePolygon face;  // facing against the normal
};

}  // namespace gyre
