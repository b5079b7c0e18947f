// Placing a convex shape beside a mesh. See local_convex.h.
#include "geometry/manifold_mesh/local_convex.h"

#include <bit>

namespace gyre {
namespace {

// Faces of a box as in support.h: 2 * axis + (1 on the positive side); corners by the bits of their signs. Which of an edge's
// two faces is left and which is right makes no difference to a search for axes.
constexpr HullEdge kBoxEdges[12] = {
    {0, 1, 4, 2}, {2, 3, 3, 4}, {4, 5, 2, 5}, {6, 7, 5, 3},  // along x
    {0, 2, 0, 4}, {1, 3, 4, 1}, {4, 6, 5, 0}, {5, 7, 1, 5},  // along y
    {0, 4, 2, 0}, {1, 5, 1, 2}, {2, 6, 0, 3}, {3, 7, 3, 1},  // along z
};

// The columns of a box: corners by the bits of their signs, normals of the faces.
constexpr float kCornerX[8] = {-1, 1, -1, 1, -1, 1, -1, 1};
constexpr float kCornerY[8] = {-1, -1, 1, 1, -1, -1, 1, 1};
constexpr float kCornerZ[8] = {-1, -1, -1, -1, 1, 1, 1, 1};
constexpr float kBoxNormalX[8] = {-1, 1, -0.0f, 0, -0.0f, 0, 0, 0};
constexpr float kBoxNormalY[8] = {-0.0f, 0, -1, 1, -0.0f, 0, 0, 0};
constexpr float kBoxNormalZ[8] = {-0.0f, 0, -0.0f, 0, -1, 1, 1, 1};

using Floats = Wide<LocalConvex::kLanes>;
using Vectors = Vec3W<LocalConvex::kLanes>;

Vectors load(const float* x, const float* y, const float* z, int i) {
  return {Floats::load_unaligned(x + i), Floats::load_unaligned(y + i), Floats::load_unaligned(z + i)};
}

float least(Floats a) { return min(min(a[0], a[1]), min(a[2], a[3])); }
float greatest(Floats a) { return max(max(a[0], a[1]), max(a[2], a[3])); }

// Columns turned into other axes, in the order of roundings of a matrix times a vector.
void turn_columns(const Mat3& turn, const float* x, const float* y, const float* z, int count, float* out_x,
                  float* out_y, float* out_z) {
  const Vectors a = splat<4>(turn.x), b = splat<4>(turn.y), c = splat<4>(turn.z);
  for (int i = 0; i < count; i += LocalConvex::kLanes) {
    const Vectors v = load(x, y, z, i);
    const Vectors turned = v.x * a + v.y * b + v.z * c;
    turned.x.store_unaligned(out_x + i);
    turned.y.store_unaligned(out_y + i);
    turned.z.store_unaligned(out_z + i);
  }
}

// The box of a shape's surface in its own frame.
Aabb box_of(const Shape& shape) {
  switch (shape.kind) {
    case ShapeKind::capsule:
    case ShapeKind::box: {
      const Vec3 half = shape.extents + Vec3{shape.radius, shape.radius, shape.radius};
      return {-half, half};
    }
    case ShapeKind::hull:
      return shape.hull->box;
    default:
      return bounds(shape, Transform{});
  }
}

}  // namespace

LocalConvex::LocalConvex(const Shape& shape, Quat orientation)
    : shape_(&shape),
      orientation_(orientation),
      rotation_(to_matrix(orientation)),
      radius_(core_radius(shape)) {
  const Vec3 e = shape.extents;
  switch (shape.kind) {
    case ShapeKind::sphere: {
      constexpr float kZero[kLanes] = {};
      place_vertices(kZero, kZero, kZero, 1);
      break;
    }
    case ShapeKind::capsule: {
      constexpr float kZero[kLanes] = {};
      const float y[kLanes] = {-e.y, e.y, e.y, e.y};
      place_vertices(kZero, y, kZero, 2);
      break;
    }
    case ShapeKind::box: {
      float x[8], y[8], z[8];
      for (int i = 0; i < 8; ++i) {
        x[i] = kCornerX[i] * e.x;
        y[i] = kCornerY[i] * e.y;
        z[i] = kCornerZ[i] * e.z;
      }
      place_vertices(x, y, z, 8);
      const float offsets[8] = {e.x, e.x, e.y, e.y, e.z, e.z, e.z, e.z};
      place_faces(kBoxNormalX, kBoxNormalY, kBoxNormalZ, offsets, 6);
      edges_ = kBoxEdges;
      break;
    }
    case ShapeKind::hull:
      place_hull(*shape.hull);
      break;
    default:
      break;
  }
  local_box_ = box_of(shape);
  size_ = length(max(absolute(local_box_.low), absolute(local_box_.high)));
  const Vec3 axes[4] = {rotation_.x, rotation_.y, rotation_.z, {}};
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 3; ++k) {
      row_[k][i] = axes[i][k];
      row_size_[k][i] = absolute(axes[i][k]);
    }
    local_low_[i] = i < 3 ? local_box_.low[i] : 0.0f;
    local_high_[i] = i < 3 ? local_box_.high[i] : 0.0f;
  }
  show_columns();
}

