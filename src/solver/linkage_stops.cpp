#include "solver/linkage_stops.h"

#include "solver/joint_equations.h"

namespace gyre {

namespace {

constexpr float kCalm = 1.0e-4f;     // m/s or rad/s: less is left as it is
constexpr int kRounds = 3;           // each looks for stops that were passed because others hold
constexpr double kSettled = 1.0e-5;  // m/s or rad/s: impulses that change speeds by less stand
constexpr int kSweeps = 100;

// A stop at one end of an axis: it sees sign times the axis' speed.
struct Stop {
  std::uint32_t node = 0;
  AxisWork* axis = nullptr;
  float sign = 1.0f;
  float asked = 0.0f;  // speed below which it holds
  float& impulse() const { return sign > 0.0f ? axis->axis.low_impulse : axis->axis.high_impulse; }
};

class StopSolve {
 public:
  StopSolve(const Linkage& linkage, const LinkageSolve& solve, ErrorBounds bounds)
      : linkage_(linkage),
        solve_(solve),
        bounds_(bounds),
        rows_(linkage.plan.rows),
        speeds_(6 * linkage.bodies.size()) {
    double* room = solve.room.data();
    const auto take = [&](std::size_t count) {
      double* const part = room;
      room += count;
      return part;
    };
    equations_ = take(kMostStops * rows_);
    changes_ = take(kMostStops * speeds_);
    sum_ = take(speeds_);
  }

  void solve() {
    for (int round = 0; round < kRounds; ++round) {
      if (count_ == kMostStops) count_ = 0;
      const std::size_t known = count_;
      list_passed();
      if (count_ == known && (round > 0 || !is_any_off())) return;
      for (std::size_t c = known; c < count_; ++c) find_response(c);
      for (std::size_t c = 0; c < count_; ++c)
        for (std::size_t d = 0; d < count_; ++d)
          if (c >= known || d >= known) matrix_[c][d] = axis_speed(stops_[c], changes_ + d * speeds_);
      find_impulses();
      push();
    }
  }

 private:
  // By how much the stop's speed is above what is asked.
  float speed_of(const Stop& stop) const {
    const LinkageNode& node = linkage_.nodes[stop.node];
    const AxisRow& row = stop.axis->row;
    float speed = bounds_.turn > 0.0f ? stop.axis->bend : 0.0f;
    if (node.body_a != kNoBody) {
      const BodyMotion& a = solve_.bodies.motion[node.body_a];
      speed -= dot(row.push_a, a.linear_velocity) + dot(row.arm_a, a.angular_velocity);
    }
    if (node.body_b != kNoBody) {
      const BodyMotion& b = solve_.bodies.motion[node.body_b];
      speed += dot(row.push_b, b.linear_velocity) + dot(row.arm_b, b.angular_velocity);
    }
    return stop.sign * speed - stop.asked;
  }

  // Those that are passed, or bear an impulse.
  void list_passed() {
    const std::uint32_t nodes = std::uint32_t(linkage_.nodes.size());
    for (std::uint32_t k = 0; k < nodes && count_ < kMostStops; ++k) {
      const std::uint32_t n = (first_ + k) % nodes;
      const LinkageNode& node = linkage_.nodes[n];
      for (AxisWork& x : solve_.work[node.work].axes) {
        if (!has_hard_stop(x) || !(x.mass > 0.0f)) continue;
        const bool turns = x.row.push_b == Vec3{} && x.row.push_a == Vec3{};
        const float least = turns ? -min(bounds_.turn, kMostStopError) : -bounds_.point;
        if (x.has_low) consider({n, &x, 1.0f}, max(low_gap(x), least));
        if (x.has_high) consider({n, &x, -1.0f}, max(high_gap(x), least));
      }
      if (count_ == kMostStops)
        first_ = n;  // those of its stops that found no room come first in the next round
    }
  }
  void consider(Stop stop, float gap) {
    if (count_ == kMostStops) return;
    const float rate = gap > 0.0f ? 1.0f / solve_.settings.substep : solve_.settings.softness.bias_rate;
    stop.asked = -rate * gap;
    if (!(stop.impulse() > 0.0f) && !(speed_of(stop) < -kCalm)) return;
    for (std::size_t c = 0; c < count_; ++c)
      if (stops_[c].axis == stop.axis && stops_[c].sign == stop.sign) return;
    stops_[count_++] = stop;
  }
  bool is_any_off() const {
    for (std::size_t c = 0; c < count_; ++c) {
      const float speed = speed_of(stops_[c]);
      if (speed < -kCalm || (speed > kCalm && stops_[c].impulse() > 0.0f)) return true;
    }
    return false;
  }

