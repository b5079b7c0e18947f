// Smoke as a volume in pictures: how much light reaches each cell, and slices across the view.
#pragma once

#include "render/fluid_sight.h"

#include <gyre/geometry.h>
#include <gyre/math.h>

#include <array>
#include <vector>

namespace gyre {

struct SmokeVolume {
  Aabb box;  // relative to the origin of the picture
  std::array<int, 3> cells{};
  std::vector<Voxel> voxels{};
  SceneColor color{};
  float extinction = 0.0f;  // 1/m, of the thickest smoke
};

// Sets the light of all voxels: one sweep away from the sun, in which a cell gets the light of its neighbours towards the sun, each by how
// often a ray comes from there, less what the smoke of these takes. `sun`: unit, towards the sun.
void light_smoke(SmokeVolume& volume, Vec3 sun);

// Slices of the box across the view as triangles, three places each, from far to near (B. Cabral, N. Cam, J. Foran, "Accelerated volume
// rendering and tomographic reconstruction using texture mapping hardware", 1994).
struct SmokeSlices {
  std::vector<Vec3> triangles;
  float thickness = 0.0f;  // m, along the view
};
// `shift`, 0 to 1: where in its part of the depth each slice lies.
SmokeSlices cut_smoke(const Aabb& box, Vec3 eye, Vec3 forward, int slices, float shift);

}  // namespace gyre
