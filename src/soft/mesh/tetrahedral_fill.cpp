#include "soft/mesh/tetrahedral_fill.h"

#include "base/container/disjoint_sets.h"
#include "base/float_mode.h"
#include "geometry/mass/closed_surface.h"
#include "geometry/mass/mass.h"
#include "geometry/shape/mesh_weld.h"
#include "soft/mesh/cut_lattice.h"
#include "soft/mesh/lattice_pieces.h"
#include "soft/mesh/lattice_stencils.h"

#include <utility>
#include <vector>

namespace gyre {
namespace {

// Twice the area of a triangle, as a share of the square of its longest edge, below which rounding could have made it.
constexpr double kNoArea = 1.0e-7;

// Loose pieces below this share of the volume are left out.
constexpr double kDroppedShare = 0.02;

// A surface that has passed all checks.
struct CheckedSurface {
  std::span<const Vec3> vertices;
  std::vector<std::uint32_t> triangles;  // wound outwards
  std::vector<std::uint32_t> component;  // of each vertex: the lowest vertex that edges join to it
  std::vector<DVec3> scaled;             // vertices in a box of longest side 1 that begins at zero
  DVec3 low, size;                       // m, the box
  double side = 0.0;                     // m, its longest
  double volume = 0.0;                   // m^3
  Array<double> component_volume;        // m^3, by component; negative for holes
  int solid_components = 0;              // components that are no holes
  double smallest_component = 0.0;       // m^3

  DVec3 corner(std::size_t triangle, std::size_t i) const {
    return DVec3(vertices[triangles[3 * triangle + i]]);
  }
};

Error check_areas(const TriangleSurface& surface) {
  for (std::uint32_t t = 0; t < surface.triangle_count(); ++t) {
    const DVec3 a = surface.corner(t, 0), b = surface.corner(t, 1), c = surface.corner(t, 2);
    const double longest = max(length_squared(b - a), max(length_squared(c - b), length_squared(a - c)));
    if (length(cross(b - a, c - a)) > kNoArea * longest) continue;
    return make_error(
        ErrorCode::invalid_geometry,
        "mesh: triangle %u (vertices %u, %u, %u) has no area; leave it out and join the triangles "
        "around it",
        t, surface.indices[3 * t], surface.indices[3 * t + 1], surface.indices[3 * t + 2]);
  }
  return {};
}

double signed_volume(const TriangleSurface& surface, DVec3 middle) {
  TetrahedronSum sum(middle);
  for (std::uint32_t t = 0; t < surface.triangle_count(); ++t)
    sum.add(surface.corner(t, 0), surface.corner(t, 1), surface.corner(t, 2));
  return sum.volume();
}

void set_box(CheckedSurface& out) {
  Vec3 low = out.vertices[out.triangles[0]], high = low;
  for (const std::uint32_t i : out.triangles) {
    low = min(low, out.vertices[i]);
    high = max(high, out.vertices[i]);
  }
  out.low = DVec3(low);
  out.size = DVec3(high) - out.low;
  out.side = max(out.size.x, max(out.size.y, out.size.z));
}

void find_components(const std::vector<std::uint32_t>& welded, CheckedSurface& out) {
  out.component.resize(out.vertices.size());
  const DisjointSets sets(out.component);
  for (std::uint32_t i = 0; i < out.component.size(); ++i) sets.unite(i, welded[i]);
  for (std::size_t i = 0; i < out.triangles.size(); i += 3) {
    sets.unite(out.triangles[i], out.triangles[i + 1]);
    sets.unite(out.triangles[i], out.triangles[i + 2]);
  }
  sets.flatten();
  out.component_volume.resize(out.vertices.size());
  const DVec3 middle = out.low + 0.5 * out.size;
  for (std::size_t t = 0; t < out.triangles.size() / 3; ++t) {
    const DVec3 a = out.corner(t, 0) - middle, b = out.corner(t, 1) - middle, c = out.corner(t, 2) - middle;
    out.component_volume[out.component[out.triangles[3 * t]]] += dot(a, cross(b, c)) / 6.0;
  }
  out.smallest_component = out.volume;
  for (const double volume : out.component_volume) {
    if (!(volume > 0.0)) continue;
    ++out.solid_components;
    out.smallest_component = min(out.smallest_component, volume);
  }
}

Error check_surface(std::span<const Vec3> vertices, std::span<const std::uint32_t> triangles,
                    CheckedSurface& out) {
  TriangleSurface surface{vertices, triangles, {}, {}};
  if (const Error error = check_surface_data(surface)) return error;
  if (const Error error = check_areas(surface)) return error;
  const std::vector<std::uint32_t> welded = weld_vertices(vertices, triangles);
  surface.welded = welded;
  if (const Error error = check_edges(surface)) return error;
  out.vertices = vertices;
  out.triangles.assign(triangles.begin(), triangles.end());
  set_box(out);
  if (signed_volume(surface, out.low + 0.5 * out.size) < 0.0) {
    for (std::size_t i = 0; i < out.triangles.size(); i += 3)
      std::swap(out.triangles[i + 1], out.triangles[i + 2]);
  }
  const Result<Solid> solid = closed_mesh_solid(vertices, out.triangles, {}, 1.0);
  if (!solid) return solid.error();
  out.volume = solid->mass;
  find_components(welded, out);
  for (const Vec3& v : vertices) out.scaled.push_back((DVec3(v) - out.low) / out.side);
  return {};
}

// The outcome of a resolution, before it is judged.
struct Filling {
  TetrahedralMesh mesh;
  Array<bool> filled;  // by component
  int pieces = 0;      // that share no face
  bool too_many = false;
  bool flat = false;  // rounding to float left a tetrahedron without volume
};

// Collects the tetrahedra of a lattice.
class LatticeFill {
 public:
  LatticeFill(const CheckedSurface& surface, const CutLattice& lattice, Filling& out)
      : surface_(surface), lattice_(lattice), out_(out) {
    point_vertex_.assign(lattice.point_count(), kNone);
    cut_vertex_.assign(lattice.cut_count(), kNone);
    out_.filled.assign(surface.vertices.size(), false);
  }
  void run();

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  bool has_inner_point(LatticePoint center) const;
  void add_face(LatticePoint center, int axis);
  void add_lattice_tetrahedron(const LatticePoint (&corner)[4]);
  void add_tetrahedron(const std::uint32_t (&corner)[4]);
  std::uint32_t vertex_of(LatticePoint p);
  std::uint32_t vertex_of_cut(std::uint32_t index);
  std::uint32_t add_vertex(DVec3 scaled) {
    out_.mesh.vertices.push_back(to_float(surface_.low + surface_.side * scaled));
    return std::uint32_t(out_.mesh.vertices.size() - 1);
  }
  void mark_component(std::uint32_t triangle) {
    out_.filled[surface_.component[surface_.triangles[3 * std::size_t(triangle)]]] = true;
  }

