// gyre info: the content of a scene or recording, the mass properties of each body as the engine found them, and how tight bounding volumes of
// its meshes are.
#include "commands.h"
#include "exit_code.h"
#include "import_options.h"
#include "mesh_bounds.h"
#include "recording_file.h"
#include "scene/json_writer.h"
#include "scene/number_text.h"
#include "scene/scene_runner.h"

#include <CLI/CLI.hpp>

#include <array>
#include <cstdio>
#include <memory>
#include <string>

namespace gyre {
namespace {

// Without the sign of a zero, which says nothing about a mass.
Vec3 plain(Vec3 v) { return v + Vec3{}; }
Sym3 plain(const Sym3& m) { return m + Sym3{}; }
MassProperties plain(const MassProperties& mass) {
  return {mass.mass, plain(mass.center), plain(mass.inertia)};
}

struct Counts {
  std::array<int, 3> bodies{};  // by BodyType
  std::array<int, std::variant_size_v<SceneGeometry>> shapes{};
  std::array<int, kJointKindCount> joints{};  // by JointKind
};

constexpr const char* kBodyWords[] = {"static", "kinematic", "dynamic"};
constexpr const char* kShapeWords[] = {
    "sphere", "box",         "capsule", "cylinder",     "cone",
    "plane",  "convex_hull", "mesh",    "height_field", "convex_decomposition"};

std::array<const char*, kJointKindCount> joint_words() {
  std::array<const char*, kJointKindCount> words{};
  for (int kind = 0; kind < kJointKindCount; ++kind) words[std::size_t(kind)] = to_string(JointKind(kind));
  return words;
}

Counts count(const Scene& scene) {
  Counts out;
  for (const SceneBody& body : scene.bodies) {
    ++out.bodies[std::size_t(body.def.type)];
    for (const SceneShape& shape : body.shapes) {
      const auto* const hull = std::get_if<SceneDecomposition>(&shape.geometry);
      if (hull == nullptr || hull->part == 0) ++out.shapes[shape.geometry.index()];
    }
  }
  for (const SceneJoint& joint : scene.joints) ++out.joints[std::size_t(kind_of(joint.def))];
  return out;
}

template <class V>
std::string vector(const V& v) {
  return "(" + rounded(double(v[0])) + ", " + rounded(double(v[1])) + ", " + rounded(double(v[2])) + ")";
}

// "12: 3 box, 9 sphere".
template <std::size_t N>
std::string listed(const std::array<int, N>& counts, const char* const* words) {
  int total = 0;
  std::string parts;
  for (std::size_t i = 0; i < N; ++i) {
    total += counts[i];
    if (counts[i] > 0) parts += (parts.empty() ? ": " : ", ") + std::to_string(counts[i]) + " " + words[i];
  }
  return std::to_string(total) + parts;
}

std::string fluid_text(const SceneFluid& fluid, const FluidInfo& info) {
  std::string out = std::string("\n") + to_string(info.kind) + " \"" + fluid.name + "\", ";
  for (std::size_t axis = 0; axis < 3; ++axis)
    out += (axis > 0 ? " x " : "") + std::to_string(info.cells[axis]);
  out += " cells of " + vector(info.cell) + " m";
  if (info.kind == FluidKind::liquid)
    out += ", " + std::to_string(info.particles) + " particles, " + rounded(info.volume) + " m^3";
  return out + "\n";
}

void print_text(const SceneRunner& runner) {
  const Scene& scene = runner.scene();
  const Counts counts = count(scene);
  std::string out;
  if (!scene.name.empty()) out += scene.name + "\n";
  out += "bodies  " + listed(counts.bodies, kBodyWords) + "\n";
  out += "shapes  " + listed(counts.shapes, kShapeWords) + "\n";
  out += "joints  " + listed(counts.joints, joint_words().data()) + "\n";
  const std::size_t softs = scene.ropes.size() + scene.cloths.size() + scene.soft_bodies.size();
  if (softs > 0) {
    out += "soft    " + std::to_string(scene.ropes.size()) + " ropes, " +
           std::to_string(scene.cloths.size()) + " cloths, " + std::to_string(scene.soft_bodies.size()) +
           " soft bodies\n";
  }
  if (!scene.gases.empty() || !scene.liquids.empty()) {
    out += "fluids  " + std::to_string(scene.gases.size()) + " gases, " +
           std::to_string(scene.liquids.size()) + " liquids\n";
  }
  out += "step    " + rounded(scene.world.time_step) + " s in " + std::to_string(scene.world.substeps) +
         " sub-steps, gravity " + vector(scene.world.gravity) + " m/s^2\n";
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const SceneBody& body = scene.bodies[i];
    out += "\nbody \"" + body.name + "\", " + kBodyWords[std::size_t(body.def.type)] + ", " +
           std::to_string(body.shapes.size()) + (body.shapes.size() == 1 ? " shape\n" : " shapes\n");
    if (body.def.type != BodyType::dynamic) continue;
    const MassProperties mass = plain(runner.world().mass_properties(runner.bodies()[i]));
    const PrincipalAxes principal = principal_axes(mass.inertia);
    const Mat3 axes = to_matrix(principal.orientation);
    out += "  mass             " + rounded(double(mass.mass)) + " kg\n";
    out += "  centre of mass   " + vector(mass.center) + " m in the body, " +
           vector(runner.world().center_of_mass(runner.bodies()[i])) + " m in the world\n";
    out += "  inertia          xx " + rounded(double(mass.inertia.xx)) + ", yy " +
           rounded(double(mass.inertia.yy)) + ", zz " + rounded(double(mass.inertia.zz)) + ", xy " +
           rounded(double(mass.inertia.xy)) + ", xz " + rounded(double(mass.inertia.xz)) + ", yz " +
           rounded(double(mass.inertia.yz)) + " kg m^2\n";
    out += "  principal        " + vector(principal.moments) + " kg m^2 about " + vector(axes.x) + ", " +
           vector(axes.y) + ", " + vector(axes.z) + "\n";
  }
  runner.for_each_soft([&](const SceneSoft& soft, SoftId id) {
    const SoftInfo info = runner.world().soft_info(id);
    out += std::string("\n") + (info.kind == SoftKind::solid ? "soft body" : to_string(info.kind)) + " \"" +
           soft.name + "\", " + std::to_string(info.vertices) + " vertices, " + rounded(info.mass) + " kg\n";
  });
  runner.for_each_fluid(
      [&](const SceneFluid& fluid, FluidId id) { out += fluid_text(fluid, runner.world().fluid_info(id)); });
  for (const SceneMesh& mesh : scene.meshes) append_mesh_bounds(out, mesh);
  std::fwrite(out.data(), 1, out.size(), stdout);
}

template <std::size_t N>
void write_counts(JsonWriter& json, const char* key, const std::array<int, N>& counts,
                  const char* const* words) {
  json.key(key).begin_object(JsonLayout::one_line);
  for (std::size_t i = 0; i < N; ++i) {
    if (counts[i] > 0) json.field(words[i], counts[i]);
  }
  json.end_object();
}

// A body that forces cannot move has no finite mass: its figures are null.
void write_body(JsonWriter& json, const SceneRunner& runner, std::size_t index) {
  const SceneBody& body = runner.scene().bodies[index];
  json.begin_object();
  json.field("name", body.name);
  json.field("type", kBodyWords[std::size_t(body.def.type)]);
  json.field("shapes", std::int64_t(body.shapes.size()));
  if (body.def.type != BodyType::dynamic) {
    for (const char* key : {"mass", "center_of_mass", "inertia", "principal_moments", "principal_axes"})
      json.key(key).null();
  } else {
    const MassProperties mass = plain(runner.world().mass_properties(runner.bodies()[index]));
    const PrincipalAxes principal = principal_axes(mass.inertia);
    const Mat3 axes = to_matrix(principal.orientation);
    json.field("mass", mass.mass);
    json.field("center_of_mass", mass.center);
    json.field("inertia", mass.inertia);
    json.field("principal_moments", principal.moments);
    json.key("principal_axes").begin_array(JsonLayout::one_line);
    for (const Vec3& axis : {axes.x, axes.y, axes.z}) json.value(plain(axis));
    json.end_array();
  }
  json.end_object();
}

// Ropes, cloths or soft bodies, and how many vertices each has.
template <class Soft>
void write_softs(JsonWriter& json, const char* key, const World& world, const std::vector<Soft>& softs,
                 std::span<const SoftId> ids) {
  json.key(key).begin_array();
  for (std::size_t i = 0; i < ids.size(); ++i) {
    json.begin_object(JsonLayout::one_line);
    json.field("name", softs[i].name);
    json.field("particles", world.soft_info(ids[i]).vertices);
    json.field("mass", world.soft_info(ids[i]).mass);
    json.end_object();
  }
  json.end_array();
}

// Gases or liquids with their cells, and how many particles each liquid has.
template <class Fluid>
void write_fluids(JsonWriter& json, const char* key, const World& world, const std::vector<Fluid>& fluids,
                  std::span<const FluidId> ids) {
  json.key(key).begin_array();
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const FluidInfo info = world.fluid_info(ids[i]);
    json.begin_object(JsonLayout::one_line);
    json.field("name", fluids[i].name);
    json.key("cells").begin_array(JsonLayout::one_line);
    for (const int cells : info.cells) json.value(cells);
    json.end_array();
    if (info.kind == FluidKind::liquid) {
      json.field("particles", info.particles);
      json.field("volume", info.volume);
    }
    json.end_object();
  }
  json.end_array();
}