void LocalConvex::place_vertices(const float* x, const float* y, const float* z, int count) {
  vertex_count_ = count;
  turn_columns(rotation_, x, y, z, count, x_, y_, z_);
}

void LocalConvex::place_faces(const float* x, const float* y, const float* z, const float* offsets,
                               int count) {
  face_count_ = count;
  turn_columns(rotation_, x, y, z, count, nx_, ny_, nz_);
  for (int i = 0; i < padded(count); ++i) offset_[i] = offsets[i];
}

void LocalConvex::place_hull(const Hull& hull) {
  place_vertices(hull.x.data(), hull.y.data(), hull.z.data(), hull.vertex_count());
  const Vectors a = splat<4>(rotation_.x), b = splat<4>(rotation_.y), c = splat<4>(rotation_.z);
  const HullPlane* const planes = hull.planes.data();
  face_count_ = hull.face_count();
  for (int i = 0; i < face_count_; i += kLanes) {
    const float* record[kLanes];
    for (int k = 0; k < kLanes; ++k)
      record[k] = reinterpret_cast<const float*>(planes + min(i + k, face_count_ - 1));
    Floats plane[4];
    Rows<kLanes>::gather(record, 0, plane);
    const Vectors turned = plane[0] * a + plane[1] * b + plane[2] * c;
    turned.x.store_unaligned(nx_ + i);
    turned.y.store_unaligned(ny_ + i);
    turned.z.store_unaligned(nz_ + i);
    plane[3].store_unaligned(offset_ + i);
  }
  edges_ = hull.edges;
  center_ = rotation_ * hull.centroid;
}

void LocalConvex::dot_faces(const Vec3* directions, float (*out)[kMaxVertices]) const {
  const Vectors a = splat<4>(directions[0]), b = splat<4>(directions[1]), c = splat<4>(directions[2]);
  for (int i = 0; i < face_count_; i += kLanes) {
    const Vectors n = load(nx_, ny_, nz_, i);
    dot(n, a).store_unaligned(out[0] + i);
    dot(n, b).store_unaligned(out[1] + i);
    dot(n, c).store_unaligned(out[2] + i);
  }
}

void LocalConvex::face_separations(const Vec3* corners, float (*each)[kMaxVertices], float* lowest) const {
  const Vectors a = splat<4>(corners[0]), b = splat<4>(corners[1]), c = splat<4>(corners[2]);
  for (int i = 0; i < face_count_; i += kLanes) {
    const Vectors n = load(nx_, ny_, nz_, i);
    const Floats offset = Floats::load_unaligned(offset_ + i);
    const Floats of_a = dot(n, a), of_b = dot(n, b), of_c = dot(n, c);
    (of_a - offset).store_unaligned(each[0] + i);
    (of_b - offset).store_unaligned(each[1] + i);
    (of_c - offset).store_unaligned(each[2] + i);
    (min(of_a, min(of_b, of_c)) - offset).store_unaligned(lowest + i);
  }
}

LocalConvex::Extent LocalConvex::extent(Vec3 direction) const {
  if (vertex_count_ == 0) return {dot(direction, support(-direction)), dot(direction, support(direction))};
  const Vectors d = splat<4>(direction);
  Floats low = dot(load(x_, y_, z_, 0), d), high = low;
  for (int i = kLanes; i < vertex_count_; i += kLanes) {
    const Floats height = dot(load(x_, y_, z_, i), d);
    low = min(low, height);
    high = max(high, height);
  }
  return {least(low), greatest(high)};
}

