// Parts that the readers of other formats share: names, folders that may be read, findings, and a mesh table. Refusals are thrown as SceneError.
#pragma once

#include "formats/findings.h"
#include "formats/gltf_exact.h"
#include "formats/import.h"
#include "scene/mesh_file.h"

#include <map>
#include <set>
#include <string>
#include <utility>

namespace gyre {

struct Import {
  std::string_view bytes;
  std::string file;    // named in errors
  std::string folder;  // of the file
  const ImportOptions& options;
  Scene scene{};
  Findings findings{};
  std::set<std::string> body_names{}, joint_names{}, mesh_names{};
  std::map<std::string, int> meshes{};  // index in the scene by file and scale
  std::size_t mesh_bytes = 0;           // of all files that were read
  GltfExact exact{};                    // goes into the scene before it is checked

  [[noreturn]] void fail(std::string message, int line = 0) const;
  // The name itself if it is free, else with a number.
  static std::string unique(std::set<std::string>& names, std::string name, const char* otherwise);

  // Reads a file that the imported one names: relative to `base` (a folder), or package://NAME/PATH. Never outside the folders that the
  // options allow, never from a network.
  std::string read_file(const std::string& uri, const std::string& base, int line);
  // The index of a mesh file in the scene, scaled.
  int mesh_index(const std::string& uri, const std::string& base, Vec3 scale, int line);
  int add_mesh(MeshData mesh, const std::string& name);
  // A mesh on a moving body: one hull or several.
  SceneGeometry solid_mesh(int mesh, bool moving) const;
};

void read_urdf_or_mjcf(Import& import);
void read_gltf(Import& import);

SceneColor color_of(double red, double green, double blue);  // 0 to 1 each, sRGB

}  // namespace gyre
