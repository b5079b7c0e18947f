// What a run tells of the engine's inside: where the time of its steps went (--times), and why bodies are awake (--explain).
#pragma once

#include "scene/scene_runner.h"

#include <gyre/debug.h>

#include <string>
#include <vector>

namespace gyre {

struct StageMean {
  std::string name;
  double ms = 0;  // of a step
};

// Sums the times of steps. Works only for a world whose timing is on.
class StageSums {
 public:
  void add(const World& world);
  std::vector<StageMean> means() const;
  double step_ms() const { return steps_ > 0 ? 1.0e3 * seconds_ / double(steps_) : 0; }

 private:
  StepTimes times_;
  std::vector<StageSeconds> sums_;
  double seconds_ = 0;
  std::uint64_t steps_ = 0;
};

// The body of that name in the scene; null if there is none.
BodyId find_body(const SceneRunner& runner, const std::string& name);
// What explain() says, with the scene's names.
std::string explain_body(const SceneRunner& runner, BodyId body);

}  // namespace gyre