void print_json(const SceneRunner& runner) {
  const Scene& scene = runner.scene();
  const Counts counts = count(scene);
  std::size_t shapes = 0;
  for (const SceneBody& body : scene.bodies) shapes += body.shapes.size();
  JsonWriter json;
  json.begin_object();
  json.field("name", scene.name);
  json.key("counts").begin_object();
  json.field("bodies", std::int64_t(scene.bodies.size()));
  write_counts(json, "bodies_by_type", counts.bodies, kBodyWords);
  json.field("shapes", std::int64_t(shapes));
  write_counts(json, "shapes_by_type", counts.shapes, kShapeWords);
  json.field("joints", std::int64_t(scene.joints.size()));
  write_counts(json, "joints_by_type", counts.joints, joint_words().data());
  json.field("materials", std::int64_t(scene.materials.size()));
  json.field("meshes", std::int64_t(scene.meshes.size()));
  json.end_object();
  json.key("bodies").begin_array();
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) write_body(json, runner, i);
  json.end_array();
  write_softs(json, "ropes", runner.world(), scene.ropes, runner.ropes());
  write_softs(json, "cloths", runner.world(), scene.cloths, runner.cloths());
  write_softs(json, "soft_bodies", runner.world(), scene.soft_bodies, runner.soft_bodies());
  write_fluids(json, "gases", runner.world(), scene.gases, runner.gases());
  write_fluids(json, "liquids", runner.world(), scene.liquids, runner.liquids());
  json.key("meshes").begin_array();
  for (const SceneMesh& mesh : scene.meshes) write_mesh_bounds(json, mesh);
  json.end_array();
  json.end_object();
  const std::string text = json.take();
  std::fwrite(text.data(), 1, text.size(), stdout);
}

