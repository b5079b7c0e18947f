// gyre convert: files of other programs to scene files, and scenes and recordings to files of other programs.
#include "commands.h"
#include "exit_code.h"
#include "formats/export.h"
#include "import_options.h"
#include "output_file.h"
#include "scene/mesh_file.h"
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

int refuse(const std::string& why) {
  std::fprintf(stderr, "gyre: %s\n", why.c_str());
  return kExitInvalid;
}

bool has_ending(const std::string& path, const std::string& end) {
  if (path.size() < end.size()) return false;
  for (std::size_t i = 0; i < end.size(); ++i) {
    const char c = path[path.size() - end.size() + i];
    if ((c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c) != end[i]) return false;
  }
  return true;
}

int write_file(const std::string& path, const SceneResult<ExportedFile>& file) {
  if (!file) return refuse(file.error().text());
  for (const std::string& note : file->notes)
    std::fprintf(stderr, "gyre: %s: %s\n", path.c_str(), note.c_str());
  OutputFile out;
  if (!out.open(path) || !out.write(file->bytes) || !out.commit()) return refuse(out.message());
  return kExitGood;
}

SceneResult<ExportedFile> convert_recording(const ConvertOptions& options) {
  std::string text;
  SceneLimits limits;
  limits.file_bytes = std::size_t(4) << 30;
  const std::string problem = read_whole_file(options.in, limits, text);
  if (!problem.empty()) return SceneError{options.in, 0, 0, "", problem};
  const auto* const bytes = reinterpret_cast<const std::byte*>(text.data());
  Result<PoseTrack> track = PoseTrack::open(std::vector<std::byte>(bytes, bytes + text.size()));
  if (!track) return SceneError{options.in, 0, 0, "", track.error().message};
  const bool is_binary = has_ending(options.out, ".glb");
  if (!is_binary && !has_ending(options.out, ".gltf"))
    return SceneError{options.out, 0, 0, "", "a recording becomes a .glb or .gltf file"};
  return export_gltf(*track, options.in, is_binary);
}

int run_convert(const ConvertOptions& options) {
  if (has_ending(options.in, ".gyrec")) return write_file(options.out, convert_recording(options));
  const bool is_binary = has_ending(options.out, ".glb"),
             is_gltf = is_binary || has_ending(options.out, ".gltf");
  const bool is_usd = has_ending(options.out, ".usda");
  const SceneResult<Scene> scene = is_gltf || is_usd ? open_split_scene(options.in, options.import)
                                                     : open_scene(options.in, options.import);
  if (!scene) return refuse(scene.error().text());
  for (const std::string& note : scene->notes) std::fprintf(stderr, "gyre: %s\n", note.c_str());
  if (is_gltf) return write_file(options.out, export_gltf(*scene, options.in, is_binary));
  if (is_usd) return write_file(options.out, export_usd(*scene, options.in));
  ExportedFile text;
  text.bytes = write_scene(*scene, {.inline_meshes = true});
  return write_file(options.out, text);
}

}  // namespace

void add_convert(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "convert", "Write a robot (URDF, MJCF), a glTF file, a scene or a recording in another format");
  const auto options = std::make_shared<ConvertOptions>();
  command
      ->add_option("IN", options->in,
                   "The file: *.urdf, *.xml, *.mjcf, *.gltf, *.glb, a scene, or a recording (*.gyrec)")
      ->required()
      ->type_name("");
  command
      ->add_option("OUT", options->out,
                   "The result: a scene file (*.gyre.json), glTF (*.glb, *.gltf; of a recording an animated "
                   "one), or USD (*.usda)")
      ->required()
      ->type_name("");
  add_import_options(*command, options->import);
  command->callback([options, &exit_code] { exit_code = run_convert(*options); });
}

}  // namespace gyre
