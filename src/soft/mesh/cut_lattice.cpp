#include "soft/mesh/cut_lattice.h"

namespace gyre {
namespace {

// The distance from the surface, in cells, at which a point counts as on it.
constexpr double kOnSurface = 1.0e-6;
// More than an axis needs so that it has one cell more.
constexpr double kCellSlack = 1.0e-6;

// Cells along the side of a block.
constexpr int kBlock = 4;

// Direction d + 7 is opposite to d. The first three of each half are long, the others short.
constexpr LatticePoint kSteps[CutLattice::kDirections] = {
    {2, 0, 0},  {0, 2, 0},  {0, 0, 2},  {1, 1, 1},    {-1, 1, 1},  {1, -1, 1},  {-1, -1, 1},
    {-2, 0, 0}, {0, -2, 0}, {0, 0, -2}, {-1, -1, -1}, {1, -1, -1}, {-1, 1, -1}, {1, 1, -1}};
constexpr int kHalf = CutLattice::kDirections / 2;

constexpr bool is_long(int direction) { return direction % kHalf < 3; }

// The key of the edge in direction d from point `self` to point `other`.
constexpr std::uint64_t edge_key(std::uint32_t self, std::uint32_t other, int d) {
  return d < kHalf ? std::uint64_t(self) * kHalf + std::uint64_t(d)
                   : std::uint64_t(other) * kHalf + std::uint64_t(d - kHalf);
}

int direction_between(LatticePoint from, LatticePoint to) {
  int direction = 0;
  for (int d = 0; d < CutLattice::kDirections; ++d) {
    const LatticePoint p = CutLattice::neighbour(from, d);
    if (p.x == to.x && p.y == to.y && p.z == to.z) direction = d;
  }
  return direction;
}

}  // namespace

CutLattice::CutLattice(const SurfaceField& field, DVec3 size, int resolution)
    : field_(field), cell_(1.0 / resolution) {
  double low[3];
  for (int axis = 0; axis < 3; ++axis) {
    // The box stands in the middle, with a cell around it.
    const double needed = size[axis] / cell_ - kCellSlack;
    int count = max(int(needed), 1);
    if (double(count) < needed) ++count;
    cells_[axis] = count + 2;
    low[axis] = 0.5 * size[axis] - 0.5 * cell_ * cells_[axis];
  }
  origin_ = {low[0], low[1], low[2]};
  corners_ = std::uint32_t((cells_[0] + 1) * (cells_[1] + 1) * (cells_[2] + 1));
  sides_.assign(corners_ + std::uint32_t(cells_[0] * cells_[1] * cells_[2]), std::int8_t(-1));
  find_far_blocks();
  classify_all();
  for (const LatticePoint p : near_) find_cuts(p);
  for (const LatticePoint p : near_) move_point(p);
}

LatticePoint CutLattice::neighbour(LatticePoint p, int direction) {
  const LatticePoint& s = kSteps[direction];
  return {p.x + s.x, p.y + s.y, p.z + s.z};
}

bool CutLattice::contains(LatticePoint p) const {
  return p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x <= 2 * cells_[0] && p.y <= 2 * cells_[1] &&
         p.z <= 2 * cells_[2];
}

std::uint32_t CutLattice::id(LatticePoint p) const {
  if (!contains(p)) return kNoPoint;
  const int i = p.x / 2, j = p.y / 2, k = p.z / 2;
  if (p.x % 2 == 0) return std::uint32_t(i + (cells_[0] + 1) * (j + (cells_[1] + 1) * k));
  return corners_ + std::uint32_t(i + cells_[0] * (j + cells_[1] * k));
}

DVec3 CutLattice::position(LatticePoint p) const {
  const Moved* const moved = moved_.find(id(p));
  return moved != nullptr ? moved->position : rest_position(p);
}

void CutLattice::find_far_blocks() {
  for (int axis = 0; axis < 3; ++axis) blocks_[axis] = cells_[axis] / kBlock + 1;
  // From the centre of a block to its corner, a cell, and some for rounding.
  const double distance = (0.8660254037844387 * kBlock + 1.001) * cell_;
  for (int k = 0; k < blocks_[2]; ++k) {
    for (int j = 0; j < blocks_[1]; ++j) {
      for (int i = 0; i < blocks_[0]; ++i) {
        const LatticePoint center{(2 * i + 1) * kBlock, (2 * j + 1) * kBlock, (2 * k + 1) * kBlock};
        far_.push_back(field_.nearest(rest_position(center), distance).triangle == SurfaceField::kNoTriangle);
      }
    }
  }
}

bool CutLattice::is_far(LatticePoint p) const {
  constexpr int kSize = 2 * kBlock;
  return far_[p.x / kSize + blocks_[0] * (p.y / kSize + blocks_[1] * (p.z / kSize))];
}

// The corners, then the centres, each after its neighbours below.
void CutLattice::classify_all() {
  for (const int odd : {0, 1}) {
    for (int z = odd; z <= 2 * cells_[2]; z += 2) {
      for (int y = odd; y <= 2 * cells_[1]; y += 2) {
        for (int x = odd; x <= 2 * cells_[0]; x += 2) classify({x, y, z});
      }
    }
  }
}

void CutLattice::classify(LatticePoint p) {
  const std::uint32_t self = id(p);
  const DVec3 at = rest_position(p);
  SurfaceField::Nearest nearest{cell_, SurfaceField::kNoTriangle};
  if (!is_far(p)) nearest = field_.nearest(at, cell_);
  if (nearest.triangle == SurfaceField::kNoTriangle) {
    // No edge from here meets the surface, so a neighbour off the surface is on the same side. Points on the border are outside.
    const LatticePoint below[3] = {{p.x - 2, p.y, p.z}, {p.x, p.y - 2, p.z}, {p.x, p.y, p.z - 2}};
    for (const LatticePoint& q : below) {
      const std::uint32_t other = id(q);
      if (other == kNoPoint) return;
      if (sides_[other] == 0) continue;
      sides_[self] = sides_[other];
      return;
    }
  } else {
    near_.push_back(p);
    if (nearest.distance < kOnSurface * cell_) {
      sides_[self] = 0;
      moved_.insert(self, {at, nearest.triangle});
      return;
    }
  }
  sides_[self] = field_.inside(at) ? 1 : -1;
}

void CutLattice::find_cuts(LatticePoint p) {
  const std::uint32_t self = id(p);
  if (sides_[self] <= 0) return;
  const DVec3 from = rest_position(p);
  for (int d = 0; d < kDirections; ++d) {
    const LatticePoint q = neighbour(p, d);
    const std::uint32_t other = id(q);
    if (other == kNoPoint || sides_[other] >= 0) continue;
    const DVec3 to = rest_position(q);
    const SurfaceField::Crossing crossing = field_.first_crossing(from, to);
    LatticeCut cut;
    cut.fraction = crossing.fraction;
    cut.triangle = crossing.triangle;
    if (crossing.triangle == SurfaceField::kNoTriangle) {
      // Rounding at the rim of a triangle: the distances of both ends decide.
      const SurfaceField::Nearest here = field_.nearest(from, 2.0 * cell_);
      cut.fraction = here.distance / (here.distance + field_.distance(to, 2.0 * cell_));
      cut.triangle = here.triangle;
    }
    cut.position = from + cut.fraction * (to - from);
    cut_of_edge_.insert(edge_key(self, other, d), std::uint32_t(cuts_.size()));
    cuts_.push_back(cut);
  }
}

void CutLattice::move_point(LatticePoint p) {
  const std::uint32_t self = id(p);
  if (sides_[self] == 0) return;
  std::uint32_t closest = kNoPoint;
  double shortest = 1.0e300;
  for (int d = 0; d < kDirections; ++d) {
    const std::uint32_t other = id(neighbour(p, d));
    if (other == kNoPoint || int(sides_[other]) * int(sides_[self]) >= 0) continue;
    const std::uint32_t index = *cut_of_edge_.find(edge_key(self, other, d));
    const double share = sides_[self] > 0 ? cuts_[index].fraction : 1.0 - cuts_[index].fraction;
    const double distance = share * (is_long(d) ? 1.0 : 0.86602540378443865);
    if (share >= (is_long(d) ? kLongShare : kShortShare) || distance >= shortest) continue;
    shortest = distance;
    closest = index;
  }
  if (closest == kNoPoint) return;
  sides_[self] = 0;
  moved_.insert(self, {cuts_[closest].position, cuts_[closest].triangle});
}

std::uint32_t CutLattice::cut_between(LatticePoint inner, LatticePoint outer) const {
  return *cut_of_edge_.find(edge_key(id(inner), id(outer), direction_between(inner, outer)));
}

}  // namespace gyre
