// The scene reader and writer against any bytes. No file is opened. What can be read can be written, and what was written
// reads back to the same text.
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
  gyre::ReadOptions options;
  options.limits.values = 100'000;
  options.limits.fluid_cells = 10'000;  // a state that names no numbers is written with all of them
  const gyre::SceneResult<gyre::Scene> scene = gyre::read_scene(text, options);
  if (!scene) {
    if (scene.error().text().find('\n') != std::string::npos) std::abort();
  } else {
    const std::string once = gyre::write_scene(*scene);
    const gyre::SceneResult<gyre::Scene> again = gyre::read_scene(once);
    if (!again || gyre::write_scene(*again) != once) std::abort();
  }
  (void)gyre::parse_obj(text, "mesh.obj", options.limits);
  (void)gyre::refuse_mesh_path(text);
  return 0;
}
