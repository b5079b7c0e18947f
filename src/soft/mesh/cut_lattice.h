// The body-centred cubic lattice of isosurface stuffing, cut by a closed surface: which points are inside, where edges meet the surface, and
// which points are moved onto it.
//
// In: a field of the surface, scaled to a box of longest side 1, and the number of cells along that side. Out: the sides of all points (inside,
// on the surface, outside), the cut points of edges from inside to outside, and the moved points. No cut point is nearer to the end of its
// edge than a fixed share of the edge: nearer ones move that end, and its other cut points vanish.
// Points have integer coordinates in half cells: all even for the corners of cells, all odd for their centres.
// Source: F. Labelle, J. R. Shewchuk, "Isosurface Stuffing: Fast Tetrahedral Meshes with Good Dihedral Angles", 2007; the shares are
// those of its bound for uniform tetrahedra.
#pragma once

#include "base/container/array.h"
#include "base/container/flat_map.h"
#include "geometry/decomposition/surface_field.h"

#include <gyre/math.h>

#include <cstdint>

namespace gyre {

struct LatticePoint {
  int x = 0, y = 0, z = 0;
};

struct LatticeCut {
  double fraction = 0.0;  // of the edge, from its inner end
  std::uint32_t triangle = SurfaceField::kNoTriangle;
  DVec3 position;
};

class CutLattice {
 public:
  static constexpr int kDirections = 14;
  static constexpr std::uint32_t kNoPoint = 0xffffffffu;
  // The nearest that a cut may be to a point, as a share of a long and of a short edge.
  static constexpr double kLongShare = 0.24999, kShortShare = 0.41189;

  // `size`: of the surface's box, which begins at zero.
  CutLattice(const SurfaceField& field, DVec3 size, int resolution);

  int cells(int axis) const { return cells_[axis]; }
  std::uint32_t point_count() const { return std::uint32_t(sides_.size()); }
  std::uint32_t id(LatticePoint p) const;
  std::int8_t side(std::uint32_t id) const { return sides_[id]; }
  // Leaves out an inner point. Its inner neighbours must be left out too.
  void set_outside(std::uint32_t id) { sides_[id] = -1; }
  // The neighbour along an edge; direction d + 7 is opposite to d.
  static LatticePoint neighbour(LatticePoint p, int direction);
  // Where a point is, moved or not.
  DVec3 position(LatticePoint p) const;
  // The triangle on which a point of side 0 lies.
  std::uint32_t triangle_of(std::uint32_t id) const { return moved_.find(id)->triangle; }
  // The index of the cut of an edge from inside to outside.
  std::uint32_t cut_between(LatticePoint inner, LatticePoint outer) const;
  const LatticeCut& cut(std::uint32_t index) const { return cuts_[index]; }
  std::uint32_t cut_count() const { return std::uint32_t(cuts_.size()); }

 private:
  struct Moved {
    DVec3 position;
    std::uint32_t triangle;
  };
  void find_far_blocks();
  bool is_far(LatticePoint p) const;
  void classify(LatticePoint p);
  void classify_all();
  void find_cuts(LatticePoint p);
  void move_point(LatticePoint p);
  DVec3 rest_position(LatticePoint p) const { return origin_ + 0.5 * cell_ * DVec3(p.x, p.y, p.z); }
  bool contains(LatticePoint p) const;

  const SurfaceField& field_;
  DVec3 origin_;
  double cell_ = 0.0;
  int cells_[3] = {};
  std::uint32_t corners_ = 0;
  Array<std::int8_t> sides_;
  int blocks_[3] = {};
  Array<bool> far_;  // of blocks of cells: whether all points in it are farther than a cell from the surface
  Array<LatticePoint> near_;  // points one cell or less from the surface, in order
  FlatMap<Moved> moved_;
  Array<LatticeCut> cuts_;
  FlatMap<std::uint32_t> cut_of_edge_;
};

}  // namespace gyre
