#include "soft/body/continuum.h"

#include "base/container/disjoint_sets.h"
#include "math/dense.h"

#include <utility>

namespace gyre {

namespace {

void sort_corners(std::span<std::uint32_t> corner) {
  for (std::size_t i = 1; i < corner.size(); ++i) {
    for (std::size_t j = i; j > 0 && corner[j - 1] > corner[j]; --j) std::swap(corner[j - 1], corner[j]);
  }
}

std::uint32_t find_edge(const NeighbourLists& lists, std::uint32_t low, std::uint32_t high) {
  std::uint32_t begin = lists.begin[low], end = lists.begin[low + 1];
  while (end - begin > 1) {
    const std::uint32_t middle = begin + (end - begin) / 2;
    (lists.other[middle] <= high ? begin : end) = middle;
  }
  return begin;
}

// Numbers the edges: those of the lower particles first. `number` becomes that of each neighbour, in the order of the lists.
int number_edges(const NeighbourLists& lists, Array<std::int32_t>& number) {
  number.resize(lists.other.size());
  int edges = 0;
  for (int row = 0; row < lists.rows(); ++row) {
    for (std::uint32_t k = lists.begin[row]; k < lists.begin[row + 1]; ++k) {
      if (lists.other[k] > std::uint32_t(row)) number[k] = edges++;
    }
  }
  for (int row = 0; row < lists.rows(); ++row) {
    for (std::uint32_t k = lists.begin[row]; k < lists.begin[row + 1]; ++k) {
      if (lists.other[k] < std::uint32_t(row))
        number[k] = number[find_edge(lists, lists.other[k], std::uint32_t(row))];
    }
  }
  return edges;
}

void set_shape(TetBlock& block, int lane, const std::uint32_t (&corner)[4], std::span<const DVec3> places) {
  double matrix[9], inverse[9];
  for (int c = 0; c < 3; ++c) {
    const DVec3 edge = places[corner[c + 1]] - places[corner[0]];
    matrix[3 * c] = edge.x, matrix[3 * c + 1] = edge.y, matrix[3 * c + 2] = edge.z;
  }
  const DVec3 a{matrix[0], matrix[1], matrix[2]}, b{matrix[3], matrix[4], matrix[5]},
      d{matrix[6], matrix[7], matrix[8]};
  if (!invert_3x3(matrix, inverse)) return;
  block.volume[lane] = float(absolute(dot(a, cross(b, d))) / 6.0);
  for (int k = 0; k < 9; ++k) block.gradient[k][lane] = float(inverse[k]);
}

// The lowest colour that no chunk with a common particle has, chunk by chunk.
template <class Block>
ColoredChunks color_chunks(const Array<Block>& blocks, int particles) {
  const int count = int(blocks.size()), chunks = (count + kChunkBlocks - 1) / kChunkBlocks;
  Array<std::uint64_t> taken;  // colours of the chunks at a particle
  taken.resize(std::size_t(particles));
  Array<std::int32_t> color;
  color.resize(std::size_t(chunks));
  int colors = 0;
  const auto each_corner = [&](int chunk, auto&& what) {
    for (int block = chunk * kChunkBlocks; block < min((chunk + 1) * kChunkBlocks, count); ++block) {
      for (const auto& corner : blocks[block].corner) {
        for (const std::int32_t particle : corner) what(taken[particle]);
      }
    }
  };
  for (int chunk = 0; chunk < chunks; ++chunk) {
    std::uint64_t near = 0;
    each_corner(chunk, [&](std::uint64_t here) { near |= here; });
    int own = 0;
    while (own < kLastChunkColor && (near >> own & 1u) != 0) ++own;
    color[chunk] = own;
    each_corner(chunk, [&](std::uint64_t& here) { here |= std::uint64_t{1} << own; });
    colors = max(colors, own + 1);
  }
  ColoredChunks out;
  for (int one = 0; one < colors; ++one) {
    out.begin.push_back(std::int32_t(out.chunks.size()));
    for (int chunk = 0; chunk < chunks; ++chunk) {
      if (color[chunk] == one) out.chunks.push_back(chunk);
    }
  }
  out.begin.push_back(std::int32_t(out.chunks.size()));
  return out;
}

// The pattern of all elements of a continuum.
struct Pattern {
  NeighbourLists lists;
  Array<std::int32_t> number;  // of the edge to each neighbour

