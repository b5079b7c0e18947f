#include "soft/mesh/lattice_pieces.h"

#include "base/container/disjoint_sets.h"

namespace gyre {
namespace {

LatticePoint moved_by(LatticePoint p, int axis, int by) {
  return {p.x + (axis == 0 ? by : 0), p.y + (axis == 1 ? by : 0), p.z + (axis == 2 ? by : 0)};
}

template <class Visit>
void visit_inner_points(const CutLattice& lattice, Visit&& visit) {
  for (const int odd : {0, 1}) {
    for (int z = odd; z <= 2 * lattice.cells(2); z += 2) {
      for (int y = odd; y <= 2 * lattice.cells(1); y += 2) {
        for (int x = odd; x <= 2 * lattice.cells(0); x += 2) {
          const LatticePoint p{x, y, z};
          const std::uint32_t id = lattice.id(p);
          if (lattice.side(id) > 0) visit(p, id);
        }
      }
    }
  }
}

// Two points across a face whose three corners all lie on the surface. The points are opposite corners of a square of the lattice; the face
// has the two points before and behind the square, and another corner of it.
void unite_across_faces(const CutLattice& lattice, const DisjointSets& sets, LatticePoint p,
                        std::uint32_t id) {
  const auto on_surface = [&](LatticePoint q) { return lattice.side(lattice.id(q)) == 0; };
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const int sign : {-1, 1}) {
      // Inner points are a cell or more from the border.
      const std::uint32_t other = lattice.id(moved_by(moved_by(p, u, 2), v, 2 * sign));
      if (lattice.side(other) <= 0) continue;
      const LatticePoint middle = moved_by(moved_by(p, u, 1), v, sign);
      if (!on_surface(moved_by(middle, axis, 1)) || !on_surface(moved_by(middle, axis, -1))) continue;
      if (on_surface(moved_by(p, u, 2)) || on_surface(moved_by(p, v, 2 * sign))) sets.unite(id, other);
    }
  }
}

}  // namespace

int drop_small_pieces(CutLattice& lattice, double max_points) {
  Array<std::uint32_t> parents, size;
  parents.resize(lattice.point_count());
  size.resize(lattice.point_count());
  const DisjointSets sets(parents);
  visit_inner_points(lattice, [&](LatticePoint p, std::uint32_t id) {
    for (int d = 0; d < CutLattice::kDirections / 2; ++d) {
      const std::uint32_t other = lattice.id(CutLattice::neighbour(p, d));
      if (lattice.side(other) > 0) sets.unite(id, other);
    }
    unite_across_faces(lattice, sets, p, id);
  });
  std::uint32_t largest = 0;
  visit_inner_points(lattice, [&](LatticePoint, std::uint32_t id) { ++size[sets.of(id)]; });
  for (const std::uint32_t points : size) largest = max(largest, points);
  int pieces = 0;
  for (const std::uint32_t points : size)
    pieces += points == largest || double(points) > max_points ? int(points > 0) : 0;
  visit_inner_points(lattice, [&](LatticePoint, std::uint32_t id) {
    const std::uint32_t points = size[sets.of(id)];
    if (points != largest && double(points) <= max_points) lattice.set_outside(id);
  });
  return pieces;
}

}  // namespace gyre
