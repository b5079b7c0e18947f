// Gases and liquids as things to draw. See fluid_draw.h.
#include "render/fluid_draw.h"

#include <algorithm>

namespace gyre {
namespace {

using Rgb3 = std::array<float, 3>;  // sRGB, 0 to 255

Rgb3 mix(Rgb3 a, Rgb3 b, float part) {
  for (std::size_t k = 0; k < 3; ++k) a[k] += part * (b[k] - a[k]);
  return a;
}

// From still (blue) to fast (red).
Rgb3 speed_color(float part) {
  constexpr Rgb3 kStops[] = {{24, 40, 110}, {36, 130, 178}, {122, 184, 120}, {230, 196, 72}, {214, 58, 38}};
  const float at = 4.0f * part;
  const int stop = std::min(int(at), 3);
  return mix(kStops[stop], kStops[stop + 1], at - float(stop));
}

Rgb3 voxel_color(const SeenFluid& fluid, const Voxel& voxel) {
  constexpr Rgb3 kClear{28, 36, 48}, kHot{255, 128, 40};
  if (!fluid.smoky) return speed_color(float(voxel.speed) / 255.0f);
  const Rgb3 smoke{float(fluid.color.red), float(fluid.color.green), float(fluid.color.blue)};
  return mix(mix(kClear, smoke, float(voxel.smoke) / 255.0f), kHot, 0.7f * float(voxel.heat) / 255.0f);
}

// A vertex at the centre of each cell, those at the sides moved to the side.
void add_picture(const SeenFluid& fluid, const Subject& subject, DrawList& list) {
  const auto across = std::size_t(fluid.flat_axis());
  const std::size_t a = across == 0 ? 1 : 0, b = across == 2 ? 1 : 2;
  const int columns = fluid.cells[a], rows = fluid.cells[b];
  const auto first = std::uint32_t(list.vertices.size());
  const Vec3 lower = difference(fluid.lower, subject.origin);
  const auto place = [](int index, int count) {
    return index == 0 ? 0.0f : index == count - 1 ? float(count) : float(index) + 0.5f;
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      float along[3];
      along[across] = 0.5f;
      along[a] = place(column, columns);
      along[b] = place(row, rows);
      const Voxel& voxel = fluid.voxels[std::size_t(column) + std::size_t(columns) * std::size_t(row)];
      const Rgb3 color = voxel_color(fluid, voxel);
      const Vec3 in_box = multiply_each(fluid.cell, Vec3{along[0], along[1], along[2]});
      list.vertices.push_back({fluid.pose == Pose{}
                                   ? lower + in_box
                                   : difference(fluid.pose * (to_float(fluid.lower) + in_box), subject.origin),
                               {0, 0, 1},
                               {std::uint8_t(color[0]), std::uint8_t(color[1]), std::uint8_t(color[2])},
                               Paint::picture});
    }
  }
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      const std::uint32_t p = first + std::uint32_t(column + columns * row), q = p + 1;
      const std::uint32_t r = p + std::uint32_t(columns), s = r + 1;
      list.shadowless.insert(list.shadowless.end(), {p, q, s, p, s, r});
    }
  }
}

void add_smoke(const SeenFluid& fluid, const Subject& subject, DrawList& list) {
  constexpr float kThickness = 14.0f;  // optical thickness of the thickest smoke along the shortest side
  SmokeVolume volume;
  volume.box = {difference(fluid.lower, subject.origin), difference(fluid.upper(), subject.origin)};
  const Vec3 size = volume.box.high - volume.box.low;
  volume.cells = fluid.cells;
  volume.voxels = fluid.voxels;
  volume.color = fluid.color;
  volume.extinction = kThickness / min(size.x, min(size.y, size.z));
  list.smoke.push_back(std::move(volume));
}

void add_water(const SeenFluid& fluid, const Subject& subject, DrawList& list) {
  const auto first = std::uint32_t(list.vertices.size());
  const SceneColor color = fluid.color;
  std::vector<Vec3> normals(fluid.vertices.size());
  for (std::size_t t = 0; t + 2 < fluid.indices.size(); t += 3) {
    const std::uint32_t a = fluid.indices[t], b = fluid.indices[t + 1], c = fluid.indices[t + 2];
    const Vec3 area = cross(fluid.vertices[b] - fluid.vertices[a], fluid.vertices[c] - fluid.vertices[a]);
    for (const std::uint32_t vertex : {a, b, c}) normals[vertex] = normals[vertex] + area;
  }
  for (std::size_t i = 0; i < fluid.vertices.size(); ++i) {
    const Vec3 v = fluid.vertices[i];
    list.vertices.push_back({difference(DVec3{v.x, v.y, v.z}, subject.origin),
                             normalized(normals[i], Vec3{0, 1, 0}),
                             {color.red, color.green, color.blue},
                             Paint::water});
  }
  for (const std::uint32_t index : fluid.indices) list.shadowless.push_back(first + index);
}

}  // namespace

void add_fluid(const SeenFluid& fluid, const Subject& subject, DrawList& list) {
  if (fluid.kind == FluidKind::liquid) {
    add_water(fluid, subject, list);
  } else if (fluid.flat_axis() >= 0) {
    add_picture(fluid, subject, list);
  } else if (fluid.smoky) {
    add_smoke(fluid, subject, list);
  }
}

}  // namespace gyre
