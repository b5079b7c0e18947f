// The inner form of shapes, their checks, bounds and radii. See shape.h.
#include "geometry/shape/shape.h"

#include "geometry/shape/cooked.h"
#include "geometry/shape/height_field.h"
#include "geometry/shape/hull.h"
#include "geometry/shape/mesh.h"
#include "math/wide_vec.h"

namespace gyre {
namespace {

Shape inner(const Sphere& sphere) {
  Shape out;
  out.kind = ShapeKind::sphere;
  out.radius = sphere.radius;
  return out;
}

Shape inner(const Box& box) {
  Shape out;
  out.kind = ShapeKind::box;
  out.radius = box.rounding;
  out.extents = max(box.half_extents - Vec3{box.rounding, box.rounding, box.rounding}, Vec3{});
  return out;
}

Shape with_height(ShapeKind kind, float radius, float half_height) {
  Shape out;
  out.kind = kind;
  out.radius = radius;
  out.extents = {0.0f, half_height, 0.0f};
  return out;
}
Shape inner(const Capsule& capsule) {
  return with_height(ShapeKind::capsule, capsule.radius, capsule.half_height);
}
Shape inner(const Cylinder& cylinder) {
  return with_height(ShapeKind::cylinder, cylinder.radius, cylinder.half_height);
}
Shape inner(const Cone& cone) { return with_height(ShapeKind::cone, cone.radius, cone.half_height); }

Shape inner(const Plane& plane) {
  Shape out;
  out.kind = ShapeKind::plane;
  // {p : dot(n, p) = offset} with any n is {p : dot(n / |n|, p) = offset / |n|}.
  const DVec3 n(plane.normal);
  const double size = length(n);
  out.extents = to_float(n / size);
  out.offset = float(double(plane.offset) / size);
  return out;
}

Shape inner(const Geometry& geometry) {
  Shape out;
  const CookedGeometry& data = *geometry.data();
  out.kind = data.kind;
  if (data.kind == ShapeKind::mesh) {
    out.mesh = data.mesh.get();
  } else if (data.kind == ShapeKind::height_field) {
    out.field = data.field.get();
  } else {
    out.hull = data.hull.get();
  }
  return out;
}

// "box: rounding is 3; allowed is 0 to 0.5 (m)".
Error check_range(const char* shape, const char* field, float value, float low, float high) {
  if (value >= low && value <= high) return {};
  return make_error(ErrorCode::invalid_argument, "%s: %s is %g m; allowed is %g to %g m", shape, field,
                    double(value), double(low), double(high));
}
Error check_length(const char* shape, const char* field, float value) {
  return check_range(shape, field, value, kMinLength, kMaxLength);
}

Error check(const Sphere& sphere) { return check_length("sphere", "radius", sphere.radius); }

Error check(const Box& box) {
  constexpr const char* kNames[3] = {"half_extents.x", "half_extents.y", "half_extents.z"};
  for (int axis = 0; axis < 3; ++axis) {
    const Error error = check_length("box", kNames[axis], box.half_extents[axis]);
    if (error) return error;
  }
  return check_range("box", "rounding", box.rounding, 0.0f, smallest(box.half_extents));
}

Error check(const Capsule& capsule) {
  const Error error = check_length("capsule", "radius", capsule.radius);
  if (error) return error;
  return check_range("capsule", "half_height", capsule.half_height, 0.0f, kMaxLength);
}

Error check(const Cylinder& cylinder) {
  const Error error = check_length("cylinder", "radius", cylinder.radius);
  return error ? error
                                       : check_length("cylinder", "half_height", cylinder.half_height);
}

Error check(const Cone& cone) {
  const Error error = check_length("cone", "radius", cone.radius);
  return error ? error : check_length("cone", "half_height", cone.half_height);
}

Error check(const Plane& plane) {
  const Vec3 n = plane.normal;
  const float size = largest(absolute(n));
  if (!is_finite(n) || !(size > 1.0e-18f) || !(size < 1.0e18f)) {
    return make_error(ErrorCode::invalid_argument,
                      "plane: normal is (%g, %g, %g); allowed is any finite vector of length 1e-18 to 1e18",
                      double(n.x), double(n.y), double(n.z));
  }
  const double distance = double(plane.offset) / length(DVec3(n));
  if (absolute(distance) <= double(kMaxLength)) return {};
  return make_error(ErrorCode::invalid_argument,
                    "plane: offset is %g, %g m from the origin; allowed is -%g to %g m", double(plane.offset),
                    distance, double(kMaxLength), double(kMaxLength));
}

Error check(const Geometry& geometry) {
  if (geometry) return {};
  return make_error(ErrorCode::invalid_argument,
                    "geometry: is empty; allowed is what cook_hull, cook_mesh or cook_height_field returned");
}

// The bounding box of a rotated box: |R| h.
Aabb rotated_box(Vec3 middle, Vec3 half, const Transform& t) {
  const Mat3 r = to_matrix(t.orientation);
  const Vec3 c = r * middle + t.position;
  const Vec3 e = half.x * absolute(r.x) + half.y * absolute(r.y) + half.z * absolute(r.z);
  return {c - e, c + e};
}

// The half size of the bounding box of a disc of radius 1 with the given axis.
Vec3 disc_extent(Vec3 axis) {
  const auto half_extent = [](float a) { return std::sqrt(max(0.0f, 1.0f - a * a)); };
  return {half_extent(axis.x), half_extent(axis.y), half_extent(axis.z)};
}

Aabb cone_bounds(const Shape& shape, const Transform& t) {
  const Vec3 axis = rotate(t.orientation, {0, 1, 0});
  const Vec3 apex = t.position + shape.extents.y * axis;
  const Vec3 base = t.position - shape.extents.y * axis;
  const Vec3 e = shape.radius * disc_extent(axis);
  return {min(apex, base - e), max(apex, base + e)};
}

// Four vertices side by side, because every processor has registers of four.
Aabb hull_bounds(const Hull& hull, const Transform& t) {
  constexpr int W = 4;
  const Mat3 r = to_matrix(t.orientation);
  const Mat3W<W> rotation{splat<W>(r.x), splat<W>(r.y), splat<W>(r.z)};
  const auto rotated = [&](std::size_t first) {
    return rotation * Vec3W<W>{Wide<W>::load_unaligned(&hull.x[first]),
                               Wide<W>::load_unaligned(&hull.y[first]),
                               Wide<W>::load_unaligned(&hull.z[first])};
  };
  Vec3W<W> low = rotated(0), high = low;
  // The padding repeats the last vertex.
  for (std::size_t i = W; i < hull.x.size(); i += W) {
    const Vec3W<W> p = rotated(i);
    low = min(low, p);
    high = max(high, p);
  }
  const auto smallest_of = [](Wide<W> v) { return min(min(v[0], v[1]), min(v[2], v[3])); };
  const auto largest_of = [](Wide<W> v) { return max(max(v[0], v[1]), max(v[2], v[3])); };
  return {Vec3{smallest_of(low.x), smallest_of(low.y), smallest_of(low.z)} + t.position,
          Vec3{largest_of(high.x), largest_of(high.y), largest_of(high.z)} + t.position};
}

// Unbounded, except if the surface is exactly perpendicular to an axis: with the slightest tilt it extends everywhere.
Aabb plane_bounds(const Shape& shape, const Transform& t) {
  const Vec3 n = rotate(t.orientation, shape.extents);
  const float offset = shape.offset + dot(n, t.position);
  Aabb box{{-kUnbounded, -kUnbounded, -kUnbounded}, {kUnbounded, kUnbounded, kUnbounded}};
  if (n.y == 0.0f && n.z == 0.0f) (n.x > 0.0f ? box.high.x : box.low.x) = n.x > 0.0f ? offset : -offset;
  if (n.z == 0.0f && n.x == 0.0f) (n.y > 0.0f ? box.high.y : box.low.y) = n.y > 0.0f ? offset : -offset;
  if (n.x == 0.0f && n.y == 0.0f) (n.z > 0.0f ? box.high.z : box.low.z) = n.z > 0.0f ? offset : -offset;
  return box;
}

float farthest_corner(const Aabb& box, Vec3 from) {
  return length(max(absolute(box.low - from), absolute(box.high - from)));
}

}  // namespace

const char* to_string(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::sphere:
      return "sphere";
    case ShapeKind::box:
      return "box";
    case ShapeKind::capsule:
      return "capsule";
    case ShapeKind::cylinder:
      return "cylinder";
    case ShapeKind::cone:
      return "cone";
    case ShapeKind::hull:
      return "hull";
    case ShapeKind::plane:
      return "plane";
    case ShapeKind::mesh:
      return "mesh";
    case ShapeKind::height_field:
      return "height_field";
  }
  return "unknown";
}

