// Scenes to scene files. What equals its default is left out; numbers are the shortest that read back bit by bit, so that
// reading what was written gives the same scene, and writing that the same text.
#pragma once

#include "scene/scene.h"

#include <string>

namespace gyre {

struct WriteOptions {
  bool inline_meshes = false;  // write vertices and triangles even where the mesh came from a file
};

std::string write_scene(const Scene& scene, const WriteOptions& options = {});

}  // namespace gyre
