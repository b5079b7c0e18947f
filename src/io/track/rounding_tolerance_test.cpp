// The slack against rounding anew: whatever is within it has the same rounded pose.
#include "io/track/rounding_tolerance.h"

#include "random.h"

#include <gtest/gtest.h>

namespace gyre {
namespace {

using testing_random::Random;

BodyMass mass_at(Vec3 center) {
  BodyMass mass;
  mass.center = center;
  return mass;
}
Pose origin_of(const BodyPose& place, Vec3 mass_center) { return origin_pose(place, mass_at(mass_center)); }

// As far as the slack allows, each part to a random side.
BodyPose moved(Random& random, const BodyPose& place, RoundingTolerance slack) {
  const auto way = [&] { return random.next(2) == 0 ? -0.999 : 0.999; };
  BodyPose to = place;
  to.center = place.center + DVec3{way() * slack.center, way() * slack.center, way() * slack.center};
  const auto turn = [&](float part) { return part + float(way()) * slack.turn; };
  to.orientation = {turn(place.orientation.x), turn(place.orientation.y), turn(place.orientation.z), turn(place.orientation.w)};
  return to;
}

TEST(RoundingTolerance, KeepsTheRoundedPose) {
  Random random;
  int found = 0;
  for (const PoseSteps steps : {PoseSteps{}, PoseSteps{20, 16}, PoseSteps{-3, 8}, PoseSteps{13, 20}}) {
    for (int i = 0; i < 20000; ++i) {
      const double far = i % 3 == 0 ? 1.0 : i % 3 == 1 ? 100.0 : 1.0e4;
      const BodyPose place{far * DVec3(random.vector(-1, 1)), random.turn(3)};
      const Vec3 mass_center = i % 2 == 0 ? Vec3{} : random.vector(-1, 1);
      const RoundingTolerance slack = find_rounding_tolerance(place, mass_at(mass_center), steps);
      if (slack.center < 0) continue;
      ++found;
      const RoundedPose rounded = round_pose(origin_of(place, mass_center), steps);
      for (int k = 0; k < 8; ++k) {
        const BodyPose to = moved(random, place, slack);
        if (!is_within(to, place, slack)) continue;  // by the last bit of a float
        ASSERT_EQ(round_pose(origin_of(to, mass_center), steps), rounded) << i;
      }
    }
  }
  EXPECT_GT(found, 30000) << "what trembles need not be rounded";
}

TEST(RoundingTolerance, IsNoneForWhatCannotBeTold) {
  EXPECT_LT(find_rounding_tolerance({{}, {0, 0, 0, 0}}, BodyMass{}, {}).center, 0.0);
  EXPECT_LT(find_rounding_tolerance({{__builtin_nan(""), 0, 0}, Quat{}}, BodyMass{}, {}).center, 0.0);
  EXPECT_LT(find_rounding_tolerance({{__builtin_inf(), 0, 0}, Quat{}}, BodyMass{}, {}).center, 0.0);
  EXPECT_LT(find_rounding_tolerance({{1e300, 0, 0}, Quat{}}, BodyMass{}, {}).center, 0.0);
  EXPECT_LT(find_rounding_tolerance({{}, {0, 0, 0, __builtin_nanf("")}}, BodyMass{}, {}).center, 0.0);
  // Then nothing may have moved at all.
  EXPECT_TRUE(is_within({}, {}, {}));
  EXPECT_FALSE(is_within({{1.0e-300, 0, 0}, {}}, {}, {}));
  EXPECT_FALSE(is_within({{}, {1.0e-38f, 0, 0, 1}}, {}, {}));
}

}  // namespace
}  // namespace gyre