ShapeKind Geometry::kind() const { return data_ ? data_->kind : ShapeKind::hull; }
std::uint64_t Geometry::content_hash() const { return data_ ? data_->content_hash : 0; }

HullView view_hull(const Geometry& hull) {
  if (!hull || !hull.data()->hull) return {};
  const Hull& data = *hull.data()->hull;
  return {data.vertices, data.face_offsets, data.face_vertices};
}

MeshView view_mesh(const Geometry& mesh) {
  if (!mesh || !mesh.data()->mesh) return {};
  return {mesh.data()->mesh->vertices, mesh.data()->mesh->indices};
}

HeightFieldView view_height_field(const Geometry& field) {
  if (!field || !field.data()->field) return {};
  const HeightField& data = *field.data()->field;
  return {data.heights, data.columns, data.rows, data.spacing};
}

Shape make_shape(const AnyShape& shape) {
  return std::visit([](const auto& kind) { return inner(kind); }, shape);
}

Error check_shape(const AnyShape& shape) {
  return std::visit([](const auto& kind) { return check(kind); }, shape);
}

Aabb bounds(const Shape& shape, const Transform& t) {
  const Vec3 radius{shape.radius, shape.radius, shape.radius};
  switch (shape.kind) {
    case ShapeKind::sphere:
      return {t.position - radius, t.position + radius};
    case ShapeKind::box:
    case ShapeKind::capsule: {
      const Aabb core = rotated_box({}, shape.extents, t);
      return {core.low - radius, core.high + radius};
    }
    case ShapeKind::cylinder: {
      const Vec3 axis = rotate(t.orientation, {0, 1, 0});
      const Vec3 e = shape.extents.y * absolute(axis) + shape.radius * disc_extent(axis);
      return {t.position - e, t.position + e};
    }
    case ShapeKind::cone:
      return cone_bounds(shape, t);
    case ShapeKind::hull:
      return hull_bounds(*shape.hull, t);
    case ShapeKind::plane:
      return plane_bounds(shape, t);
    case ShapeKind::mesh:
      return rotated_box(center(shape.mesh->tree.box), half_size(shape.mesh->tree.box), t);
    case ShapeKind::height_field:
      return rotated_box(center(shape.field->box), half_size(shape.field->box), t);
  }
  return {};
}

