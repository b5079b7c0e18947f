#include "solver/rows/body_newton.h"

#include "math/wide_double.h"
#include "solver/rows/natural_map.h"

namespace gyre {

namespace {

// Velocities in a row of J: linear and angular of a, then of b.
constexpr int kJacobianSize = 12;

using Pair = WideDouble<2>;

// to += by values, for C numbers.
template <int C>
void add_times(const double* values, double by, double* to) {
  const Pair wide(by);
  GYRE_UNROLL
  for (int k = 0; k < C; k += 2)
    (Pair::load_loose(to + k) + wide * Pair::load_loose(values + k)).store_loose(to + k);
}

// block += column gain^T.
void add_product(const double* column, const double* gain, double* block) {
  GYRE_UNROLL
  for (int r = 0; r < kLuBlock; ++r) add_times<kLuBlock>(gain, column[r], block + r * kLuBlock);
}

class BodyNewton {
 public:
  BodyNewton(const RowProblem& problem, NumberRoom& room)
      : p_(problem),
        lu_{problem.plan, room.take(problem.plan->values), room.take(problem.plan->values),
            room.take(problem.plan->rows)},
        step_(room.take(problem.plan->rows)),
        velocities_(room.take(problem.plan->rows)),
        constants_(room.take(rows())),
        gains_(room.take(kJacobianSize * rows())) {}

  std::size_t rows() const { return p_.rows.size(); }
  double residual_of(int i, std::span<const double> x, std::span<const double> w) const {
    const auto in = [](std::span<const double> list) {
      return [list](int j) { return list[std::size_t(j)]; };
    };
    return row_residual(i, p_.rows[std::size_t(i)].limits, *p_.friction, in(x), in(w),
                        [&](int j) { return p_.rows[std::size_t(j)].diagonal; });
  }
  void find_speeds(std::span<const double> x, std::span<double> w) const {
    for (std::size_t i = 0; i < p_.bodies.size(); ++i)
      for (std::size_t k = 0; k < kLuBlock; ++k)
        velocities_[kLuBlock * i + k] = velocities_of(p_.bodies[i])[k];
    add_impulses(x);
    for (std::size_t i = 0; i < rows(); ++i)
      w[i] = speed_of_row(p_.rows[i]) - p_.rows[i].target_speed + p_.rows[i].compliance * x[i];
  }
  void find_change(std::span<const double> dx, std::span<double> dw) const {
    for (double& value : velocities_) value = 0.0;
    add_impulses(dx);
    for (std::size_t i = 0; i < rows(); ++i) dw[i] = speed_of_row(p_.rows[i]) + p_.rows[i].compliance * dx[i];
  }

  bool find_step(std::span<const double> x, std::span<const double> w, double damping, std::span<double> dx) {
    // Rows that make up loads come first.
    for (const bool of_loads : {true, false}) {
      for (std::size_t i = 0; i < rows(); ++i) {
        const RowKind kind = p_.rows[i].limits.kind;
        if (kind != RowKind::cone_second && (kind == RowKind::box) == of_loads) resolve(i, x, w, damping);
      }
    }
    assemble();
    if (!factor_lu(lu_)) return false;
    solve_lu(lu_, step_);
    for (std::size_t i = 0; i < rows(); ++i) {
      const double* const gain = &gains_[kJacobianSize * i];
      dx[i] = constants_[i];
      if (is_idle(gain)) continue;
      double sum = constants_[i];
      const double* const a = at(p_.rows[i].body_a);
      const double* const b = at(p_.rows[i].body_b);
      for (int k = 0; a != nullptr && k < kLuBlock; ++k) sum -= gain[k] * a[k];
      for (int k = 0; b != nullptr && k < kLuBlock; ++k) sum -= gain[kLuBlock + k] * b[k];
      dx[i] = sum;
    }
    return true;
  }

