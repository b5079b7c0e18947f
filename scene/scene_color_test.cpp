// Colours and the view: what is given wins in its order, is kept by the writer, and never reaches the physics.
#include "scene/scene_color.h"

#include "scene/scene_reader.h"
#include "scene/scene_runner.h"
#include "scene/scene_writer.h"

#include <gtest/gtest.h>

#include <string>

namespace gyre::scene_color_test {
namespace {

const std::string kColored = R"({"gyre_scene": 1,
  "view": {"eye": [3, 4, 5], "target": [0, 1, 0], "field_of_view": 0.5},
  "materials": {"wood": {"color": "#A06030"}, "plain": {}},
  "bodies": [
    {"name": "floor", "type": "static", "shapes": [{"type": "plane"}]},
    {"name": "first", "position": [0, 3, 0], "color": "#0000ff", "shapes": [
      {"type": "sphere", "radius": 0.5, "material": "wood", "color": "#00ff00"},
      {"type": "sphere", "radius": 0.5, "material": "wood"}]},
    {"name": "second", "position": [3, 3, 0], "shapes": [
      {"type": "sphere", "radius": 0.5, "material": "wood"},
      {"type": "sphere", "radius": 0.5, "material": "plain"},
      {"type": "sphere", "radius": 0.5, "color": null}]}]})";

TEST(SceneColor, TheNearestOneGivenWins) {
  const SceneResult<Scene> scene = read_scene(kColored);
  ASSERT_TRUE(scene) << scene.error().text();
  EXPECT_EQ(resolved_color(*scene, 1, 0), (SceneColor{0, 255, 0}));
  EXPECT_EQ(resolved_color(*scene, 1, 1), (SceneColor{0, 0, 255}));
  EXPECT_EQ(resolved_color(*scene, 2, 0), (SceneColor{0xa0, 0x60, 0x30}));
  EXPECT_EQ(resolved_color(*scene, 2, 1), automatic_color(BodyType::dynamic, 2));
  EXPECT_EQ(resolved_color(*scene, 2, 2), automatic_color(BodyType::dynamic, 2));
  EXPECT_EQ(resolved_color(*scene, 0, 0), kGroundColor);
  EXPECT_NE(automatic_color(BodyType::dynamic, 0), automatic_color(BodyType::dynamic, 1));
  EXPECT_EQ(automatic_color(BodyType::fixed, 0), automatic_color(BodyType::fixed, 1));
}

TEST(SceneColor, IsWrittenAsItIsRead) {
  const SceneResult<Scene> first = read_scene(kColored);
  ASSERT_TRUE(first);
  const SceneResult<Scene> second = read_scene(write_scene(*first));
  ASSERT_TRUE(second) << second.error().text();
  for (std::size_t body = 0; body < first->bodies.size(); ++body) {
    EXPECT_EQ(first->bodies[body].color, second->bodies[body].color);
    for (std::size_t shape = 0; shape < first->bodies[body].shapes.size(); ++shape) {
      EXPECT_EQ(first->bodies[body].shapes[shape].color, second->bodies[body].shapes[shape].color);
    }
  }
  EXPECT_EQ(first->materials[1].color, second->materials[1].color);
  EXPECT_EQ(color_text({0x0a, 0xff, 0x30}), "#0aff30");
  ASSERT_TRUE(second->view);
  EXPECT_EQ(second->view->eye, (DVec3{3, 4, 5}));
  EXPECT_EQ(second->view->target, (DVec3{0, 1, 0}));
  EXPECT_EQ(second->view->field_of_view, 0.5f);
}

TEST(SceneColor, NeverReachesThePhysics) {
  std::string text = kColored;
  for (std::size_t at; (at = text.find("\"color\": \"#")) != std::string::npos;) {
    text.replace(at, std::string("\"color\": \"#A06030\"").size(), "\"color\": null    ");
  }
  const auto hash_after = [](const std::string& scene_text) {
    SceneResult<Scene> scene = read_scene(scene_text);
    if (!scene) return std::uint64_t(0);
    SceneResult<SceneRunner> runner = SceneRunner::create(*std::move(scene), "scene");
    for (int i = 0; i < 60; ++i) runner->step();
    return runner->world().hash();
  };
  EXPECT_EQ(hash_after(kColored), hash_after(text));
  EXPECT_NE(hash_after(text), 0u);
}

TEST(SceneColor, WrongOnesAreRefusedInWords) {
  const SceneResult<Scene> color =
      read_scene(R"({"gyre_scene": 1, "bodies": [{"name": "b", "color": "red"}]})");
  ASSERT_FALSE(color);
  EXPECT_EQ(color.error().text(),
            "scene: /bodies/0/color: found \"red\", expected a color as \"#rrggbb\" in hexadecimal digits");
  const SceneResult<Scene> view =
      read_scene(R"({"gyre_scene": 1, "view": {"eye": [1, 2, 3], "target": [1, 2, 3]}})");
  ASSERT_FALSE(view);
  EXPECT_EQ(view.error().text(), "scene: /view/target: found the place of the eye, expected another one");
}

}  // namespace
}  // namespace gyre::scene_color_test
