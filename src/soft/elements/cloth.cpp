#include "soft/elements/cloth.h"

#include "base/container/sort.h"
#include "math/rotation.h"

#include <cmath>

namespace gyre {

namespace {

struct Grid {
  int columns, rows;  // particles
  double dx, dy;

  std::uint32_t at(int i, int j) const { return std::uint32_t(i + j * columns); }
  // The width of the strip that a line of the grid stands for: half a cell at the edge.
  double row_share(int j) const { return j == 0 || j == rows - 1 ? 0.5 * dy : dy; }
  double column_share(int i) const { return i == 0 || i == columns - 1 ? 0.5 * dx : dx; }
};

// Stiffness of links along x and along y a width, and of links across a cell, that together make the material's. With links across,
// the sheet has C11 = K1 + G a^2, C22 = K2 + G / a^2, C12 = G with a = dx / dy, and a strip that is free to contract has C11 - C12^2 / C22.
struct LinkStiffness {
  double x, y, across;
  bool is_stable;  // false in long cells: see below
};

LinkStiffness link_stiffness(const Grid& grid, const ClothMaterial& material) {
  const double stretch = double(material.stretch_stiffness), shear = double(material.shear_stiffness);
  const double a = grid.dx / grid.dy;
  const double c = 0.5 * (stretch + std::sqrt(stretch * stretch + 4.0 * shear * shear));
  const double diagonal = grid.dx * grid.dx + grid.dy * grid.dy;
  const double x = max(c - shear * a * a, 0.0), y = max(c - shear / (a * a), 0.0);
  // A strip that is pulled along y contracts along x by the ratio G / C, which presses the links along x. Particles that leave the plane by turns
  // turn these by an angle / dx, and the links along y, which hold them, by one / dy; links across a cell do not turn. So with K1 (G / C) / a
  // above K2 a the sheet folds at once, and a strip along x likewise.
  const double contraction = shear / c;
  const bool is_stable = contraction * x <= y * a * a && contraction * y * a * a <= x;
  return {x, y, shear * diagonal / (2.0 * grid.dx * grid.dy), is_stable};
}

void add_links(const Grid& grid, const LinkStiffness& k, Array<Spring>& springs) {
  const float across = float(std::sqrt(grid.dx * grid.dx + grid.dy * grid.dy));
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const bool more_x = i + 1 < grid.columns, more_y = j + 1 < grid.rows;
      if (more_x) {
        springs.push_back(
            {grid.at(i, j), grid.at(i + 1, j), float(grid.dx), float(k.x * grid.row_share(j) / grid.dx)});
      }
      if (more_y) {
        springs.push_back(
            {grid.at(i, j), grid.at(i, j + 1), float(grid.dy), float(k.y * grid.column_share(i) / grid.dy)});
      }
      if (more_x && more_y && k.across > 0.0) {
        springs.push_back({grid.at(i, j), grid.at(i + 1, j + 1), across, float(k.across)});
        springs.push_back({grid.at(i + 1, j), grid.at(i, j + 1), across, float(k.across)});
      }
    }
  }
}

// Two triangles a cell, cut along alternating diagonals.
void add_sheet(const Grid& grid, Array<SheetTriangle>& triangles) {
  const auto corner = [&](SheetTriangle& one, int k, int i, int j) {
    one.corner[k] = grid.at(i, j);
    one.place[k][0] = i * grid.dx;
    one.place[k][1] = j * grid.dy;
  };
  for (int j = 0; j + 1 < grid.rows; ++j) {
    for (int i = 0; i + 1 < grid.columns; ++i) {
      const int turn = (i + j) % 2;
      SheetTriangle low, high;
      corner(low, 0, i, j), corner(low, 1, i + 1, j), corner(low, 2, turn == 0 ? i + 1 : i, j + 1);
      corner(high, 0, turn == 0 ? i : i + 1, j), corner(high, 1, i + 1, j + 1), corner(high, 2, i, j + 1);
      triangles.push_back(low);
      triangles.push_back(high);
    }
  }
}

