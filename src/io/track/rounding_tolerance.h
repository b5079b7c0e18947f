// The distance that a body may move from a reference pose before its rounded pose can change. Bodies in a heap
// tremble by a thousandth of a rounding step, and need not be rounded again.
#pragma once

#include "io/track/pose_codec.h"
#include "rigid/store/body_store.h"

#include <cmath>

namespace gyre {

struct RoundingTolerance {
  double center = -1.0;  // m, each coordinate of the centre of mass
  float quaternion = -1.0f;  // each component of the quaternion
};

// No tolerance if the pose is too close to a rounding boundary.
RoundingTolerance find_rounding_tolerance(const BodyPose& body_pose, const BodyMass& mass, PoseSteps steps);

// Without a tolerance, true only if the pose is the same.
inline bool is_within(const BodyPose& now, const BodyPose& reference, RoundingTolerance tolerance) {
  const DVec3 displacement = now.center - reference.center;
  const Quat a = now.orientation, b = reference.orientation;
  const float change =
      max(max(std::fabs(a.x - b.x), std::fabs(a.y - b.y)), max(std::fabs(a.z - b.z), std::fabs(a.w - b.w)));
  const double distance =
      max(std::fabs(displacement.x), max(std::fabs(displacement.y), std::fabs(displacement.z)));
  return distance <= max(tolerance.center, 0.0) && change <= max(tolerance.quaternion, 0.0f);
}

}  // namespace gyre