Aabb LocalConvex::box() const {
  if (vertex_count_ == 0) {
    const Extent x = extent({1, 0, 0}), y = extent({0, 1, 0}), z = extent({0, 0, 1});
    return {{x.low, y.low, z.low}, {x.high, y.high, z.high}};
  }
  Vectors low = load(x_, y_, z_, 0), high = low;
  for (int i = kLanes; i < vertex_count_; i += kLanes) {
    const Vectors v = load(x_, y_, z_, i);
    low = gyre::min(low, v);
    high = gyre::max(high, v);
  }
  return {{least(low.x), least(low.y), least(low.z)}, {greatest(high.x), greatest(high.y), greatest(high.z)}};
}

bool LocalConvex::has_low_vertex_inside(Vec3 direction, float height, const Vec3* outward,
                                         const Vec3* points, float room) const {
  const Vectors d = splat<4>(direction);
  for (int i = 0; i < vertex_count_; i += kLanes) {
    const Vectors v = load(x_, y_, z_, i);
    Mask<4> inside = dot(d, v) <= Floats(height);
    if (none(inside)) continue;
    for (int k = 0; k < 3; ++k)
      inside = inside & (dot(splat<4>(outward[k]), v - splat<4>(points[k])) < Floats(-room));
    if (any(inside)) return true;
  }
  return false;
}

int LocalConvex::lowest_vertex(Vec3 direction) const {
  const Vectors d = splat<4>(direction);
  const auto height = [&](int i) { return dot(load(x_, y_, z_, i), d); };
  Floats low = height(0);
  for (int i = kLanes; i < vertex_count_; i += kLanes) low = min(low, height(i));
  const Floats lowest(least(low));
  for (int i = 0; i < vertex_count_; i += kLanes) {
    if (const unsigned bits = to_bits(height(i) <= lowest); bits != 0) return i + std::countr_zero(bits);
  }
  return 0;
}

bool LocalConvex::lies_outside(Vec3 outward, Vec3 point, float room) const {
  const Vectors d = splat<4>(outward), p = splat<4>(point);
  for (int i = 0; i < vertex_count_; i += kLanes) {
    if (!all(dot(d, load(x_, y_, z_, i) - p) > Floats(room))) return false;
  }
  return has_vertices();
}

Vec3 LocalConvex::support(Vec3 direction) const {
  return rotation_ * gyre::support(*shape_, transpose_times(rotation_, direction));
}

void LocalConvex::face_towards(Vec3 direction, FacePolygon& out) const {
  support_face(*shape_, transpose_times(rotation_, direction), out);
  out.normal = rotation_ * out.normal;
  for (int i = 0; i < out.count; ++i) out.vertices[i] = rotation_ * out.vertices[i];
}

bool LocalConvex::can_touch(const AxisBox& box, float reach) const {
  const Floats middle = Floats(0.5f) * (box.low() + box.high()),
               half = Floats(0.5f) * (box.high() - box.low());
  const Floats size = absolute(middle);
  if (shape_->kind == ShapeKind::sphere) {
    const Floats outside = max(size - half, Floats(0.0f));
    const Floats squared = outside * outside;
    return squared[0] + squared[1] + squared[2] <= square(radius_ + reach) * 1.0001f;
  }
  const Floats along = Floats::load(row_[0]) * Floats(middle[0]) + Floats::load(row_[1]) * Floats(middle[1]) +
                       Floats::load(row_[2]) * Floats(middle[2]);
  const Floats spread = Floats::load(row_size_[0]) * Floats(half[0]) +
                        Floats::load(row_size_[1]) * Floats(half[1]) +
                        Floats::load(row_size_[2]) * Floats(half[2]) +
                        Floats(reach + 1.0e-6f * max(size[0], max(size[1], size[2])));
  return none((along - spread > Floats::load(local_high_)) | (along + spread < Floats::load(local_low_)));
}

void LocalConvex::show_columns() {
  using Core = ConvexColumns::Core;
  const Core core = shape_->kind == ShapeKind::box ? Core::box
                    : face_count_ > 0              ? Core::polyhedron
                    : vertex_count_ == 1           ? Core::ball
                    : vertex_count_ == 2           ? Core::segment
                                                   : Core::curved;
  columns_ = {core,
              vertex_count_,
              face_count_,
              x_,
              y_,
              z_,
              nx_,
              ny_,
              nz_,
              offset_,
              {rotation_.x, rotation_.y, rotation_.z},
              local_box_,
              shape_->extents,
              center_,
              radius_,
              size_};
}

float LocalConvex::box_distance(Vec3 point) const {
  const Vec3 local = to_local(point);
  return largest(max(local - local_box_.high, local_box_.low - local));
}

}  // namespace gyre