void set_membrane(SoftBody& body, std::span<const SheetTriangle> triangles, double stretch,
                  double contraction, double shear) {
  body.continuum = make_membrane(triangles, body.particles.count);
  body.continuum.material.stretch = float(stretch);
  body.continuum.material.contraction = float(contraction);
  body.continuum.material.shear = float(shear);
}

void add_plate(const Grid& grid, double stiffness, Array<MatrixEntry>& entries) {
  constexpr double kBent[3] = {1.0, -2.0, 1.0}, kTwisted[4] = {1.0, -1.0, -1.0, 1.0};
  const double x = stiffness / (grid.dx * grid.dx * grid.dx), y = stiffness / (grid.dy * grid.dy * grid.dy);
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      if (i + 2 < grid.columns) {
        const std::uint32_t line[3] = {grid.at(i, j), grid.at(i + 1, j), grid.at(i + 2, j)};
        add_quadratic(entries, line, kBent, x * grid.row_share(j));
      }
      if (j + 2 < grid.rows) {
        const std::uint32_t line[3] = {grid.at(i, j), grid.at(i, j + 1), grid.at(i, j + 2)};
        add_quadratic(entries, line, kBent, y * grid.column_share(i));
      }
      if (i + 1 < grid.columns && j + 1 < grid.rows) {
        const std::uint32_t cell[4] = {grid.at(i, j), grid.at(i + 1, j), grid.at(i, j + 1),
                                       grid.at(i + 1, j + 1)};
        add_quadratic(entries, cell, kTwisted, 2.0 * stiffness / (grid.dx * grid.dy));
      }
    }
  }
}

}  // namespace

Array<DVec3> grid_places(const float (&size)[2], const int (&cells)[2], const Pose& pose) {
  const double dx = double(size[0]) / cells[0], dy = double(size[1]) / cells[1];
  Array<DVec3> places;
  for (int j = 0; j <= cells[1]; ++j) {
    for (int i = 0; i <= cells[0]; ++i) {
      const DVec3 local{i * dx - 0.5 * double(size[0]), 0.0, j * dy - 0.5 * double(size[1])};
      places.push_back(pose.position + rotate(to_double(pose.orientation), local));
    }
  }
  return places;
}

SoftBody grid_cloth(const float (&size)[2], const int (&cells)[2], const Pose& pose,
                    const ClothMaterial& material) {
  const Grid grid{cells[0] + 1, cells[1] + 1, double(size[0]) / cells[0], double(size[1]) / cells[1]};
  SoftBody body;
  body.damping = material.damping;
  Particles& particles = body.particles;
  particles.resize(grid.columns * grid.rows);
  const Array<DVec3> places = grid_places(size, cells, pose);
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const int particle = int(grid.at(i, j));
      particles.set_place(particle, places[particle]);
      particles.mass[particle] =
          float(double(material.area_density) * grid.column_share(i) * grid.row_share(j));
    }
  }
  if (material.links == ClothLinks::membrane) {
    Array<SheetTriangle> triangles;
    add_sheet(grid, triangles);
    set_membrane(body, triangles, double(material.stretch_stiffness), 0.0, double(material.shear_stiffness));
  } else {
    const double stretch = double(material.stretch_stiffness), shear = double(material.shear_stiffness);
    LinkStiffness k = link_stiffness(grid, material);
    if (!k.is_stable && !material.is_visual) {
      Array<SheetTriangle> triangles;
      add_sheet(grid, triangles);
      set_membrane(body, triangles, 0.0, 0.0, shear);
      k = {stretch, stretch, 0.0, true};
    }
    Array<Spring> springs;
    add_links(grid, k, springs);
    set_springs(body, springs);
  }
  if (material.bend_stiffness > 0.0f) {
    Array<MatrixEntry> entries;
    add_plate(grid, double(material.bend_stiffness), entries);
    set_bending(body, entries);
  }
  return body;
}

