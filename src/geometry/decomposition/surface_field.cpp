// Distances and winding numbers with one tree. See surface_field.h.
#include "geometry/decomposition/surface_field.h"

#include "geometry/distance/closest.h"
#include "math/trig.h"

namespace gyre {
namespace {

// Distance in radii of a group of triangles beyond which it is one dipole. The error there is at most a few hundredths.
constexpr double kDipoleRadii = 2.0;

// A sum of angles as one complex number and full turns, so that one arc tangent serves all of them.
class AngleSum {
 public:
  // Adds half the solid angle of the triangle, which is the argument of a complex number.
  void add_triangle(DVec3 a, DVec3 b, DVec3 c) {
    const double la = length(a), lb = length(b), lc = length(c);
    const double y = dot(a, cross(b, c));
    const double x = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    const double size = absolute(x) + absolute(y);
    if (!(size > 0.0)) return;  // on an edge or a corner
    const double re = (re_ * x - im_ * y) / size, im = (re_ * y + im_ * x) / size;
    // Two upper halves that make a lower one mean that the sum passed half a turn.
    if (im_ >= 0.0 && y >= 0.0 && im < 0.0) ++full_turns_;
    if (im_ < 0.0 && y < 0.0 && im >= 0.0) --full_turns_;
    // Products of numbers of size about one shrink slowly, so the sum is normalised.
    const double norm = absolute(re) + absolute(im);
    re_ = re / norm;
    im_ = im / norm;
  }
  double total() const { return atan2(im_, re_) + 2.0 * kPiDouble * double(full_turns_); }

 private:
  double re_ = 1.0, im_ = 0.0;
  int full_turns_ = 0;
};

DVec3 box_corner(const StaticTree::Node& node, int lane, bool high) {
  const auto& side = high ? node.high : node.low;
  return {double(side[0][lane]), double(side[1][lane]), double(side[2][lane])};
}

double box_distance_squared(const StaticTree::Node& node, int lane, DVec3 p) {
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double outside =
        max(max(double(node.low[axis][lane]) - p[axis], p[axis] - double(node.high[axis][lane])), 0.0);
    sum += outside * outside;
  }
  return sum;
}

}  // namespace

SurfaceField::SurfaceField(std::span<const DVec3> vertices, std::span<const std::uint32_t> indices)
    : vertices_(vertices), indices_(indices) {
  // Boxes are float and slightly wider, so that nothing is outside.
  constexpr float kSlack = 2.0e-7f;
  std::vector<Aabb> boxes(indices.size() / 3);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    Vec3 low = to_float(vertices[indices[3 * i]]), high = low;
    for (std::size_t k = 1; k < 3; ++k) {
      const Vec3 p = to_float(vertices[indices[3 * i + k]]);
      low = min(low, p);
      high = max(high, p);
    }
    boxes[i] = {low - Vec3{kSlack, kSlack, kSlack}, high + Vec3{kSlack, kSlack, kSlack}};
  }
  build_static_tree(boxes, tree_);
  dipoles_.resize(tree_.nodes.size() * StaticTree::kWidth);
  gather(0, 0xffffffffu);
}

// Sums the triangles below `child`, and stores the dipole in `slot` unless that is none.
SurfaceField::Sum SurfaceField::gather(std::uint32_t child, std::uint32_t slot) {
  Sum sum;
  if (is_leaf(child)) {
    for (std::uint32_t i = leaf_first(child); i < leaf_first(child) + leaf_count(child); ++i) {
      const DVec3 a = corner(i, 0), b = corner(i, 1), c = corner(i, 2);
      const DVec3 normal = 0.5 * cross(b - a, c - a);
      const double area = length(normal);
      sum.normal += normal;
      sum.area += area;
      sum.moment += area / 3.0 * (a + b + c);
    }
  } else {
    for (int lane = 0; lane < StaticTree::kWidth; ++lane) {
      const std::uint32_t below = tree_.nodes[child].child[lane];
      if (below == StaticTree::kNoChild) continue;
      const Sum child_sum = gather(below, child * StaticTree::kWidth + std::uint32_t(lane));
      sum.normal += child_sum.normal;
      sum.area += child_sum.area;
      sum.moment += child_sum.moment;
    }
  }
  if (slot == 0xffffffffu) return sum;
  const StaticTree::Node& node = tree_.nodes[slot / StaticTree::kWidth];
  const int lane = int(slot % StaticTree::kWidth);
  const DVec3 low = box_corner(node, lane, false), high = box_corner(node, lane, true);
  Dipole& dipole = dipoles_[slot];
  dipole.normal = sum.normal;
  dipole.center = sum.area > 0.0 ? sum.moment / sum.area : 0.5 * (low + high);
  const DVec3 to_low = dipole.center - low, to_high = high - dipole.center;
  dipole.radius = length(DVec3{max(to_low.x, to_high.x), max(to_low.y, to_high.y), max(to_low.z, to_high.z)});
  return sum;
}

