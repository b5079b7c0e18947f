#include "bench/scenes/soft_scene.h"

#include <utility>

namespace gyre::bench::soft {

Sheet make_sheet(const std::string& scene) {
  Sheet sheet;
  sheet.held = scene == "hanging";
  const double height = sheet.held ? 0.0 : 0.9;
  constexpr std::uint32_t n = Sheet::kSide;
  const auto cells_beside = [](std::uint32_t i) { return i == 0 || i == n - 1 ? 1 : 2; };
  const double quarter = double(Sheet::kAreaDensity) * Sheet::kSpacing * Sheet::kSpacing / 4.0;
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t at = i + j * n;
      sheet.vertices.push_back({i * Sheet::kSpacing - 1.0, height, j * Sheet::kSpacing - 1.0});
      sheet.masses.push_back(float(quarter * cells_beside(i) * cells_beside(j)));
      if (i + 1 < n) sheet.edges.push_back({at, at + 1});
      if (j + 1 < n) sheet.edges.push_back({at, at + n});
      if (i + 1 == n || j + 1 == n) continue;
      sheet.diagonals.push_back({at, at + n + 1});
      sheet.diagonals.push_back({at + 1, at + n});
      for (const std::uint32_t v : {at, at + n, at + 1, at + 1, at + n, at + n + 1})
        sheet.triangles.push_back(v);
    }
  }
  return sheet;
}

double six_volumes(const std::vector<DVec3>& p, const Tetrahedron& t) {
  return dot(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]), p[t[3]] - p[t[0]]);
}

Beam make_beam() {
  Beam beam;
  constexpr std::uint32_t cells[3] = {30, 8, 7};
  constexpr double size = 1.0 / 30.0;  // m, of a cell
  constexpr std::uint32_t stride[3] = {1, cells[0] + 1, (cells[0] + 1) * (cells[1] + 1)};
  for (std::uint32_t k = 0; k <= cells[2]; ++k) {
    for (std::uint32_t j = 0; j <= cells[1]; ++j) {
      for (std::uint32_t i = 0; i <= cells[0]; ++i) {
        if (i == 0) beam.clamped.push_back(std::uint32_t(beam.vertices.size()));
        if (i == cells[0]) beam.tip.push_back(std::uint32_t(beam.vertices.size()));
        beam.vertices.push_back({i * size, j * size, k * size});
      }
    }
  }
  // Six tetrahedra around the diagonal of each cell, one for each order of the axes.
  constexpr std::size_t orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (std::uint32_t k = 0; k < cells[2]; ++k) {
    for (std::uint32_t j = 0; j < cells[1]; ++j) {
      for (std::uint32_t i = 0; i < cells[0]; ++i) {
        const std::uint32_t corner = i * stride[0] + j * stride[1] + k * stride[2];
        for (const auto& order : orders) {
          Tetrahedron t{corner};
          for (std::size_t a = 0; a < 3; ++a) t[a + 1] = t[a] + stride[order[a]];
          if (six_volumes(beam.vertices, t) < 0.0) std::swap(t[2], t[3]);
          beam.tetrahedra.push_back(t);
        }
      }
    }
  }
  beam.masses.assign(beam.vertices.size(), 0.0f);
  for (const Tetrahedron& t : beam.tetrahedra) {
    for (const std::uint32_t v : t)
      beam.masses[v] += float(double(Beam::kDensity) * six_volumes(beam.vertices, t) / 24.0);
  }
  return beam;
}

Rope make_rope() {
  Rope rope;
  const double spacing = Rope::kLength / (Rope::kVertices - 1);
  for (std::uint32_t i = 0; i < Rope::kVertices; ++i) {
    const bool end = i == 0 || i + 1 == Rope::kVertices;
    rope.vertices.push_back({i * spacing, 0.0, 0.0});
    rope.masses.push_back(float(double(Rope::kLinearDensity) * spacing * (end ? 0.5 : 1.0)));
  }
  return rope;
}

}  // namespace gyre::bench::soft
