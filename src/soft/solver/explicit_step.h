// One sub-step of a soft body by explicit schemes, on the same elements as the implicit one. Each is stable up to a step that the
// stiffest oscillation, of angular frequency w, decides: semi-implicit Euler and Verlet for h < 2 / w, Runge and Kutta's for h < 2.83 / w,
// explicit Euler without damping for none. They are here to be compared, and for soft, coarse bodies.
//
// Sources: E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", 2006, chapter I; L. Verlet, "Computer Experiments on
// Classical Fluids", 1967; W. Kutta, "Beitrag zur naeherungsweisen Integration totaler Differentialgleichungen", 1901.
#pragma once

#include "base/arena/arena.h"
#include "soft/body/soft_body.h"
#include "soft/kernels/soft_kernels.h"
#include "task/task_system.h"

namespace gyre {

enum class ExplicitScheme : std::uint8_t { explicit_euler, semi_implicit_euler, rk4, verlet };

struct ExplicitSettings {
  float step = 0.0f;  // s
  Vec3 gravity{};     // m/s^2
  ExplicitScheme scheme = ExplicitScheme::semi_implicit_euler;
};

void step_explicit(SoftBody& body, const ExplicitSettings& settings, const SoftKernels& kernels, Arena& arena,
                   TaskSystem& tasks);

}  // namespace gyre