 private:
  // dx = constant - gain dv of row i, and of the second row of a cone.
  void resolve(std::size_t i, std::span<const double> x, std::span<const double> w, double damping) {
    const Row& row = p_.rows[i];
    const RowLimits& limits = row.limits;
    const bool is_cone = limits.kind == RowKind::cone;
    const std::size_t count = is_cone ? 2 : 1;
    MapPoint at{{x[i], 0.0}, {w[i], 0.0}, row.diagonal, 0.0, damping};
    if (is_cone) at.x[1] = x[i + 1], at.w[1] = w[i + 1], at.rate = max(at.rate, p_.rows[i + 1].diagonal);
    if (limits.kind != RowKind::box) at.load = load_of(limits, [&](int j) { return x[std::size_t(j)]; });
    const MapEquations e = is_cone ? cone_equations(limits, *p_.friction, at) : scalar_equation(limits, at);
    // (own + speed compliance) dx = right - speed J dv - load dL.
    double own[2][2] = {{1.0, 0.0}, {0.0, 1.0}};
    for (std::size_t r = 0; r < count; ++r) {
      for (std::size_t k = 0; k < count; ++k)
        own[r][k] = e.own[r][k] + e.speed[r][k] * p_.rows[i + k].compliance;
    }
    double inverse[2][2] = {{1.0 / own[0][0]}};
    if (is_cone) {
      const double d = own[0][0] * own[1][1] - own[0][1] * own[1][0];
      inverse[0][0] = own[1][1] / d, inverse[0][1] = -own[0][1] / d;
      inverse[1][0] = -own[1][0] / d, inverse[1][1] = own[0][0] / d;
    }
    for (std::size_t r = 0; r < count; ++r) {
      double* const gain = &gains_[kJacobianSize * (i + r)];
      for (std::size_t k = 0; k < kJacobianSize; ++k) gain[k] = 0.0;
      double constant = 0.0, of_load = 0.0;
      for (std::size_t k = 0; k < count; ++k) {
        constant += inverse[r][k] * e.right[k];
        of_load += inverse[r][k] * e.load[k];
        double by = 0.0;
        for (std::size_t m = 0; m < count; ++m) by += inverse[r][m] * e.speed[m][k];
        if (by != 0.0) add_times<kJacobianSize>(jacobian_of(p_.rows[i + k]), by, gain);
      }
      for (std::int32_t k = 0; of_load != 0.0 && k < limits.load_count; ++k) {
        const std::size_t j = std::size_t(limits.load_first + k);
        constant -= of_load * constants_[j];
        for (std::size_t m = 0; m < kJacobianSize; ++m) gain[m] -= of_load * gains_[kJacobianSize * j + m];
      }
      constants_[i + r] = constant;
    }
  }
  // The matrix 1 + M^-1 J^T G, and its right side M^-1 J^T c.
  void assemble() {
    for (double& value : lu_.lower) value = 0.0;
    for (double& value : lu_.upper) value = 0.0;
    for (double& value : step_) value = 0.0;
    for (const BlockColumn& column : lu_.plan->columns) {
      for (int k = 0; k < kLuBlock; ++k) lu_.lower[column.diagonal + std::uint32_t(7 * k)] = 1.0;
    }
    std::int32_t last_a = kNoRowBody, last_b = kNoRowBody;
    BlockLocation between;
    for (std::size_t i = 0; i < rows(); ++i) {
      const Row& row = p_.rows[i];
      const double* const gain = &gains_[kJacobianSize * i];
      const double* const gains_a = gains_of(row);
      const double* const gains_b = gains_a + kLuBlock;
      if (constants_[i] != 0.0) {
        if (row.body_a != kNoRowBody) add_times<kLuBlock>(gains_a, constants_[i], at(row.body_a));
        if (row.body_b != kNoRowBody) add_times<kLuBlock>(gains_b, constants_[i], at(row.body_b));
      }
      // Inactive limits, which are most rows of joints in a crowd.
      if (is_idle(gain)) continue;
      if (row.body_a != kNoRowBody) add_product(gains_a, gain, &lu_.lower[column_of(row.body_a).diagonal]);
      if (row.body_b != kNoRowBody)
        add_product(gains_b, gain + kLuBlock, &lu_.lower[column_of(row.body_b).diagonal]);
      if (row.body_a == kNoRowBody || row.body_b == kNoRowBody) continue;
      if (row.body_a != last_a || row.body_b != last_b) {
        last_a = row.body_a, last_b = row.body_b;
        between = find_block(*lu_.plan, std::uint32_t(last_a), std::uint32_t(last_b));
      }
      add_product(gains_a, gain + kLuBlock, &(between.first_is_row ? lu_.lower : lu_.upper)[between.offset]);
      add_product(gains_b, gain, &(between.first_is_row ? lu_.upper : lu_.lower)[between.offset]);
    }
  }
  static bool is_idle(const double* gain) {
    for (std::size_t k = 0; k < kJacobianSize; ++k) {
      if (gain[k] != 0.0) return false;
    }
    return true;
  }

  const BlockColumn& column_of(std::int32_t body) const {
    return lu_.plan->columns[lu_.plan->index_of[std::size_t(body)]];
  }
  // The part of the step of the body; null if no row moves it.
  double* at(std::int32_t body) const { return body == kNoRowBody ? nullptr : &step_[column_of(body).row]; }

  // Adds the effect of impulses to the velocities.
  void add_impulses(std::span<const double> impulses) const {
    for (std::size_t i = 0; i < rows(); ++i) {
      if (impulses[i] == 0.0) continue;
      const Row& row = p_.rows[i];
      const double* const gains = gains_of(row);
      if (row.body_a != kNoRowBody)
        add_times<kLuBlock>(gains, impulses[i], &velocities_[kLuBlock * std::size_t(row.body_a)]);
      if (row.body_b != kNoRowBody)
        add_times<kLuBlock>(gains + kLuBlock, impulses[i], &velocities_[kLuBlock * std::size_t(row.body_b)]);
    }
  }
  double speed_of_row(const Row& row) const {
    double sum = 0.0;
    const auto add = [&](std::int32_t body, const double* all) {
      const double* const v = &velocities_[kLuBlock * std::size_t(body)];
      for (int k = 0; k < kLuBlock; ++k) sum += all[k] * v[k];
    };
    if (row.body_a != kNoRowBody) add(row.body_a, jacobian_of(row));
    if (row.body_b != kNoRowBody) add(row.body_b, jacobian_of(row) + kLuBlock);
    return sum;
  }

  const RowProblem& p_;
  BlockLu lu_;
  std::span<double> step_, velocities_, constants_, gains_;
};

}  // namespace

std::size_t body_newton_room(std::size_t rows, const BlockPlan& plan) {
  return 2 * plan.values + 3 * plan.rows + (1 + kJacobianSize) * rows + newton_search_room(rows);
}

NewtonResult solve_body_newton(const RowProblem& problem, double tolerance, int max_steps,
                               std::span<double> x, NumberRoom room) {
  BodyNewton newton(problem, room);
  return newton_search(newton, tolerance, max_steps, x, room);
}

}  // namespace gyre