  // ------------------------------------------------------- velocities of the linkage's bodies, six numbers each

  static DVec3 at(const double* speeds, std::int32_t side, int part) {
    const double* const v = speeds + 6 * side + 3 * part;
    return {v[0], v[1], v[2]};
  }
  static void add(double* speeds, std::int32_t side, DVec3 linear, DVec3 angular) {
    double* const v = speeds + 6 * side;
    v[0] += linear.x, v[1] += linear.y, v[2] += linear.z;
    v[3] += angular.x, v[4] += angular.y, v[5] += angular.z;
  }
  double axis_speed(const Stop& stop, const double* speeds) const {
    const LinkageNode& node = linkage_.nodes[stop.node];
    const AxisRow& row = stop.axis->row;
    double speed = 0.0;
    if (node.side_a >= 0)
      speed -= dot(DVec3(row.push_a), at(speeds, node.side_a, 0)) +
               dot(DVec3(row.arm_a), at(speeds, node.side_a, 1));
    if (node.side_b >= 0)
      speed += dot(DVec3(row.push_b), at(speeds, node.side_b, 0)) +
               dot(DVec3(row.arm_b), at(speeds, node.side_b, 1));
    return double(stop.sign) * speed;
  }
  float inverse_mass(std::int32_t body) const { return solve_.bodies.inertia[body].inverse_mass; }

  // What an impulse of one at the stop makes of all bodies, and what the equations answer.
  void find_response(std::size_t c) {
    const Stop& stop = stops_[c];
    const LinkageNode& own = linkage_.nodes[stop.node];
    const AxisRow& row = stop.axis->row;
    double* const change = changes_ + c * speeds_;
    double* const answer = equations_ + c * rows_;
    for (std::size_t i = 0; i < speeds_; ++i) change[i] = 0.0;
    if (own.side_a >= 0)
      add(change, own.side_a, DVec3((-stop.sign * inverse_mass(own.body_a)) * row.push_a),
          DVec3(linkage_.bodies[std::size_t(own.side_a)].inverse * (-stop.sign * row.arm_a)));
    if (own.side_b >= 0)
      add(change, own.side_b, DVec3((stop.sign * inverse_mass(own.body_b)) * row.push_b),
          DVec3(linkage_.bodies[std::size_t(own.side_b)].inverse * (stop.sign * row.arm_b)));
    for (std::size_t n = 0; n < linkage_.nodes.size(); ++n) {
      const LinkageNode& node = linkage_.nodes[n];
      double* const x = answer + first_row(n);
      for (int i = 0; i < node.count; ++i) x[i] = -row_speed_of(node, i, change);
    }
    solve_blocks(linkage_.plan, linkage_.values, {answer, rows_});
    for (std::size_t n = 0; n < linkage_.nodes.size(); ++n) {
      const LinkageNode& node = linkage_.nodes[n];
      const double* const x = answer + first_row(n);
      for (int i = 0; i < node.count; ++i) {
        const DVec3 push = DVec3(node.rows.push.at(i));
        if (node.side_a >= 0)
          add(change, node.side_a, (-x[i] * double(inverse_mass(node.body_a))) * push,
              -x[i] * DVec3(node.rows.spin_a.at(i)));
        if (node.side_b >= 0)
          add(change, node.side_b, (x[i] * double(inverse_mass(node.body_b))) * push,
              x[i] * DVec3(node.rows.spin_b.at(i)));
      }
    }
  }
  std::size_t first_row(std::size_t node) const {
    return linkage_.plan.columns[linkage_.plan.place_of[node]].row;
  }
  static double row_speed_of(const LinkageNode& node, int i, const double* speeds) {
    const DVec3 push = DVec3(node.rows.push.at(i));
    double speed = 0.0;
    if (node.side_a >= 0)
      speed -= dot(push, at(speeds, node.side_a, 0)) +
               dot(DVec3(node.rows.arm_a.at(i)), at(speeds, node.side_a, 1));
    if (node.side_b >= 0)
      speed += dot(push, at(speeds, node.side_b, 0)) +
               dot(DVec3(node.rows.arm_b.at(i)), at(speeds, node.side_b, 1));
    return speed;
  }

