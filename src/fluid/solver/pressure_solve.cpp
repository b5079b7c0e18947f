// Conjugate gradients on the pressure equation.
#include "fluid/solver/pressure_solve.h"

#include "fluid/solver/pressure_pockets.h"
#include "task/parallel.h"

namespace gyre {

namespace {

// Chebyshev's iteration on the eigenvalues between `low` and 2 (Y. Saad, "Iterative Methods for Sparse Linear Systems", 2003, 12.3).
struct Chebyshev {
  float middle, radius, sigma, rho;
  explicit Chebyshev(float low)
      : middle(0.5f * (2.0f + low)), radius(0.5f * (2.0f - low)), sigma(middle / radius), rho(1.0f / sigma) {}
  float first_gain() const { return 1.0f / middle; }
  void next(float& inertia, float& gain) {
    const float following = 1.0f / (2.0f * sigma - rho);
    inertia = following * rho;
    gain = 2.0f * following / radius;
    rho = following;
  }
};

constexpr float kSmoothLow = 0.35f;    // what a coarser level sees of the eigenvalues is below
constexpr float kCoarsestLow = 0.25f;  // of at most two cells an axis
constexpr int kCoarsestSteps = 8;

struct Cycle {
  PressureMatrix& matrix;
  const GasKernels& kernels;
  TaskSystem& tasks;
  double product = 0.0;  // of the finest level: result times right side

  template <class Fn>
  void rows(const GridShape& shape, Fn&& fn) {
    for_blocks(tasks, shape.rows(), kGridRows, [&](int begin, int end, int) { fn(begin, end); });
  }
  void wrap(int index, float* field) {
    wrap_ghosts(matrix.levels[index].shape, matrix.levels[index].periodic, field);
  }
  double smooth(int index, const float* b, float* x, const float* before, float inertia, float gain,
                float* out) {
    const PressureLevel level = matrix.level(index);
    wrap(index, x);
    return reduce_blocks(
        tasks, level.shape.rows(), kGridRows, 0.0,
        [&](int begin, int end, int) {
          return kernels.smooth(level, b, x, before, inertia, gain, out, begin, end);
        },
        [](double sum, double more) { return sum + more; });
  }
  void scale(int index, const float* b, float gain, float* out) {
    const PressureLevel level = matrix.level(index);
    rows(level.shape, [&](int begin, int end) { kernels.scale(level, b, gain, out, begin, end); });
  }