  std::int32_t edge(std::uint32_t low, std::uint32_t high) const {
    return number[find_edge(lists, low, high)];
  }
};

// Adds all pairs of elements of `size` corners each.
void add_pairs(std::span<const std::uint32_t> corners, std::size_t size, Array<MatrixEntry>& entries) {
  for (std::size_t first = 0; first < corners.size(); first += size) {
    for (std::size_t a = 0; a < size; ++a) {
      for (std::size_t b = 0; b < size; ++b) entries.push_back({corners[first + a], corners[first + b], 0.0});
    }
  }
}

Pattern make_pattern(Array<MatrixEntry>& pairs, int particles, Continuum& continuum) {
  merge_entries(pairs);
  Pattern pattern;
  pattern.lists = list_neighbours(pairs, particles);
  continuum.edges = number_edges(pattern.lists, pattern.number);
  Array<std::int32_t> place;
  continuum.rows = slice_rows(pattern.lists, place);
  continuum.edge_of_place.assign(continuum.rows.places(), -1);
  for (int row = 0; row < particles; ++row) {
    for (std::uint32_t k = pattern.lists.begin[row]; k < pattern.lists.begin[row + 1]; ++k) {
      const int side = pattern.lists.other[k] < std::uint32_t(row) ? 1 : 0;
      continuum.edge_of_place[place[k]] = 2 * pattern.number[k] + side;
    }
  }
  return pattern;
}

bool share_a_face(const std::uint32_t* a, const std::uint32_t* b) {
  int common = 0;
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 4; ++k) common += a[i] == b[k] ? 1 : 0;
  }
  return common == 3;
}

// Cells and their corners, kCellCorners each, ascending, the last several times where there are fewer.
class CellLists {
 public:
  Array<std::uint32_t> corners;

  // `group`: by tetrahedron, ascending.
  CellLists(std::span<const std::uint32_t> tetrahedra, std::span<const std::uint32_t> group,
            Continuum& continuum)
      : tetrahedra_(tetrahedra), continuum_(continuum) {
    if (group.empty()) return;
    continuum.cell_of.assign(group.size(), -1);
    continuum.cell_begin.push_back(0);
    for (std::size_t first = 0, end = 0; first < group.size(); first = end) {
      while (end < group.size() && group[end] == group[first]) ++end;
      for (std::size_t t = first; t < end; ++t) add_cell(t, end);
    }
  }

 private:
  // The cell of all tetrahedra from `first` to `end` that hang together with the first one by whole faces.
  void add_cell(std::size_t first, std::size_t end) {
    if (continuum_.cell_of[first] >= 0) return;
    parts_.clear(), around_.clear();
    parts_.push_back(std::int32_t(first));
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      const std::uint32_t* const own = tetrahedra_.data() + 4 * std::size_t(parts_[k]);
      for (int a = 0; a < 4; ++a) add_corner(own[a]);
      for (std::size_t t = first; t < end; ++t) {
        bool is_new = continuum_.cell_of[t] < 0;
        for (const std::int32_t part : parts_) is_new = is_new && part != std::int32_t(t);
        if (is_new && share_a_face(own, tetrahedra_.data() + 4 * t)) parts_.push_back(std::int32_t(t));
      }
    }
    if (parts_.size() == 1 || around_.size() > kCellCorners) return;
    const std::int32_t number = std::int32_t(continuum_.cell_begin.size()) - 1;
    for (const std::int32_t part : parts_) {
      continuum_.cell_of[part] = number;
      continuum_.cell_parts.push_back(part);
    }
    continuum_.cell_begin.push_back(std::int32_t(continuum_.cell_parts.size()));
    sort_corners(around_.view());
    while (around_.size() < kCellCorners) around_.push_back(around_.back());
    corners.append(around_.view());
  }
  void add_corner(std::uint32_t corner) {
    for (const std::uint32_t one : around_) {
      if (one == corner) return;
    }
    around_.push_back(corner);
  }

  std::span<const std::uint32_t> tetrahedra_;
  Continuum& continuum_;
  Array<std::int32_t> parts_;
  Array<std::uint32_t> around_;
};