int show_info(const std::string& path, const ImportOptions& import, bool as_json) {
  if (is_recording(path)) return show_recording(path, as_json);
  SceneResult<Scene> scene = open_split_scene(path, import);
  if (!scene) {
    std::fprintf(stderr, "gyre: %s\n", scene.error().text().c_str());
    return kExitInvalid;
  }
  for (const std::string& note : scene->notes) std::fprintf(stderr, "gyre: %s\n", note.c_str());
  const SceneResult<SceneRunner> runner = SceneRunner::create(*std::move(scene), path);
  if (!runner) {
    std::fprintf(stderr, "gyre: %s\n", runner.error().text().c_str());
    return kExitInvalid;
  }
  if (as_json) {
    print_json(*runner);
  } else {
    print_text(*runner);
  }
  return kExitGood;
}

}  // namespace

void add_info(CLI::App& app, int& exit_code) {
  struct Options {
    std::string scene;
    bool json = false;
    ImportOptions import;
  };
  CLI::App* command = app.add_subcommand(
      "info", "Show what a scene or a recording holds, mass properties of bodies and bounds of meshes");
  const auto options = std::make_shared<Options>();
  command
      ->add_option("SCENE", options->scene,
                   "The scene (*.gyre.json), robot, glTF file or recording (*.gyrec); - for standard input")
      ->required()
      ->type_name("");
  command->add_flag("--json", options->json, "Print it as JSON");
  add_import_options(*command, options->import);
  command->callback(
      [options, &exit_code] { exit_code = show_info(options->scene, options->import, options->json); });
}

}  // namespace gyre