  // x = an approximate solution of A x = b on this level.
  void run(int index, const float* b, float* x, float* other) {
    float inertia, gain;
    if (index == matrix.count - 1) {
      Chebyshev steps(index == 0 ? 0.1f : kCoarsestLow);
      scale(index, b, steps.first_gain(), x);
      float* now = x;
      float* before = nullptr;
      for (int i = 1; i < kCoarsestSteps; ++i) {  // an odd number of steps from x: it ends in `other`
        steps.next(inertia, gain);
        float* const out = now == x ? other : x;
        product = smooth(index, b, now, before, inertia, gain, out);
        before = now;
        now = out;
      }
      steps.next(inertia, gain);
      product = smooth(index, b, now, before, inertia, gain, x);
      return;
    }
    Chebyshev down(kSmoothLow);
    scale(index, b, down.first_gain(), other);
    down.next(inertia, gain);
    smooth(index, b, other, nullptr, inertia, gain, x);
    const PressureLevel level = matrix.level(index);
    wrap(index, x);
    rows(level.shape, [&](int begin, int end) { kernels.residual(level, b, x, other, begin, end); });
    wrap(index, other);
    PressureGrid& coarse = matrix.levels[index + 1];
    rows(coarse.shape, [&](int begin, int end) {
      kernels.restrict_rows(level, coarse.shape, other, coarse.b.data(), begin, end);
    });
    run(index + 1, coarse.b.data(), coarse.x.data(), coarse.other.data());
    wrap(index + 1, coarse.x.data());
    rows(level.shape,
         [&](int begin, int end) { kernels.prolong(level, coarse.shape, coarse.x.data(), x, begin, end); });
    Chebyshev up(kSmoothLow);
    smooth(index, b, x, x, 0.0f, up.first_gain(), other);
    up.next(inertia, gain);
    product = smooth(index, b, other, x, inertia, gain, x);
  }
};

// Where no side is open the right side must add up to zero; what it adds up to is spread over all cells.
void remove_mean(const PressureMatrix& matrix, float* r, TaskSystem& tasks) {
  const GridShape& shape = matrix.levels[0].shape;
  const float* const inverse = matrix.levels[0].inverse_diagonal.data();
  const double sum = reduce_blocks(
      tasks, shape.rows(), kGridRows, 0.0,
      [&](int begin, int end, int) {
        double part = 0.0;
        for (int row = begin; row < end; ++row) {
          const int c = shape.row(row % shape.cells[1], row / shape.cells[1]);
          for (int i = c; i < c + shape.cells[0]; ++i) part += double(r[i]);
        }
        return part;
      },
      [](double a, double b) { return a + b; });
  const float mean = matrix.active_cells > 0 ? float(sum / double(matrix.active_cells)) : 0.0f;
  if (mean == 0.0f) return;
  for_blocks(tasks, shape.rows(), kGridRows, [&](int begin, int end, int) {
    for (int row = begin; row < end; ++row) {
      const int c = shape.row(row % shape.cells[1], row / shape.cells[1]);
      for (int i = c; i < c + shape.cells[0]; ++i) r[i] -= inverse[i] > 0.0f ? mean : 0.0f;
    }
  });
}

}  // namespace

PressureReport solve_pressure(PressureMatrix& matrix, const PressureVectors& v, float target,
                              int max_iterations, const GasKernels& kernels, TaskSystem& tasks,
                              const BodyCoupling* coupling) {
  const PressureLevel level = matrix.level(0);
  const GridShape& shape = level.shape;
  const auto rows = [&](auto&& fn) {
    for_blocks(tasks, shape.rows(), kGridRows, [&](int begin, int end, int) { fn(begin, end); });
  };
  if (matrix.has_pockets) {
    remove_pocket_means(matrix, v.r);
  } else if (matrix.singular) {
    remove_mean(matrix, v.r, tasks);
  }
  PressureReport report;
  const FieldRows cells{shape, {shape.cells[0], shape.cells[1], shape.cells[2]}};
  report.first = report.last = reduce_blocks(
      tasks, shape.rows(), kGridRows, 0.0f,
      [&](int begin, int end, int) { return kernels.largest(cells, v.r, begin, end); },
      [](float a, float b) { return a > b ? a : b; });
  rows([&](int begin, int end) { kernels.scale(level, v.r, 0.0f, v.x, begin, end); });
  if (!(report.last > target)) return report;

  Cycle cycle{matrix, kernels, tasks};
  double before = 0.0;
  while (report.iterations < max_iterations) {
    cycle.run(0, v.r, v.z, v.other);
    const double now = cycle.product;
    if (!(now > 0.0)) break;
    const float beta = report.iterations == 0 ? 0.0f : float(now / before);
    before = now;
    if (report.iterations == 0) {
      rows([&](int begin, int end) { kernels.scale(level, v.r, 0.0f, v.p, begin, end); });
    }
    rows([&](int begin, int end) { kernels.update_direction(level, beta, v.z, v.p, begin, end); });
    wrap_ghosts(shape, matrix.levels[0].periodic, v.p);
    double curvature = reduce_blocks(
        tasks, shape.rows(), kGridRows, 0.0,
        [&](int begin, int end, int) { return kernels.apply(level, v.p, v.q, begin, end); },
        [](double sum, double more) { return sum + more; });
    if (coupling != nullptr && coupling->any_moves) curvature += coupling->add_product(v.p, v.q);
    if (!(curvature > 0.0)) break;
    const float alpha = float(now / curvature);
    report.last = reduce_blocks(
        tasks, shape.rows(), kGridRows, 0.0f,
        [&](int begin, int end, int) {
          return kernels.advance(level, alpha, v.p, v.q, v.x, v.r, begin, end);
        },
        [](float a, float b) { return a > b ? a : b; });
    ++report.iterations;
    if (!(report.last > target)) break;
  }
  return report;
}

}  // namespace gyre
