// Placing a convex shape beside a mesh. See placed_convex.h.
#include "geometry/placed_convex.h"

namespace gyre {
namespace {

// Faces of a box as in support.h: 2 * axis + (1 on the positive side); corners by the bits of their signs. Which of an edge's
// two faces is left and which is right makes no difference to a search for axes.
constexpr HullEdge kBoxEdges[12] = {
    {0, 1, 4, 2}, {2, 3, 3, 4}, {4, 5, 2, 5}, {6, 7, 5, 3},  // along x
    {0, 2, 0, 4}, {1, 3, 4, 1}, {4, 6, 5, 0}, {5, 7, 1, 5},  // along y
    {0, 4, 2, 0}, {1, 5, 1, 2}, {2, 6, 0, 3}, {3, 7, 3, 1},  // along z
};

}  // namespace

PlacedConvex::PlacedConvex(const Shape& shape, Quat orientation)
    : shape_(&shape),
      orientation_(orientation),
      rotation_(to_matrix(orientation)),
      radius_(core_radius(shape)) {
  const Vec3 e = shape.extents;
  switch (shape.kind) {
    case ShapeKind::sphere:
      add_vertex({0, 0, 0});
      break;
    case ShapeKind::capsule:
      add_vertex({0, -e.y, 0});
      add_vertex({0, e.y, 0});
      break;
    case ShapeKind::box:
      for (int i = 0; i < 8; ++i)
        add_vertex({(i & 1) ? e.x : -e.x, (i & 2) ? e.y : -e.y, (i & 4) ? e.z : -e.z});
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 normal{axis == 0 ? 1.0f : 0.0f, axis == 1 ? 1.0f : 0.0f, axis == 2 ? 1.0f : 0.0f};
        add_face(-normal, e[axis]);
        add_face(normal, e[axis]);
      }
      edges_ = kBoxEdges;
      break;
    case ShapeKind::hull:
      for (const Vec3 v : shape.hull->vertices) add_vertex(v);
      for (const HullPlane& plane : shape.hull->planes) add_face(plane.normal, plane.offset);
      edges_ = shape.hull->edges;
      center_ = rotation_ * shape.hull->centroid;
      break;
    default:
      break;
  }
  local_box_ = bounds(shape, Transform{});
  size_ = length(max(absolute(local_box_.low), absolute(local_box_.high)));
}

void PlacedConvex::add_vertex(Vec3 local) {
  const Vec3 v = rotation_ * local;
  x_[vertex_count_] = v.x;
  y_[vertex_count_] = v.y;
  z_[vertex_count_] = v.z;
  ++vertex_count_;
}

void PlacedConvex::add_face(Vec3 local_normal, float offset) {
  const Vec3 n = rotation_ * local_normal;
  nx_[face_count_] = n.x;
  ny_[face_count_] = n.y;
  nz_[face_count_] = n.z;
  offset_[face_count_] = offset;
  ++face_count_;
}

float PlacedConvex::lowest(Vec3 direction) const {
  if (vertex_count_ == 0) return dot(direction, support(-direction));
  float low = x_[0] * direction.x + y_[0] * direction.y + z_[0] * direction.z;
  for (int i = 1; i < vertex_count_; ++i) {
    low = min(low, x_[i] * direction.x + y_[i] * direction.y + z_[i] * direction.z);
  }
  return low;
}

int PlacedConvex::lowest_vertex(Vec3 direction) const {
  int winner = 0;
  float low = dot(vertex(0), direction);
  for (int i = 1; i < vertex_count_; ++i) {
    const float value = dot(vertex(i), direction);
    if (value < low) {
      low = value;
      winner = i;
    }
  }
  return winner;
}

Vec3 PlacedConvex::support(Vec3 direction) const {
  return rotation_ * gyre::support(*shape_, transpose_times(rotation_, direction));
}

void PlacedConvex::face_towards(Vec3 direction, FacePolygon& out) const {
  support_face(*shape_, transpose_times(rotation_, direction), out);
  out.normal = rotation_ * out.normal;
  for (int i = 0; i < out.count; ++i) out.vertices[i] = rotation_ * out.vertices[i];
}

bool PlacedConvex::may_touch(const Aabb& box, float reach) const {
  const Vec3 middle = gyre::center(box), half = half_size(box);
  if (shape_->kind == ShapeKind::sphere) {
    const Vec3 outside = max(absolute(middle) - half, {0, 0, 0});
    return length_squared(outside) <= square(radius_ + reach) * 1.0001f;
  }
  const Vec3 axes[3] = {rotation_.x, rotation_.y, rotation_.z};
  const float slack = reach + 1.0e-6f * largest(absolute(middle));
  for (int i = 0; i < 3; ++i) {
    const float along = dot(axes[i], middle), spread = dot(absolute(axes[i]), half) + slack;
    if (along - spread > local_box_.high[i] || along + spread < local_box_.low[i]) return false;
  }
  return true;
}

float PlacedConvex::box_distance(Vec3 point) const {
  const Vec3 local = to_local(point);
  return largest(max(local - local_box_.high, local_box_.low - local));
}

}  // namespace gyre
