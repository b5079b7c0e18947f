// How far a body may go from where it was looked at before its rounded pose can change: what lies in a heap trembles by a thousandth
// of a step, and need not be rounded again to know that.
#pragma once

#include "io/track/pose_codec.h"
#include "rigid/store/body_store.h"

#include <cmath>

namespace gyre {

struct RoundingTolerance {
  double center = -1.0;  // m, each coordinate of the centre of mass
  float quaternion = -1.0f;    // each part of the quaternion
};

// None where it is too near to tell.
RoundingTolerance find_rounding_tolerance(const BodyPose& body_pose, const BodyMass& mass, PoseSteps steps);

// With no slack, only if it has not moved at all.
inline bool is_within(const BodyPose& now, const BodyPose& reference, RoundingTolerance tolerance) {
  const DVec3 displacement = now.center - reference.center;
  const Quat a = now.orientation, b = reference.orientation;
  const float change =
      max(max(std::fabs(a.x - b.x), std::fabs(a.y - b.y)), max(std::fabs(a.z - b.z), std::fabs(a.w - b.w)));
  const double distance = max(std::fabs(displacement.x), max(std::fabs(displacement.y), std::fabs(displacement.z)));
  return distance <= max(tolerance.center, 0.0) && change <= max(tolerance.quaternion, 0.0f);
}

}  // namespace gyre
