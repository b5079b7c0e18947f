// Planes against convex shapes, and the dispatch for two shapes of any kind. See manifold.h.
#include "geometry/manifold/manifold.h"

#include "geometry/manifold/clip.h"
#include "geometry/shape/hull.h"
#include "geometry/shape/support.h"

namespace gyre {
namespace {

// Points of a shape that may touch a plane. If there are too many, the highest are replaced.
class Lowest {
 public:
  Lowest(const Shape& plane, float radius, float max_separation)
      : normal_(plane.extents), offset_(plane.offset), radius_(radius), max_separation_(max_separation) {}

  // A vertex of the core, in the plane's frame.
  void add(Vec3 vertex, std::uint32_t id) {
    const float separation = dot(normal_, vertex) - offset_ - radius_;
    if (!(separation <= max_separation_)) return;
    const ManifoldPoint point{vertex - (radius_ + 0.5f * separation) * normal_, separation,
                              feature_vertex_b(id)};
    if (count_ < kMaxClipPoints) {
      points_[count_++] = point;
      return;
    }
    int highest = 0;
    for (int i = 1; i < count_; ++i) {
      if (points_[i].separation > points_[highest].separation) highest = i;
    }
    if (separation < points_[highest].separation) points_[highest] = point;
  }

  void finish(LocalManifold& out) {
    out.normal = normal_;
    out.count = reduce_points(points_, count_, normal_);
    for (int i = 0; i < out.count; ++i) out.points[i] = points_[i];
  }

 private:
  Vec3 normal_;
  float offset_, radius_, max_separation_;
  int count_ = 0;
  // Not cleared: only the counted elements are read.
  union {
    ManifoldPoint points_[kMaxClipPoints];
  };
};

// Turns a manifold from A to B into one from B to A, in the frame of the other shape.
void flip(LocalManifold& manifold, const Transform& a_from_b) {
  manifold.normal = -rotate(a_from_b.orientation, manifold.normal);
  for (int i = 0; i < manifold.count; ++i)
    manifold.points[i].position = a_from_b * manifold.points[i].position;
}

}  // namespace

void collide_plane(const Shape& plane, const Shape& b, const Transform& a_from_b, float max_separation,
                   LocalManifold& out) {
  Lowest lowest(plane, core_radius(b), max_separation);
  const Vec3 e = b.extents;
  switch (b.kind) {
    case ShapeKind::sphere:
      lowest.add(a_from_b.position, 0);
      break;
    case ShapeKind::capsule:
      lowest.add(a_from_b * Vec3{0, -e.y, 0}, 0);
      lowest.add(a_from_b * Vec3{0, e.y, 0}, 1);
      break;
    case ShapeKind::box:
      for (std::uint32_t i = 0; i < 8; ++i) {
        lowest.add(a_from_b * Vec3{(i & 1) ? e.x : -e.x, (i & 2) ? e.y : -e.y, (i & 4) ? e.z : -e.z}, i);
      }
      break;
    case ShapeKind::hull:
      for (std::size_t i = 0; i < b.hull->vertices.size(); ++i) {
        lowest.add(a_from_b * b.hull->vertices[i], std::uint32_t(i));
      }
      break;
    default: {
      // Cylinders and cones: the cap or the line of the mantle that faces the plane, with the lowest point of the rim.
      FacePolygon face;
      support_face(b, rotate_inverse(a_from_b.orientation, -plane.extents), face);
      for (int i = 0; i < face.count; ++i) lowest.add(a_from_b * face.vertices[i], face.ids[i]);
      break;
    }
  }
  lowest.finish(out);
}

int collide_shapes(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                   PairCache& cache, LocalManifold* out, CachedTriangles* triangles) {
  const bool convex_a = is_convex(a.kind), convex_b = is_convex(b.kind);
  if (convex_a && convex_b) {
    collide_convex(a, b, a_from_b, max_separation, cache, out[0]);
    return out[0].count > 0 ? 1 : 0;
  }
  if (!convex_a && !convex_b) return 0;
  // The non-convex shape comes first.
  const bool swapped = convex_a;
  const Shape& first = swapped ? b : a;
  const Shape& second = swapped ? a : b;
  const Transform first_from_second = swapped ? inverse(a_from_b) : a_from_b;
  int count = 0;
  if (first.kind == ShapeKind::plane) {
    collide_plane(first, second, first_from_second, max_separation, out[0]);
    count = out[0].count > 0 ? 1 : 0;
  } else {
    count = collide_mesh(first, second, first_from_second, max_separation, out, triangles);
  }
  for (int i = 0; swapped && i < count; ++i) flip(out[i], a_from_b);
  return count;
}

}  // namespace gyre
