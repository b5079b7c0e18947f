// Farthest points and facing features of the convex shapes. See support.h.
#include "geometry/shape/support.h"

#include "geometry/shape/hull.h"

namespace gyre {
namespace {

// Corners of the polygon that represents a round cap, without the lowest point.
constexpr int kRimVertices = 8;
constexpr float kHalfSqrt2 = 0.70710678f;  // half of the square root of two
constexpr float kRimX[kRimVertices] = {1, kHalfSqrt2, 0, -kHalfSqrt2, -1, -kHalfSqrt2, 0, kHalfSqrt2};
constexpr float kRimZ[kRimVertices] = {0, kHalfSqrt2, 1, kHalfSqrt2, 0, -kHalfSqrt2, -1, -kHalfSqrt2};
// rad, the lean below which the lowest point of a rim is noise. The eight corners are then at most 8 % of r * lean too
// high.
constexpr float kSteadyLean = 1.0e-3f;
// Cosine (7 degrees) above which the lowest point replaces a corner. That avoids slivers, and the corner keeps its
// name.
constexpr float kSameCorner = 0.9925f;

struct Radial {
  float length;  // of the component of a direction perpendicular to y
  float x, z;    // unit; (1, 0) if that component vanishes
};

Radial radial_component(Vec3 direction) {
  // Scaled by the larger component first, against under- and overflow.
  const float scale = max(absolute(direction.x), absolute(direction.z));
  if (!(scale > 1.0e-37f)) return {0.0f, 1.0f, 0.0f};
  const float x = direction.x / scale, z = direction.z / scale;
  const float n = std::sqrt(x * x + z * z);
  return {n * scale, x / n, z / n};
}

Vec3 support_box(const Shape& shape, Vec3 d) {
  const Vec3 e = shape.extents;
  return {d.x < 0.0f ? -e.x : e.x, d.y < 0.0f ? -e.y : e.y, d.z < 0.0f ? -e.z : e.z};
}

Vec3 support_cylinder(const Shape& shape, Vec3 d) {
  const Radial r = radial_component(d);
  return {shape.radius * r.x, d.y < 0.0f ? -shape.extents.y : shape.extents.y, shape.radius * r.z};
}

Vec3 support_cone(const Shape& shape, Vec3 d) {
  const Radial r = radial_component(d);
  const float h = shape.extents.y;
  // Apex against rim: h * d.y against -h * d.y + radius * d_r.
  if (2.0f * h * d.y > shape.radius * r.length) return {0.0f, h, 0.0f};
  return {shape.radius * r.x, -h, shape.radius * r.z};
}

void set_point(FacePolygon& out, Vec3 point, int id, Vec3 direction) {
  out.count = 1;
  out.vertices[0] = point;
  out.ids[0] = std::uint8_t(id);
  out.normal = normalized(direction);
}

void set_segment(FacePolygon& out, Vec3 a, int id_a, Vec3 b, int id_b, Vec3 normal) {
  out.count = 2;
  out.vertices[0] = a;
  out.vertices[1] = b;
  out.ids[0] = std::uint8_t(id_a);
  out.ids[1] = std::uint8_t(id_b);
  out.normal = normal;
}

// A segment along y faces a direction that leans less than 45 degrees from the plane perpendicular to it. Otherwise one
// of its ends does.
void capsule_face(const Shape& shape, Vec3 d, FacePolygon& out) {
  const Radial r = radial_component(d);
  const float h = shape.extents.y;
  if (absolute(d.y) > r.length || h == 0.0f) {
    out.feature = 1;
    return set_point(out, {0.0f, d.y < 0.0f ? -h : h, 0.0f}, d.y < 0.0f ? 0 : 1, d);
  }
  out.feature = 0;
  set_segment(out, {0, -h, 0}, 0, {0, h, 0}, 1, {r.x, 0, r.z});
}

// Inner boxes may be flat in one or more axes (rounding equal to a half extent). The face is then a segment or point.
void box_face(const Shape& shape, Vec3 d, FacePolygon& out) {
  const Vec3 size = absolute(d);
  const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
  const bool positive = d[axis] >= 0.0f;
  out.feature = std::uint32_t(2 * axis + (positive ? 1 : 0));
  const int u = axis == 2 ? 0 : axis + 1, v = u == 2 ? 0 : u + 1;  // axis, u, v is right-handed
  // The corners as signs along u and v, counter-clockwise around the positive axis.
  constexpr int kSigns[4][2] = {{1, 1}, {0, 1}, {0, 0}, {1, 0}};
  const bool flat_u = shape.extents[u] == 0.0f, flat_v = shape.extents[v] == 0.0f;
  out.count = 0;
  for (int i = 0; i < 4; ++i) {
    const int corner = positive ? i : 3 - i;
    const int sign_u = kSigns[corner][0], sign_v = kSigns[corner][1];
    if ((flat_u && sign_u == 0) || (flat_v && sign_v == 0)) continue;
    const int bits = (sign_u << u) | (sign_v << v) | ((positive ? 1 : 0) << axis);
    const Vec3 e = shape.extents;
    out.ids[out.count] = std::uint8_t(bits);
    out.vertices[out.count++] = {(bits & 1) ? e.x : -e.x, (bits & 2) ? e.y : -e.y, (bits & 4) ? e.z : -e.z};
  }
  const float sign = positive ? 1.0f : -1.0f;
  out.normal = {axis == 0 ? sign : 0.0f, axis == 1 ? sign : 0.0f, axis == 2 ? sign : 0.0f};
  // A feature without area has only the normals perpendicular to its segment (or any normal, at a point).
  if (out.count == 1) {
    out.normal = normalized(d);
  } else if (out.count == 2) {
    const Vec3 flat{out.vertices[0].x == out.vertices[1].x ? d.x : 0.0f,
                    out.vertices[0].y == out.vertices[1].y ? d.y : 0.0f,
                    out.vertices[0].z == out.vertices[1].z ? d.z : 0.0f};
    out.normal = normalized(flat, out.normal);
  }
}

// The disc of the shape's radius at height y, seen from above (up) or below. `first_id` names its first corner; the
// lowest point has the id after the eight.
void disc_face(const Shape& shape, float y, bool up, Vec3 d, int first_id, FacePolygon& out) {
  const Radial r = radial_component(d);
  // The position of the lowest point: -1 none, else between the corners `slot` and `slot + 1`, or in place of one of
  // them.
  int slot = -1, replaced = -1;
  if (r.length > kSteadyLean * absolute(d.y)) {
    float best = -2.0f;
    int nearest = 0;
    for (int i = 0; i < kRimVertices; ++i) {
      const float c = r.x * kRimX[i] + r.z * kRimZ[i];
      if (c > best) {
        best = c;
        nearest = i;
      }
    }
    if (best > kSameCorner) {
      replaced = nearest;
    } else {
      const bool after = kRimX[nearest] * r.z - kRimZ[nearest] * r.x > 0.0f;
      slot = after ? nearest : (nearest + kRimVertices - 1) % kRimVertices;
    }
  }
  out.count = 0;
  const auto add = [&](float x, float z, int id) {
    out.ids[out.count] = std::uint8_t(first_id + id);
    out.vertices[out.count++] = {shape.radius * x, y, shape.radius * z};
  };
  // From x towards z is clockwise seen from above.
  for (int k = 0; k < kRimVertices; ++k) {
    const int i = up ? kRimVertices - 1 - k : k;
    if (up && i == slot) add(r.x, r.z, kRimVertices);
    if (i == replaced) {
      add(r.x, r.z, i);
    } else {
      add(kRimX[i], kRimZ[i], i);
    }
    if (!up && i == slot) add(r.x, r.z, kRimVertices);
  }
  out.normal = {0.0f, up ? 1.0f : -1.0f, 0.0f};
}

void cylinder_face(const Shape& shape, Vec3 d, FacePolygon& out) {
  const Radial r = radial_component(d);
  const float h = shape.extents.y;
  if (absolute(d.y) >= r.length) {
    const bool up = d.y >= 0.0f;
    out.feature = up ? 1 : 0;
    return disc_face(shape, up ? h : -h, up, d, up ? 16 : 0, out);
  }
  // The line of the mantle has the same name at every angle, so that a rolling cylinder keeps its two contacts.
  out.feature = 2;
  const float x = shape.radius * r.x, z = shape.radius * r.z;
  set_segment(out, {x, -h, z}, 32, {x, h, z}, 33, {r.x, 0.0f, r.z});
}

void cone_face(const Shape& shape, Vec3 d, FacePolygon& out) {
  const Radial r = radial_component(d);
  const float h = shape.extents.y;
  const float slant = std::sqrt(shape.radius * shape.radius + 4.0f * h * h);
  const float n_r = 2.0f * h / slant,
              n_y = shape.radius / slant;  // the normal of the mantle: outward and upward component
  const float along_mantle = n_r * r.length + n_y * d.y;
  if (-d.y >= along_mantle) {
    out.feature = 0;
    return disc_face(shape, -h, false, d, 0, out);
  }
  // More than 45 degrees above the normal of the mantle: the apex alone.
  const float d_length = std::sqrt(r.length * r.length + d.y * d.y);
  if (d.y * n_r > r.length * n_y && along_mantle < kHalfSqrt2 * d_length) {
    out.feature = 2;
    return set_point(out, {0.0f, h, 0.0f}, 32, d);
  }
  out.feature = 1;
  set_segment(out, {shape.radius * r.x, -h, shape.radius * r.z}, 33, {0.0f, h, 0.0f}, 32,
              {n_r * r.x, n_y, n_r * r.z});
}

void hull_face(const Hull& hull, Vec3 d, FacePolygon& out) {
  const int face = support_face(hull, d);
  const std::uint32_t begin = hull.face_offsets[std::size_t(face)];
  const std::uint32_t count = hull.face_offsets[std::size_t(face) + 1] - begin;
  out.feature = std::uint32_t(face);
  out.normal = hull.planes[std::size_t(face)].normal;
  out.count = int(min(count, std::uint32_t(kMaxFaceVertices)));
  // A face with too many corners is thinned evenly. The reduced polygon lies inside it.
  for (int i = 0; i < out.count; ++i) {
    const std::uint32_t pick = std::uint32_t(i) * count / std::uint32_t(out.count);
    const std::uint8_t vertex = hull.face_vertices[begin + pick];
    out.ids[i] = vertex;
    out.vertices[i] = hull.vertices[vertex];
  }
}

}  // namespace

Vec3 support(const Shape& shape, Vec3 direction) {
  switch (shape.kind) {
    case ShapeKind::box:
      return support_box(shape, direction);
    case ShapeKind::capsule:
      return {0.0f, direction.y < 0.0f ? -shape.extents.y : shape.extents.y, 0.0f};
    case ShapeKind::cylinder:
      return support_cylinder(shape, direction);
    case ShapeKind::cone:
      return support_cone(shape, direction);
    case ShapeKind::hull:
      return shape.hull->vertices[std::size_t(support_vertex(*shape.hull, direction))];
    default:
      return {};
  }
}

int support_face(const Shape& shape, Vec3 direction, FacePolygon& out) {
  switch (shape.kind) {
    case ShapeKind::box:
      box_face(shape, direction, out);
      break;
    case ShapeKind::capsule:
      capsule_face(shape, direction, out);
      break;
    case ShapeKind::cylinder:
      cylinder_face(shape, direction, out);
      break;
    case ShapeKind::cone:
      cone_face(shape, direction, out);
      break;
    case ShapeKind::hull:
      hull_face(*shape.hull, direction, out);
      break;
    default:
      out.feature = 0;
      set_point(out, {}, 0, direction);
      break;
  }
  return out.count;
}

}  // namespace gyre
