// See rounding_slack.h. All bounds are on the safe side: a slack that is too small costs a rounding, one that is too large a frame.
#include "io/track/rounding_tolerance.h"

namespace gyre {

namespace {

// From a number, in steps, to where it would be rounded to another integer; less what arithmetic may be off by.
double to_next(double value) {
  return 0.5 - std::fabs(value - std::floor(value + 0.5)) - 1.0e-5 - 1.0e-15 * std::fabs(value);
}

}  // namespace

RoundingTolerance find_rounding_tolerance(const BodyPose& place, const BodyMass& mass, PoseSteps steps) {
  const Quat q = place.orientation;
  const Vec3 mass_center = mass.center;
  const Pose pose = origin_pose(place, mass);
  if (!is_finite(pose)) return {};
  const double parts[4] = {double(q.x), double(q.y), double(q.z), double(q.w)};
  double square = 0.0;
  for (const double part : parts) square += part * part;
  if (!(square > 0.9 && square < 1.1)) return {};
  double turn = 0.5;
  for (const double part : parts)
    turn = min(turn, to_next(part * (power_of_two(steps.orientation_bits) / std::sqrt(square))));
  // Parts that change by t each change the unit quaternion by 2 t, over a length of 0.94 or more.
  turn *= power_of_two(-steps.orientation_bits) / 2.5;

  double way = 0.5;
  for (int i = 0; i < 3; ++i) way = min(way, to_next(pose.position[i] * power_of_two(steps.position_bits)));
  way *= power_of_two(-steps.position_bits);
  // And turn what is as far from the origin as the centre of mass: by 8 |m| times as much at most; floats add their last bits.
  const double arm = double(absolute(mass_center.x) + absolute(mass_center.y) + absolute(mass_center.z));
  way -= arm * (20.0 * max(turn, 0.0) + 2.0e-6);
  if (!(way > 0.0) || !(turn > 0.0)) return {};
  return {way, float(0.99 * turn)};
}

}  // namespace gyre
