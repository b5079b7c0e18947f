#include "geometry/mass/submerged_round.h"

#include "geometry/mass/quadrature.h"
#include "math/trig.h"

namespace gyre {

namespace {

// Gauss-Legendre nodes and weights on [0, 1].
constexpr QuadratureNode kNodes[12] = {
    {0.0092196828766403748, 0.023587668193255914}, {0.047941371814762573, 0.053469662997659213},
    {0.11504866290284765, 0.080039164271673111},   {0.20634102285669129, 0.10158371336153296},
    {0.31608425050090988, 0.1167462682691774},     {0.43738329574426554, 0.12457352290670139},
    {0.56261670425573451, 0.12457352290670139},    {0.68391574949909006, 0.1167462682691774},
    {0.79365897714330869, 0.10158371336153296},    {0.88495133709715235, 0.080039164271673111},
    {0.95205862818523745, 0.053469662997659213},   {0.99078031712335968, 0.023587668193255914},
};

// A stretch of the axis on which the square of the radius is a polynomial of the distance from `middle`.
struct Section {
  double low, high;
  bool ball;  // radius^2 = size^2 - (y - middle)^2, else radius = size + slope (y - middle)
  double size, slope, middle;

  double radius_squared(double y) const {
    const double z = y - middle;
    return max(ball ? size * size - z * z : (size + slope * z) * (size + slope * z), 0.0);
  }
};

// Sums slices across the axis. A slice is a disc; its part with s < (level - along y) / across is submerged, where s is
// the coordinate along `side`, the direction across the axis in which the plane rises.
class SliceSum {
 public:
  SliceSum(DVec3 normal, double level) : level_(level), along_(normal.y) {
    // A level plane has no side. This lean is too small to matter.
    constexpr double kMinLean = 1.0e-8;
    const double lean = std::sqrt(normal.x * normal.x + normal.z * normal.z);
    across_ = max(lean, kMinLean);
    if (lean > 0.0) side_ = {normal.x / lean, 0.0, normal.z / lean};
  }

  void add(const Section& section) {
    double cuts[4];
    const int count = find_cuts(section, cuts);
    for (int i = 0; i + 1 < count; ++i) add_piece(section, cuts[i], cuts[i + 1]);
  }

  SubmergedPart result() const {
    SubmergedPart out;
    out.volume = volume_;
    if (volume_ > 0.0) out.center = (first_side_ / volume_) * side_ + DVec3{0.0, first_up_ / volume_, 0.0};
    if (!(area_ > 0.0)) return out;
    const double s = area_side_ / area_, y = area_up_ / area_;
    out.area = area_;
    out.area_center = s * side_ + DVec3{0.0, y, 0.0};
    // Along the chords of the cut, and in the plane of axis and side.
    const DVec3 chord{side_.z, 0.0, -side_.x};
    add_product(out.spread, chord_square_, chord);
    const double ss = side_side_ - area_ * s * s, sy = side_up_ - area_ * s * y, yy = up_up_ - area_ * y * y;
    out.spread.xx += ss * side_.x * side_.x;
    out.spread.zz += ss * side_.z * side_.z;
    out.spread.xz += ss * side_.x * side_.z;
    out.spread.yy += yy;
    out.spread.xy += sy * side_.x;
    out.spread.yz += sy * side_.z;
    return out;
  }

 private:
  double line(double y) const { return (level_ - along_ * y) / across_; }

  // The ends of the section and, between them in ascending order, the heights at which the line touches the rim of the
  // slice.
  int find_cuts(const Section& section, double (&cuts)[4]) const {
    int count = 0;
    cuts[count++] = section.low;
    double roots[2];
    if (section.ball) {
      const double d = level_ - along_ * section.middle;
      const double rest = section.size * section.size - d * d;
      const double half_chord = rest > 0.0 ? across_ * std::sqrt(rest) : 0.0;
      roots[0] = section.middle + d * along_ - half_chord;
      roots[1] = section.middle + d * along_ + half_chord;
    } else {
      const double size = section.size - section.slope * section.middle;  // at y = 0
      for (int i = 0; i < 2; ++i) {
        const double sign = i == 0 ? 1.0 : -1.0;
        const double rise = along_ + sign * across_ * section.slope;
        roots[i] = rise != 0.0 ? (level_ - sign * across_ * size) / rise : section.low;
      }
    }
    const double first = min(roots[0], roots[1]), second = max(roots[0], roots[1]);
    if (first > section.low && first < section.high) cuts[count++] = first;
    if (second > section.low && second < section.high && second != first) cuts[count++] = second;
    cuts[count++] = section.high;
    return count;
  }

