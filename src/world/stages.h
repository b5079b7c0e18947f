// The stages of a step by name, in order: for the profiler, the step table in docs/step.md and the first difference of two
// replays.
#pragma once

#include <cstdint>

namespace gyre {

enum class StageName : std::uint8_t {
  refit,
  find_pairs,
  collide,
  link_islands,
  solve,
  clamp_fast_bodies,
  finish_bodies,
  break_joints,
  put_to_sleep,
};
constexpr int kStageCount = 9;
inline constexpr const char* kStageNames[kStageCount] = {"refit",        "find_pairs",  "collide",
                                                         "link_islands", "solve",       "clamp_fast_bodies",
                                                         "finish_bodies", "break_joints", "put_to_sleep"};

}  // namespace gyre
