// What gyre simulate prints at the end.
#pragma once

#include "insight.h"
#include "scene/scene_runner.h"

#include <string>
#include <utility>
#include <vector>

namespace gyre {

struct RunFigures {
  double wall_seconds = 0;
  std::vector<float> step_ms;     // of each step
  std::vector<StageMean> stages;  // empty if they were not timed
  double stages_step_ms = 0;      // mean of the whole step, as the engine measured it
  // Names of bodies, and why they are awake.
  std::vector<std::pair<std::string, std::string>> explanations;
};

// 16 hexadecimal digits.
std::string hash_text(const World& world);

std::string summary_text(const SceneRunner& runner, const RunFigures& figures);
// The parts that were asked for beside the summary; empty if none was.
std::string times_text(const RunFigures& figures);
std::string explanations_text(const RunFigures& figures);
std::string summary_json(const SceneRunner& runner, const RunFigures& figures);

}  // namespace gyre
