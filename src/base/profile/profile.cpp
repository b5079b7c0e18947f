// Times of stages by the steady clock. Results are copied into two small arrays on request.
#include "base/profile/profile.h"

#include <chrono>

namespace gyre {

namespace {

std::uint64_t now_nanoseconds() {
  const auto since_start = std::chrono::steady_clock::now().time_since_epoch();
  return static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::nanoseconds>(since_start).count());
}

constexpr double kSecondsPerNanosecond = 1e-9;

}  // namespace

StageProfile::StageProfile(std::span<const char* const> stage_names,
                           std::span<const char* const> counter_names) {
  for (const char* const name : stage_names) stages_.push_back(Stage{.name = name});
  for (const char* const name : counter_names) counters_.push_back(Counter{.name = name});
  times_.resize(stages_.size());
  counts_.resize(counters_.size());
}

void StageProfile::set_enabled(bool enabled) {
  enabled_ = enabled;
  for (Stage& stage : stages_) stage.opened = 0;
}

void StageProfile::start_step() {
  ++steps_;
  for (Stage& stage : stages_) stage.step = 0;
  for (Counter& counter : counters_) counter.step = 0;
}

void StageProfile::open(int stage) {
  GYRE_ASSERT(stages_[stage].opened == 0, "a stage has one open zone at most");
  stages_[stage].opened = now_nanoseconds();
}

void StageProfile::close(int index) {
  Stage& stage = stages_[index];
  if (stage.opened == 0) return;  // switched on in the middle of the zone
  const std::uint64_t now = now_nanoseconds();
  const std::uint64_t spent = now - stage.opened;
  stage.opened = 0;
  stage.step += spent;
  stage.total += spent;
}

void StageProfile::add(int index, std::uint64_t amount) {
  counters_[index].step += amount;
  counters_[index].total += amount;
}

std::span<const StageTime> StageProfile::step_times() const {
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    times_[i] = {stages_[i].name, static_cast<double>(stages_[i].step) * kSecondsPerNanosecond};
  }
  return times_;
}

std::span<const StageTime> StageProfile::total_times() const {
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    times_[i] = {stages_[i].name, static_cast<double>(stages_[i].total) * kSecondsPerNanosecond};
  }
  return times_;
}

std::span<const StageCount> StageProfile::step_counts() const {
  for (std::size_t i = 0; i < counters_.size(); ++i) counts_[i] = {counters_[i].name, counters_[i].step};
  return counts_;
}

std::span<const StageCount> StageProfile::total_counts() const {
  for (std::size_t i = 0; i < counters_.size(); ++i) counts_[i] = {counters_[i].name, counters_[i].total};
  return counts_;
}

void StageProfile::clear() {
  for (Stage& stage : stages_) stage = Stage{.name = stage.name};
  for (Counter& counter : counters_) counter = Counter{.name = counter.name};
  steps_ = 0;
}

}  // namespace gyre
