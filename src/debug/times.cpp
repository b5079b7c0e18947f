// set_timing, read_times: the results of the profiler. See <gyre/debug.h>.
#include "world/stages.h"
#include "world/world_access.h"
#include "world/world_state.h"

#include <gyre/debug.h>

namespace gyre {

void set_timing(World& world, bool enabled) { state_of(world).profile.set_enabled(enabled); }
bool timing(const World& world) { return state_of(world).profile.enabled(); }

void read_times(const World& world, StepTimes& out) {
  const StageProfile& profile = state_of(world).profile;
  out.steps = profile.step_count();
  const std::span<const StageTime> times = profile.step_times();
  out.seconds = times[kWholeStep].seconds;
  out.stages.clear();
  for (const StageTime& stage : times.first(kStageCount)) out.stages.push_back({stage.name, stage.seconds});
  out.counts.clear();
  for (const StageCount& count : profile.step_counts()) out.counts.push_back({count.name, count.value});
}

}  // namespace gyre
