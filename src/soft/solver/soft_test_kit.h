// Parts that the tests of soft bodies share.
#pragma once

#include "soft/body/soft_energy.h"
#include "soft/solver/body_system.h"
#include "soft/solver/implicit_step.h"

#include <cmath>

namespace gyre::soft_test {

struct Bench {
  Arena arena;
  TaskSystem tasks{1};
  const SoftKernels& kernels = select_soft_kernels(0);

  ImplicitReport step(SoftBody& body, const ImplicitSettings& settings) {
    return step_implicit(body, settings, kernels, arena, tasks);
  }
  // Long steps, which backward Euler damps, until it rests.
  void settle(SoftBody& body, Vec3 gravity, float step, int steps) {
    ImplicitSettings settings;
    settings.step = step;
    settings.gravity = gravity;
    settings.tolerance = 1.0e-6f;
    settings.most_iterations = 400;
    for (int i = 0; i < steps; ++i) this->step(body, settings);
  }
};

// The change of velocity that impulses (N s, a row for each particle, also those that fill up the last slice) make: A d = impulses, by conjugate gradients.
inline void find_response(Bench& bench, const SoftBody& body, const ImplicitStep& step,
                          const VectorRows& impulses, const VectorRows& change) {
  SoftPass pass = step.pass;
  pass.change = change;
  pass.residual = make_vectors(bench.arena, body.particles.x.size());
  for (std::size_t i = 0; i < body.particles.x.size(); ++i) {
    change.x[i] = change.y[i] = change.z[i] = 0.0f;
    pass.residual.x[i] = impulses.x[i], pass.residual.y[i] = impulses.y[i],
    pass.residual.z[i] = impulses.z[i];
  }
  BodySystem system(pass, step.carried, bench.kernels, bench.tasks);
  double error = system.sum(bench.kernels.precondition);
  iterate(system, error, 1.0e-12 * error, 1, 500);
}

inline DVec3 momentum(const SoftBody& body) {
  DVec3 sum{};
  for (int i = 0; i < body.particles.count; ++i)
    sum += double(body.particles.mass[i]) * DVec3(body.particles.velocity(i));
  return sum;
}
inline double mass_of(const SoftBody& body) {
  double sum = 0.0;
  for (int i = 0; i < body.particles.count; ++i) sum += double(body.particles.mass[i]);
  return sum;
}
inline DVec3 center_of(const SoftBody& body) {
  DVec3 sum{};
  for (int i = 0; i < body.particles.count; ++i)
    sum += double(body.particles.mass[i]) * body.particles.place(i);
  return sum / mass_of(body);
}
inline DVec3 angular_momentum(const SoftBody& body) {
  const DVec3 center = center_of(body);
  DVec3 sum{};
  for (int i = 0; i < body.particles.count; ++i) {
    sum += double(body.particles.mass[i]) *
           cross(body.particles.place(i) - center, DVec3(body.particles.velocity(i)));
  }
  return sum;
}
inline double kinetic_energy(const SoftBody& body) {
  double sum = 0.0;
  for (int i = 0; i < body.particles.count; ++i) {
    sum += 0.5 * double(body.particles.mass[i]) * length_squared(DVec3(body.particles.velocity(i)));
  }
  return sum;
}

}  // namespace gyre::soft_test
