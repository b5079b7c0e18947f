// The names of the stages of a step, in order, for the profiler, the step table in docs/step.md and the first
// difference of two replays.
#pragma once

#include <cstdint>

namespace gyre {

enum class StageName : std::uint8_t {
  refit,
  find_pairs,
  flow,
  touch_soft,
  collide,
  link_islands,
  solve,
  clamp_fast_bodies,
  finish_bodies,
  break_joints,
  put_to_sleep,
};
constexpr int kStageCount = 11;
inline constexpr const char* kStageNames[kStageCount] = {
    "refit", "find_pairs",        "flow",          "touch_soft",   "collide",     "link_islands",
    "solve", "clamp_fast_bodies", "finish_bodies", "break_joints", "put_to_sleep"};

// The profiler measures the whole step beside its stages.
constexpr int kWholeStep = kStageCount;
inline constexpr const char* kWholeStepName = "step";

// The amounts of work in a step, for the profiler.
enum class CounterName : std::uint8_t {
  refitted_boxes,  // shapes whose fat box changed in the broad phase
  new_pairs,       // of fat boxes; each became a contact
  contacts,        // pairs of fat boxes
  full_looks,      // contacts whose manifolds were computed, because their bodies had moved
  manifolds,       // in the solver
  colors,          // graph colours of the manifolds
  joints,          // in the solver
  swept_joints,    // of these: iterative ones, such as springs, ropes and graphs too dense for a direct solve
  awake_bodies,
  fast_bodies,  // bodies that CCD swept
};
constexpr int kCounterCount = 10;
inline constexpr const char* kCounterNames[kCounterCount] = {
    "refitted_boxes", "new_pairs", "contacts",     "full_looks",   "manifolds",
    "colors",         "joints",    "swept_joints", "awake_bodies", "fast_bodies"};

}  // namespace gyre
