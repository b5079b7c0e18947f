// What happened during a step, as arrays in an order that never depends on threads. Valid until the next change.
#pragma once

#include <gyre/ids.h>
#include <gyre/math.h>
#include <gyre/result.h>

#include <cstdint>
#include <span>

namespace gyre {

// Two shapes began to touch. Sorted by shape index.
struct ContactBegin {
  ShapeId shape_a{}, shape_b{};
  BodyId body_a{}, body_b{};
};
// Two shapes ceased to touch, or one of them was removed.
struct ContactEnd {
  ShapeId shape_a{}, shape_b{};
};
// Two shapes met with speed.
struct ContactHit {
  ShapeId shape_a{}, shape_b{};
  BodyId body_a{}, body_b{};
  DVec3 point{};
  Vec3 normal{};      // from a to b
  float speed = 0;  // m/s, of approach along the normal
  float impulse = 0;           // N s, along the normal, over the whole step and all points with this normal
  std::int32_t triangle = -1;  // of a mesh or height field, numbered as in CastHit (queries.h); else -1
};
// Two shapes touched in the last step and in the one before. Not an event: there may be very many, so World::persisting()
// lists them for who asks.
struct ContactPersist {
  ShapeId shape_a{}, shape_b{};
  BodyId body_a{}, body_b{};
  float impulse = 0;  // N s, along the normals, over the last step and all points
};
// Something entered or left a sensor. What passes through within one step, however fast, is told to enter and to leave in
// that step. A sensor or a visitor that is a mesh or height field is met from both sides; two of these do not see each other.
struct SensorTouch {
  ShapeId sensor{}, visitor{};
  bool begins = true;
};
struct JointBroken {
  JointId joint{};
  float force = 0;   // N
  float torque = 0;  // N m
};
// A body fell asleep or woke.
struct SleepChange {
  BodyId body{};
  bool asleep = false;
};

struct Events {
  std::span<const ContactBegin> begins{};
  std::span<const ContactEnd> ends{};
  std::span<const ContactHit> hits{};
  std::span<const SensorTouch> sensors{};
  std::span<const JointBroken> broken{};
  std::span<const SleepChange> sleep_changes{};
};

// How a step was cut, where time is not fixed.
struct StepReport {
  int parts = 0;         // the most in which the motion of a body was computed, if not fixed; 0: there were none
  float error = 0;       // m, the largest estimated error of a body's points in the step
  int impacts = 0;       // times of impact that were advanced to
  bool bounded = false;  // there were more than Stepping::max_impacts: the rest of the step was a fixed one
};

// Something that was refused or had to be contained. `message` names object, field, value and allowed range.
struct Problem {
  ErrorCode code = ErrorCode::none;
  BodyId body{};  // null if it is not about a body
  char message[232] = {};
};

}  // namespace gyre
