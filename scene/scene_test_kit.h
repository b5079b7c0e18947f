// Helpers of the tests of scenes: refusals with the place and the words that they must have, and scenes that run.
#pragma once

#include "scene/scene_reader.h"
#include "scene/scene_runner.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace gyre::scene_test {

// The reader's refusal, or that of the world which is made of what it read.
inline SceneError refusal(const std::string& text) {
  SceneResult<Scene> scene = read_scene(text);
  if (!scene) return scene.error();
  SceneResult<SceneRunner> runner = SceneRunner::create(*std::move(scene), "scene");
  EXPECT_FALSE(runner) << text;
  return runner ? SceneError{} : runner.error();
}

struct Refused {
  std::string text, pointer, found, expected;
};
inline void expect_refused(const Refused& bad) {
  const SceneError error = refusal(bad.text);
  EXPECT_EQ(error.pointer, bad.pointer) << bad.text << "\n" << error.message;
  for (const std::string& words : {bad.found, bad.expected})
    EXPECT_NE(error.message.find(words), std::string::npos)
        << bad.text << "\nsays: " << error.message << "\nlacks: " << words;
}

inline SceneRunner run(const std::string& text, int steps = 0) {
  SceneResult<Scene> scene = read_scene(text);
  EXPECT_TRUE(scene) << scene.error().text();
  SceneResult<SceneRunner> runner = SceneRunner::create(*std::move(scene), "scene");
  EXPECT_TRUE(runner) << runner.error().text();
  for (int i = 0; i < steps; ++i) EXPECT_TRUE(runner->step()) << runner->problem();
  return *std::move(runner);
}

}  // namespace gyre::scene_test
