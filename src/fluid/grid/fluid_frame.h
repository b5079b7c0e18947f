// FluidFrame: where the axes of a fluid's box stand in the world, and how they move. The box, its fields and its emitters are in these axes; what
// comes from the world and goes to it passes through here. A null frame is the world itself and leaves every number as it is.
#pragma once

#include "math/rotation.h"

#include <gyre/math.h>

namespace gyre {

struct FluidFrame {
  Pose pose{};              // world from the axes of the box
  Vec3 velocity{};          // m/s, of the origin of these axes
  Vec3 angular_velocity{};  // rad/s

  bool moves() const { return velocity != Vec3{} || angular_velocity != Vec3{}; }
};

inline DVec3 vector_to_frame(const FluidFrame* frame, DVec3 v) {
  return frame == nullptr ? v : rotate_inverse(to_double(frame->pose.orientation), v);
}
inline DVec3 vector_to_world(const FluidFrame* frame, DVec3 v) {
  return frame == nullptr ? v : rotate(to_double(frame->pose.orientation), v);
}
inline Vec3 vector_to_frame(const FluidFrame* frame, Vec3 v) {
  return frame == nullptr ? v : rotate_inverse(frame->pose.orientation, v);
}
inline Vec3 vector_to_world(const FluidFrame* frame, Vec3 v) {
  return frame == nullptr ? v : rotate(frame->pose.orientation, v);
}
inline DVec3 point_to_frame(const FluidFrame* frame, DVec3 point) {
  return frame == nullptr ? point : vector_to_frame(frame, point - frame->pose.position);
}
inline DVec3 point_to_world(const FluidFrame* frame, DVec3 point) {
  return frame == nullptr ? point : frame->pose.position + vector_to_world(frame, point);
}
inline Pose pose_to_frame(const FluidFrame* frame, const Pose& pose) {
  if (frame == nullptr) return pose;
  return {point_to_frame(frame, pose.position),
          normalized(conjugate(frame->pose.orientation) * pose.orientation)};
}

// The velocity, in the world, of the frame at a point of the world.
inline Vec3 frame_velocity(const FluidFrame* frame, DVec3 point) {
  if (frame == nullptr) return {};
  return frame->velocity + cross(frame->angular_velocity, difference(point, frame->pose.position));
}
// A velocity of the fluid at a point of the world: in the axes of the box and relative to them, and back.
inline Vec3 velocity_to_frame(const FluidFrame* frame, DVec3 point, Vec3 velocity) {
  return frame == nullptr ? velocity : vector_to_frame(frame, velocity - frame_velocity(frame, point));
}
inline Vec3 velocity_to_world(const FluidFrame* frame, DVec3 point, Vec3 velocity) {
  return frame == nullptr ? velocity : vector_to_world(frame, velocity) + frame_velocity(frame, point);
}

}  // namespace gyre