namespace {

// One side of an edge of a mesh.
struct MeshSide {
  std::uint64_t key;               // of its two particles
  std::uint32_t triangle, corner;  // the corner it does not have
};

// Where the corners of a triangle lie in its own plane, the first at the origin and the second along the first axis.
SheetTriangle flatten(std::span<const DVec3> places, const std::uint32_t* corner) {
  const DVec3 first = places[corner[1]] - places[corner[0]], second = places[corner[2]] - places[corner[0]];
  const double along = length(first), x = along > 0.0 ? dot(first, second) / along : 0.0;
  const double y = along > 0.0 ? length(cross(first, second)) / along : 0.0;
  return {{corner[0], corner[1], corner[2]}, {{0.0, 0.0}, {along, 0.0}, {x, y}}};
}

double area_of(const SheetTriangle& one) { return 0.5 * one.place[1][0] * one.place[2][1]; }

// The slope outward across the edge opposite `corner`, times the length of the edge, of the linear function with these values: its
// coefficients, which are cotangents of the two angles at the edge.
void outward_slope(const SheetTriangle& one, int corner, double (&coefficient)[3]) {
  const int a = (corner + 1) % 3, b = (corner + 2) % 3;
  const auto cotangent = [&](int at, int other) {
    const double ux = one.place[other][0] - one.place[at][0], uy = one.place[other][1] - one.place[at][1];
    const double vx = one.place[corner][0] - one.place[at][0], vy = one.place[corner][1] - one.place[at][1];
    return (ux * vx + uy * vy) / (2.0 * area_of(one));
  };
  coefficient[a] = cotangent(b, a);
  coefficient[b] = cotangent(a, b);
  coefficient[corner] = -coefficient[a] - coefficient[b];
}

// |e| b_e of the edge opposite `corner`, as a sum over the particles of both triangles.
struct EdgeBend {
  std::uint32_t particle[6];
  double coefficient[6];
  double share = 0.0;  // w_e of the first triangle; 0 at the border
};

class MeshPlate {
 public:
  MeshPlate(std::span<const SheetTriangle> triangles, double stiffness)
      : triangles_(triangles), stiffness_(stiffness) {
    Array<MeshSide> scratch;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      for (std::uint32_t c = 0; c < 3; ++c) {
        const std::uint64_t a = triangles[t].corner[(c + 1) % 3], b = triangles[t].corner[(c + 2) % 3];
        sides_.push_back({min(a, b) << 32 | max(a, b), t, c});
      }
    }
    scratch.resize(sides_.size());
    merge_sort(sides_.view(), scratch.view(),
               [](const MeshSide& a, const MeshSide& b) { return a.key < b.key; });
  }

