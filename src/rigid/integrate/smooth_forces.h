// The smooth part of motion: bodies that no contact or joint acts on, with the forces that depend on where and how fast they are,
// as one system of ordinary differential equations. For integrators that look at forces at several stages
// (rigid/integrate/smooth_schemes.h); the default one does not come here.
//
// A system holds bodies that springs couple, or one body alone. Its state is place and orientation, and as velocities v and the
// angular momentum L about the centre of mass (world frame), since  x' = v, m v' = F, q' = 1/2 w q, w = I^-1(q) L, L' = T.
// A body that may not turn about some axes has its angular velocity in the place of L: what holds it takes up the rest.
//
// In: the world as the step began, the state of the system. Out: forces. In double throughout: velocities and places become
// floats when the step is over.
#pragma once

#include "solver/motion/torque_free_rotation.h"
#include "rigid/field/medium.h"

#include <span>

namespace gyre {

struct SmoothState {
  DVec3 x;  // m, centre of mass, world
  DQuat q;  // world_from_body
  DVec3 v;  // m/s
  DVec3 l;  // kg m^2/s, world; rad/s of a body with locked axes
};

// What stays the same in a step.
struct SmoothBody {
  std::uint32_t body = 0;
  double mass = 1.0;
  Tensor inertia, inverse_inertia;                     // body frame
  DVec3 acceleration;                           // m/s^2: gravity, and forces that the user gave
  DVec3 torque;                                        // N m, that the user gave
  double linear_damping = 0.0, angular_damping = 0.0;  // 1/s
  double bounding_radius = 0.0;                                  // m
  std::uint8_t locked_linear = 0, locked_angular = 0;
  std::span<const std::uint32_t> fields{};  // that act on it: slots
  SmoothState start;                        // as the step began
};

// One end of a spring: a body of the system, or a point that is carried along by what is none of it.
struct SpringEnd {
  int index = -1;          // in the system; -1: carried
  std::int32_t body = -1;  // kNoBody: the fixed world
  DVec3 arm;               // from the centre of mass, body frame
  DVec3 point, velocity;   // carried: as the part began, world
};

// Hooke's spring with a damper, between two points.
struct SmoothSpring {
  std::uint32_t joint = 0;
  double stiffness = 0.0, damping = 0.0, rest = 0.0;  // N/m, N s/m, m
  SpringEnd a, b;
  DVec3 impulse;        // N s, on b, of the part: what the scheme made of the forces at its stages
  DVec3 total;          // of the step
  double length = 0.0;  // m, when last looked at
};

struct Rates {
  DVec3 acceleration;  // m/s^2
  DVec3 torque;        // N m; rad/s^2 of a body with locked axes
};

struct SmoothSystem {
  const RigidWorld* world = nullptr;
  std::span<SmoothBody> bodies{};
  std::span<SmoothSpring> springs{};
  bool carried = false;  // a spring has an end on something that moves and is none of the system
  bool damped = false;   // forces depend on velocities
  double begin = 0.0;    // s, as the step began: for fields that change by themselves
  double substep_begin = 0.0;     // s after that, as the part began: since then carried points move
};

// World angular velocity.
DVec3 spin_of(const SmoothBody& body, const SmoothState& s);
// The l that goes with an angular velocity.
DVec3 momentum_of(const SmoothBody& body, const SmoothState& s, DVec3 spin);
DVec3 without_axes(DVec3 v, std::uint8_t locked);

// Forces at a state, `time` after the step began (s). Springs add `weight` (s) times theirs to their impulse. With `damping` that
// of the bodies is among the forces.
void find_rates(const SmoothSystem& system, std::span<const SmoothState> states, double time, double weight,
                bool damping, std::span<Rates> rates);

// The force of a spring on b between two points, and its length.
struct SpringForce {
  DVec3 force;
  double length = 0.0;
};
SpringForce spring_force(const SmoothSpring& spring, DVec3 a, DVec3 b, DVec3 velocity_a, DVec3 velocity_b);

}  // namespace gyre
