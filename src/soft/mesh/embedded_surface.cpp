#include "soft/mesh/embedded_surface.h"

#include "geometry/distance/closest.h"

namespace gyre {
namespace {

// Cubes that list the tetrahedra whose centres lie in them.
class TetrahedronGrid {
 public:
  TetrahedronGrid(std::span<const Vec3> vertices, std::span<const std::uint32_t> tetrahedra, double cell);
  struct Nearest {
    std::uint32_t tetrahedron = 0;
    double distance = 1.0e300;
  };
  Nearest nearest(DVec3 p) const;
  DVec3 corner(std::uint32_t tetrahedron, int i) const {
    return DVec3(vertices_[tetrahedra_[4 * std::size_t(tetrahedron) + std::size_t(i)]]);
  }

 private:
  int coordinate(double value, int axis) const {
    return int(clamp((value - low_[axis]) / cell_, 0.0, double(cells_[axis] - 1)));
  }
  std::uint32_t cube_of(DVec3 p) const {
    return std::uint32_t(coordinate(p.x, 0) +
                         cells_[0] * (coordinate(p.y, 1) + cells_[1] * coordinate(p.z, 2)));
  }
  void search_cube(DVec3 p, std::uint32_t cube, Nearest& best) const;

  std::span<const Vec3> vertices_;
  std::span<const std::uint32_t> tetrahedra_;
  double cell_;
  DVec3 low_;
  int cells_[3] = {};
  double radius_ = 0.0;  // of the largest tetrahedron about its centre
  Array<DVec3> centers_;
  Array<std::uint32_t> first_, items_;
};

TetrahedronGrid::TetrahedronGrid(std::span<const Vec3> vertices, std::span<const std::uint32_t> tetrahedra,
                                 double cell)
    : vertices_(vertices), tetrahedra_(tetrahedra), cell_(cell) {
  Vec3 low = vertices[0], high = vertices[0];
  for (const Vec3& v : vertices) {
    low = min(low, v);
    high = max(high, v);
  }
  low_ = DVec3(low);
  const DVec3 size = DVec3(high) - low_;
  constexpr int kMaxCubes = 256;
  for (int axis = 0; axis < 3; ++axis) cells_[axis] = int(min(size[axis] / cell, double(kMaxCubes))) + 1;
  const std::uint32_t count = std::uint32_t(tetrahedra.size() / 4);
  centers_.resize(count);
  first_.resize(std::size_t(cells_[0]) * std::size_t(cells_[1]) * std::size_t(cells_[2]) + 1);
  for (std::uint32_t t = 0; t < count; ++t) {
    centers_[t] = 0.25 * (corner(t, 0) + corner(t, 1) + corner(t, 2) + corner(t, 3));
    for (int i = 0; i < 4; ++i) radius_ = max(radius_, length(corner(t, i) - centers_[t]));
    ++first_[cube_of(centers_[t]) + 1];
  }
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  items_.resize(count);
  Array<std::uint32_t> next = first_;
  for (std::uint32_t t = 0; t < count; ++t) items_[next[cube_of(centers_[t])]++] = t;
}

void TetrahedronGrid::search_cube(DVec3 p, std::uint32_t cube, Nearest& best) const {
  for (std::uint32_t i = first_[cube]; i < first_[cube + 1]; ++i) {
    const std::uint32_t t = items_[i];
    if (length(p - centers_[t]) - radius_ > best.distance) continue;
    const SimplexPoint on = closest_on_tetrahedron(p, corner(t, 0), corner(t, 1), corner(t, 2), corner(t, 3));
    const double distance = length(on.point - p);
    if (distance > best.distance || (distance == best.distance && t > best.tetrahedron)) continue;
    best = {t, distance};
  }
}

// Rings of cubes around that of the point, until no tetrahedron beyond can be nearer.
TetrahedronGrid::Nearest TetrahedronGrid::nearest(DVec3 p) const {
  const int at[3] = {coordinate(p.x, 0), coordinate(p.y, 1), coordinate(p.z, 2)};
  Nearest best;
  const int last = max(cells_[0], max(cells_[1], cells_[2]));
  for (int ring = 0; ring <= last; ++ring) {
    // The centre of a tetrahedron in this ring is at least that far from any point of the middle cube.
    if (best.distance < (ring - 1) * cell_ - radius_) break;
    for (int z = max(at[2] - ring, 0); z <= min(at[2] + ring, cells_[2] - 1); ++z) {
      for (int y = max(at[1] - ring, 0); y <= min(at[1] + ring, cells_[1] - 1); ++y) {
        const bool rim = z == at[2] - ring || z == at[2] + ring || y == at[1] - ring || y == at[1] + ring;
        const int stride = rim ? 1 : max(2 * ring, 1);
        for (int x = at[0] - ring; x <= at[0] + ring; x += stride) {
          if (x < 0 || x >= cells_[0]) continue;
          search_cube(p, std::uint32_t(x + cells_[0] * (y + cells_[1] * z)), best);
        }
      }
    }
  }
  return best;
}

void set_weights(EmbeddedPoint& out, DVec3 p, DVec3 a, DVec3 b, DVec3 c, DVec3 d) {
  const DVec3 u = b - a, v = c - a, w = d - a, r = p - a;
  const double whole = dot(u, cross(v, w));
  const double second = dot(r, cross(v, w)) / whole, third = dot(u, cross(r, w)) / whole,
               fourth = dot(u, cross(v, r)) / whole;
  out.weight[0] = float(1.0 - second - third - fourth);
  out.weight[1] = float(second);
  out.weight[2] = float(third);
  out.weight[3] = float(fourth);
}

}  // namespace

Array<EmbeddedPoint> embed_points(std::span<const Vec3> vertices, std::span<const std::uint32_t> tetrahedra,
                                  double cell, std::span<const Vec3> points, Array<double>& distance) {
  const TetrahedronGrid grid(vertices, tetrahedra, cell);
  Array<EmbeddedPoint> out;
  out.resize(points.size());
  distance.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const DVec3 p(points[i]);
    const TetrahedronGrid::Nearest nearest = grid.nearest(p);
    const std::uint32_t t = nearest.tetrahedron;
    for (std::size_t k = 0; k < 4; ++k) out[i].corner[k] = tetrahedra[4 * std::size_t(t) + k];
    set_weights(out[i], p, grid.corner(t, 0), grid.corner(t, 1), grid.corner(t, 2), grid.corner(t, 3));
    distance[i] = nearest.distance;
  }
  return out;
}

}  // namespace gyre
