// StageProfile: the time of each stage of a step, and counters, for the last step and in all. Stages and counters are
// indices into the owner's tables of names. Used by the thread that runs the step. When disabled, a zone costs one test
// of a flag.
#pragma once

#include "base/check.h"
#include "base/container/array.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace gyre {

struct StageTime {
  const char* name = "";
  double seconds = 0.0;
};

struct StageCount {
  const char* name = "";
  std::uint64_t value = 0;
};

class StageProfile {
 public:
  StageProfile() = default;
  // The names must outlive the profile (they are literals).
  explicit StageProfile(std::span<const char* const> stage_names,
                        std::span<const char* const> counter_names = {});

  // Off at first. A change drops the zones that are open.
  void set_enabled(bool enabled);
  bool enabled() const { return enabled_; }

  // Starts the next step: its times and counters are zero.
  void begin_step() {
    if (enabled_) start_step();
  }
  // A zone of a stage. A stage may have many zones in a step, which add up. Zones of different stages may nest; each
  // counts its own whole time.
  void begin(int stage) {
    if (enabled_) open(stage);
  }
  void end(int stage) {
    if (enabled_) close(stage);
  }
  void count(int counter, std::uint64_t amount = 1) {
    if (enabled_) add(counter, amount);
  }

  // The step that began last; one entry per stage or counter, in table order. Valid until the next call of any function
  // here.
  std::span<const StageTime> step_times() const;
  std::span<const StageCount> step_counts() const;
  // All steps since the start or the last clear().
  std::span<const StageTime> total_times() const;
  std::span<const StageCount> total_counts() const;

  std::uint64_t step_nanoseconds(int stage) const { return stages_[stage].step; }
  std::uint64_t total_nanoseconds(int stage) const { return stages_[stage].total; }
  std::uint64_t step_count() const { return steps_; }

  // Resets all times, counters and steps.
  void clear();

 private:
  struct Stage {
    const char* name = "";
    std::uint64_t opened = 0;  // clock at begin; 0 when closed
    std::uint64_t step = 0;    // nanoseconds
    std::uint64_t total = 0;
  };
  struct Counter {
    const char* name = "";
    std::uint64_t step = 0;
    std::uint64_t total = 0;
  };

  void start_step();
  void open(int stage);
  void close(int stage);
  void add(int counter, std::uint64_t amount);

  Array<Stage> stages_;
  Array<Counter> counters_;
  mutable Array<StageTime> times_;    // result of the last *_times()
  mutable Array<StageCount> counts_;  // result of the last *_counts()
  std::uint64_t steps_ = 0;
  bool enabled_ = false;
};

// A zone that ends with its scope.
class StageZone {
 public:
  StageZone(StageProfile& profile, int stage) : profile_(profile), stage_(stage) { profile_.begin(stage_); }
  ~StageZone() { profile_.end(stage_); }
  StageZone(const StageZone&) = delete;
  StageZone& operator=(const StageZone&) = delete;

 private:
  StageProfile& profile_;
  int stage_;
};

}  // namespace gyre
