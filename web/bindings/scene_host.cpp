// Scene files in the browser: the same reader and runner as the command line's. A scene's host is a world's host too, so every
// function of World takes it.
#include "scene/scene_color.h"
#include "scene/scene_reader.h"
#include "scene/scene_runner.h"
#include "scene/scene_writer.h"
#include "web/bindings/hosts.h"

#include <emscripten.h>

#include <string>
#include <vector>

namespace gyre::web {
namespace {

struct SceneHost final : WorldHost {
  explicit SceneHost(SceneRunner own) : runner(std::move(own)) {}
  ~SceneHost() override { recorder.reset(); }
  World& world() override { return runner.world(); }
  SceneRunner runner;
};

SceneHost& scene_of(Host* host) { return *static_cast<SceneHost*>(host); }

void overrule(Call& call, SceneWorld& world) {
  if (call.given()) get(call, world.gravity);
  if (call.given()) get(call, world.time_step);
  if (call.given()) get(call, world.sleeping);
  Stepping stepping = stepping_of(world);
  if (call.given()) get(call, stepping);
  set_stepping(world, stepping);
}

int refuse_scene(Answer& answer, const SceneError& error) {
  return answer.checked(make_error(ErrorCode::invalid_data, "%s", error.text().c_str()));
}

// Vertices held at the start, those of a region among them, which a scene as it stands names one by one.
std::vector<std::vector<SceneHold>> holds_of(const SceneRunner& runner) {
  std::vector<std::vector<SceneHold>> holds;
  bool by_region = false;
  const Scene& scene = runner.scene();
  for (const SceneRope& rope : scene.ropes) holds.push_back(rope.holds);
  for (const SceneCloth& cloth : scene.cloths) holds.push_back(cloth.holds);
  for (const SceneSoftBody& solid : scene.soft_bodies) {
    holds.push_back(solid.holds);
    by_region = by_region || solid.pinned_region.has_value();
  }
  if (!by_region) return holds;
  const std::vector<SceneSoftBody> solids = runner.final_scene().soft_bodies;
  for (std::size_t i = 0; i < solids.size(); ++i) holds[holds.size() - solids.size() + i] = solids[i].holds;
  return holds;
}

}  // namespace
}  // namespace gyre::web

using namespace gyre;
using namespace gyre::web;

extern "C" {

// Arguments: the scene's text, its name in errors, threads, SIMD width; the files that it may name: how many, then name and bytes
// of each; and settings that overrule those of the scene, each after whether it is given: gravity, time step, sleeping, stepping.
// The answer: a handle.
EMSCRIPTEN_KEEPALIVE int gyre_scene_open() {
  Call call(nullptr);
  Answer answer(nullptr, 0);
  std::string_view text, file;
  get(call, text);
  get(call, file);
  WorldDef def;
  get(call, def.threads);
  limit_threads(def);
  get(call, def.simd_width);
  ReadOptions options;
  options.file = std::string(file);
  for (double files = call.next(); files > 0.0; --files) {
    std::string_view name, bytes;
    get(call, name);
    get(call, bytes);
    options.files.emplace(std::string(name), std::string(bytes));
  }
  SceneResult<Scene> scene = read_scene(text, options);
  if (!scene) return refuse_scene(answer, scene.error());
  overrule(call, scene->world);
  SceneResult<SceneRunner> runner =
      SceneRunner::create(*std::move(scene), options.file, def.threads, def.simd_width);
  if (!runner) return refuse_scene(answer, runner.error());
  Host* const host = new SceneHost(*std::move(runner));
  answer.pointer(host);
  return answer.done();
}

// The scene's name and time step; then of its bodies and of its joints: how many, their ids, and the name of each. Ids of bodies
// and joints that are gone stay in their places.
EMSCRIPTEN_KEEPALIVE int gyre_scene_info(Host* host) {
  Answer answer(host, 0);
  const SceneRunner& runner = scene_of(host).runner;
  const Scene& scene = runner.scene();
  put_text(answer, std::string_view(scene.name));
  answer.number(scene.world.time_step);
  put_array(answer, runner.bodies());
  for (const SceneBody& body : scene.bodies) put_text(answer, std::string_view(body.name));
  put_array(answer, runner.joints());
  for (const SceneJoint& joint : scene.joints) put_text(answer, std::string_view(joint.name));
  return answer.done();
}

// How the scene looks. Of each body, in the order of the scene: how many shapes, and of each its colour as 0xrrggbb and the name of its
// material, empty if it has none. Then whether the scene says from where to look, and if so eye, target and the angle of view.
EMSCRIPTEN_KEEPALIVE int gyre_scene_looks(Host* host) {
  Answer answer(host, 0);
  const Scene& scene = scene_of(host).runner.scene();
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const std::vector<SceneShape>& shapes = scene.bodies[i].shapes;
    answer.number(double(shapes.size()));
    for (std::size_t k = 0; k < shapes.size(); ++k) {
      const SceneColor color = resolved_color(scene, i, k);
      answer.number(double(color.red << 16 | color.green << 8 | color.blue));
      put_text(answer, shapes[k].material < 0
                           ? std::string_view()
                           : std::string_view(scene.materials[std::size_t(shapes[k].material)].name));
    }
  }
  answer.number(scene.view.has_value());
  if (scene.view)
    put(answer, scene.view->eye), put(answer, scene.view->target), put(answer, scene.view->field_of_view);
  return answer.done();
}

