// BodySystem: the linear system of one body, and conjugate gradients on it.
#pragma once

#include "soft/body/soft_body.h"
#include "soft/kernels/soft_kernels.h"
#include "soft/solver/soft_pass.h"
#include "task/parallel.h"
#include "task/task_system.h"

namespace gyre {

// Iterations over which the fall of the energy of the error is summed.
inline constexpr int kDelay = 2;

// The system of a pass.
class BodySystem {
 public:
  BodySystem(const SoftPass& pass, std::span<const CarriedInertia> carried, const SoftKernels& kernels,
             TaskSystem& tasks)
      : pass_(pass), carried_(carried), kernels_(kernels), tasks_(tasks) {}

  // product = A p; p times it.
  double apply() {
    double curvature = sum(kernels_.apply);
    for (const CarriedInertia& one : carried_) {
      const int i = one.particle;
      const Vec3 p{pass_.direction.x[i], pass_.direction.y[i], pass_.direction.z[i]};
      const Vec3 more = one.inertia * p;
      pass_.product.x[i] += more.x, pass_.product.y[i] += more.y, pass_.product.z[i] += more.z;
      curvature += double(dot(p, more));
    }
    return pass_.volume_scale > 0.0f ? curvature + apply_gas() : curvature;
  }

  double apply_gas() {
    const std::size_t rows = std::size_t(pass_.slices) * kSliceRows;
    double along = 0.0;
    for (std::size_t i = 0; i < rows; ++i)
      along += double(
          dot(pass_.volume_gradient[i], {pass_.direction.x[i], pass_.direction.y[i], pass_.direction.z[i]}));
    const float scaled = pass_.volume_scale * float(along);
    for (std::size_t i = 0; i < rows; ++i) {
      const Vec3 more = scaled * pass_.volume_gradient[i];
      pass_.product.x[i] += more.x, pass_.product.y[i] += more.y, pass_.product.z[i] += more.z;
    }
    return double(pass_.volume_scale) * along * along;
  }

  // d += alpha p; the residual times its preconditioned one.
  double advance(float alpha) { return sum(kernels_.advance, alpha); }
  // p = preconditioned residual + beta p
  void turn(float beta) { each(kernels_.turn, beta); }

  template <class Kernel, class... Rest>
  void each(Kernel kernel, Rest... rest) {
    for_blocks(tasks_, pass_.slices, kBlockSlices,
               [&](int begin, int end, int) { kernel(pass_, rest..., begin, end); });
  }
  template <class Kernel, class... Rest>
  double sum(Kernel kernel, Rest... rest) {
    return reduce_blocks(
        tasks_, pass_.slices, kBlockSlices, 0.0,
        [&](int begin, int end, int) { return kernel(pass_, rest..., begin, end); },
        [](double a, double b) { return a + b; });
  }

 private:
  const SoftPass& pass_;
  std::span<const CarriedInertia> carried_;
  const SoftKernels& kernels_;
  TaskSystem& tasks_;
};

// Until the energy of the error, e . A e, falls by at most `wanted` in kDelay iterations, which is a lower bound of that energy and near it
// (M. Hestenes, E. Stiefel, 1952). The residual says less: in a fine mesh of a stiff body a small one belongs to a large slow motion.
// Returns the number of iterations, within bounds; `error` becomes the residual at the end.
inline int iterate(BodySystem& system, double& error, double wanted, int least, int most) {
  int iterations = 0;
  double gains[kDelay] = {};
  while (error > 0.0 && iterations < most) {
    const double curvature = system.apply();
    if (!(curvature > 0.0)) break;
    gains[iterations % kDelay] = error * (error / curvature);
    const double after = system.advance(float(error / curvature));
    system.turn(float(after / error));
    error = after;
    ++iterations;
    double recent = 0.0;
    for (const double gain : gains) recent += gain;
    if (iterations >= max(least, kDelay) && recent <= wanted) break;
  }
  return iterations;
}

}  // namespace gyre
