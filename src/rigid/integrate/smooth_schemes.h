// The integrators, on a system of smooth forces (rigid/integrate/smooth_forces.h).
//
//   explicit_euler       x += h v, then v += h a;  q by exp(h w), then L += h T
//   semi_implicit_euler  v += h a, then x += h v;  L += h T, then the exact turn at constant L (solver/motion/torque_free_rotation.h)
//   rk4                  Kutta's four stages on (x, v, q, L), weights 1, 2, 2, 1; q scaled back to length 1
//   verlet               from the last two poses: V+ = (x - x-) / h- + a (h + h-) / 2, x += h V+, which keeps order 2 where the
//                        step changes. Orientation alike: L at the middle of the last turn is I(q_mid) (turn / h-), T moves it on
//                        to the middle of the next, and I(q_mid) (turn / h) = L is solved for the turn. Velocities that forces
//                        ask for, and those that are shown, are V + a h- / 2 at the time of the pose.
// Euler's schemes take damping of bodies exactly, as the default integrator does; the others as a force.
// Sources: E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", I.1, VII.5; W. Kutta, "Beitrag zur
// naeherungsweisen Integration totaler Differentialgleichungen", 1901; L. Verlet, "Computer Experiments on Classical Fluids", 1967.
#pragma once

#include "rigid/integrate/smooth_forces.h"

namespace gyre {

// Memory for the bodies of a system.
struct SchemeRoom {
  std::span<SmoothState> states;    // present state of the system
  std::span<LastMove> moves;        // Verlet: the last move. `linear` and `angular` are not used.
  std::span<DVec3> delta_rotation;  // rotation vector since the step began: the sum over the sub-steps
  std::span<SmoothState> stage;   // Runge-Kutta: the stage's state, and sums over stages
  std::span<Rates> rates, sum;
  std::span<DVec3> drift;
  std::span<DQuat> rates_q, sum_q;  // of the orientation
};
SchemeRoom make_room(std::size_t bodies, Arena& arena);

// Advances the system by `h`, `time` after the step began (s).
void integrate(IntegratorKind kind, const SmoothSystem& system, SchemeRoom& room, double time, double h);

// Puts the state with the velocities at the time of the pose into `stage`: Verlet's own are half a step
// older.
void set_pose_velocities(IntegratorKind kind, const SmoothSystem& system, SchemeRoom& room, double time);

// The order of the error of positions.
constexpr int order_of(IntegratorKind kind) {
  return kind == IntegratorKind::rk4 ? 4 : kind == IntegratorKind::verlet ? 2 : 1;
}

}  // namespace gyre
