// See rounding_tolerance.h. All bounds are conservative: a tolerance that is too small costs one rounding, one that
// is too large a wrong frame.
#include "io/track/rounding_tolerance.h"

namespace gyre {

namespace {

// The distance of a number, in rounding steps, to the point at which it rounds to another integer, minus the
// arithmetic error.
double distance_to_rounding(double value) {
  return 0.5 - std::fabs(value - std::floor(value + 0.5)) - 1.0e-5 - 1.0e-15 * std::fabs(value);
}

}  // namespace

RoundingTolerance find_rounding_tolerance(const BodyPose& body_pose, const BodyMass& mass, PoseSteps steps) {
  const Quat q = body_pose.orientation;
  const Vec3 mass_center = mass.center;
  const Pose pose = origin_pose(body_pose, mass);
  if (!is_finite(pose)) return {};
  const double components[4] = {double(q.x), double(q.y), double(q.z), double(q.w)};
  double square = 0.0;
  for (const double component : components) square += component * component;
  if (!(square > 0.9 && square < 1.1)) return {};
  double quaternion = 0.5;
  for (const double component : components)
    quaternion =
        min(quaternion,
            distance_to_rounding(component * (power_of_two(steps.orientation_bits) / std::sqrt(square))));
  // If each component changes by t, the unit quaternion changes by 2 t over a length of at least 0.94.
  quaternion *= power_of_two(-steps.orientation_bits) / 2.5;

  double center = 0.5;
  for (int i = 0; i < 3; ++i)
    center = min(center, distance_to_rounding(pose.position[i] * power_of_two(steps.position_bits)));
  center *= power_of_two(-steps.position_bits);
  // A rotation also moves the origin about the centre of mass: by 8 |m| times the change at most. Floats add their
  // last bits.
  const double arm = double(absolute(mass_center.x) + absolute(mass_center.y) + absolute(mass_center.z));
  center -= arm * (20.0 * max(quaternion, 0.0) + 2.0e-6);
  if (!(center > 0.0) || !(quaternion > 0.0)) return {};
  return {center, float(0.99 * quaternion)};
}

}  // namespace gyre
