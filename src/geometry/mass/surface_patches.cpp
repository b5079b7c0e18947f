#include "geometry/mass/surface_patches.h"

#include "geometry/mass/quadrature.h"
#include "geometry/shape/hull.h"
#include "math/trig.h"

namespace gyre {

namespace {

using PatchFn = FunctionRef<void(const SurfacePatch&)>;

// ------------------------------------------------------------------------------------------------------------ polyhedra

constexpr int kMaxCorners = 256;  // corners of a face, and one more for each edge that the plane cuts

// Corners are not initialised, because most faces have four.
struct PolygonCorner {
  double x, y, z;

  operator DVec3() const { return {x, y, z}; }
};
struct Polygon {
  Polygon() : count(0) {}

  void add(DVec3 p) { corners[count++] = {p.x, p.y, p.z}; }

  int count;
  PolygonCorner corners[kMaxCorners + 2];
};

// Sutherland-Hodgman clipping, for one plane.
void cut_polygon(const Polygon& in, DVec3 normal, double level, Polygon& out) {
  out.count = 0;
  for (int i = 0; i < in.count; ++i) {
    const DVec3 a = in.corners[i], b = in.corners[i + 1 < in.count ? i + 1 : 0];
    const double above_a = dot(normal, a) - level, above_b = dot(normal, b) - level;
    if (above_a <= 0.0) out.add(a);
    if ((above_a <= 0.0) != (above_b <= 0.0)) out.add(a + (above_a / (above_a - above_b)) * (b - a));
  }
}

void emit_triangle(DVec3 a, DVec3 b, DVec3 c, DVec3 normal, PatchFn fn) {
  const double area = 0.5 * dot(normal, cross(b - a, c - a));
  if (!(area > 0.0)) return;
  const DVec3 middle = (a + b + c) / 3.0;
  for (const DVec3& corner : {a, b, c}) fn({middle + 0.5 * (corner - middle), normal, area / 3.0});
}

void emit_polygon(const Polygon& polygon, DVec3 normal, PatchFn fn) {
  if (polygon.count < 3) return;
  DVec3 middle;
  for (int i = 0; i < polygon.count; ++i) middle += DVec3(polygon.corners[i]);
  middle = middle / double(polygon.count);
  for (int i = 0; i < polygon.count; ++i) {
    emit_triangle(middle, polygon.corners[i], polygon.corners[i + 1 < polygon.count ? i + 1 : 0], normal, fn);
  }
}

// Emits the part of a face below the plane.
void emit_face(const Polygon& face, DVec3 face_normal, DVec3 normal, double level, PatchFn fn) {
  Polygon submerged;
  cut_polygon(face, normal, level, submerged);
  emit_polygon(submerged, face_normal, fn);
}

DVec3 box_half(const Shape& box) {
  const double r = double(box.radius);
  return DVec3(box.extents) + DVec3{r, r, r};
}

void box_patches(const Shape& box, DVec3 normal, double level, PatchFn fn) {
  const DVec3 half = box_half(box);
  const DVec3 axes[3] = {{half.x, 0, 0}, {0, half.y, 0}, {0, 0, half.z}};
  for (int face = 0; face < 6; ++face) {
    const double sign = face % 2 == 0 ? 1.0 : -1.0;
    const DVec3 out = sign * axes[face / 2];
    // Counter-clockwise seen from outside.
    const DVec3 u = axes[(face / 2 + 1) % 3], v = sign * axes[(face / 2 + 2) % 3];
    Polygon polygon;
    for (const DVec3& corner : {out + u + v, out - u + v, out - u - v, out + u - v}) polygon.add(corner);
    emit_face(polygon, out / length(out), normal, level, fn);
  }
}

void hull_patches(const Hull& hull, DVec3 normal, double level, PatchFn fn) {
  for (int face = 0; face < hull.face_count(); ++face) {
    Polygon polygon;
    const std::size_t f = std::size_t(face);
    for (std::uint32_t i = hull.face_offsets[f]; i < hull.face_offsets[f + 1]; ++i) {
      polygon.add(DVec3(hull.vertices[hull.face_vertices[i]]));
    }
    emit_face(polygon, DVec3(hull.planes[f].normal), normal, level, fn);
  }
}

// --------------------------------------------------------------------------------------------------------- round shapes

constexpr int kAround = 16;
// cos and sin of (i + 1/2) / 16 of a full rotation.
constexpr double kCos[4] = {0.98078528040323043, 0.83146961230254524, 0.55557023301960218,
                            0.19509032201612825};

DVec3 around(int i) {
  const int quarter = i / 4, step = i % 4;
  const double c = kCos[step], s = kCos[3 - step];
  switch (quarter) {
    case 0:
      return {c, 0.0, s};
    case 1:
      return {-s, 0.0, c};
    case 2:
      return {-c, 0.0, -s};
    default:
      return {s, 0.0, -c};
  }
}

// Gauss-Legendre on [0, 1].
constexpr QuadratureNode kFour[4] = {{0.069431844202973713, 0.17392742256872693},
                                     {0.33000947820757187, 0.32607257743127307},
                                     {0.66999052179242813, 0.32607257743127307},
                                     {0.93056815579702629, 0.17392742256872693}};

// Rings of patches, each weighted by its fraction below the plane.
class Rings {
 public:
  Rings(DVec3 normal, double level, PatchFn fn) : normal_(normal), level_(level), fn_(fn) {}

