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

// Beside the stages the profiler keeps the step as a whole.
constexpr int kWholeStep = kStageCount;
inline constexpr const char* kWholeStepName = "step";

// What there was to do in a step, for the profiler.
enum class CounterName : std::uint8_t {
  refitted_boxes,  // shapes whose fat box the broad phase was shown anew
  new_pairs,       // of fat boxes, which became contacts
  contacts,        // pairs of fat boxes
  full_looks,      // contacts whose shapes were asked, because the pair had moved
  manifolds,       // that the solver had
  colors,          // groups that they were solved in
  joints,          // that the solver had
  swept_joints,    // of these: springs, ropes, and nets too dense to be solved directly
  awake_bodies,
  fast_bodies,     // swept, because they moved far
};
constexpr int kCounterCount = 10;
inline constexpr const char* kCounterNames[kCounterCount] = {"refitted_boxes", "new_pairs", "contacts",
                                                             "full_looks",     "manifolds", "colors",
                                                             "joints",         "swept_joints", "awake_bodies",
                                                             "fast_bodies"};

}  // namespace gyre
