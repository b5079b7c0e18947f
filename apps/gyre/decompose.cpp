// gyre decompose: a mesh file to convex hulls, with what they are like.
#include "commands.h"
#include "complain.h"
#include "exit_code.h"
#include "interrupt.h"
#include "option_checks.h"
#include "output_file.h"
#include "progress.h"
#include "scene/decomposition_folder.h"
#include "scene/json_writer.h"
#include "scene/mesh_file.h"
#include "scene/number_text.h"

#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdio>
#include <memory>
#include <string>

namespace gyre {
namespace {

struct DecomposeOptions {
  std::string mesh, out;
  DecompositionDef def;
  std::string meaning = "automatic";
  std::string cache = default_decomposition_folder();
  bool no_cache = false, json = false, quiet = false;
};

// Wavefront OBJ, one object for each hull.
std::string to_obj(const Decomposition& made) {
  std::string out = "# " + std::to_string(made.hulls.size()) + " convex hulls\n";
  std::size_t base = 1;
  for (std::size_t i = 0; i < made.hulls.size(); ++i) {
    const HullView hull = view_hull(made.hulls[i]);
    out += "o hull_" + std::to_string(i) + "\n";
    for (const Vec3& v : hull.vertices) {
      char line[96];
      std::snprintf(line, sizeof line, "v %.9g %.9g %.9g\n", double(v.x), double(v.y), double(v.z));
      out += line;
    }
    for (std::size_t f = 0; f + 1 < hull.face_offsets.size(); ++f) {
      out += "f";
      for (std::uint32_t k = hull.face_offsets[f]; k < hull.face_offsets[f + 1]; ++k)
        out += " " + std::to_string(base + hull.face_indices[k]);
      out += "\n";
    }
    base += hull.vertices.size();
  }
  return out;
}

struct Run {
  Decomposition made;
  double seconds = 0.0;
  bool cached = false;
  std::size_t triangles = 0, vertices = 0;

