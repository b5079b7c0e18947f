// Force fields within a step: which bodies they act on, and what they give these in each sub-step.
//
// Between the forces and the constraints of a sub-step of length h the velocities u = (v, w) of a body become u + d with
//   (M + h D + c h^2 K) d = h (F + D (s - u)) - c h^2 K (u - u0)
// M is its mass, D the drag against the stream s, F pulls and lifts at the present place, K how these give way to motion, u0 the
// velocity as the sub-step began. Drag is implicit: whatever its size, velocities go towards the stream's and never beyond.
// Pulls and lifts are explicit, with mass made larger by c h^2 K: with c = 1/4 linear ones swing with tan(W h / 2) = w h / 2 as by
// the trapezoidal rule, so without loss or gain at any stiffness; c grows to 4 where w h is beyond 1. Where nothing moves it
// has no say. A body so light or thin that it dives through the surface within a sub-step would be thrown out all the same:
// its lift is implicit, that of where it will be at the sub-step's end. docs/fields.md derives all this.
// D and which fields act are found once a step, s, F and K in every sub-step.
//
// In: fields, places, velocities. Out: velocities. Bodies are independent of each other.
#pragma once

#include "base/arena/arena.h"
#include "rigid/field/medium.h"

#include <span>

namespace gyre {

// A body on which fields act in this step.
struct FieldBody {
  std::uint32_t body = 0;
  std::span<const std::uint32_t> fields{};  // slots of fields
  std::span<Mat6> drags{};                  // D of each of these, zero for those that are no media
  Mat6 drag;                                // their sum
  bool has_drag = false;
  bool has_implicit_lift = false;  // its lift is implicit
  bool unconstrained = false;                  // no constraint acts on the body
  Vec3 linear_before, angular_before;  // u0
};

// What fields do to a body at one moment, with drag as it is then: for integrators that look at forces at several stages.
Vec6 force_of_fields(const RigidWorld& w, std::uint32_t body, std::span<const std::uint32_t> fields,
                     const BodyState& state, double time);

// Stages of the program of sub-steps, over blocks of kFieldBodiesPerBlock bodies; their context is this.
struct FieldSolve {
  RigidWorld* world = nullptr;
  std::span<FieldBody> bodies{};
  float h = 0.0f;  // s

  int blocks() const;
};
constexpr int kFieldBodiesPerBlock = 8;

// Of those of the bodies on which a field acts, in the same order; BodyFlags::touched says so too, after constraints had their say.
// Without `free` only of those that constraints act on too.
FieldSolve find_field_bodies(RigidWorld& w, std::span<const std::uint32_t> bodies, float h, Arena& arena,
                             bool free = true);

// Once, as the step begins: drag and stream.
void prepare_fields_stage(void* context, int begin, int end, int worker);
// As a sub-step begins: each notes its velocity.
void watch_fields_stage(void* context, int begin, int end, int worker);
// Between its forces and its constraints.
void apply_fields_stage(void* context, int begin, int end, int worker);

}  // namespace gyre
