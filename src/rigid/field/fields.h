// Force fields within a step: the bodies on which they act, and the change of velocity in each sub-step.
//
// Between the forces and the constraints of a sub-step of length h, the velocities u = (v, w) of a body become u + d
// with
//   (M + h D + c h^2 K) d = h (F + D (s - u)) - c h^2 K (u - u0)
// M is the mass, D the drag against the stream s, F the radial forces and buoyancy at the present pose, K their
// stiffness, u0 the velocity at the beginning of the sub-step. Drag is implicit: velocities approach that of the
// stream at any drag and never pass it. Radial forces and buoyancy are explicit, with a mass that is enlarged by c h^2
// K. With c = 1/4 linear ones oscillate at the frequency W of the trapezoidal rule, tan(W h / 2) = w h / 2, without
// loss or gain at any stiffness; c grows to 4 if w h exceeds 1. The term vanishes at constant velocity. A very light
// or thin body would dive through the surface within a sub-step and be thrown out; its buoyancy is implicit, at the pose
// at the end of the sub-step. docs/fields.md has the derivation.
// D and the list of fields are found once a step; s, F and K in every sub-step.
//
// In: fields, poses, velocities. Out: velocities. Bodies are independent of each other.
#pragma once

#include "base/arena/arena.h"
#include "rigid/field/medium.h"

#include <span>

namespace gyre {

// A body with the fields that act on it in this step.
struct FieldBody {
  std::uint32_t body = 0;
  std::span<const std::uint32_t> fields{};  // slots of fields
  std::span<Mat6> drags{};                  // D of each field; zero for radial fields
  Mat6 drag;                                // their sum
  bool has_drag = false;
  bool has_implicit_buoyancy = false;  // the buoyancy is implicit
  bool unconstrained = false;          // no constraint acts on the body
  Vec3 linear_before, angular_before;  // u0
};

// Force and torque of fields on a body at one moment, with explicit drag, for integrators that evaluate forces at
// several stages.
Vec6 force_of_fields(const RigidWorld& w, std::uint32_t body, std::span<const std::uint32_t> fields,
                     const BodyState& state, double time);

// The context of the stages below, which run on blocks of kFieldBodiesPerBlock bodies.
struct FieldSolve {
  RigidWorld* world = nullptr;
  std::span<FieldBody> bodies{};
  float h = 0.0f;  // s

  int blocks() const;
};
constexpr int kFieldBodiesPerBlock = 8;

// The bodies on which a field acts, in the same order. Sets their BodyFlags::constraint_use, so constraints must have
// set theirs before. Without `free`, only bodies that constraints act on, too.
FieldSolve find_field_bodies(RigidWorld& w, std::span<const std::uint32_t> bodies, float h, Arena& arena,
                             bool free = true);

// Once at the beginning of the step: drag and stream.
void prepare_field_bodies(const FieldSolve& fields, int begin, int end);
// At the beginning of a sub-step: stores the velocities.
void record_field_velocities(const FieldSolve& fields, int begin, int end);
// Between the forces and the constraints of a sub-step.
void apply_field_forces(const FieldSolve& fields, int begin, int end);

}  // namespace gyre
