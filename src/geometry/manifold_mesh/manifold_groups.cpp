// Contacts with equal normals become one manifold. See manifold_mesh.h.
#include "geometry/manifold_mesh/manifold_mesh.h"

namespace gyre {

void ManifoldGroups::add_point(Group& group, const ManifoldPoint& point) const {
  for (int i = 0; i < group.count; ++i) {
    if (group.points[i].feature != point.feature) continue;
    if (point.separation < group.points[i].separation) group.points[i] = point;
    return;
  }
  if (group.count == kPointRoom) group.count = reduce_points(group.points, group.count, group.normal, fade_);
  group.points[group.count++] = point;
}

void ManifoldGroups::add(Vec3 normal, std::uint32_t triangle, const MeshPoints& points) {
  if (points.count == 0) return;
  const float deepest = points.deepest();
  int best = -1;
  float nearest = kSameNormal;
  for (int i = 0; i < count_; ++i) {
    const float cosine = dot(groups_[i].normal, normal);
    if (cosine > nearest) {
      nearest = cosine;
      best = i;
    }
  }
  if (best < 0) {
    if (count_ == kRoom) merge_nearest();
    best = count_++;
    groups_[best].normal = normal;
    groups_[best].deepest = deepest;
    groups_[best].triangle = triangle;
    groups_[best].count = 0;
  }
  Group& group = groups_[best];
  if (deepest < group.deepest) {
    group.deepest = deepest;
    group.normal = normal;
    group.triangle = triangle;
  }
  for (int i = 0; i < points.count; ++i) add_point(group, points.points[i]);
}

// Joins the two groups with the most similar normals, under the normal of the deeper.
void ManifoldGroups::merge_nearest() {
  int into = 0, from = 1;
  float nearest = -2.0f;
  for (int i = 0; i < count_; ++i) {
    for (int k = i + 1; k < count_; ++k) {
      const float cosine = dot(groups_[i].normal, groups_[k].normal);
      if (cosine > nearest) {
        nearest = cosine;
        into = i;
        from = k;
      }
    }
  }
  Group& target = groups_[into];
  const Group& source = groups_[from];
  if (source.deepest < target.deepest) {
    target.normal = source.normal;
    target.deepest = source.deepest;
    target.triangle = source.triangle;
  }
  for (int i = 0; i < source.count; ++i) add_point(target, source.points[i]);
  for (int i = from; i + 1 < count_; ++i) groups_[i] = groups_[i + 1];
  --count_;
}

int ManifoldGroups::finish(Vec3 position, LocalManifold* out) {
  while (count_ > kMaxMeshManifolds) merge_nearest();
  for (int i = 0; i < count_; ++i) {
    Group& group = groups_[i];
    LocalManifold& manifold = out[i];
    manifold.normal = group.normal;
    manifold.triangle = group.triangle;
    manifold.count = reduce_points(group.points, group.count, group.normal, fade_);
    for (int k = 0; k < manifold.count; ++k) {
      manifold.points[k] = group.points[k];
      manifold.points[k].position += position;
    }
  }
  return count_;
}

}  // namespace gyre
