// CellBox: a range of cells of a grid.
#pragma once

namespace gyre {

// Cells from `low` to `high` along each axis, the latter not among them.
struct CellBox {
  int low[3] = {0, 0, 0}, high[3] = {0, 0, 0};

  bool contains(const CellBox& other) const;
  bool overlaps(const CellBox& other) const;
  void include(const CellBox& other);
  bool operator==(const CellBox&) const = default;
};

}  // namespace gyre
