// gyre convert: a file of another program as a scene file.
#include "commands.h"
#include "exit_code.h"
#include "import_options.h"
#include "output_file.h"
#include "scene/scene_writer.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>
#include <string>

namespace gyre {
namespace {

struct ConvertOptions {
  std::string in, out;
  ImportOptions import;
};

int run_convert(const ConvertOptions& options) {
  const auto refuse = [](const std::string& why) {
    std::fprintf(stderr, "gyre: %s\n", why.c_str());
    return kExitInvalid;
  };
  const SceneResult<Scene> scene = open_scene(options.in, options.import);
  if (!scene) return refuse(scene.error().text());
  for (const std::string& note : scene->notes) std::fprintf(stderr, "gyre: %s\n", note.c_str());
  OutputFile out;
  if (!out.open(options.out) || !out.write(write_scene(*scene, {.inline_meshes = true})) || !out.commit())
    return refuse(out.message());
  return kExitGood;
}

}  // namespace

void add_convert(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("convert", "Write a robot (URDF, MJCF) or a glTF file as a scene file");
  const auto options = std::make_shared<ConvertOptions>();
  command->add_option("IN", options->in, "The file: *.urdf, *.xml, *.mjcf, *.gltf, *.glb or a scene")
      ->required()
      ->type_name("");
  command->add_option("OUT", options->out, "The scene file (*.gyre.json)")->required()->type_name("");
  add_import_options(*command, options->import);
  command->callback([options, &exit_code] { exit_code = run_convert(*options); });
}

}  // namespace gyre
