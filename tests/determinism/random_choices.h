// The choices of a world that a number makes: each follows from the number, the step and its purpose.
#pragma once

#include "scenes.h"

namespace gyre::scenes {

class RandomChoices {
 public:
  float seconds(int step) const {
    if (!uneven_steps_) return kStepSeconds;
    Random random = dice(step, 5);
    const float lengths[] = {kStepSeconds, 2 * kStepSeconds, 0.5f * kStepSeconds, 0.25f * kStepSeconds};
    return lengths[pick(random, 4)];
  }

 protected:
  explicit RandomChoices(std::uint32_t number) : number_(number) {}

  static std::uint32_t pick(Random& random, std::uint32_t count) {
    return std::uint32_t(random.next(0, 65536)) % count;
  }
  static bool coin(Random& random) { return pick(random, 2) == 0; }

  // A stream of numbers of its own for every step and purpose.
  Random dice(int step, std::uint32_t purpose) const {
    std::uint32_t seed = number_ * 0x9e3779b9u + std::uint32_t(step) * 0x85ebca6bu + purpose * 0xc2b2ae35u;
    seed = (seed ^ seed >> 16) * 0x7feb352du;
    return Random(seed ^ seed >> 15);
  }

  std::uint32_t number_;
  bool uneven_steps_ = false;
};

}  // namespace gyre::scenes