  // A piece whose slices are all below, all above, or all cut.
  void add_piece(const Section& section, double low, double high) {
    const double middle = 0.5 * (low + high);
    const double t = line(middle), r2 = section.radius_squared(middle);
    const bool is_cut = t * t < r2;
    if (!is_cut && t <= 0.0) return;
    const double width = high - low;
    for (const QuadratureNode& node : kNodes) {
      if (!is_cut) {
        const double y = low + width * node.at;
        add_disc(y, section.radius_squared(y), width * node.weight);
      } else {
        // 3 u^2 - 2 u^3 makes a root at an end smooth.
        const double u = node.at;
        const double y = low + width * u * u * (3.0 - 2.0 * u);
        add_segment(y, section.radius_squared(y), 6.0 * u * (1.0 - u) * width * node.weight);
      }
    }
  }
  void add_disc(double y, double r2, double weight) {
    const double area = weight * kPiDouble * r2;
    volume_ += area;
    first_up_ += area * y;
  }
  void add_segment(double y, double r2, double weight) {
    const double r = std::sqrt(r2);
    const double t = clamp(line(y), -r, r);
    const double half = std::sqrt(max(r2 - t * t, 0.0));  // of the chord
    const double area = weight * (r2 * (r > 0.0 ? kPiDouble - acos(t / r) : 0.0) + t * half);
    volume_ += area;
    first_up_ += area * y;
    first_side_ -= weight * 2.0 / 3.0 * half * half * half;
    const double strip = 2.0 * half * weight / across_;  // of the cut
    area_ += strip;
    area_side_ += strip * t;
    area_up_ += strip * y;
    side_side_ += strip * t * t;
    side_up_ += strip * t * y;
    up_up_ += strip * y * y;
    chord_square_ += strip * half * half / 3.0;
  }

  double level_, along_, across_;
  DVec3 side_{1.0, 0.0, 0.0};
  double volume_ = 0.0, first_up_ = 0.0, first_side_ = 0.0;
  double area_ = 0.0, area_side_ = 0.0, area_up_ = 0.0;
  double side_side_ = 0.0, side_up_ = 0.0, up_up_ = 0.0, chord_square_ = 0.0;
};

}  // namespace

SubmergedPart submerged_sphere(double radius, DVec3 normal, double level) {
  const double t = clamp(level, -radius, radius);
  const double low = radius + t, rest = radius * radius - t * t;
  SubmergedPart out;
  out.volume = kPiDouble / 3.0 * low * low * (2.0 * radius - t);
  if (out.volume > 0.0) out.center = (-0.25 * kPiDouble * rest * rest / out.volume) * normal;
  out.area = kPiDouble * rest;
  out.area_center = t * normal;
  const double about = 0.25 * out.area * rest;
  out.spread.xx = out.spread.yy = out.spread.zz = about;
  add_product(out.spread, -about, normal);
  return out;
}

SubmergedPart submerged_round(const Shape& shape, DVec3 normal, double level) {
  const double r = double(shape.radius), h = double(shape.extents.y);
  SliceSum sum(normal, level);
  if (shape.kind == ShapeKind::cone) {
    sum.add({-h, h, false, 0.5 * r, -0.5 * r / h, 0.0});
    return sum.result();
  }
  if (h > 0.0) sum.add({-h, h, false, r, 0.0, 0.0});
  if (shape.kind == ShapeKind::capsule) {
    sum.add({-h - r, -h, true, r, 0.0, -h});
    sum.add({h, h + r, true, r, 0.0, h});
  }
  return sum.result();
}

}  // namespace gyre
