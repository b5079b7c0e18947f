// The events of a step, as arrays in an order that never depends on threads. Valid until the next change or step.
#pragma once

#include <gyre/ids.h>
#include <gyre/math.h>
#include <gyre/result.h>

#include <array>
#include <cstdint>
#include <span>

namespace gyre {

// Two shapes began to touch. Sorted by shape index.
struct ContactBegin {
  ShapeId shape_a{}, shape_b{};
  BodyId body_a{}, body_b{};
};
// Two shapes stopped touching, or one of them was removed.
struct ContactEnd {
  ShapeId shape_a{}, shape_b{};
};
// Two shapes collided. Only collisions with a noticeable approach speed, relative to the size of the shapes, are listed.
struct ContactHit {
  ShapeId shape_a{}, shape_b{};
  BodyId body_a{}, body_b{};
  DVec3 point{};
  Vec3 normal{};      // from a to b
  float approach_speed = 0;    // m/s, along the normal
  float impulse = 0;           // N s, along the normal, over the whole step and all points with this normal
  std::int32_t triangle = -1;  // of a mesh or height field, numbered as in CastHit (queries.h); else -1
};
// Two shapes touched in the last step and in the one before. It is not an event, since there may be very many such pairs:
// World::contact_pairs() lists them on demand.
struct ContactPair {
  ShapeId shape_a{}, shape_b{};
  BodyId body_a{}, body_b{};
  float impulse = 0;  // N s, along the normals, over the last step and all points
};
// A shape entered or left a sensor. A shape that passes through within one step, however fast, is reported to enter and to leave in
// that step. A mesh or height field that is the sensor or the visitor is met from both sides; two of them do not detect each other.
struct SensorTouch {
  ShapeId sensor{}, visitor{};
  bool begins = true;
};
// A joint broke and was removed.
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
// A rope, cloth or solid began to touch a shape: one of its vertices overlaps the shape or is held by it. `vertex` is the first of these. Sorted by
// the index of the soft matter, then of the shape.
struct SoftContactBegin {
  SoftId soft{};
  ShapeId shape{};
  BodyId body{};
  int vertex = 0;
};
// A rope, cloth or solid stopped touching a shape, or one of them was removed or placed anew.
struct SoftContactEnd {
  SoftId soft{};
  ShapeId shape{};
};
// A tetrahedron of a solid was turned inside out in the step. It turns back by itself, unless the model is linear.
struct SoftInverted {
  SoftId soft{};
  int tetrahedron = 0;  // in the order of SolidDef::tetrahedra; of a box: five of each cell
  std::array<std::uint32_t, 4> vertices{};
};
// A cloth tore or a solid broke at a vertex: some of the elements around it have the new vertex instead.
struct SoftTorn {
  SoftId soft{};
  int vertex = 0;
  int new_vertex = 0;
};

// A body, or a rope, cloth or solid, entered or left a fluid: the room within the surface of a liquid, the box of a gas. A body is inside while
// any point of its shapes is; sensors and fixed bodies do not count. Soft matter is inside while any vertex is. A visitor that is removed
// leaves, and all visitors of a fluid leave when it is removed. Sorted by the index of the fluid, bodies before soft matter.
struct FluidTouch {
  FluidId fluid{};
  BodyId body{};    // null: the visitor is soft matter
  SoftId soft{};    // null: the visitor is a body
  int vertex = -1;  // of soft matter that enters: the first vertex inside; else -1
  bool begins = true;
};

struct Events {
  std::span<const ContactBegin> begins{};
  std::span<const ContactEnd> ends{};
  std::span<const ContactHit> hits{};
  std::span<const SensorTouch> sensors{};
  std::span<const JointBroken> broken{};
  std::span<const SleepChange> sleep_changes{};
  std::span<const SoftContactBegin> soft_begins{};
  std::span<const SoftContactEnd> soft_ends{};
  std::span<const SoftInverted> inverted{};
  std::span<const SoftTorn> torn{};
  std::span<const FluidTouch> fluid_touches{};
};

// How the last step was divided, if TimeStepping is not fixed.
struct StepStats {
  int parts = 0;         // the largest number of parts in which a body's motion was computed; a fixed sub-step is two of them
  float error = 0;       // m, the largest estimated error of a body's points in the step
  int impacts = 0;       // times of impact at which the step was divided
  bool bounded = false;  // Stepping::max_impacts was reached: what was left of the step was a fixed one
};

enum class Severity : std::uint8_t {
  warning,  // the world goes on, but not as it should: a spring that the step cannot follow
  error,    // a call was refused, or a body stopped being finite
};

// A refused call, or a report of the step. The message names the object, the field, the value and the allowed range.
struct Problem {
  ErrorCode code = ErrorCode::none;
  BodyId body{};  // null if it is not about one body
  char message[232] = {};
  Severity severity = Severity::error;
  SoftId soft{};  // null if it is not about one rope, cloth or solid
};

// Called for each problem at once, from the thread that changes or steps the world: for logs. It must not call the world.
struct ProblemHook {
  void (*call)(void* user, const Problem& problem) = nullptr;  // null: none
  void* user = nullptr;
};

}  // namespace gyre
