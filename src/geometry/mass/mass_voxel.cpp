// An estimate of mass properties by counting voxels. It needs no closed surface, and it checks the exact integrals.
//
// The centre of a voxel is inside if a ray from it crosses the surface an odd number of times. Rays run along all three
// axes and the majority decides, so that a hole in the surface spoils only the rays through it. A ray with an odd
// number of crossings in total does not vote.
// Source: F. Nooruddin, G. Turk, "Simplification and Repair of Polygonal Models Using Volumetric Techniques", 2003.
#include "base/container/sort.h"
#include "base/float_mode.h"
#include "geometry/mass/closed_surface.h"
#include "geometry/mass/mass.h"

#include <cstddef>
#include <vector>

namespace gyre {
namespace {

constexpr int kMinResolution = 2;
constexpr int kMaxResolution = 512;

struct VoxelGrid {
  DVec3 low;  // corner of the first voxel
  double size = 0.0;
  int count[3] = {};

  double center(int axis, int i) const { return low[axis] + (double(i) + 0.5) * size; }
  std::size_t index(const int (&i)[3]) const {
    return (std::size_t(i[2]) * std::size_t(count[1]) + std::size_t(i[1])) * std::size_t(count[0]) +
           std::size_t(i[0]);
  }
  std::size_t total() const { return std::size_t(count[0]) * std::size_t(count[1]) * std::size_t(count[2]); }
};

VoxelGrid make_grid(const TriangleSurface& surface, int resolution) {
  Vec3 low = surface.vertices[surface.indices[0]], high = low;
  for (const std::uint32_t i : surface.indices) {
    low = min(low, surface.vertices[i]);
    high = max(high, surface.vertices[i]);
  }
  const DVec3 extent = DVec3(high) - DVec3(low);
  VoxelGrid grid;
  grid.size = max(extent.x, max(extent.y, extent.z)) / double(resolution);
  for (int axis = 0; axis < 3; ++axis) {
    grid.count[axis] = grid.size > 0.0 ? max(1, int(std::ceil(extent[axis] / grid.size - 1.0e-9))) : 0;
  }
  const auto slack = [&](int axis) { return 0.5 * (double(grid.count[axis]) * grid.size - extent[axis]); };
  grid.low = DVec3(low) - DVec3(slack(0), slack(1), slack(2));
  return grid;
}

// A point of the plane perpendicular to the rays. Rays are offset from voxel centres by about a thousandth of a voxel,
// so that they meet no edge of an axis-aligned model.
struct PlanePoint {
  double u, v;
};
constexpr double kOffsetU = 1.3127e-3, kOffsetV = 0.9241e-3;  // of a voxel: lines pass beside edges of round coordinates

bool comes_before(PlanePoint a, PlanePoint b) { return a.u != b.u ? a.u < b.u : a.v < b.v; }

// The side of the edge on which the point lies. Both triangles of an edge compute the same number with opposite signs,
// so no ray passes between them.
double side_of(PlanePoint a, PlanePoint b, PlanePoint p) {
  const bool swap = comes_before(b, a);
  const PlanePoint from = swap ? b : a, to = swap ? a : b;
  const double side = (to.u - from.u) * (p.v - from.v) - (to.v - from.v) * (p.u - from.u);
  const double decided = side != 0.0 ? side : 1.0e-300;
  return swap ? -decided : decided;
}

struct Crossing {
  std::uint32_t column;
  double height;  // along the axis
};

class RayVotes {
 public:
  RayVotes(const TriangleSurface& surface, const VoxelGrid& grid, std::vector<signed char>& votes)
      : surface_(surface), grid_(grid), votes_(votes) {}
  void cast_along(int axis);

 private:
  void cross_triangle(std::uint32_t triangle);
  void vote(std::size_t begin, std::size_t end);

