// Grouping of contacts by normal: the step of collide_mesh (declared in manifold.h) that is worth a test of its own.
//
// In: the points of one triangle after the other, each set with its normal. Out: at most kMaxMeshManifolds manifolds of
// at most four points. Points with equal names become one; contacts whose normals differ by less than two degrees share
// a manifold, with the normal of the deepest.
#pragma once

#include "geometry/manifold_mesh/mesh_points.h"

namespace gyre {

// Cosine (of two degrees) between the normals of contacts on one level piece of ground.
constexpr float kSameNormal = 0.9994f;

// A point of uneven ground counts half if it lies this much above the deepest, in sizes of the shape: of five points under a face those
// near it decide how it rocks.
constexpr float kNearPoint = 1.0e-3f;

class ManifoldGroups {
 public:
  static constexpr int kRoom = 16;
  static constexpr int kPointRoom = 56;

  // `size`: of the shape.
  explicit ManifoldGroups(float size) : fade_(1.0f / (kNearPoint * size)) {}

  void add(Vec3 normal, std::uint32_t triangle, const MeshPoints& points);
  // The smallest separation; infinity if there are no contacts.
  float deepest() const {
    float smallest = __builtin_huge_valf();
    for (int i = 0; i < count_; ++i) smallest = min(smallest, groups_[i].deepest);
    return smallest;
  }
  bool empty() const { return count_ == 0; }
  // Writes the manifolds with their positions moved by `position`, in the order of their first contacts. Returns their
  // number.
  int finish(Vec3 position, LocalManifold* out);

 private:
  struct Group {
    Vec3 normal;
    float deepest;
    std::uint32_t triangle;
    int count;
    // Not cleared: only the counted elements are read.
    union {
      ManifoldPoint points[kPointRoom];
    };
    Group() {}
  };

  void add_point(Group& group, const ManifoldPoint& point) const;
  void merge_nearest();

  float fade_;  // 1/m, as in reduce_points()
  int count_ = 0;
  Group groups_[kRoom];
};

// True if a mesh or height field (one of the two shapes) has no box within `max_distance` of the other, convex shape.
// False if boxes cannot tell, or if the shapes are of other kinds.
bool is_clear_of_surface(const Shape& a, const Shape& b, const Transform& a_from_b, float max_distance);

}  // namespace gyre