  // A ring at height y of the given radius. The normal is (out, up); `area` is that of the whole ring.
  void emit_ring(double y, double radius, double out, double up, double area) const {
    const double half = 0.5 * std::sqrt(area / kAround);
    for (int i = 0; i < kAround; ++i) {
      const DVec3 outward = around(i);
      const DVec3 position = radius * outward + DVec3{0.0, y, 0.0};
      const double share = clamp(0.5 + (level_ - dot(normal_, position)) / (2.0 * half), 0.0, 1.0);
      if (share > 0.0) fn_({position, out * outward + DVec3{0.0, up, 0.0}, share * area / kAround});
    }
  }
  // A flat lid: two rings of equal area.
  void emit_lid(double y, double radius, double up) const {
    const double area = kPiDouble * radius * radius;
    // Centroid radii of the inner half of a disc and of the ring around it.
    emit_ring(y, 0.47140452079103168 * radius, 0.0, up, 0.5 * area);
    emit_ring(y, 0.86189508425267470 * radius, 0.0, up, 0.5 * area);
  }
  // Half a ball or a whole one: equal heights have equal areas (Archimedes).
  void emit_ball(double middle, double radius, double low, double high) const {
    for (const QuadratureNode& node : kFour) {
      const double z = low + node.at * (high - low);
      const double across = std::sqrt(radius * radius - z * z);
      emit_ring(middle + z, across, across / radius, z / radius,
                2.0 * kPiDouble * radius * node.weight * (high - low));
    }
  }
  // The side of a cone or cylinder from (low, radius_low) to (high, radius_high).
  void emit_side(double low, double radius_low, double high, double radius_high) const {
    const double rise = high - low, narrow = radius_low - radius_high;
    const double slant = std::sqrt(rise * rise + narrow * narrow);
    for (const QuadratureNode& node : kFour) {
      const double radius = radius_low - node.at * narrow;
      emit_ring(low + node.at * rise, radius, rise / slant, narrow / slant,
                2.0 * kPiDouble * radius * slant * node.weight);
    }
  }

 private:
  DVec3 normal_;
  double level_;
  PatchFn fn_;
};

void round_patches(const Shape& shape, const Rings& rings) {
  const double r = double(shape.radius), h = double(shape.extents.y);
  switch (shape.kind) {
    case ShapeKind::sphere:
      rings.emit_ball(0.0, r, -r, r);
      return;
    case ShapeKind::capsule:
      if (h > 0.0) rings.emit_side(-h, r, h, r);
      rings.emit_ball(-h, r, -r, 0.0);
      rings.emit_ball(h, r, 0.0, r);
      return;
    case ShapeKind::cylinder:
      rings.emit_side(-h, r, h, r);
      rings.emit_lid(-h, r, -1.0);
      rings.emit_lid(h, r, 1.0);
      return;
    case ShapeKind::cone:
      rings.emit_side(-h, r, h, 0.0);
      rings.emit_lid(-h, r, -1.0);
      return;
    default:
      return;
  }
}

// The shadow of a cone. Its base is an ellipse, and its apex lies on the line of the minor axis.
double cone_shadow(double radius, double height, double along, double across) {
  const double small = radius * along, apex = height * across;
  if (apex <= small) return kPiDouble * radius * small;
  return radius * (small * (kPiDouble - acos(small / apex)) + std::sqrt(apex * apex - small * small));
}

}  // namespace

void for_each_patch(const Shape& shape, DVec3 normal, double level,
                    FunctionRef<void(const SurfacePatch&)> fn) {
  switch (shape.kind) {
    case ShapeKind::box:
      return box_patches(shape, normal, level, fn);
    case ShapeKind::hull:
      return hull_patches(*shape.hull, normal, level, fn);
    default:
      return round_patches(shape, Rings(normal, level, fn));
  }
}

double projected_area(const Shape& shape, DVec3 direction) {
  const double r = double(shape.radius), h = double(shape.extents.y);
  const double along = absolute(direction.y), across = std::sqrt(max(1.0 - along * along, 0.0));
  switch (shape.kind) {
    case ShapeKind::sphere:
      return kPiDouble * r * r;
    case ShapeKind::capsule:
      return kPiDouble * r * r + 4.0 * r * h * across;
    case ShapeKind::cylinder:
      return kPiDouble * r * r * along + 4.0 * r * h * across;
    case ShapeKind::cone:
      return cone_shadow(r, 2.0 * h, along, across);
    case ShapeKind::box: {
      const DVec3 half = box_half(shape);
      return 4.0 * (half.y * half.z * absolute(direction.x) + half.x * half.z * along +
                    half.x * half.y * absolute(direction.z));
    }
    case ShapeKind::hull: {
      double area = 0.0;
      for_each_patch(shape, direction, double(kUnbounded), [&](const SurfacePatch& patch) {
        area += max(-dot(patch.normal, direction), 0.0) * patch.area;
      });
      return area;
    }
    default:
      return 0.0;
  }
}

}  // namespace gyre
