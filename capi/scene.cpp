// Scene files in C: the reader and runner of the command line behind a handle.
#include "capi/convert.h"
#include "scene/scene_reader.h"
#include "scene/scene_runner.h"
#include "scene/scene_writer.h"

#include <string>

struct GyreScene {
  GyreScene(gyre::SceneRunner own) : runner(std::move(own)) { world.value = &runner.world(); }

  gyre::SceneRunner runner;
  GyreWorld world;
  std::vector<gyre::SoftId> softs;    // filled when asked for
  std::vector<gyre::FluidId> fluids;  // likewise
  std::string text;                   // the last answer of gyre_scene_write
};

namespace gyre {
namespace {

GyreScene* opened(SceneResult<Scene> scene, const std::string& file, std::int32_t threads,
                  std::int32_t simd_width) {
  if (!scene) {
    c::refuse_text(ErrorCode::invalid_data, scene.error().text());
    return nullptr;
  }
  SceneResult<SceneRunner> runner = SceneRunner::create(*std::move(scene), file, threads, simd_width);
  if (!runner) {
    c::refuse_text(ErrorCode::invalid_data, runner.error().text());
    return nullptr;
  }
  return new GyreScene(*std::move(runner));
}

template <class Named>
const char* name_at(const std::vector<Named>& rows, std::size_t index) {
  return index < rows.size() ? rows[index].name.c_str() : "";
}
// The name at `index` of several lists, one after the other.
template <class... Lists>
const char* name_among(std::size_t index, const Lists&... lists) {
  const char* found = "";
  const auto look = [&](const auto& list) {
    if (index < list.size()) {
      found = list[index].name.c_str();
      return true;
    }
    index -= list.size();
    return false;
  };
  (look(lists) || ...);
  return found;
}
template <class Out, class Id, class Named>
Out find_named(std::span<const Id> ids, const std::vector<Named>& rows, const char* name) {
  for (std::size_t i = 0; name != nullptr && i < ids.size() && i < rows.size(); ++i) {
    if (rows[i].name == name) return c::same<Out>(ids[i]);
  }
  return {};
}
template <class Out, class Id>
const Out* rows_of(std::span<const Id> ids, std::size_t* count) {
  static_assert(sizeof(Out) == sizeof(Id));
  c::set_count(count, ids.size());
  return reinterpret_cast<const Out*>(ids.data());
}
// Several lists of ids as one.
template <class Out, class Id>
const Out* joined(std::vector<Id>& into, std::initializer_list<std::span<const Id>> lists,
                  std::size_t* count) {
  into.clear();
  for (const std::span<const Id> list : lists) into.insert(into.end(), list.begin(), list.end());
  return rows_of<Out>(std::span<const Id>(into), count);
}

}  // namespace
}  // namespace gyre

using namespace gyre;
using namespace gyre::c;

extern "C" {

GyreScene* gyre_scene_load(const char* path, int32_t threads, int32_t simd_width) noexcept {
  const std::string file = path != nullptr ? path : "";
  return opened(load_scene(file), file, threads, simd_width);
}
GyreScene* gyre_scene_read(const char* text, size_t text_count, int32_t threads,
                           int32_t simd_width) noexcept {
  return opened(read_scene(std::string_view(text, text != nullptr ? text_count : 0)), "scene", threads,
                simd_width);
}
void gyre_scene_destroy(GyreScene* scene) noexcept { delete scene; }

GyreWorld* gyre_scene_world(GyreScene* scene) noexcept { return scene != nullptr ? &scene->world : nullptr; }
const char* gyre_scene_name(const GyreScene* scene) noexcept {
  return scene != nullptr ? scene->runner.scene().name.c_str() : "";
}
double gyre_scene_time_step(const GyreScene* scene) noexcept {
  return scene != nullptr ? double(scene->runner.scene().world.time_step) : 0.0;
}
bool gyre_scene_step(GyreScene* scene) noexcept {
  if (scene == nullptr) {
    refuse_null("gyre_scene_step");
    return false;
  }
  if (scene->runner.step()) return true;
  refuse_text(ErrorCode::invalid_argument, scene->runner.problem());
  return false;
}

const GyreBodyId* gyre_scene_bodies(const GyreScene* scene, size_t* count) noexcept {
  return rows_of<GyreBodyId>(scene != nullptr ? scene->runner.bodies() : std::span<const BodyId>(), count);
}
const GyreJointId* gyre_scene_joints(const GyreScene* scene, size_t* count) noexcept {
  return rows_of<GyreJointId>(scene != nullptr ? scene->runner.joints() : std::span<const JointId>(), count);
}
const GyreSoftId* gyre_scene_softs(const GyreScene* scene, size_t* count) noexcept {
  set_count(count, 0);
  if (scene == nullptr) return nullptr;
  const SceneRunner& runner = scene->runner;
  return joined<GyreSoftId>(const_cast<GyreScene*>(scene)->softs,
                            {runner.ropes(), runner.cloths(), runner.soft_bodies()}, count);
}
const GyreFluidId* gyre_scene_fluids(const GyreScene* scene, size_t* count) noexcept {
  set_count(count, 0);
  if (scene == nullptr) return nullptr;
  const SceneRunner& runner = scene->runner;
  return joined<GyreFluidId>(const_cast<GyreScene*>(scene)->fluids, {runner.gases(), runner.liquids()},
                             count);
}

const char* gyre_scene_body_name(const GyreScene* scene, size_t index) noexcept {
  return scene != nullptr ? name_at(scene->runner.scene().bodies, index) : "";
}
const char* gyre_scene_joint_name(const GyreScene* scene, size_t index) noexcept {
  return scene != nullptr ? name_at(scene->runner.scene().joints, index) : "";
}
const char* gyre_scene_soft_name(const GyreScene* scene, size_t index) noexcept {
  if (scene == nullptr) return "";
  const Scene& all = scene->runner.scene();
  return name_among(index, all.ropes, all.cloths, all.soft_bodies);
}
const char* gyre_scene_fluid_name(const GyreScene* scene, size_t index) noexcept {
  if (scene == nullptr) return "";
  const Scene& all = scene->runner.scene();
  return name_among(index, all.gases, all.liquids);
}
GyreBodyId gyre_scene_body(const GyreScene* scene, const char* name) noexcept {
  if (scene == nullptr) return {};
  return find_named<GyreBodyId>(scene->runner.bodies(), scene->runner.scene().bodies, name);
}
GyreJointId gyre_scene_joint(const GyreScene* scene, const char* name) noexcept {
  if (scene == nullptr) return {};
  return find_named<GyreJointId>(scene->runner.joints(), scene->runner.scene().joints, name);
}

const char* gyre_scene_write(const GyreScene* scene, size_t* count) noexcept {
  set_count(count, 0);
  if (scene == nullptr) return "";
  std::string& text = const_cast<GyreScene*>(scene)->text;
  text = write_scene(scene->runner.final_scene(), {.inline_meshes = true});
  set_count(count, text.size());
  return text.c_str();
}

}  // extern "C"
