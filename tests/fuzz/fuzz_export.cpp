// The writers of glTF, USD and VTK on any scene that can be read. A glTF file of a scene reads back as the same scene: after a step it has the same
// hash.
#include "formats/export.h"
#include "formats/import.h"
#include "formats/vtk_writer.h"
#include "scene/scene_reader.h"
#include "scene/scene_runner.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace {

// Limits of inputs that take long to make a world of, and of decompositions, which the writers get split.
bool is_small(const gyre::Scene& scene) {
  for (const gyre::SceneBody& body : scene.bodies) {
    for (const gyre::SceneShape& shape : body.shapes) {
      if (std::holds_alternative<gyre::SceneDecomposition>(shape.geometry)) return false;
    }
  }
  return scene.bodies.size() <= 50;
}

std::optional<gyre::SceneRunner> runner_of(const gyre::Scene& scene) {
  gyre::SceneResult<gyre::SceneRunner> made = gyre::SceneRunner::create(scene, "scene");
  return made ? std::optional<gyre::SceneRunner>(*std::move(made)) : std::nullopt;
}

// A mesh that glTF holds once for two equal hulls may have the points of either, which differ in roundings. A centre of mass that is a million
// metres away makes these large.
bool is_sane(const gyre::Scene& scene) {
  for (const gyre::SceneBody& body : scene.bodies) {
    if (body.def.center_of_mass && gyre::length(*body.def.center_of_mass) > 1.0e6f) return false;
  }
  return true;
}

// The scene as it comes back from glTF.
std::optional<gyre::Scene> read_back(const gyre::Scene& scene, bool binary) {
  const gyre::SceneResult<gyre::ExportedFile> file = gyre::export_gltf(scene, "scene", binary);
  if (!file) return std::nullopt;  // refused in words
  gyre::ImportOptions closed;
  closed.open_files = false;
  gyre::SceneResult<gyre::Scene> again =
      gyre::import_scene(file->bytes, gyre::FileFormat::gltf, "scene", closed);
  if (!again) std::abort();
  return *std::move(again);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gyre::ReadOptions options;
  options.limits.values = 20'000;
  options.limits.vertices = options.limits.triangles = options.limits.soft_vertices = 2'000;
  options.limits.fluid_cells = 2'000;
  const gyre::SceneResult<gyre::Scene> scene =
      gyre::read_scene(std::string_view(reinterpret_cast<const char*>(data), size), options);
  if (!scene || !is_small(*scene)) return 0;
  const std::optional<gyre::Scene> text = read_back(*scene, false), binary = read_back(*scene, true);
  if (text.has_value() != binary.has_value()) std::abort();
  (void)gyre::export_usd(*scene, "scene");
  std::optional<gyre::SceneRunner> runner = runner_of(*scene);
  if (!runner) return 0;
  gyre::VtkSeries series;
  (void)series.add_state(*runner);
  const bool steps = runner->step();
  if (steps) (void)series.add_state(*runner);
  (void)series.collection("run");
  for (const std::optional<gyre::Scene>* again : {&text, &binary}) {
    if (!*again) continue;
    std::optional<gyre::SceneRunner> other = runner_of(**again);
    if (!other || other->step() != steps) std::abort();
    if (steps && is_sane(*scene) && other->world().hash() != runner->world().hash()) std::abort();
  }
  return 0;
}
