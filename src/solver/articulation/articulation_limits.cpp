#include "solver/articulation/articulation_limits.h"

#include "solver/articulation/articulation_response.h"

namespace gyre {

namespace {

constexpr float kSpeedTolerance = 1.0e-4f;  // m/s or rad/s: smaller violations stay
constexpr int kRounds = 3;                  // each finds limits that are violated because others hold
constexpr double kSettledSpeed = 1.0e-5;    // m/s or rad/s: smaller changes of speed end the iteration
constexpr int kIterations = 100;

// A limit at one end of an axis: its speed is sign times that of the axis.
struct LimitRow {
  std::uint32_t node = 0;
  AxisConstraint* axis = nullptr;
  float sign = 1.0f;
  float bias = 0.0f;  // speed below which it acts
  float& impulse() const { return sign > 0.0f ? axis->axis.low_impulse : axis->axis.high_impulse; }
};

class LimitSolve {
 public:
  LimitSolve(const Articulation& articulation, const ArticulationSolve& solve, ErrorBounds bounds)
      : articulation_(articulation), solve_(solve), bounds_(bounds), row_count_(articulation.plan.rows) {
    std::span<double> room = solve.room;
    columns_ = {take_room(room, response_room(kMaxLimits, row_count_))};
    speeds_ = take_room(room, 6 * articulation.bodies.size());
  }

  void solve() {
    for (int round = 0; round < kRounds; ++round) {
      if (count_ == kMaxLimits) count_ = 0;
      const std::size_t known = count_;
      list_violated();
      if (count_ == known && (round > 0 || !is_any_violated())) return;
      for (std::size_t c = known; c < count_; ++c)
        find_response(articulation_, solve_, rows_[c], columns_.at(c, row_count_));
      compute_delassus(articulation_, solve_, {rows_, count_}, columns_, known, matrix_[0], kMaxLimits);
      find_impulses();
      apply();
    }
  }

 private:
  // Speed of the limit minus its bias.
  float speed_of(const LimitRow& limit) const {
    const float second_order_bias = bounds_.rotation > 0.0f ? limit.axis->second_order_bias : 0.0f;
    const float speed =
        second_order_bias + axis_speed(articulation_.nodes[limit.node], limit.axis->row, solve_.bodies);
    return limit.sign * speed - limit.bias;
  }

  // Lists limits that are violated or have an impulse.
  void list_violated() {
    const std::uint32_t nodes = std::uint32_t(articulation_.nodes.size());
    for (std::uint32_t k = 0; k < nodes && count_ < kMaxLimits; ++k) {
      const std::uint32_t n = (first_ + k) % nodes;
      const ArticulationNode& node = articulation_.nodes[n];
      for (AxisConstraint& x : solve_.work[node.work].axes) {
        if (!has_hard_limit(x) || !(x.mass > 0.0f)) continue;
        const bool is_angular = x.row.linear_b == Vec3{} && x.row.linear_a == Vec3{};
        const float lowest = is_angular ? -min(bounds_.rotation, kMaxLimitError) : -bounds_.point;
        if (x.has_low) consider({n, &x, 1.0f}, max(low_gap(x), lowest));
        if (x.has_high) consider({n, &x, -1.0f}, max(high_gap(x), lowest));
      }
      if (count_ == kMaxLimits) first_ = n;  // its other limits come first in the next round
    }
  }
  void consider(LimitRow limit, float gap) {
    if (count_ == kMaxLimits) return;
    const float rate = gap > 0.0f ? 1.0f / solve_.settings.substep : solve_.settings.softness.bias_rate;
    limit.bias = -rate * gap;
    if (!(limit.impulse() > 0.0f) && !(speed_of(limit) < -kSpeedTolerance)) return;
    for (std::size_t c = 0; c < count_; ++c)
      if (limits_[c].axis == limit.axis && limits_[c].sign == limit.sign) return;
    rows_[count_] = {limit.node, &limit.axis->row, limit.sign};
    limits_[count_++] = limit;
  }
  bool is_any_violated() const {
    for (std::size_t c = 0; c < count_; ++c) {
      const float speed = speed_of(limits_[c]);
      if (speed < -kSpeedTolerance || (speed > kSpeedTolerance && limits_[c].impulse() > 0.0f)) return true;
    }
    return false;
  }

  void find_impulses() {
    double speed[kMaxLimits], low[kMaxLimits];
    for (std::size_t c = 0; c < count_; ++c) {
      speed[c] = double(speed_of(limits_[c]));
      low[c] = -double(limits_[c].impulse());
      impulses_[c] = 0.0;
    }
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      double largest = 0.0;
      for (std::size_t c = 0; c < count_; ++c) {
        if (!(matrix_[c][c] > 0.0)) continue;
        const double now = max(low[c], impulses_[c] - speed[c] / matrix_[c][c]), by = now - impulses_[c];
        if (by == 0.0) continue;
        impulses_[c] = now;
        for (std::size_t d = 0; d < count_; ++d) speed[d] += matrix_[d][c] * by;
        largest = max(largest, std::abs(by * matrix_[c][c]));
      }
      if (largest < kSettledSpeed) return;
    }
  }

  void apply() {
    apply_row_impulses(articulation_, solve_, {rows_, count_}, {impulses_, count_}, speeds_);
    for (std::size_t c = 0; c < count_; ++c)
      if (impulses_[c] != 0.0) limits_[c].impulse() = max(0.0f, limits_[c].impulse() + float(impulses_[c]));
  }

  const Articulation& articulation_;
  const ArticulationSolve& solve_;
  ErrorBounds bounds_;
  std::size_t row_count_;    // of the equations
  ResponseColumns columns_;  // by limit
  std::span<double> speeds_;
  std::size_t count_ = 0;
  std::uint32_t first_ = 0;  // node
  // Valid for the first `count_` limits.
  LimitRow limits_[kMaxLimits];
  ResponseRow rows_[kMaxLimits];
  double matrix_[kMaxLimits][kMaxLimits];
  double impulses_[kMaxLimits];
};

}  // namespace

std::size_t limits_room(std::size_t rows, std::size_t bodies) {
  return response_room(kMaxLimits, rows) + 6 * bodies;
}

void solve_limits(const Articulation& articulation, const ArticulationSolve& solve, ErrorBounds bounds) {
  if (!articulation.has_limits) return;
  LimitSolve(articulation, solve, bounds).solve();
}

}  // namespace gyre