  void add(Array<MatrixEntry>& entries) const {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) add_triangle(t, entries);
  }

 private:
  // The side of the triangle on the other side; null at the border.
  const MeshSide* across(std::uint32_t triangle, std::uint32_t corner) const {
    const std::uint64_t a = triangles_[triangle].corner[(corner + 1) % 3],
                        b = triangles_[triangle].corner[(corner + 2) % 3];
    const std::uint64_t key = min(a, b) << 32 | max(a, b);
    std::size_t low = 0, high = sides_.size();
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (sides_[middle].key < key ? low : high) = middle;
    }
    for (std::size_t k = low; k < sides_.size() && sides_[k].key <= key; ++k) {
      if (sides_[k].key == key && sides_[k].triangle != triangle) return &sides_[k];
    }
    return nullptr;
  }

  EdgeBend bend_of(std::uint32_t t, std::uint32_t corner) const {
    EdgeBend bend{};
    const MeshSide* const other = across(t, corner);
    if (other == nullptr) return bend;
    double coefficient[3];
    const SheetTriangle& here = triangles_[t];
    const SheetTriangle& there = triangles_[other->triangle];
    outward_slope(here, int(corner), coefficient);
    for (int k = 0; k < 3; ++k) bend.particle[k] = here.corner[k], bend.coefficient[k] = coefficient[k];
    outward_slope(there, int(other->corner), coefficient);
    for (int k = 0; k < 3; ++k)
      bend.particle[3 + k] = there.corner[k], bend.coefficient[3 + k] = coefficient[k];
    bend.share = area_of(here) / (area_of(here) + area_of(there));
    return bend;
  }

  void add_triangle(std::uint32_t t, Array<MatrixEntry>& entries) const {
    const SheetTriangle& one = triangles_[t];
    const double area = area_of(one);
    std::uint32_t particle[18];
    double curvature[3][18];  // xx, yy, xy
    int count = 0;
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      const EdgeBend bend = bend_of(t, corner);
      if (bend.share == 0.0) continue;
      const double* const a = one.place[(corner + 1) % 3];
      const double* const b = one.place[(corner + 2) % 3];
      const double x = b[1] - a[1], y = a[0] - b[0], square = x * x + y * y;
      const double weight = bend.share / (area * square);
      for (int k = 0; k < 6; ++k) {
        particle[count] = bend.particle[k];
        curvature[0][count] = weight * x * x * bend.coefficient[k];
        curvature[1][count] = weight * y * y * bend.coefficient[k];
        curvature[2][count] = weight * x * y * bend.coefficient[k];
        ++count;
      }
    }
    const std::span<const std::uint32_t> particles(particle, std::size_t(count));
    for (int part = 0; part < 3; ++part) {
      add_quadratic(entries, particles, {curvature[part], std::size_t(count)},
                    (part == 2 ? 2.0 : 1.0) * stiffness_ * area);
    }
  }

  std::span<const SheetTriangle> triangles_;
  double stiffness_;
  Array<MeshSide> sides_;
};

// k A / |e|^2 along each edge, A of the triangles on both sides.
void add_edge_springs(std::span<const DVec3> places, std::span<const SheetTriangle> triangles,
                      double stiffness, Array<Spring>& springs) {
  for (const SheetTriangle& one : triangles) {
    for (int c = 0; c < 3; ++c) {
      const std::uint32_t a = one.corner[c], b = one.corner[(c + 1) % 3];
      const double span = length(places[b] - places[a]);
      springs.push_back({a, b, float(span), float(stiffness * area_of(one) / (span * span))});
    }
  }
}

}  // namespace

SoftBody mesh_cloth(std::span<const DVec3> places, std::span<const std::uint32_t> triangles,
                    const ClothMaterial& material) {
  SoftBody body;
  body.damping = material.damping;
  Particles& particles = body.particles;
  particles.resize(int(places.size()));
  for (int i = 0; i < particles.count; ++i) particles.set_place(i, places[std::size_t(i)]);
  Array<SheetTriangle> sheet;
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    sheet.push_back(flatten(places, &triangles[t]));
    for (const std::uint32_t corner : sheet.back().corner) {
      particles.mass[corner] += material.area_density * float(area_of(sheet.back()) / 3.0);
    }
  }
  const double stretch = double(material.stretch_stiffness), shear = double(material.shear_stiffness);
  if (material.links == ClothLinks::membrane) {
    const double ratio = 0.5 * stretch / shear - 1.0, c = stretch / (1.0 - ratio * ratio);
    set_membrane(body, sheet, c, ratio * c, shear);
  } else {
    Array<Spring> springs;
    add_edge_springs(places, sheet, stretch, springs);
    set_springs(body, springs);
  }
  if (material.bend_stiffness > 0.0f) {
    Array<MatrixEntry> entries;
    MeshPlate(sheet, double(material.bend_stiffness)).add(entries);
    set_bending(body, entries);
  }
  return body;
}

}  // namespace gyre
