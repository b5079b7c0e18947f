// The trials of contacts: their judges against the exact motion, and Gyre in those with an answer that it reaches.
#include "bench/scenes/contact_trials.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/scenes/gyre_engine.h"

namespace gyre::bench::contact_trials_test {
namespace {

const ContactTrial& trial_named(const std::string& name) {
  for (const ContactTrial& trial : contact_trials())
    if (name == trial.name) return trial;
  ADD_FAILURE() << name;
  return contact_trials().front();
}

double figure_of(const std::vector<Figure>& figures, const std::string& name) {
  for (const Figure& figure : figures)
    if (name == figure.name) return figure.value;
  ADD_FAILURE() << name;
  return 1.0e9;
}

// Bodies move freely, but for supports that turn and what rides on them.
class FreeMotion final : public Engine {
 public:
  const char* name() const override { return "free"; }
  std::string settings() const override { return {}; }
  bool create(const Scene& scene, int, bool, std::string&) override {
    scene_ = scene;
    return true;
  }
  void step() override { ++steps_; }
  BodyState state(int i) override {
    const Body& body = scene_.bodies[std::size_t(i)];
    const double t = steps_ * kDt;
    return {{body.pos + t * body.vel, axis_angle(body.ang, t * len(body.ang)) * body.q}, body.vel, body.ang};
  }
  bool cast_ray(V3, V3, double&) override { return false; }

 private:
  Scene scene_;
  int steps_ = 0;
};

TEST(ContactTrials, JudgeFreeMotionAsItIs) {
  FreeMotion near_miss, tiles, cut_shot, turntable;
  EXPECT_EQ(figure_of(*find_figures(near_miss, trial_named("near_miss")), "deflected_of_200"), 0.0);
  EXPECT_NEAR(figure_of(*find_figures(tiles, trial_named("tiles")), "worst_lag_pct_of_the_path"), 0.0, 1e-9);
  // Nothing is struck, and nothing is carried.
  const std::vector<Figure> missed = *find_figures(cut_shot, trial_named("cut_shot"));
  EXPECT_EQ(figure_of(missed, "worst_error_deg"), 180.0);
  EXPECT_NEAR(figure_of(missed, "most_energy_gained_pct"), 0.0, 1e-9);
  EXPECT_GT(figure_of(*find_figures(turntable, trial_named("turntable")), "median_slip_mm"), 1000.0);
}

TEST(ContactTrials, NothingIsDeflectedThatPassesOrSlidesOverFlushTiles) {
  GyreEngine near_miss, tiles;
  EXPECT_LT(figure_of(*find_figures(near_miss, trial_named("near_miss")), "worst_change_of_velocity"), 1e-3);
  const std::vector<Figure> slid = *find_figures(tiles, trial_named("tiles"));
  EXPECT_LT(figure_of(slid, "worst_bump_mm"), 1.0);
  EXPECT_LT(figure_of(slid, "worst_change_of_velocity_pct"), 0.1);
}

}  // namespace
}  // namespace gyre::bench::contact_trials_test
