// Zones add up per step and in all; a disabled profile counts nothing.
#include "base/profile/profile.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>

namespace gyre::profile_test {
namespace {

constexpr const char* kStages[] = {"collide", "solve"};
constexpr const char* kCounters[] = {"contacts"};

void wait_a_little() { std::this_thread::sleep_for(std::chrono::milliseconds(2)); }

TEST(StageProfile, OffCountsNothing) {
  StageProfile profile(kStages, kCounters);
  profile.begin_step();
  {
    const StageZone zone(profile, 0);
    wait_a_little();
    profile.count(0, 5);
  }
  EXPECT_EQ(profile.step_count(), 0u);
  EXPECT_EQ(profile.total_nanoseconds(0), 0u);
  EXPECT_EQ(profile.step_counts()[0].value, 0u);
  EXPECT_EQ(std::string(profile.step_times()[1].name), "solve");
}

TEST(StageProfile, ZonesAddUp) {
  StageProfile profile(kStages, kCounters);
  profile.set_enabled(true);
  for (int step = 0; step < 2; ++step) {
    profile.begin_step();
    for (int sub = 0; sub < 2; ++sub) {
      const StageZone outer(profile, 1);
      const StageZone inner(profile, 0);
      wait_a_little();
      profile.count(0, 10);
    }
  }
  EXPECT_EQ(profile.step_count(), 2u);
  EXPECT_GE(profile.step_times()[0].seconds, 0.004);
  EXPECT_GE(profile.total_times()[0].seconds, 0.008);
  EXPECT_GE(profile.total_nanoseconds(1), profile.total_nanoseconds(0)) << "the outer zone holds the inner";
  EXPECT_GT(profile.total_nanoseconds(0), profile.step_nanoseconds(0));
  EXPECT_EQ(profile.step_counts()[0].value, 20u);
  EXPECT_EQ(profile.total_counts()[0].value, 40u);
  profile.clear();
  EXPECT_EQ(profile.total_nanoseconds(0), 0u);
  EXPECT_EQ(std::string(profile.total_times()[0].name), "collide");
}

TEST(StageProfile, SwitchedOnInsideAZone) {
  StageProfile profile(kStages);
  profile.begin(0);
  profile.set_enabled(true);
  profile.end(0);
  EXPECT_EQ(profile.total_nanoseconds(0), 0u);
}

}  // namespace
}  // namespace gyre::profile_test