double SurfaceField::winding(DVec3 p) const {
  std::uint32_t stack[StaticTree::kStackSize];
  int depth = 0;
  stack[depth++] = 0;
  double far = 0.0;
  AngleSum near;
  while (depth > 0) {
    const std::uint32_t at = stack[--depth];
    const StaticTree::Node& node = tree_.nodes[at];
    for (int lane = 0; lane < StaticTree::kWidth; ++lane) {
      const std::uint32_t below = node.child[lane];
      if (below == StaticTree::kNoChild) continue;
      const Dipole& dipole = dipoles_[at * StaticTree::kWidth + std::uint32_t(lane)];
      const DVec3 offset = dipole.center - p;
      const double square = dot(offset, offset);
      if (square > kDipoleRadii * kDipoleRadii * dipole.radius * dipole.radius) {
        far += dot(offset, dipole.normal) / (square * std::sqrt(square));
      } else if (is_leaf(below)) {
        for (std::uint32_t i = leaf_first(below); i < leaf_first(below) + leaf_count(below); ++i)
          near.add_triangle(corner(i, 0) - p, corner(i, 1) - p, corner(i, 2) - p);
      } else {
        stack[depth++] = below;
      }
    }
  }
  return (far + 2.0 * near.total()) / (4.0 * kPiDouble);
}

SurfaceField::Nearest SurfaceField::nearest(DVec3 p, double max_distance) const {
  struct Entry {
    std::uint32_t child;
    double square;
  };
  Entry stack[StaticTree::kStackSize];
  int depth = 0;
  stack[depth++] = {0, 0.0};
  double best = max_distance * max_distance;
  std::uint32_t triangle = kNoTriangle;
  while (depth > 0) {
    const Entry entry = stack[--depth];
    if (!(entry.square < best)) continue;
    if (is_leaf(entry.child)) {
      for (std::uint32_t i = leaf_first(entry.child); i < leaf_first(entry.child) + leaf_count(entry.child);
           ++i) {
        const SimplexPoint near = closest_on_triangle(p, corner(i, 0), corner(i, 1), corner(i, 2));
        const double square = length_squared(near.point - p);
        if (!(square < best)) continue;
        best = square;
        triangle = tree_.items[i];
      }
      continue;
    }
    const StaticTree::Node& node = tree_.nodes[entry.child];
    const int bottom = depth;
    for (int lane = 0; lane < StaticTree::kWidth; ++lane) {
      if (node.child[lane] == StaticTree::kNoChild) continue;
      const double square = box_distance_squared(node, lane, p);
      if (!(square < best)) continue;
      // The nearest on top. Equally near lanes keep their order.
      int slot = depth++;
      for (; slot > bottom && stack[slot - 1].square <= square; --slot) stack[slot] = stack[slot - 1];
      stack[slot] = {node.child[lane], square};
    }
  }
  return {std::sqrt(best), triangle};
}

SurfaceField::Crossing SurfaceField::first_crossing(DVec3 p, DVec3 q) const {
  // Edges belong to both of their triangles, so that no segment slips through between them.
  constexpr double kEdgeSlack = 1.0e-12;
  Crossing first{1.0, kNoTriangle};
  const Vec3 a = to_float(p), b = to_float(q);
  // Wider than the rounding of the ends; boxes of the tree are wider still.
  const Aabb box = grow(Aabb{min(a, b), max(a, b)}, 2.0e-7f);
  walk_overlaps(
      tree_, box, [](std::uint32_t, int) { return true; },
      [&](std::uint32_t begin, std::uint32_t count) {
        for (std::uint32_t i = begin; i < begin + count; ++i) {
          const DVec3 u = corner(i, 0) - p, v = corner(i, 1) - p, w = corner(i, 2) - p, along = q - p;
          const double weights[3] = {dot(along, cross(v, w)), dot(along, cross(w, u)),
                                     dot(along, cross(u, v))};
          const double sum = weights[0] + weights[1] + weights[2];
          const double slack = kEdgeSlack * length(along);
          const auto beyond = [&](double weight) { return sum > 0.0 ? weight < -slack : weight > slack; };
          if (sum == 0.0 || beyond(weights[0]) || beyond(weights[1]) || beyond(weights[2])) continue;
          const double fraction = dot(cross(v - u, w - u), u) / sum;
          if (!(fraction >= 0.0 && fraction <= 1.0)) continue;
          const bool sooner = fraction < first.fraction || first.triangle == kNoTriangle ||
                              (fraction == first.fraction && tree_.items[i] < first.triangle);
          if (sooner) first = {fraction, tree_.items[i]};
        }
      });
  return first;
}

}  // namespace gyre
