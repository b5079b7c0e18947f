#include "scene/scene_labels.h"

#include "scene/scene_color.h"
#include "scene/scene_reader.h"

#include <gtest/gtest.h>

namespace gyre::scene_labels_test {
namespace {

struct MemorySink final : ByteSink {
  bool write(std::span<const std::byte> more) override {
    bytes.insert(bytes.end(), more.begin(), more.end());
    return true;
  }
  std::vector<std::byte> bytes;
};

TEST(SceneLabels, ARecordingKnowsNamesColoursAndView) {
  SceneResult<Scene> scene = read_scene(R"({"gyre_scene": 1, "name": "two \"bodies\"",
      "view": {"eye": [1, 2, 3.5], "target": [0, 1, 0], "field_of_view": 0.5}, "bodies": [
      {"name": "ground", "type": "static", "shapes": [{"type": "plane"}]},
      {"name": "pair", "position": [0, 2, 0], "color": "#102030", "shapes": [
        {"type": "sphere", "radius": 0.5}, {"type": "sphere", "radius": 0.25, "color": "#a0b0c0"}]}],
      "ropes": [{"name": "line", "points": [[0, 4, 0], [1, 4, 0]]}],
      "cloths": [{"name": "flag", "color": "#0a0b0c", "grid": {"size": [1, 1], "cells": [2, 2]}}]})");
  ASSERT_TRUE(scene) << scene.error().text();
  SceneResult<SceneRunner> runner = SceneRunner::create(*std::move(scene), "test");
  ASSERT_TRUE(runner) << runner.error().text();
  MemorySink sink;
  Recorder recorder(runner->world(), sink);
  label_bodies(recorder, *runner);
  ASSERT_TRUE(recorder.finish());
  Result<PoseTrack> track = PoseTrack::open(sink.bytes);
  ASSERT_TRUE(track) << track.error().message;
  const TrackFrame frame = track->frame();
  ASSERT_EQ(frame.ids.size(), 2u);
  const TrackLabel ground = track->label(frame.ids[0]), pair = track->label(frame.ids[1]);
  EXPECT_EQ(ground.name, "ground");
  const SceneColor automatic = resolved_color(runner->scene(), 0, 0);
  ASSERT_EQ(ground.colors.size(), 1u);
  EXPECT_EQ(ground.colors[0], (TrackColor{automatic.red, automatic.green, automatic.blue}));
  EXPECT_EQ(pair.name, "pair");
  ASSERT_EQ(pair.colors.size(), 2u);
  EXPECT_EQ(pair.colors[0], (TrackColor{0x10, 0x20, 0x30}));
  EXPECT_EQ(pair.colors[1], (TrackColor{0xa0, 0xb0, 0xc0}));
  ASSERT_EQ(frame.soft_ids.size(), 2u);
  const TrackLabel line = track->soft_label(frame.soft_ids[0]), flag = track->soft_label(frame.soft_ids[1]);
  EXPECT_EQ(line.name, "line");
  const SceneColor own = automatic_color(BodyType::dynamic, 2);
  ASSERT_EQ(line.colors.size(), 1u);
  EXPECT_EQ(line.colors[0], (TrackColor{own.red, own.green, own.blue}));
  EXPECT_EQ(flag.name, "flag");
  ASSERT_EQ(flag.colors.size(), 1u);
  EXPECT_EQ(flag.colors[0], (TrackColor{0x0a, 0x0b, 0x0c}));
  const std::string note(track->note("scene"));
  EXPECT_NE(note.find("\"name\": \"two \\\"bodies\\\"\""), std::string::npos) << note;
  EXPECT_NE(note.find("\"eye\": [1, 2, 3.5]"), std::string::npos) << note;
  EXPECT_NE(note.find("\"field_of_view\": 0.5"), std::string::npos) << note;
}

TEST(SceneLabels, TheViewOfANoteIsThatOfTheScene) {
  Scene scene;
  EXPECT_FALSE(view_of_note(scene_note(scene)));
  scene.view = SceneView{.eye = {1, 2, 3.5}, .target = {0, 1, 0}, .field_of_view = 0.5f};
  const std::optional<SceneView> view = view_of_note(scene_note(scene));
  ASSERT_TRUE(view);
  EXPECT_EQ(view->eye, scene.view->eye);
  EXPECT_EQ(view->target, scene.view->target);
  EXPECT_EQ(view->field_of_view, 0.5f);
  for (const char* other : {"", "{}", "[]", "{\"view\": 3}", "{\"view\": {\"eye\": [1]}}", "{\"view\": "})
    EXPECT_FALSE(view_of_note(other)) << other;
}

}  // namespace
}  // namespace gyre::scene_labels_test
