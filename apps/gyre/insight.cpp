#include "insight.h"

namespace gyre {

void StageSums::add(const World& world) {
  read_times(world, times_);
  if (sums_.empty()) sums_.resize(times_.stages.size());
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    sums_[i].name = times_.stages[i].name;
    sums_[i].seconds += times_.stages[i].seconds;
  }
  seconds_ += times_.seconds;
  ++steps_;
}

std::vector<StageMean> StageSums::means() const {
  std::vector<StageMean> means;
  for (const StageSeconds& sum : sums_) means.push_back({sum.name, 1.0e3 * sum.seconds / double(steps_)});
  return means;
}

BodyId find_body(const SceneRunner& runner, const std::string& name) {
  for (std::size_t i = 0; i < runner.bodies().size(); ++i) {
    if (runner.scene().bodies[i].name == name) return runner.bodies()[i];
  }
  return {};
}

std::string explain_body(const SceneRunner& runner, BodyId body) {
  const BodyNames names{[](void* user, BodyId id) -> const char* {
                          const SceneBody* known = static_cast<const SceneRunner*>(user)->body_of(id);
                          return known != nullptr ? known->name.c_str() : nullptr;
                        },
                        const_cast<SceneRunner*>(&runner)};
  return explain(runner.world(), body, names).words;
}

}  // namespace gyre
