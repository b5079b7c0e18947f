// Smooth motion: free bodies under forces that depend on pose and velocity, as a system of ordinary
// differential equations. For integrators with several stages (rigid/integrate/smooth_schemes.h); the default
// integrator does not use it.
//
// A system holds bodies that springs connect, or a single body. Its state is position and orientation, and as
// velocities v and the angular momentum L about the centre of mass (world frame): x' = v, m v' = F, q' = 1/2
// w q, w = I^-1(q) L, L' = T. A body with locked angular axes has its angular velocity in the place of L: the
// locks take up the rest.
//
// In: the world as the step began, the state of the system. Out: forces. Everything is double; velocities and
// poses become floats after the step.
#pragma once

#include "rigid/field/medium.h"
#include "solver/motion/torque_free_rotation.h"

#include <span>

namespace gyre {

struct SmoothState {
  DVec3 x;  // m, centre of mass, world
  DQuat q;  // world_from_body
  DVec3 v;  // m/s
  DVec3 l;  // kg m^2/s, world; rad/s for a body with locked axes
};

// Constants of a body in a step.
struct SmoothBody {
  std::uint32_t body = 0;
  double mass = 1.0;
  Tensor inertia, inverse_inertia;                     // body frame
  DVec3 acceleration;                                  // m/s^2: gravity, and forces of the user
  DVec3 torque;                                        // N m, of the user
  double linear_damping = 0.0, angular_damping = 0.0;  // 1/s
  double bounding_radius = 0.0;                        // m
  std::uint8_t locked_linear = 0, locked_angular = 0;
  std::span<const std::uint32_t> fields{};  // slots of the fields that act on it
  SmoothState start;                        // at the beginning of the step
};

// One end of a spring: a body of the system, or a point on another body that carries it.
struct SpringEnd {
  int index = -1;          // in the system; -1: carried
  std::int32_t body = -1;  // kNoBody: the static world
  DVec3 arm;               // from the centre of mass, body frame
  DVec3 point, velocity;   // carried: at the beginning of the sub-step, world
};

// Hooke's spring with a damper, between two points.
struct SmoothSpring {
  std::uint32_t joint = 0;
  double stiffness = 0.0, damping = 0.0, rest = 0.0;  // N/m, N s/m, m
  SpringEnd a, b;
  DVec3 impulse;        // N s, on b, in the sub-step: the scheme's sum of forces at its stages
  DVec3 total;          // of the step
  double length = 0.0;  // m, at the last evaluation
};

struct Rates {
  DVec3 acceleration;  // m/s^2
  DVec3 torque;        // N m; rad/s^2 for a body with locked axes
};

struct SmoothSystem {
  const RigidWorld* world = nullptr;
  std::span<SmoothBody> bodies{};
  std::span<SmoothSpring> springs{};
  bool carried = false;  // a spring has an end on a moving body outside of the system
  bool damped = false;   // forces depend on velocities
  double begin = 0.0;    // s, at the beginning of the step, for fields that vary in time
  double substep_begin = 0.0;  // s after that, at the beginning of the sub-step, from where carried points
                               // move
};

// World angular velocity.
DVec3 spin_of(const SmoothBody& body, const SmoothState& s);
// The l for an angular velocity.
DVec3 momentum_of(const SmoothBody& body, const SmoothState& s, DVec3 spin);
DVec3 without_axes(DVec3 v, std::uint8_t locked);

// Forces at a state, `time` after the beginning of the step (s). Springs add their force times `weight` (s)
// to their impulse. `damping`: includes the damping of bodies.
void find_rates(const SmoothSystem& system, std::span<const SmoothState> states, double time, double weight,
                bool damping, std::span<Rates> rates);

// The force of a spring on b between two points, and its length.
struct SpringForce {
  DVec3 force;
  double length = 0.0;
};
SpringForce spring_force(const SmoothSpring& spring, DVec3 a, DVec3 b, DVec3 velocity_a, DVec3 velocity_b);

}  // namespace gyre