  void find_impulses() {
    double speed[kMostStops], low[kMostStops];
    for (std::size_t c = 0; c < count_; ++c) {
      speed[c] = double(speed_of(stops_[c]));
      low[c] = -double(stops_[c].impulse());
      impulses_[c] = 0.0;
    }
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      double most = 0.0;
      for (std::size_t c = 0; c < count_; ++c) {
        if (!(matrix_[c][c] > 0.0)) continue;
        const double now = max(low[c], impulses_[c] - speed[c] / matrix_[c][c]), by = now - impulses_[c];
        if (by == 0.0) continue;
        impulses_[c] = now;
        for (std::size_t d = 0; d < count_; ++d) speed[d] += matrix_[d][c] * by;
        most = max(most, std::abs(by * matrix_[c][c]));
      }
      if (most < kSettled) return;
    }
  }

  void push() {
    for (std::size_t i = 0; i < speeds_; ++i) sum_[i] = 0.0;
    for (std::size_t c = 0; c < count_; ++c) {
      if (impulses_[c] == 0.0) continue;
      for (std::size_t i = 0; i < speeds_; ++i) sum_[i] += impulses_[c] * changes_[c * speeds_ + i];
      stops_[c].impulse() = max(0.0f, stops_[c].impulse() + float(impulses_[c]));
    }
    // Adding zero keeps -0 out of the state.
    for (std::size_t b = 0; b < linkage_.bodies.size(); ++b) {
      BodyMotion& motion = solve_.bodies.motion[linkage_.bodies[b].body];
      motion.linear_velocity += to_float(at(sum_, std::int32_t(b), 0)) + Vec3{};
      motion.angular_velocity += to_float(at(sum_, std::int32_t(b), 1)) + Vec3{};
    }
    for (std::size_t n = 0; n < linkage_.nodes.size(); ++n) {
      const LinkageNode& node = linkage_.nodes[n];
      for (int i = 0; i < node.count; ++i) {
        double impulse = 0.0;
        for (std::size_t c = 0; c < count_; ++c)
          impulse += impulses_[c] * equations_[c * rows_ + first_row(n) + std::size_t(i)];
        keep_impulse(solve_.records[node.record], solve_.work[node.work],
                     {node.rows.push.at(i), node.rows.arm_a.at(i), node.rows.arm_b.at(i)}, i,
                     float(impulse) + 0.0f);
      }
    }
  }

  const Linkage& linkage_;
  const LinkageSolve& solve_;
  ErrorBounds bounds_;
  std::size_t rows_, speeds_;
  double *equations_, *changes_,
      *sum_;  // by stop: impulses that the equations answer with; velocities of all bodies
  std::size_t count_ = 0;
  std::uint32_t first_ = 0;  // node
  Stop stops_[kMostStops];
  double matrix_[kMostStops][kMostStops] = {};
  double impulses_[kMostStops] = {};
};

}  // namespace

std::size_t stops_room(std::size_t rows, std::size_t bodies) {
  return kMostStops * (rows + 6 * bodies) + 6 * bodies;
}

void solve_stops(const Linkage& linkage, const LinkageSolve& solve, ErrorBounds bounds) {
  if (!linkage.has_stops) return;
  StopSolve(linkage, solve, bounds).solve();
}

}  // namespace gyre
