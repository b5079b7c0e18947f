// How much a scene may ask for. The defaults are far above any sensible scene and below what would exhaust a machine.
#pragma once

#include <cstddef>

namespace gyre {

struct SceneLimits {
  std::size_t file_bytes = std::size_t(256) << 20;  // of the scene and of each mesh file
  std::size_t values = 40'000'000;                  // JSON values in the scene
  int depth = 64;                                   // of arrays and objects within each other
  std::size_t bodies = 1'000'000;
  std::size_t shapes = 4'000'000;  // all bodies together
  std::size_t joints = 1'000'000;
  std::size_t triangles = 20'000'000;  // of one mesh
  std::size_t vertices = 20'000'000;   // of one mesh
  std::size_t soft_vertices = 8'000'000;  // of ropes, cloths and soft bodies, all together
  std::size_t fluid_cells = std::size_t(1) << 25;  // of gases and liquids, all together
  std::size_t name_bytes = 1024;
};

}  // namespace gyre
