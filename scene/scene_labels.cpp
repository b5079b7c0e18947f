// What a recorder is told of a scene. See scene_labels.h.
#include "scene/scene_labels.h"

#include "scene/json_document.h"
#include "scene/json_writer.h"
#include "scene/scene_color.h"
#include "scene/scene_reader.h"

namespace gyre {

std::string scene_note(const Scene& scene) {
  JsonWriter json;
  json.begin_object();
  json.field("name", scene.name);
  json.field("time_step", scene.world.time_step);
  if (scene.view) {
    json.key("view").begin_object();
    json.field("eye", scene.view->eye);
    json.field("target", scene.view->target);
    json.field("field_of_view", scene.view->field_of_view);
    json.end_object();
  }
  json.end_object();
  return json.take();
}

// A scene of nothing but the view is read as any scene is.
std::optional<SceneView> view_of_note(std::string_view note) {
  std::string text;
  try {
    const Json members = parse_document(note, "note", {});
    if (!members.is_object() || !members.contains("view")) return {};
    text = Json{{"gyre_scene", 1}, {"view", members.at("view")}}.dump();
  } catch (const SceneError&) {
    return {};
  }
  const SceneResult<Scene> scene = read_scene(text);
  return scene ? scene->view : std::nullopt;
}

void label_bodies(Recorder& recorder, const SceneRunner& runner) {
  const Scene& scene = runner.scene();
  recorder.note("scene", scene_note(scene));
  std::vector<TrackColor> colors;
  for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
    colors.clear();
    for (std::size_t shape = 0; shape < scene.bodies[body].shapes.size(); ++shape) {
      const SceneColor color = resolved_color(scene, body, shape);
      colors.push_back({color.red, color.green, color.blue});
    }
    recorder.label(runner.bodies()[body], scene.bodies[body].name, colors);
  }
  runner.for_each_soft([&](const SceneSoft& soft, SoftId id) {
    const SoftInfo info = runner.world().soft_info(id);
    const SceneColor color = resolved_soft_color(scene, info.kind, std::size_t(info.user_data));
    const TrackColor stored{color.red, color.green, color.blue};
    recorder.label_soft(id, soft.name, {&stored, 1});
  });
}

}  // namespace gyre