// Ropes, cloths and soft bodies, in this order: how many, their ids, and of each its name, its colour as 0xrrggbb, and the vertices
// that the scene holds: how many, and of each its number and which body of the scene holds it, -1 for the world.
EMSCRIPTEN_KEEPALIVE int gyre_scene_softs(Host* host) {
  Answer answer(host, 0);
  const SceneRunner& runner = scene_of(host).runner;
  const std::vector<std::vector<SceneHold>> holds = holds_of(runner);
  std::vector<SoftId> ids;
  for (const std::span<const SoftId> some : {runner.ropes(), runner.cloths(), runner.soft_bodies()})
    ids.insert(ids.end(), some.begin(), some.end());
  put_array(answer, std::span<const SoftId>(ids));
  std::size_t index = 0;
  runner.for_each_soft([&](const SceneSoft& soft, SoftId id) {
    const SoftInfo info = runner.world().soft_info(id);
    put_text(answer, std::string_view(soft.name));
    const SceneColor color = resolved_soft_color(runner.scene(), info.kind, std::size_t(info.user_data));
    answer.number(double(color.red << 16 | color.green << 8 | color.blue));
    put_list(answer, std::span<const SceneHold>(holds[index]),
             [&](const SceneHold& hold) { put(answer, hold.vertex), put(answer, hold.body); });
    ++index;
  });
  return answer.done();
}

// Gases and liquids, in this order: how many, their ids, and of each its name and its colour as 0xrrggbb.
EMSCRIPTEN_KEEPALIVE int gyre_scene_fluids(Host* host) {
  Answer answer(host, 0);
  const SceneRunner& runner = scene_of(host).runner;
  std::vector<FluidId> ids;
  for (const std::span<const FluidId> some : {runner.gases(), runner.liquids()})
    ids.insert(ids.end(), some.begin(), some.end());
  put_array(answer, std::span<const FluidId>(ids));
  const auto put_looks = [&](const SceneFluid& fluid, FluidKind kind) {
    put_text(answer, std::string_view(fluid.name));
    const SceneColor color = resolved_fluid_color(fluid, kind);
    answer.number(double(color.red << 16 | color.green << 8 | color.blue));
  };
  for (const SceneGas& gas : runner.scene().gases) put_looks(gas, FluidKind::gas);
  for (const SceneLiquid& liquid : runner.scene().liquids) put_looks(liquid, FluidKind::liquid);
  return answer.done();
}

// One step of the scene with its timed forces.
EMSCRIPTEN_KEEPALIVE int gyre_scene_step(Host* host) {
  Answer answer(host, 0);
  SceneRunner& runner = scene_of(host).runner;
  if (runner.step()) return answer.done();
  return answer.checked(make_error(ErrorCode::invalid_argument, "%s", runner.problem().c_str()));
}

// Steps done and the time of the scene.
EMSCRIPTEN_KEEPALIVE int gyre_scene_progress(Host* host) {
  Answer answer(host, 0);
  const SceneRunner& runner = scene_of(host).runner;
  answer.number(double(runner.steps()));
  answer.number(runner.time());
  return answer.done();
}

// The scene as it stands now, as the text of a scene file.
EMSCRIPTEN_KEEPALIVE int gyre_scene_write(Host* host) {
  Answer answer(host, 0);
  const std::string text = write_scene(scene_of(host).runner.final_scene(), {.inline_meshes = true});
  const std::byte* begin = reinterpret_cast<const std::byte*>(text.data());
  answer.bytes(std::vector<std::byte>(begin, begin + text.size()));
  return answer.done();
}

}  // extern "C"
