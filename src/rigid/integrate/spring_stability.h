// The step that an explicit scheme needs to follow the world's springs.
//
// The fastest oscillation of all springs together is the largest eigenvalue w^2 of S = K^1/2 B M^-1 B' K^1/2
// over the springs that are forces (one row of B each: along the spring, at its two points), by power
// iteration; its damping comes from the dampers in the same mode. A scheme follows x'' = -w^2 x - 2 d x' as
// long as no eigenvalue of its step lies outside the unit circle; bisection of the scheme's own 2 x 2 matrix
// finds the longest such step.
//
// Source: G. H. Golub, C. F. Van Loan, "Matrix Computations", 8.2 (power iteration); E. Hairer, G. Wanner,
// "Solving Ordinary Differential Equations II", IV.2 (stability functions).
#pragma once

#include "base/arena/arena.h"
#include "rigid/store/rigid_world.h"

namespace gyre {

struct SpringMode {
  int springs = 0;          // springs that are forces, of awake bodies
  double frequency = 0.0;   // rad/s, undamped, of the fastest mode
  double decay = 0.0;       // 1/s, d
  std::uint32_t joint = 0;  // the joint with the largest share of it
};
SpringMode find_fastest_mode(const RigidWorld& w, Arena& arena);

// The longest stable step for an oscillator, s: 0 if there is none, kAnyStep without bound.
constexpr double kAnyStep = 1.0e30;
double critical_step(IntegratorKind kind, double frequency, double decay);

}  // namespace gyre
