// The surface by dual contouring without normals: a vertex in each box of eight centres that the surface passes, in the middle of its crossings
// of the box's edges, and a quadrilateral round each edge that it crosses (S. Gibson, "Constrained Elastic Surface Nets", 1998).
#include "fluid/liquid/liquid_surface.h"

#include "fluid/liquid/liquid_pass.h"

namespace gyre {

namespace {

struct SurfaceField {
  const LiquidGrid& grid;

  // The distance at a centre; positive beyond the sides of the box.
  float at(int i, int j, int k) const {
    const int place[3] = {i, j, k};
    int inside[3];
    bool outside = false;
    for (int axis = 0; axis < 3; ++axis) {
      const int last = grid.shape.cells[axis] - 1;
      inside[axis] = place[axis] < 0 ? 0 : place[axis] > last ? last : place[axis];
      outside = outside || inside[axis] != place[axis];
    }
    const float value = grid.surface[grid.shape.at(inside[0], inside[1], inside[2])];
    return outside ? absolute(value) : value;
  }
};

// Corner numbers of the box's twelve edges.
constexpr int kEdges[12][2] = {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3},
                               {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};

}  // namespace

void find_surface_mesh(const LiquidGrid& grid, Array<Vec3>& vertices, Array<std::uint32_t>& indices) {
  vertices.clear();
  indices.clear();
  const GridShape& shape = grid.shape;
  const SurfaceField field{grid};
  const Vec3 h = grid.box.cell;
  const Vec3 size{float(shape.cells[0]) * h.x, float(shape.cells[1]) * h.y, float(shape.cells[2]) * h.z};
  constexpr std::uint32_t kNone = 0xffffffffu;
  Array<std::uint32_t> vertex;
  vertex.resize(std::size_t(shape.size), kNone);
  for (int k = -1; k < shape.cells[2]; ++k) {
    for (int j = -1; j < shape.cells[1]; ++j) {
      for (int i = -1; i < shape.cells[0]; ++i) {
        float value[8];
        int inside = 0;
        for (int corner = 0; corner < 8; ++corner) {
          value[corner] = field.at(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2));
          inside += value[corner] < 0.0f ? 1 : 0;
        }
        if (inside == 0 || inside == 8) continue;
        // Corners beyond a side take no part but that the vertex then lies on the side.
        const int index[3] = {i, j, k};
        int beyond = 0;
        for (int corner = 0; corner < 8; ++corner) {
          for (int axis = 0; axis < 3; ++axis) {
            const int place = index[axis] + (corner >> axis & 1);
            if (place < 0 || place >= shape.cells[axis]) beyond |= 1 << corner;
          }
        }
        Vec3 sum{};
        int crossings = 0;
        for (const auto& edge : kEdges) {
          const float a = value[edge[0]], b = value[edge[1]];
          if ((beyond >> edge[0] & 1) != 0 || (beyond >> edge[1] & 1) != 0 || (a < 0.0f) == (b < 0.0f))
            continue;
          const float t = a / (a - b);
          const auto corner = [](int c) { return Vec3{float(c & 1), float(c >> 1 & 1), float(c >> 2)}; };
          sum += lerp(corner(edge[0]), corner(edge[1]), t);
          ++crossings;
        }
        Vec3 place = crossings > 0 ? sum / float(crossings) : Vec3{0.5f, 0.5f, 0.5f};
        float* const parts[3] = {&place.x, &place.y, &place.z};
        for (int axis = 0; axis < 3; ++axis) {
          if (index[axis] < 0 || index[axis] == shape.cells[axis] - 1) *parts[axis] = 0.5f;
        }
        place += Vec3{float(i) + 0.5f, float(j) + 0.5f, float(k) + 0.5f};
        vertex[shape.at(i, j, k)] = std::uint32_t(vertices.size());
        vertices.push_back(max(Vec3{}, min(size, multiply_each(place, h))));
      }
    }
  }
  for (int k = -1; k < shape.cells[2]; ++k) {
    for (int j = -1; j < shape.cells[1]; ++j) {
      for (int i = -1; i < shape.cells[0]; ++i) {
        const bool here = field.at(i, j, k) < 0.0f;
        const int index[3] = {i, j, k};
        for (int axis = 0; axis < 3; ++axis) {
          const int a = (axis + 1) % 3, b = (axis + 2) % 3;
          // Centres of the ghosts' rows belong to no box on their outer side.
          if (index[a] < 0 || index[b] < 0) continue;
          const bool next =
              field.at(i + (axis == 0 ? 1 : 0), j + (axis == 1 ? 1 : 0), k + (axis == 2 ? 1 : 0)) < 0.0f;
          if (here == next) continue;
          const int c = shape.at(i, j, k), back_a = shape.stride(a), back_b = shape.stride(b);
          const std::uint32_t quad[4] = {vertex[c - back_a - back_b], vertex[c - back_b], vertex[c],
                                         vertex[c - back_a]};
          // Anticlockwise about the axis, which points out of the liquid if it begins within it.
          const int order[2][6] = {{0, 2, 1, 0, 3, 2}, {0, 1, 2, 0, 2, 3}};
          for (const int corner : order[here ? 1 : 0]) indices.push_back(quad[corner]);
        }
      }
    }
  }
}

}  // namespace gyre
