// Gases and liquids as they are seen: smoke and heat of each cell in 8 bits, the speed of a flat gas, the surface of a liquid.
#pragma once

#include "scene/scene.h"

#include <gyre/fluid.h>
#include <gyre/world.h>

#include <array>
#include <cstdint>
#include <vector>

namespace gyre {

struct Voxel {
  std::uint8_t smoke = 0;  // 255: the thickest that its emitters and its beginning give
  std::uint8_t heat = 0;   // 255: the hottest, 0: the ambient temperature
  std::uint8_t light = 0;  // of the sun, 255: all of it; see smoke.h
  std::uint8_t speed = 0;  // of a flat gas without smoke and heat, 255: the fastest now
};

struct SeenFluid {
  FluidKind kind = FluidKind::gas;
  std::array<int, 3> cells{};
  DVec3 lower{};  // m, in the axes of `pose`
  Vec3 cell{};    // m, edges of a cell
  Pose pose{};    // of a flat gas; boxes of others stand upright in the world
  SceneColor color{};
  bool smoky = false;                    // there may be smoke or heat
  std::vector<Voxel> voxels{};           // of a gas, x fastest, then y, then z
  std::vector<Vec3> vertices{};          // of the surface of a liquid, m
  std::vector<std::uint32_t> indices{};  // three a triangle, counter-clockwise seen from outside

  DVec3 upper() const {
    return lower + Vec3{cell.x * float(cells[0]), cell.y * float(cells[1]), cell.z * float(cells[2])};
  }
  int flat_axis() const;  // the axis with one cell, -1 if there is none
};

// `scene` (may be null) tells colours, and what the thickest smoke and the highest temperature are.
std::vector<SeenFluid> look_at_fluids(const World& world, const Scene* scene);

}  // namespace gyre
