// The readers of URDF, MJCF, glTF, STL and PLY against any bytes. No file is opened. A scene that is made can be written and read back.
#include "formats/import.h"
#include "scene/mesh_file.h"
#include "scene/scene_reader.h"
#include "scene/scene_writer.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  gyre::ImportOptions options;
  options.open_files = false;
  options.limits.values = 100'000;
  options.limits.vertices = options.limits.triangles = 100'000;
  for (const gyre::FileFormat format : {gyre::FileFormat::mjcf, gyre::FileFormat::gltf}) {
    const gyre::SceneResult<gyre::Scene> scene = gyre::import_scene(text, format, "file", options);
    if (!scene) {
      if (scene.error().text().find('\n') != std::string::npos) std::abort();
      continue;
    }
    const std::string once = gyre::write_scene(*scene);
    const gyre::SceneResult<gyre::Scene> again = gyre::read_scene(once);
    if (!again || gyre::write_scene(*again) != once) std::abort();
  }
  (void)gyre::parse_stl(text, "mesh.stl", options.limits);
  (void)gyre::parse_ply(text, "mesh.ply", options.limits);
  return 0;
}