float inner_radius(const Shape& shape) {
  const float h = shape.extents.y;
  switch (shape.kind) {
    case ShapeKind::sphere:
    case ShapeKind::capsule:
      return shape.radius;
    case ShapeKind::box:
      return smallest(shape.extents) + shape.radius;
    case ShapeKind::cylinder:
      return min(shape.radius, h);
    case ShapeKind::cone: {
      // The plane of the mantle through the apex (0, h) and the rim (r, -h) is h r / slant from the origin, below h.
      return h * (shape.radius / std::sqrt(shape.radius * shape.radius + 4.0f * h * h));
    }
    case ShapeKind::hull:
      return shape.hull->inner_radius;
    case ShapeKind::plane:
      return kUnbounded;
    case ShapeKind::mesh:
    case ShapeKind::height_field:
      return 0.0f;
  }
  return 0.0f;
}

float outer_radius(const Shape& shape, Vec3 center) {
  const Vec3 offset = absolute(center);
  const float h = shape.extents.y;
  const float rim =
      std::sqrt(center.x * center.x + center.z * center.z) + shape.radius;  // to the far side of a disc
  switch (shape.kind) {
    case ShapeKind::sphere:
      return length(center) + shape.radius;
    case ShapeKind::box:
    case ShapeKind::capsule:
      return length(offset + shape.extents) + shape.radius;
    case ShapeKind::cylinder:
      return length(Vec3{rim, offset.y + h, 0.0f});
    case ShapeKind::cone: {
      return max(length(Vec3{center.x, center.y - h, center.z}), length(Vec3{rim, center.y + h, 0.0f}));
    }
    case ShapeKind::hull: {
      float farthest = 0.0f;
      for (const Vec3& vertex : shape.hull->vertices)
        farthest = max(farthest, length_squared(vertex - center));
      return std::sqrt(farthest);
    }
    case ShapeKind::plane:
      return kUnbounded;
    case ShapeKind::mesh:
      return farthest_corner(shape.mesh->tree.box, center);
    case ShapeKind::height_field:
      return farthest_corner(shape.field->box, center);
  }
  return 0.0f;
}

}  // namespace gyre
