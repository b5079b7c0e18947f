#include "geometry/mass/submerged.h"

#include "geometry/mass/submerged_round.h"
#include "geometry/shape/hull.h"

namespace gyre {

namespace {

// Sums the part of a polyhedron below a plane, face by face.
class PolyhedronCut {
 public:
  PolyhedronCut(DVec3 normal, double level) : normal_(normal), level_(level), apex_(level * normal) {}

  void begin_face() { has_first_ = has_exit_ = has_entry_ = false; }
  // Corners in order, counter-clockwise seen from outside, and the first one again at the end.
  void corner(DVec3 p) {
    const double height = dot(normal_, p) - level_;
    if (has_last_) edge(last_, last_height_, p, height);
    last_ = p;
    last_height_ = height;
    has_last_ = true;
  }
  void end_face() {
    has_last_ = false;
    // The cut lies on the other side of this edge, so it runs in the opposite direction.
    if (has_exit_ && has_entry_) cut_edge(entry_ - apex_, exit_ - apex_);
  }
  SubmergedPart result() const {
    SubmergedPart out;
    out.volume = max(volume_, 0.0);
    out.center = apex_ + (volume_ != 0.0 ? first_ / volume_ : DVec3());
    if (!(area_ > 0.0)) return out;
    const DVec3 middle = area_first_ / area_;
    out.area = area_;
    out.area_center = apex_ + middle;
    out.spread = area_second_;
    add_product(out.spread, -area_, middle);
    return out;
  }

 private:
  void edge(DVec3 a, double height_a, DVec3 b, double height_b) {
    const bool below_a = height_a <= 0.0, below_b = height_b <= 0.0;
    if (below_a != below_b) {
      const double share = height_a / (height_a - height_b);
      const DVec3 crossing = a + share * (b - a);
      add_corner(crossing);
      if (below_a) {
        exit_ = crossing;
        has_exit_ = true;
      } else {
        entry_ = crossing;
        has_entry_ = true;
      }
    }
    if (below_b) add_corner(b);
  }
  // Corners of the submerged part of the face, as a fan.
  void add_corner(DVec3 p) {
    const DVec3 at = p - apex_;
    if (!has_first_) {
      fan_ = at;
      has_first_ = true;
    } else {
      tetrahedron(fan_, previous_, at);
    }
    previous_ = at;
  }
  void tetrahedron(DVec3 a, DVec3 b, DVec3 c) {
    const double volume = dot(a, cross(b, c)) / 6.0;
    volume_ += volume;
    first_ += 0.25 * volume * (a + b + c);
  }
  void cut_edge(DVec3 a, DVec3 b) {
    const double area = 0.5 * dot(normal_, cross(a, b));
    area_ += area;
    area_first_ += area / 3.0 * (a + b);
    add_product(area_second_, area / 12.0, a);
    add_product(area_second_, area / 12.0, b);
    add_product(area_second_, area / 12.0, a + b);
  }

  DVec3 normal_;
  double level_;
  DVec3 apex_;
  DVec3 last_, fan_, previous_, exit_, entry_;
  double last_height_ = 0.0;
  bool has_last_ = false, has_first_ = false, has_exit_ = false, has_entry_ = false;
  double volume_ = 0.0, area_ = 0.0;
  DVec3 first_, area_first_;
  SecondMoments area_second_;
};

// Corners by the signs of their coordinates (bit 0: x positive ...), counter-clockwise seen from outside.
constexpr std::uint8_t kBoxFaceCorners[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                                {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

SubmergedPart submerged_box(DVec3 half, DVec3 normal, double level) {
  PolyhedronCut cut(normal, level);
  for (const auto& face : kBoxFaceCorners) {
    cut.begin_face();
    for (int i = 0; i <= 4; ++i) {
      const std::uint8_t corner = face[i % 4];
      cut.corner({(corner & 1) != 0 ? half.x : -half.x, (corner & 2) != 0 ? half.y : -half.y,
                  (corner & 4) != 0 ? half.z : -half.z});
    }
    cut.end_face();
  }
  return cut.result();
}

SubmergedPart submerged_hull(const Hull& hull, DVec3 normal, double level) {
  PolyhedronCut cut(normal, level);
  for (int face = 0; face < hull.face_count(); ++face) {
    const std::uint32_t first = hull.face_offsets[std::size_t(face)],
                        last = hull.face_offsets[std::size_t(face) + 1];
    cut.begin_face();
    for (std::uint32_t i = first; i < last; ++i) cut.corner(DVec3(hull.vertices[hull.face_vertices[i]]));
    cut.corner(DVec3(hull.vertices[hull.face_vertices[first]]));
    cut.end_face();
  }
  return cut.result();
}

DVec3 outer_half(const Shape& box) {
  const DVec3 r{double(box.radius), double(box.radius), double(box.radius)};
  return DVec3(box.extents) + r;
}

// The volume of a rounded box relative to the sharp one: a core, slabs on its faces, quarter rods on its edges, a ball.
double rounded_share(const Shape& box) {
  const double r = double(box.radius);
  if (r == 0.0) return 1.0;
  const DVec3 c = 2.0 * DVec3(box.extents), sharp = 2.0 * outer_half(box);
  const double volume = c.x * c.y * c.z + 2.0 * r * (c.x * c.y + c.y * c.z + c.z * c.x) +
                        kPiDouble * r * r * (c.x + c.y + c.z) + 4.0 / 3.0 * kPiDouble * r * r * r;
  return volume / (sharp.x * sharp.y * sharp.z);
}

}  // namespace

SubmergedPart submerged_part(const Shape& shape, DVec3 normal, double level) {
  switch (shape.kind) {
    case ShapeKind::sphere:
      return submerged_sphere(double(shape.radius), normal, level);
    case ShapeKind::box: {
      SubmergedPart part = submerged_box(outer_half(shape), normal, level);
      part.volume *= rounded_share(shape);
      return part;
    }
    case ShapeKind::capsule:
    case ShapeKind::cylinder:
    case ShapeKind::cone:
      return submerged_round(shape, normal, level);
    case ShapeKind::hull:
      return submerged_hull(*shape.hull, normal, level);
    default:
      return {};
  }
}

double volume_of(const Shape& shape) {
  const double r = double(shape.radius), h = double(shape.extents.y);
  switch (shape.kind) {
    case ShapeKind::sphere:
      return 4.0 / 3.0 * kPiDouble * r * r * r;
    case ShapeKind::box: {
      const DVec3 half = outer_half(shape);
      return 8.0 * half.x * half.y * half.z * rounded_share(shape);
    }
    case ShapeKind::capsule:
      return kPiDouble * r * r * (2.0 * h + 4.0 / 3.0 * r);
    case ShapeKind::cylinder:
      return 2.0 * kPiDouble * r * r * h;
    case ShapeKind::cone:
      return 2.0 / 3.0 * kPiDouble * r * r * h;
    case ShapeKind::hull:
      // All of the hull lies below a plane through its highest point.
      return submerged_hull(*shape.hull, {0, 1, 0}, double(shape.hull->box.high.y)).volume;
    default:
      return 0.0;
  }
}

}  // namespace gyre
