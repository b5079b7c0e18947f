// What gyre simulate prints at the end.
#pragma once

#include "scene/scene_runner.h"

#include <string>
#include <vector>

namespace gyre {

struct RunFigures {
  double wall_seconds = 0;
  std::vector<float> step_ms;  // of each step
};

// 16 hexadecimal digits.
std::string hash_text(const World& world);

std::string summary_text(const SceneRunner& runner, const RunFigures& figures);
std::string summary_json(const SceneRunner& runner, const RunFigures& figures);

}  // namespace gyre
