// Files of other programs to scenes: URDF and MJCF (robots), glTF 2.0 with its physics extensions.
//
// In: bytes and the folders that may be read. Out: a scene that has passed every check of the scene reader, or the error with file and
// place. Elements that the reader does not know, or the engine cannot simulate, are counted in the notes of the scene; strict refuses them.
#pragma once

#include "scene/decomposition_split.h"
#include "scene/scene.h"
#include "scene/scene_error.h"
#include "scene/scene_limits.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace gyre {

enum class FileFormat { scene, urdf, mjcf, gltf };

struct ImportOptions {
  bool strict = false;          // refuse a file with anything that would be left out
  bool free_base = false;       // URDF: the root link moves freely; otherwise the root is static
  bool keep_fixed = false;      // fixed joints stay joints; otherwise they make one body of two links
  bool self_collision = false;  // URDF: links of the robot collide with each other, neighbours excepted
  bool decompose =
      false;  // concave meshes of moving bodies become several hulls; otherwise each becomes one hull
  // Folders that may be read beside the folder of the file. NAME=FOLDER is the folder of the package NAME.
  std::vector<std::string> packages;
  bool open_files = true;  // false: only the bytes themselves are read, and those of `files`
  // Bytes of files by the name that the imported one gives them, used before anything is opened: for where there is no disk.
  std::map<std::string, std::string, std::less<>> files{};
  SceneLimits limits;
};

// By the end of the name: .urdf; .xml and .mjcf (the root element decides between URDF and MJCF); .gltf and .glb. All others are scenes.
FileFormat format_of(std::string_view path);
// The reason why this build cannot read the format; empty if it can.
std::string missing_format(FileFormat format);

SceneResult<Scene> import_scene(std::string_view bytes, FileFormat format, const std::string& path,
                                const ImportOptions& options = {}) noexcept;

// A file of any format, scenes included.
SceneResult<Scene> open_scene(const std::string& path, const ImportOptions& options = {}) noexcept;
// The same with convex decompositions split, as load_split_scene() does.
SceneResult<Scene> open_split_scene(const std::string& path, const ImportOptions& options = {},
                                    SplitOptions split = {});

}  // namespace gyre