// Corners of a lane, which ascend, and the edges between them.
template <int Corners>
void set_corners(SolidBlock<Corners>& block, int lane, const std::uint32_t* corner, const Pattern& pattern,
                 int edges) {
  int edge = 0;
  for (int a = 0; a < Corners; ++a) {
    block.corner[a][lane] = std::int32_t(corner[a]);
    for (int b = a + 1; b < Corners; ++b)
      block.edge[edge++][lane] = corner[a] == corner[b] ? edges : pattern.edge(corner[a], corner[b]);
  }
}

void number_pieces(Continuum& continuum, std::span<const std::uint32_t> corners, int particles) {
  Array<std::uint32_t> parents;
  parents.resize(std::size_t(particles));
  const DisjointSets sets{std::span<std::uint32_t>(parents.data(), parents.size())};
  for (std::size_t k = 0; k < corners.size(); ++k) sets.unite(corners[k & ~std::size_t(3)], corners[k]);
  sets.flatten();
  continuum.pieces = 0;
  for (std::uint32_t i = 0; i < std::uint32_t(particles); ++i)
    parents[i] = parents[i] == i ? std::uint32_t(continuum.pieces++) : parents[parents[i]];
  if (continuum.pieces > 1) continuum.piece = std::move(parents);
}

// Empty lanes, whose corners are the particle that the block's first lane names.
template <class Block>
void fill_up(Array<Block>& blocks, std::size_t elements, int edges) {
  for (std::size_t t = elements; t < blocks.size() * kTetLanes; ++t) {
    Block& block = blocks[t / kTetLanes];
    for (auto& corner : block.corner) corner[t % kTetLanes] = block.corner[0][0];
    for (auto& edge : block.edge) edge[t % kTetLanes] = edges;  // a block that nobody reads
  }
}

}  // namespace

namespace {

// Gradients of all corners of a cell.
struct CellGradients {
  double of[kCellCorners][3] = {};
};

// Those of one of its tetrahedra.
CellGradients part_gradients(const CellBlock& block, int lane, const TetBlock& part, int at) {
  CellGradients out;
  int corner[4];
  for (int a = 0; a < 4; ++a) {
    corner[a] = 0;
    while (block.corner[corner[a]][lane] != part.corner[a][at]) ++corner[a];
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (int a = 1; a < 4; ++a) {
      const double own = double(part.gradient[TetBlock::kOthers * axis + a - 1][at]);
      out.of[corner[a]][axis] = own, out.of[corner[0]][axis] -= own;
    }
  }
  return out;
}

// Adds a share of the products of the gradients of each two corners.
void add_products(const CellGradients& gradients, double share, double (&products)[CellBlock::kEdges]) {
  int edge = 0;
  for (int a = 0; a < kCellCorners; ++a) {
    for (int b = a + 1; b < kCellCorners; ++b, ++edge) {
      for (int axis = 0; axis < 3; ++axis)
        products[edge] += share * gradients.of[a][axis] * gradients.of[b][axis];
    }
  }
}

}  // namespace

void renew_cell(Continuum& continuum, int cell) {
  CellBlock& block = continuum.cells[cell / kTetLanes];
  const int lane = cell % kTetLanes;
  CellGradients mean;
  double volume = 0.0, products[CellBlock::kEdges] = {};
  for (std::int32_t k = continuum.cell_begin[cell]; k < continuum.cell_begin[cell + 1]; ++k) {
    const TetBlock& part = continuum.tetrahedra[continuum.cell_parts[k] / kTetLanes];
    const int at = continuum.cell_parts[k] % kTetLanes;
    const CellGradients gradients = part_gradients(block, lane, part, at);
    const double own = double(part.volume[at]);
    volume += own;
    for (int a = 0; a < kCellCorners; ++a) {
      for (int axis = 0; axis < 3; ++axis) mean.of[a][axis] += own * gradients.of[a][axis];
    }
    add_products(gradients, own, products);
  }
  for (auto& gradient : mean.of) {
    for (double& one : gradient) one /= volume;
  }
  add_products(mean, -volume, products);
  block.volume[lane] = float(volume);
  for (int axis = 0; axis < 3; ++axis) {
    for (int a = 1; a < kCellCorners; ++a)
      block.gradient[CellBlock::kOthers * axis + a - 1][lane] = float(mean.of[a][axis]);
  }
  for (int edge = 0; edge < CellBlock::kEdges; ++edge)
    block.tie[edge][lane] = float(-2.0 * kSpreadShare * products[edge]);
}

