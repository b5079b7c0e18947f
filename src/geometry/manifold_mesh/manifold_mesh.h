// The steps of collide_mesh (declared in manifold.h) that are worth testing alone: collecting contacts by normal.
//
// In: points of one triangle after the other, each set with its normal. Out: at most kMaxMeshManifolds manifolds of at most
// four points. Points with the same name meet in one; contacts whose normals differ by less than two degrees share a
// manifold, with the normal of the deepest.
#pragma once

#include "geometry/manifold_mesh/mesh_points.h"

namespace gyre {

// Cosine (of two degrees) between the normals of contacts that belong to one stretch of ground.
constexpr float kSameNormal = 0.9994f;

class ManifoldGroups {
 public:
  static constexpr int kRoom = 16;
  static constexpr int kPointRoom = 56;

  void add(Vec3 normal, std::uint32_t triangle, const MeshPoints& points);
  // The least separation; infinity if there are no contacts.
  float deepest() const {
    float least = __builtin_huge_valf();
    for (int i = 0; i < count_; ++i) least = min(least, groups_[i].deepest);
    return least;
  }
  bool empty() const { return count_ == 0; }
  // Writes the manifolds, positions moved by `position`; in the order in which their first contact came. Returns how many.
  int finish(Vec3 position, LocalManifold* out);

 private:
  struct Group {
    Vec3 normal;
    float deepest;
    std::uint32_t triangle;
    int count;
    // Not cleared: only the counted ones are ever read.
    union {
      ManifoldPoint points[kPointRoom];
    };
    Group() {}
  };

  static void add_point(Group& group, const ManifoldPoint& point);
  void merge_nearest();

  int count_ = 0;
  Group groups_[kRoom];
};

// Whether a mesh or height field (one of the two) has nothing within `reach` of the other, convex shape, by a look at boxes
// alone: false where they do not tell, or where the two are of other kinds.
bool is_clear_of_surface(const Shape& a, const Shape& b, const Transform& a_from_b, float reach);

}  // namespace gyre
