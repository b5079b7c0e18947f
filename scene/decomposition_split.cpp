// See decomposition_split.h.
#include "scene/decomposition_split.h"

#include "scene/number_text.h"

#include <map>
#include <utility>

namespace gyre {
namespace {

struct Split {
  Decomposition made;
  float density_scale = 1.0f;
};

std::string in_words(double value) {
  std::string out;
  append_rounded(out, value, 3);
  return out;
}

DecompositionDef def_of(const Scene& scene, const SceneDecomposition& shape, const SplitOptions& options) {
  const SceneMesh& mesh = scene.meshes[std::size_t(shape.mesh)];
  DecompositionDef def;
  def.vertices = mesh.vertices;
  def.indices = mesh.indices;
  def.concavity = shape.concavity;
  def.max_hulls = shape.max_hulls;
  def.max_hull_vertices = shape.max_hull_vertices;
  def.meaning = shape.meaning;
  def.shell_thickness = shape.shell_thickness;
  def.threads = options.threads;
  def.progress = options.progress;
  def.user = options.user;
  return def;
}

// What the hulls' densities are multiplied by, so that together they weigh what the solid does.
float scale_of(const Decomposition& made) {
  double sum = 0.0;
  for (const Geometry& hull : made.hulls) {
    const Result<MassProperties> mass = mass_properties(hull, 1.0f);
    if (mass) sum += double(mass->mass);
  }
  const double wanted = made.stats.solid_volume;
  return sum > 0.0 && wanted > 0.0 ? float(wanted / sum) : 1.0f;
}

}  // namespace

Result<Decomposition> decompose_stored(DecompositionDef def, const SplitOptions& options, bool* cached) {
  const std::uint64_t key = decomposition_key(def);
  std::vector<std::byte> bytes;
  if (cached != nullptr) *cached = false;
  if (options.store != nullptr && options.store->load(key, bytes)) {
    Result<Decomposition> kept = load_decomposition(bytes, key);
    if (cached != nullptr) *cached = kept.has_value();
    if (kept) return kept;
  }
  Result<Decomposition> made = decompose(def);
  if (made && options.store != nullptr) options.store->save(key, save_decomposition(*made, key));
  return made;
}

std::optional<SceneError> split_decompositions(Scene& scene, const std::string& file,
                                               const SplitOptions& options) {
  std::map<std::uint64_t, Split> splits;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    SceneBody& body = scene.bodies[b];
    std::vector<SceneShape> shapes;
    for (std::size_t s = 0; s < body.shapes.size(); ++s) {
      SceneShape& shape = body.shapes[s];
      const auto* const whole = std::get_if<SceneDecomposition>(&shape.geometry);
      if (whole == nullptr || whole->hull) {
        shapes.push_back(std::move(shape));
        continue;
      }
      const DecompositionDef def = def_of(scene, *whole, options);
      const std::uint64_t key = decomposition_key(def);
      if (splits.count(key) == 0) {
        Result<Decomposition> made = decompose_stored(def, options);
        if (!made) {
          return SceneError{file, 0, 0,
                            "/bodies/" + std::to_string(b) + "/shapes/" + std::to_string(s) + "/mesh",
                            made.error().message};
        }
        const std::string findings = describe_findings(made->stats);
        if (!findings.empty())
          scene.notes.push_back("mesh \"" + scene.meshes[std::size_t(whole->mesh)].name + "\": " + findings);
        Split& split = splits[key];
        split.density_scale = scale_of(*made);
        split.made = *std::move(made);
      }
      const Split& split = splits[key];
      for (std::size_t i = 0; i < split.made.hulls.size(); ++i) {
        SceneShape part = shape;
        auto& hull = std::get<SceneDecomposition>(part.geometry);
        hull.hull = split.made.hulls[i];
        hull.part = int(i);
        hull.density_scale = split.density_scale;
        shapes.push_back(std::move(part));
      }
    }
    body.shapes = std::move(shapes);
  }
  return std::nullopt;
}

std::string describe_findings(const DecompositionStats& report) {
  const MeshFindings& mesh = report.mesh;
  std::string out;
  const auto add = [&](const std::string& words) { out += (out.empty() ? "" : "; ") + words; };
  if (mesh.open_edges > 0) add(std::to_string(mesh.open_edges) + " open edges");
  if (mesh.non_manifold_edges > 0) add(std::to_string(mesh.non_manifold_edges) + " edges of more than two triangles");
  if (mesh.flipped_triangles > 0)
    add(std::to_string(mesh.flipped_triangles) + " triangles wound the wrong way were turned");
  if (mesh.degenerate_triangles > 0)
    add(std::to_string(mesh.degenerate_triangles) + " triangles without area were left out");
  if (mesh.shell) {
    add("taken for a sheet of " + in_words(double(report.shell_thickness)) + " m");
  } else if (mesh.open_edges > 0) {
    add("taken for a solid whose holes are closed");
  }
  if (!report.within_concavity) {
    add("the hulls are not as close as was asked for: they reach up to " + in_words(double(report.overhang)) +
        " m beyond the solid, and surface lies up to " + in_words(double(report.depth)) + " m deep in them");
  }
  return out;
}

}  // namespace gyre
