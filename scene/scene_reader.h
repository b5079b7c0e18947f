// Scene files to scenes. Whatever the bytes are, the answer is a scene in which every name is resolved and every number is
// finite and in range, or an error that names file, place, what was found and what was expected.
#pragma once

#include "scene/scene.h"
#include "scene/scene_error.h"
#include "scene/scene_limits.h"

#include <map>
#include <string>
#include <string_view>

namespace gyre {

struct ReadOptions {
  std::string file = "scene";  // named in errors
  bool mesh_files = false;     // whether files may be opened
  std::string folder;          // where mesh files are looked for; empty: the current one
  // Bytes of mesh files by the name that the scene gives them, used before anything is opened: for where there is no disk.
  std::map<std::string, std::string, std::less<>> files;
  SceneLimits limits;
};

SceneResult<Scene> read_scene(std::string_view text, const ReadOptions& options = {}) noexcept;

// The same for a file; mesh files are looked for beside it.
SceneResult<Scene> load_scene(const std::string& path, const SceneLimits& limits = {}) noexcept;

}  // namespace gyre
