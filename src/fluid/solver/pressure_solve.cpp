// Conjugate gradients on the pressure equation.
#include "fluid/solver/pressure_solve.h"

#include "fluid/solver/pressure_pockets.h"
#include "task/parallel.h"

#include <utility>

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

// Numbers of a field that a stage works on before the next follows: a quarter of a megabyte, so that the four fields of a stage fit into a cache of the second
// level. Of any size the bits are the same.
constexpr int kStaggered = 1 << 16;

struct Cycle {
  PressureMatrix& matrix;
  const GasKernels& kernels;
  TaskSystem& tasks;
  double product = 0.0;  // of the finest level: result times right side

  template <class Fn>
  void rows(const GridShape& shape, Fn&& fn) {
    rows_between(0, shape.rows(), fn);
  }
  template <class Fn>
  void rows_between(int first, int last, Fn&& fn) {
    for_blocks(tasks, last - first, kGridRows,
               [&](int begin, int end, int) { fn(first + begin, first + end); });
  }
  // Adds fn(begin, end) of blocks of rows to a sum, in the order of rows.
  template <class Fn>
  double add_rows_between(int first, int last, double sum, Fn&& fn) {
    return reduce_blocks(
        tasks, last - first, kGridRows, sum,
        [&](int begin, int end, int) { return fn(first + begin, first + end); },
        [](double all, double more) { return all + more; });
  }

  // Calls stages, fn(first row, last row), on some rows after the other: each a layer of cells behind the one before, so that what that one has written
  // is still in the cache. A stage reads its row and the neighbours, and no stage writes what one before has yet to read. If the level is
  // periodic, each stage waits for all rows of the one before, and begins with its ghosts.
  template <class... Stages>
  void run_staggered(int index, Stages&&... stages) {
    const PressureGrid& grid = matrix.levels[index];
    const bool wraps = grid.periodic[0] || grid.periodic[1] || grid.periodic[2];
    const int rows = grid.shape.rows();
    const int lag = wraps ? 0 : round_up(grid.shape.cells[1]);
    const int chunk = wraps ? round_up(rows) : round_up(kStaggered / grid.shape.pitch);
    const int count = int(sizeof...(stages));
    for (int begin = 0; begin < rows + (count - 1) * lag; begin += chunk) {
      int first = begin;
      const auto run_stage = [&](auto& stage) {
        const int from = first > 0 ? first : 0, to = first + chunk < rows ? first + chunk : rows;
        if (from < to) stage(from, to);
        first -= lag;
      };
      (run_stage(stages), ...);
    }
  }
  static int round_up(int rows) { return (rows + kGridRows - 1) / kGridRows * kGridRows; }
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
    const float first_gain = down.first_gain();
    down.next(inertia, gain);
    const PressureLevel level = matrix.level(index);
    // One step of the iteration on some rows.
    const auto smooth_rows = [&](const float* from, const float* before, float keeps, float gains, float* to,
                                 int first, int last) {
      return add_rows_between(first, last, product, [&](int begin, int end) {
        return kernels.smooth(level, b, from, before, keeps, gains, to, begin, end);
      });
    };
    run_staggered(
        index,
        [&](int first, int last) {
          rows_between(first, last,
                       [&](int begin, int end) { kernels.scale(level, b, first_gain, other, begin, end); });
        },
        [&](int first, int last) {
          if (first == 0) wrap(index, other);
          smooth_rows(other, nullptr, inertia, gain, x, first, last);
        },
        [&](int first, int last) {
          if (first == 0) wrap(index, x);
          rows_between(first, last,
                       [&](int begin, int end) { kernels.residual(level, b, x, other, begin, end); });
        });
    wrap(index, other);
    PressureGrid& coarse = matrix.levels[index + 1];
    rows(coarse.shape, [&](int begin, int end) {
      kernels.restrict_rows(level, coarse.shape, other, coarse.b.data(), begin, end);
    });
    run(index + 1, coarse.b.data(), coarse.x.data(), coarse.other.data());
    wrap(index + 1, coarse.x.data());
    Chebyshev up(kSmoothLow);
    const float up_gain = up.first_gain();
    up.next(inertia, gain);
    product = 0.0;
    run_staggered(
        index,
        [&](int first, int last) {
          rows_between(first, last, [&](int begin, int end) {
            kernels.prolong(level, coarse.shape, coarse.x.data(), x, begin, end);
          });
        },
        [&](int first, int last) {
          if (first == 0) wrap(index, x);
          smooth_rows(x, x, 0.0f, up_gain, other, first, last);
        },
        [&](int first, int last) {
          if (first == 0) wrap(index, other);
          product = smooth_rows(other, x, inertia, gain, x, first, last);
        });
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

PressureReport solve_pressure(PressureMatrix& matrix, const PressureVectors& vectors, float target,
                              int max_iterations, const GasKernels& kernels, TaskSystem& tasks,
                              const BodyCoupling* coupling) {
  PressureVectors v = vectors;
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
    double curvature = 0.0;
    const auto update = [&](int first, int last) {
      cycle.rows_between(first, last, [&](int begin, int end) {
        kernels.update_direction(level, beta, v.z, v.p, begin, end);
      });
    };
    const auto apply = [&](int first, int last) {
      if (first == 0) cycle.wrap(0, v.p);
      curvature = cycle.add_rows_between(first, last, curvature, [&](int begin, int end) {
        return kernels.apply(level, v.p, v.q, begin, end);
      });
    };
    if (report.iterations == 0) {
      // The first direction is the preconditioned residual itself.
      std::swap(v.p, v.z);
      cycle.run_staggered(0, apply);
    } else {
      cycle.run_staggered(0, update, apply);
    }
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
