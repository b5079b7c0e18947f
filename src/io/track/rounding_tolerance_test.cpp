// Every pose within the tolerance has the same rounded pose.
#include "io/track/rounding_tolerance.h"

#include "random.h"

#include <gtest/gtest.h>

namespace gyre::rounding_tolerance_test {
namespace {

using testing_random::Random;

BodyMass mass_at(Vec3 center) {
  BodyMass mass;
  mass.center = center;
  return mass;
}
Pose origin_of(const BodyPose& body_pose, Vec3 mass_center) {
  return origin_pose(body_pose, mass_at(mass_center));
}

// Moves by the whole tolerance, each component in a random direction.
BodyPose moved(Random& random, const BodyPose& body_pose, RoundingTolerance tolerance) {
  const auto sign = [&] { return random.next(2) == 0 ? -0.999 : 0.999; };
  BodyPose to = body_pose;
  to.center = body_pose.center +
              DVec3{sign() * tolerance.center, sign() * tolerance.center, sign() * tolerance.center};
  const auto change = [&](float component) { return component + float(sign()) * tolerance.quaternion; };
  to.orientation = {change(body_pose.orientation.x), change(body_pose.orientation.y),
                    change(body_pose.orientation.z), change(body_pose.orientation.w)};
  return to;
}

TEST(RoundingTolerance, KeepsTheRoundedPose) {
  Random random;
  int found = 0;
  for (const PoseSteps steps : {PoseSteps{}, PoseSteps{20, 16}, PoseSteps{-3, 8}, PoseSteps{13, 20}}) {
    for (int i = 0; i < 20000; ++i) {
      const double far = i % 3 == 0 ? 1.0 : i % 3 == 1 ? 100.0 : 1.0e4;
      const BodyPose body_pose{far * DVec3(random.vector(-1, 1)), random.turn(3)};
      const Vec3 mass_center = i % 2 == 0 ? Vec3{} : random.vector(-1, 1);
      const RoundingTolerance tolerance = find_rounding_tolerance(body_pose, mass_at(mass_center), steps);
      if (tolerance.center < 0) continue;
      ++found;
      const RoundedPose rounded = round_pose(origin_of(body_pose, mass_center), steps);
      for (int k = 0; k < 8; ++k) {
        const BodyPose to = moved(random, body_pose, tolerance);
        if (!is_within(to, body_pose, tolerance)) continue;  // by the last bit of a float
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
  // Without a tolerance only the same pose is within it.
  EXPECT_TRUE(is_within({}, {}, {}));
  EXPECT_FALSE(is_within({{1.0e-300, 0, 0}, {}}, {}, {}));
  EXPECT_FALSE(is_within({{}, {1.0e-38f, 0, 0, 1}}, {}, {}));
}

}  // namespace
}  // namespace gyre::rounding_tolerance_test