  std::size_t hull_vertices() const {
    std::size_t sum = 0;
    for (const Geometry& hull : made.hulls) sum += view_hull(hull).vertices.size();
    return sum;
  }
};

void print_text(const Run& run) {
  const DecompositionStats& r = run.made.stats;
  const auto share = [&](float length) {
    return rounded(double(length)) + " m (" + rounded(double(length) / double(r.size)) + " of the size)";
  };
  std::string out = std::to_string(run.made.hulls.size()) + " hulls, " + std::to_string(run.hull_vertices()) +
                    " vertices, of " + std::to_string(run.triangles) + " triangles, in " +
                    rounded(run.seconds) + " s" + (run.cached ? " from the cache\n" : "\n");
  out += "size       " + rounded(double(r.size)) + " m, diameter of the smallest sphere around\n";
  out += "overhang   " + share(r.overhang) + ", at most " + rounded(double(r.overhang_bound)) +
         " m: hull beyond the solid\n";
  out += "depth      " + share(r.depth) + ": surface below a hull\n";
  out += "uncovered  " + share(r.uncovered) + ": surface outside of all hulls\n";
  out += "volume     " + rounded(r.solid_volume) + " m^3 of the solid, " + rounded(r.hull_volume) +
         " m^3 of the hulls: " + rounded(r.excess_volume) + " m^3 too much, " + rounded(r.missing_volume) +
         " m^3 missing\n";
  const std::string findings = describe_findings(r);
  if (!findings.empty()) out += "note       " + findings + "\n";
  std::fwrite(out.data(), 1, out.size(), stdout);
}

void print_json(const Run& run) {
  const DecompositionStats& r = run.made.stats;
  JsonWriter json;
  json.begin_object();
  json.field("hulls", std::int64_t(run.made.hulls.size()));
  json.field("hull_vertices", std::int64_t(run.hull_vertices()));
  json.field("triangles", std::int64_t(run.triangles));
  json.field("seconds", run.seconds);
  json.field("cached", run.cached);
  json.field("size", r.size);
  json.field("overhang", r.overhang);
  json.field("overhang_bound", r.overhang_bound);
  json.field("depth", r.depth);
  json.field("uncovered", r.uncovered);
  json.field("solid_volume", r.solid_volume);
  json.field("hull_volume", r.hull_volume);
  json.field("excess_volume", r.excess_volume);
  json.field("missing_volume", r.missing_volume);
  json.field("within_concavity", r.within_concavity);
  json.field("shell_thickness", r.shell_thickness);
  json.key("mesh").begin_object();
  json.field("open_edges", std::int64_t(r.mesh.open_edges));
  json.field("crowded_edges", std::int64_t(r.mesh.non_manifold_edges));
  json.field("turned_triangles", std::int64_t(r.mesh.flipped_triangles));
  json.field("left_out_triangles", std::int64_t(r.mesh.degenerate_triangles));
  json.field("openness", r.mesh.openness);
  json.field("shell", r.mesh.shell);
  json.end_object();
  json.end_object();
  const std::string text = json.take();
  std::fwrite(text.data(), 1, text.size(), stdout);
}

constexpr std::uint64_t kTicks = 1000;

bool show_progress(void* user, float done) {
  static_cast<Progress*>(user)->show(std::uint64_t(done * float(kTicks)));
  return !interrupted();
}

int run_decompose(const DecomposeOptions& options) {
  std::string bytes;
  const std::string problem = read_whole_file(options.mesh, {}, bytes);
  if (!problem.empty()) return complain(options.mesh + ": " + problem);
  const SceneResult<MeshData> mesh = parse_mesh(bytes, options.mesh, {});
  if (!mesh) return complain(mesh.error().text());
  OutputFile out;
  if (!options.out.empty() && !out.open(options.out)) return complain(out.message());

  watch_interrupt();
  Progress progress(!options.quiet, kTicks, "permille");
  DecompositionFolder folder(options.no_cache ? std::string() : options.cache);
  DecompositionDef def = options.def;
  def.vertices = mesh->vertices;
  def.indices = mesh->indices;
  def.meaning = options.meaning == "solid"   ? SurfaceMeaning::solid
                : options.meaning == "shell" ? SurfaceMeaning::shell
                                             : SurfaceMeaning::automatic;
  def.progress = show_progress;
  def.user = &progress;
  SplitOptions split;
  split.store = &folder;
  Run run;
  const auto start = std::chrono::steady_clock::now();
  Result<Decomposition> made = decompose_stored(def, split, &run.cached);
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  progress.clear();
  if (!made && made.error().code == ErrorCode::cancelled) return complain("interrupted", kExitInterrupted);
  if (!made && made.error().code == ErrorCode::invalid_argument)
    return complain(made.error().message, kExitUsage);
  if (!made) return complain(options.mesh + ": " + made.error().message);
  if (folder.failed()) std::fprintf(stderr, "gyre: the result cannot be kept in %s\n", options.cache.c_str());
  run.made = *std::move(made);
  run.triangles = mesh->indices.size() / 3;
  if (out.is_open() && !(out.write(to_obj(run.made)) && out.commit())) return complain(out.message());
  if (options.json) {
    print_json(run);
  } else if (!options.quiet) {
    print_text(run);
  }
  return kExitGood;
}

}  // namespace

void add_decompose(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("decompose", "Cut a concave mesh into convex hulls, and say how near they come");
  const auto options = std::make_shared<DecomposeOptions>();
  options->def.threads = 0;
  command->add_option("MESH", options->mesh, "The mesh (Wavefront OBJ, STL or PLY)")
      ->required()
      ->type_name("");
  command->add_option("--out", options->out, "Write the hulls, one object each")->type_name("FILE.obj");
  command
      ->add_option(
          "--concavity", options->def.concavity,
          "How far hulls may reach beyond the solid, as a part of its size: 0.001 to 1; 0.02 if not given")
      ->type_name("X");
  command
      ->add_option("--max-hulls", options->def.max_hulls, "At most so many hulls, 1 to 1024; 32 if not given")
      ->type_name("N");
  command
      ->add_option("--max-hull-vertices", options->def.max_hull_vertices,
                   "At most so many vertices each, 8 to 255; 128 if not given")
      ->type_name("N");
  take_one_of(
      command->add_option("--meaning", options->meaning, "What the triangles are: automatic, solid or shell")
          ->type_name("WORD"),
      {"automatic", "solid", "shell"});
  command
      ->add_option("--shell-thickness", options->def.shell_thickness,
                   "Thickness of a shell in m; 0: half of what --concavity allows")
      ->type_name("M");
  add_threads_option(*command, options->def.threads,
                     "Threads; 0 = all cores, as if not given; never changes the result");
  command
      ->add_option("--cache", options->cache,
                   "Where results are kept; $GYRE_CACHE or ~/.cache/gyre if not given")
      ->type_name("FOLDER");
  command->add_flag("--no-cache", options->no_cache, "Neither look for a kept result nor keep this one");
  command->add_flag("--json", options->json, "Print what was measured as JSON");
  command->add_flag("--quiet", options->quiet, "Print nothing and show no progress");
  command->callback([options, &exit_code] { exit_code = run_decompose(*options); });
}

}  // namespace gyre