  const TriangleSurface& surface_;
  const VoxelGrid& grid_;
  std::vector<signed char>& votes_;
  std::vector<Crossing> crossings_;
  int axis_ = 0, u_ = 1, v_ = 2;
};

void RayVotes::cross_triangle(std::uint32_t triangle) {
  DVec3 corners[3];
  PlanePoint p[3];
  double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
  for (int i = 0; i < 3; ++i) {
    corners[i] = surface_.corner(triangle, i);
    p[i] = {corners[i][u_], corners[i][v_]};
    low[0] = min(low[0], p[i].u);
    low[1] = min(low[1], p[i].v);
    high[0] = max(high[0], p[i].u);
    high[1] = max(high[1], p[i].v);
  }
  const auto first = [&](int k, int axis) {
    return int(max(0.0, (low[k] - grid_.low[axis]) / grid_.size - 1.0));
  };
  const auto last = [&](int k, int axis) {
    return min(grid_.count[axis] - 1, int((high[k] - grid_.low[axis]) / grid_.size + 1.0));
  };
  for (int j = first(1, v_); j <= last(1, v_); ++j) {
    for (int i = first(0, u_); i <= last(0, u_); ++i) {
      const PlanePoint ray{grid_.center(u_, i) + kOffsetU * grid_.size,
                           grid_.center(v_, j) + kOffsetV * grid_.size};
      const double c = side_of(p[0], p[1], ray), a = side_of(p[1], p[2], ray), b = side_of(p[2], p[0], ray);
      if (!((a > 0.0 && b > 0.0 && c > 0.0) || (a < 0.0 && b < 0.0 && c < 0.0))) continue;
      const double height =
          (a * corners[0][axis_] + b * corners[1][axis_] + c * corners[2][axis_]) / (a + b + c);
      crossings_.push_back({std::uint32_t(j * grid_.count[u_] + i), height});
    }
  }
}

// The voxels of one ray. Its crossings are sorted.
void RayVotes::vote(std::size_t begin, std::size_t end) {
  if ((end - begin) % 2 != 0) {
    // No vote: undo the contribution of cast_along.
    for (int k = 0; k < grid_.count[axis_]; ++k) {
      int i[3];
      i[axis_] = k;
      i[u_] = int(crossings_[begin].column) % grid_.count[u_];
      i[v_] = int(crossings_[begin].column) / grid_.count[u_];
      ++votes_[grid_.index(i)];
    }
    return;
  }
  for (std::size_t pair = begin; pair < end; pair += 2) {
    const double from = (crossings_[pair].height - grid_.low[axis_]) / grid_.size - 0.5;
    const double to = (crossings_[pair + 1].height - grid_.low[axis_]) / grid_.size - 0.5;
    const int first = max(0, int(std::ceil(from))),
              last = min(grid_.count[axis_] - 1, int(std::ceil(to)) - 1);
    for (int k = first; k <= last; ++k) {
      int i[3];
      i[axis_] = k;
      i[u_] = int(crossings_[pair].column) % grid_.count[u_];
      i[v_] = int(crossings_[pair].column) / grid_.count[u_];
      votes_[grid_.index(i)] = static_cast<signed char>(votes_[grid_.index(i)] + 2);
    }
  }
}

// Each voxel gets -1 (outside), +1 (inside) or 0 (no vote) from this axis.
void RayVotes::cast_along(int axis) {
  axis_ = axis;
  u_ = (axis + 1) % 3;
  v_ = (axis + 2) % 3;
  for (signed char& vote : votes_) --vote;
  crossings_.clear();
  for (std::uint32_t triangle = 0; triangle < surface_.triangle_count(); ++triangle) cross_triangle(triangle);
  std::vector<Crossing> scratch(crossings_.size());
  merge_sort(std::span<Crossing>(crossings_), std::span<Crossing>(scratch),
             [](const Crossing& a, const Crossing& b) {
               return a.column != b.column ? a.column < b.column : a.height < b.height;
             });
  for (std::size_t begin = 0, end = 0; begin < crossings_.size(); begin = end) {
    while (end < crossings_.size() && crossings_[end].column == crossings_[begin].column) ++end;
    vote(begin, end);
  }
}

Solid sum_voxels(const VoxelGrid& grid, const std::vector<signed char>& votes, double density) {
  const double mass = density * grid.size * grid.size * grid.size;
  const DVec3 middle =
      grid.low + 0.5 * grid.size * DVec3(double(grid.count[0]), double(grid.count[1]), double(grid.count[2]));
  Solid solid;
  DVec3 first;
  int i[3];
  for (i[2] = 0; i[2] < grid.count[2]; ++i[2]) {
    for (i[1] = 0; i[1] < grid.count[1]; ++i[1]) {
      for (i[0] = 0; i[0] < grid.count[0]; ++i[0]) {
        if (votes[grid.index(i)] <= 0) continue;
        const DVec3 at = DVec3(grid.center(0, i[0]), grid.center(1, i[1]), grid.center(2, i[2])) - middle;
        solid.mass += mass;
        first += mass * at;
        add_product(solid.moments, mass, at);
      }
    }
  }
  if (!(solid.mass > 0.0)) return solid;
  const DVec3 shift = first / solid.mass;
  solid.center = middle + shift;
  add_product(solid.moments, -solid.mass, shift);
  const double own = solid.mass * grid.size * grid.size / 12.0;  // of the cubes themselves
  solid.moments.xx += own;
  solid.moments.yy += own;
  solid.moments.zz += own;
  return solid;
}

}  // namespace

Result<MassProperties> voxel_mass(std::span<const Vec3> vertices, std::span<const std::uint32_t> indices,
                                  float density, int resolution) {
  const FloatMode mode;
  if (const Error error = check_density(double(density), "kg/m^3"))
    return error;
  if (resolution < kMinResolution || resolution > kMaxResolution) {
    return make_error(ErrorCode::invalid_argument, "resolution is %d voxels; allowed are %d to %d",
                      resolution, kMinResolution, kMaxResolution);
  }
  const TriangleSurface surface{vertices, indices, {}, {}};
  if (const Error error = check_surface_data(surface)) return error;
  const VoxelGrid grid = make_grid(surface, resolution);
  std::vector<signed char> votes(grid.total(), 0);
  RayVotes rays(surface, grid, votes);
  for (int axis = 0; axis < 3 && grid.size > 0.0; ++axis) rays.cast_along(axis);
  const Solid solid = sum_voxels(grid, votes, double(density));
  if (!(solid.mass > 0.0)) {
    return make_error(
        ErrorCode::invalid_geometry,
        "mesh: none of %d x %d x %d voxels lies inside; allowed are surfaces that enclose a volume",
        grid.count[0], grid.count[1], grid.count[2]);
  }
  return checked_mass(solid, "mesh");
}

}  // namespace gyre