  const CheckedSurface& surface_;
  const CutLattice& lattice_;
  Filling& out_;
  Array<std::uint32_t> point_vertex_, cut_vertex_;
};

std::uint32_t LatticeFill::vertex_of(LatticePoint p) {
  const std::uint32_t id = lattice_.id(p);
  std::uint32_t& vertex = point_vertex_[id];
  if (vertex != kNone) return vertex;
  if (lattice_.side(id) == 0) mark_component(lattice_.triangle_of(id));
  vertex = add_vertex(lattice_.position(p));
  return vertex;
}

std::uint32_t LatticeFill::vertex_of_cut(std::uint32_t index) {
  std::uint32_t& vertex = cut_vertex_[index];
  if (vertex != kNone) return vertex;
  mark_component(lattice_.cut(index).triangle);
  vertex = add_vertex(lattice_.cut(index).position);
  return vertex;
}

void LatticeFill::add_tetrahedron(const std::uint32_t (&corner)[4]) {
  TetrahedralMesh& mesh = out_.mesh;
  if (mesh.tetrahedra.size() / 4 >= kMaxFillTetrahedra) {
    out_.too_many = true;
    return;
  }
  const DVec3 a(mesh.vertices[corner[0]]), b(mesh.vertices[corner[1]]), c(mesh.vertices[corner[2]]),
      d(mesh.vertices[corner[3]]);
  const double volume = dot(b - a, cross(c - a, d - a)) / 6.0;
  out_.flat |= !(volume > 0.0);
  mesh.filled_volume += volume;
  mesh.tetrahedra.append(corner);
}

void LatticeFill::add_lattice_tetrahedron(const LatticePoint (&corner)[4]) {
  std::int8_t side[4];
  bool any_inside = false, even[4];
  for (int i = 0; i < 4; ++i) {
    const LatticePoint& p = corner[i];
    side[i] = lattice_.side(lattice_.id(p));
    any_inside |= side[i] > 0;
    even[i] = (p.x / 2 + p.y / 2 + p.z / 2) % 2 == 0;
  }
  if (!any_inside) return;
  const StencilTetrahedra pieces = cut_lattice_tetrahedron(side, even);
  for (int piece = 0; piece < pieces.count; ++piece) {
    std::uint32_t vertex[4];
    for (int i = 0; i < 4; ++i) {
      const int from = pieces.node[piece][i] / 4, to = pieces.node[piece][i] % 4;
      vertex[i] = from == to ? vertex_of(corner[from])
                             : vertex_of_cut(lattice_.cut_between(corner[from], corner[to]));
    }
    add_tetrahedron(vertex);
  }
}

// True if the centre or a corner of the cell is inside.
bool LatticeFill::has_inner_point(LatticePoint center) const {
  if (lattice_.side(lattice_.id(center)) > 0) return true;
  for (int i = 0; i < 8; ++i) {
    const LatticePoint p{center.x + 2 * (i & 1) - 1, center.y + (i & 2) - 1, center.z + (i & 4) / 2 - 1};
    if (lattice_.side(lattice_.id(p)) > 0) return true;
  }
  return false;
}

// The four tetrahedra around the edge from a cell's centre to the next centre along the axis.
void LatticeFill::add_face(LatticePoint center, int axis) {
  const auto along = [](LatticePoint p, int on, int by) {
    return LatticePoint{p.x + (on == 0 ? by : 0), p.y + (on == 1 ? by : 0), p.z + (on == 2 ? by : 0)};
  };
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const LatticePoint next = along(center, axis, 2), middle = along(center, axis, 1);
  constexpr int kAround[5][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
  for (int i = 0; i < 4 && !out_.too_many; ++i) {
    const LatticePoint here = along(along(middle, u, kAround[i][0]), v, kAround[i][1]);
    const LatticePoint there = along(along(middle, u, kAround[i + 1][0]), v, kAround[i + 1][1]);
    add_lattice_tetrahedron({center, next, here, there});
  }
}

void LatticeFill::run() {
  const int last[3] = {2 * lattice_.cells(0) - 1, 2 * lattice_.cells(1) - 1, 2 * lattice_.cells(2) - 1};
  // A tetrahedron lies around the edge between two cells, and its other corners are corners of both.
  const std::size_t columns = std::size_t(lattice_.cells(0)), rows = std::size_t(lattice_.cells(1));
  const auto cell_at = [&](int x, int y, int z) {
    return std::size_t(x / 2) + columns * (std::size_t(y / 2) + rows * std::size_t(z / 2));
  };
  Array<bool> inner;
  inner.resize(columns * rows * std::size_t(lattice_.cells(2)));
  for (int z = 1; z <= last[2]; z += 2) {
    for (int y = 1; y <= last[1]; y += 2) {
      for (int x = 1; x <= last[0]; x += 2) inner[cell_at(x, y, z)] = has_inner_point({x, y, z});
    }
  }
  for (int z = 1; z <= last[2] && !out_.too_many; z += 2) {
    for (int y = 1; y <= last[1]; y += 2) {
      for (int x = 1; x <= last[0]; x += 2) {
        const bool here = inner[cell_at(x, y, z)];
        const LatticePoint center{x, y, z};
        if (x < last[0] && (here || inner[cell_at(x + 2, y, z)])) add_face(center, 0);
        if (y < last[1] && (here || inner[cell_at(x, y + 2, z)])) add_face(center, 1);
        if (z < last[2] && (here || inner[cell_at(x, y, z + 2)])) add_face(center, 2);
      }
    }
  }
}

// About 12 a cell, and some more at the surface.
double expected_tetrahedra(const CheckedSurface& surface, int resolution) {
  const double cell = surface.side / resolution;
  return 12.0 * surface.volume / (cell * cell * cell);
}

int largest_resolution(const CheckedSurface& surface) {
  int resolution = kMinFillResolution;
  while (resolution < kMaxFillResolution &&
         expected_tetrahedra(surface, resolution + 1) < 0.9 * double(kMaxFillTetrahedra))
    ++resolution;
  return resolution;
}

// The first triangle of a component that no tetrahedron touches; or none.
std::uint32_t find_unfilled(const CheckedSurface& surface, const Filling& filling) {
  for (std::size_t t = 0; t < surface.triangles.size() / 3; ++t) {
    const std::uint32_t component = surface.component[surface.triangles[3 * t]];
    if (surface.component_volume[component] > 0.0 && !filling.filled[component]) return std::uint32_t(t);
  }
  return SurfaceField::kNoTriangle;
}

// A reason to refuse what a resolution gave. `detail` is the number of a triangle or vertex, or the share of the volume in percent.
enum class FillFault { none, too_many, flat, empty_component, pieces, volume, thin_feature };
struct FillCheck {
  FillFault fault = FillFault::none;
  double detail = 0.0;
};

FillCheck check_filling(const CheckedSurface& surface, Filling& filling, int resolution) {
  if (filling.too_many) return {FillFault::too_many, 0.0};
  const std::uint32_t unfilled = find_unfilled(surface, filling);
  if (unfilled != SurfaceField::kNoTriangle) return {FillFault::empty_component, double(unfilled)};
  if (filling.flat) return {FillFault::flat, 0.0};
  if (filling.pieces != surface.solid_components) return {FillFault::pieces, double(filling.pieces)};
  TetrahedralMesh& mesh = filling.mesh;
  mesh.surface_volume = surface.volume;
  const double share = mesh.filled_volume / surface.volume;
  if (!(absolute(share - 1.0) <= kFillVolumeShare)) return {FillFault::volume, 100.0 * share};
  const double cell = surface.side / resolution;
  Array<double> distance;
  mesh.surface.triangles.assign(surface.triangles);
  mesh.surface.points = embed_points(mesh.vertices, mesh.tetrahedra, cell, surface.vertices, distance);
  const double max_uncovered = max(kMaxUncoveredCells * cell, kMaxUncoveredShare * surface.side);
  for (const std::uint32_t i : surface.triangles) {
    if (distance[i] > max_uncovered) return {FillFault::thin_feature, double(i)};
  }
  return {};
}

FillCheck fill(const CheckedSurface& surface, const SurfaceField& field, int resolution, Filling& out) {
  if (expected_tetrahedra(surface, resolution) > 1.2 * double(kMaxFillTetrahedra))
    return {FillFault::too_many, 0.0};
  CutLattice lattice(field, surface.size / surface.side, resolution);
  const double cell = surface.side / resolution, point_volume = 0.5 * cell * cell * cell;
  const double dropped = min(kDroppedShare * surface.volume, 0.25 * surface.smallest_component);
  out.pieces = drop_small_pieces(lattice, dropped / point_volume);
  LatticeFill(surface, lattice, out).run();
  return check_filling(surface, out, resolution);
}

// The first of a series of finer resolutions, each a quarter above the one before, that passes all checks; 0 if none does.
int find_better(const CheckedSurface& surface, const SurfaceField& field, int resolution) {
  const int last = largest_resolution(surface);
  while (resolution < last) {
    resolution = min(resolution + max(resolution / 4, 1), last);
    Filling filling;
    if (fill(surface, field, resolution, filling).fault == FillFault::none) return resolution;
  }
  return 0;
}

Error fault_error(const CheckedSurface& surface, const SurfaceField& field, const FillCheck& check,
                  int resolution) {
  constexpr ErrorCode kCode = ErrorCode::invalid_geometry;
  if (check.fault == FillFault::too_many) {
    return make_error(ErrorCode::invalid_argument,
                      "resolution: %d needs more than %u tetrahedra for this surface; use %d or less",
                      resolution, kMaxFillTetrahedra, min(largest_resolution(surface), resolution - 1));
  }
  if (check.fault == FillFault::flat) {
    return make_error(
        kCode,
        "mesh: its coordinates are too large for its size of %g m, so that rounding leaves tetrahedra "
        "without volume; move it near the origin",
        surface.side);
  }
  const int better = find_better(surface, field, resolution);
  const Error advice = better > 0
                           ? make_error(kCode, "use resolution %d", better)
                           : make_error(kCode, "no resolution within the limits keeps it: make it thicker");
  const unsigned number = unsigned(check.detail);
  if (check.fault == FillFault::empty_component) {
    return make_error(
        kCode,
        "mesh: the connected component with triangle %u is too thin for resolution %d and has no "
        "tetrahedron; %s",
        number, resolution, advice.message);
  }
  if (check.fault == FillFault::pieces) {
    return make_error(
        kCode,
        "mesh: has %d connected components and would have %u at resolution %d, whose cells are too "
        "large for it; %s",
        surface.solid_components, number, resolution, advice.message);
  }
  if (check.fault == FillFault::thin_feature) {
    return make_error(
        kCode, "mesh: the surface at vertex %u is too thin for resolution %d and has no tetrahedra; %s",
        number, resolution, advice.message);
  }
  return make_error(kCode, "mesh: resolution %d fills %.1f %% of its volume; allowed are %.0f to %.0f %%; %s",
                    resolution, check.detail, 100.0 * (1.0 - kFillVolumeShare),
                    100.0 * (1.0 + kFillVolumeShare), advice.message);
}

}  // namespace

Result<TetrahedralMesh> fill_with_tetrahedra(std::span<const Vec3> vertices,
                                             std::span<const std::uint32_t> triangles, int resolution) {
  const FloatMode mode;
  if (resolution < kMinFillResolution || resolution > kMaxFillResolution) {
    return make_error(ErrorCode::invalid_argument, "resolution: %d; allowed are %d to %d", resolution,
                      kMinFillResolution, kMaxFillResolution);
  }
  CheckedSurface surface;
  if (const Error error = check_surface(vertices, triangles, surface)) return error;
  const SurfaceField field(surface.scaled, surface.triangles);
  Filling filling;
  const FillCheck check = fill(surface, field, resolution, filling);
  if (check.fault != FillFault::none) return fault_error(surface, field, check, resolution);
  return std::move(filling.mesh);
}

}  // namespace gyre