Continuum make_continuum(std::span<const std::uint32_t> corners, std::span<const DVec3> places,
                         std::span<const std::uint32_t> group) {
  Continuum continuum;
  const CellLists cells(corners, group, continuum);
  Array<MatrixEntry> pairs;
  add_pairs(corners, 4, pairs);
  add_pairs(cells.corners.view(), kCellCorners, pairs);
  const Pattern pattern = make_pattern(pairs, int(places.size()), continuum);
  const std::size_t count = corners.size() / 4, cell_count = cells.corners.size() / kCellCorners;
  continuum.tetrahedra.resize((count + kTetLanes - 1) / kTetLanes);
  for (std::size_t t = 0; t < count; ++t) {
    std::uint32_t corner[4];
    for (std::size_t a = 0; a < 4; ++a) corner[a] = corners[4 * t + a];
    sort_corners(corner);
    TetBlock& block = continuum.tetrahedra[t / kTetLanes];
    const int lane = int(t % kTetLanes);
    set_corners(block, lane, corner, pattern, continuum.edges);
    set_shape(block, lane, corner, places);
    block.stiffness[lane] = continuum.is_in_cell(t) ? 0.0f : 1.0f;
  }
  continuum.cells.resize((cell_count + kTetLanes - 1) / kTetLanes);
  for (std::size_t c = 0; c < cell_count; ++c) {
    CellBlock& block = continuum.cells[c / kTetLanes];
    const int lane = int(c % kTetLanes);
    set_corners(block, lane, cells.corners.data() + kCellCorners * c, pattern, continuum.edges);
    block.stiffness[lane] = 1.0f;
    renew_cell(continuum, int(c));
  }
  fill_up(continuum.tetrahedra, count, continuum.edges);
  fill_up(continuum.cells, cell_count, continuum.edges);
  number_pieces(continuum, corners, int(places.size()));
  continuum.tetrahedron_chunks = color_chunks(continuum.tetrahedra, int(places.size()));
  continuum.cell_chunks = color_chunks(continuum.cells, int(places.size()));
  return continuum;
}

Continuum make_membrane(std::span<const SheetTriangle> triangles, int particles) {
  Continuum continuum;
  Array<std::uint32_t> corners;
  for (const SheetTriangle& one : triangles) corners.append(one.corner);
  Array<MatrixEntry> pairs;
  add_pairs(corners.view(), 3, pairs);
  const Pattern pattern = make_pattern(pairs, particles, continuum);
  continuum.triangles.resize((triangles.size() + kTetLanes - 1) / kTetLanes);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    int order[3] = {0, 1, 2};  // by particle, ascending
    const SheetTriangle& one = triangles[t];
    for (int i = 1; i < 3; ++i) {
      for (int j = i; j > 0 && one.corner[order[j - 1]] > one.corner[order[j]]; --j)
        std::swap(order[j - 1], order[j]);
    }
    TriangleBlock& block = continuum.triangles[t / kTetLanes];
    const int lane = int(t % kTetLanes);
    double side[2][2];
    for (int k = 0; k < 2; ++k) {
      for (int c = 0; c < 2; ++c) side[k][c] = one.place[order[k + 1]][c] - one.place[order[0]][c];
    }
    const double twice = side[0][0] * side[1][1] - side[0][1] * side[1][0];
    for (int a = 0; a < 3; ++a) block.corner[a][lane] = std::int32_t(one.corner[order[a]]);
    block.edge[0][lane] = pattern.edge(one.corner[order[0]], one.corner[order[1]]);
    block.edge[1][lane] = pattern.edge(one.corner[order[0]], one.corner[order[2]]);
    block.edge[2][lane] = pattern.edge(one.corner[order[1]], one.corner[order[2]]);
    block.area[lane] = float(0.5 * absolute(twice));
    const double inverse[4] = {side[1][1] / twice, -side[0][1] / twice, -side[1][0] / twice,
                               side[0][0] / twice};
    for (int k = 0; k < 4; ++k) block.inverse[k][lane] = float(inverse[k]);
  }
  fill_up(continuum.triangles, triangles.size(), continuum.edges);
  continuum.triangle_chunks = color_chunks(continuum.triangles, particles);
  return continuum;
}

}  // namespace gyre
