// A convex shape as a mesh sees it: turned into the mesh's axes, with the origin at the shape's own, so that all numbers
// near the contact are small whatever the place in the mesh.
//
// In: a convex Shape and its orientation. Out: vertices, face planes and edges for axis searches (polyhedra, capsules and
// spheres), support points for the rest, and what one plane after the other has to know. As in support.h everything is of
// the core; the surface lies `radius` farther out.
#pragma once

#include "geometry/hull.h"
#include "geometry/support.h"

#include <span>

namespace gyre {

class PlacedConvex {
 public:
  static constexpr int kMaxVertices = 256;

  PlacedConvex(const Shape& shape, Quat orientation);

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
  // The component of every face's normal along `direction`, into face_count() floats.
  void face_components(Vec3 direction, float* out) const {
    for (int i = 0; i < face_count_; ++i)
      out[i] = nx_[i] * direction.x + ny_[i] * direction.y + nz_[i] * direction.z;
  }
  // How far a triangle's lowest corner lies before each face, into face_count() floats.
  void face_separations(const Vec3* corners, float* out) const {
    const Vec3 a = corners[0], b = corners[1], c = corners[2];
    for (int i = 0; i < face_count_; ++i) {
      const float at_a = nx_[i] * a.x + ny_[i] * a.y + nz_[i] * a.z;
      const float at_b = nx_[i] * b.x + ny_[i] * b.y + nz_[i] * b.z;
      const float at_c = nx_[i] * c.x + ny_[i] * c.y + nz_[i] * c.z;
      out[i] = min(at_a, min(at_b, at_c)) - offset_[i];
    }
  }
  // Edges between two faces; empty for capsules, whose one edge has no faces (vertex 0 to vertex 1).
  std::span<const HullEdge> edges() const { return edges_; }

  // The core's extent along `direction`: the least and the greatest dot product of it with any of its points.
  float lowest(Vec3 direction) const;
  float highest(Vec3 direction) const { return -lowest(-direction); }
  Vec3 support(Vec3 direction) const;
  // The feature that faces `direction`, in the mesh's axes. FacePolygon ids keep their meaning.
  void face_towards(Vec3 direction, FacePolygon& out) const;
  // The vertex of the core farthest against `direction`; only if has_vertices().
  int lowest_vertex(Vec3 direction) const;

  // Whether anything within `reach` of the surface may lie in the box: false only if certainly nothing does.
  bool may_touch(const Aabb& box, float reach) const;
  // How far a point lies outside the shape's local box; negative inside. And the local box itself.
  float box_distance(Vec3 point) const;
  Vec3 to_local(Vec3 v) const { return transpose_times(rotation_, v); }
  Vec3 from_local(Vec3 v) const { return rotation_ * v; }
  const Aabb& local_box() const { return local_box_; }

 private:
  void add_vertex(Vec3 local);
  void add_face(Vec3 local_normal, float offset);

  const Shape* shape_;
  Quat orientation_;
  Mat3 rotation_;
  float radius_ = 0.0f, size_ = 0.0f;
  Vec3 center_;
  Aabb local_box_;  // of the surface, in the shape's frame
  int vertex_count_ = 0, face_count_ = 0;
  std::span<const HullEdge> edges_;
  // Columns, not cleared: only the counted ones are ever read.
  float x_[kMaxVertices], y_[kMaxVertices], z_[kMaxVertices];
  float nx_[kMaxVertices], ny_[kMaxVertices], nz_[kMaxVertices], offset_[kMaxVertices];
};

// What a shape has to say about the planes with one normal. Neighbouring triangles mostly share it, so it is asked once.
struct PlaneSide {
  Vec3 normal;
  float lowest = 0.0f, highest = 0.0f;  // of the core along the normal
  bool has_face = false;
  FacePolygon face;  // facing against the normal
};

}  // namespace gyre
