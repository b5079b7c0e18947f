// The stops of a bundle of linkages (solver/linkage_lanes.h), solved together with the equations: solver/linkage_stops.h, with a
// lane for each linkage. A lane takes part only with the stops that it finds passed itself, in the order of the joints, and stands still
// once its own impulses do, so its neighbours change no bit of it.
#pragma once

#include "solver/linkage_place.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// As in solver/linkage_stops.cpp.
constexpr float kLaneCalm = 1.0e-3f, kLaneSettled = 1.0e-5f;  // rad/s
constexpr int kLaneRounds = 3, kLaneSweeps = 100;

// The stops at either end of an axis: x are the impulses found, beyond those that the axis has.
template <int W>
struct LinkedStop {
  Wide<W> speed, low_asked, high_asked, low_x, high_x;
  Mask<W> low_on, high_on;
  LinkedAxis<W>* axis;
  const LaneNode* node;
  bool has_low;   // a swing has only the other one
  bool is_known;  // what an impulse makes of the linkage
};

template <int W>
constexpr std::size_t stop_room(const LinkageBundle& bundle) {
  const std::size_t n = bundle.stop_count;
  return n * sizeof(LinkedStop<W>) + n * (bundle.row_count + 6 * bundle.moving_count + n) * sizeof(Wide<W>);
}

template <int W>
class LaneStops {
 public:
  GYRE_INLINE LaneStops(const Bundle<W>& bundle, const LaneSettings& settings, ErrorBounds bounds)
      : b_(bundle),
        s_(settings),
        bounds_(bounds),
        stops_(reinterpret_cast<LinkedStop<W>*>(settings.room)),
        answers_(reinterpret_cast<Wide<W>*>(stops_ + bundle.plain.stop_count)),
        changes_(answers_ + std::size_t(bundle.plain.stop_count) * bundle.plain.row_count),
        matrix_(changes_ + std::size_t(bundle.plain.stop_count) * 6 * bundle.plain.moving_count) {}

  GYRE_INLINE void solve() {
    list();
    for (int round = 0; round < kLaneRounds; ++round) {
      const Mask<W> live = look(round == 0);
      if (none(live)) return;
      for (std::uint32_t a = 0; a < count_; ++a)
        if (!stops_[a].is_known && any(stops_[a].low_on | stops_[a].high_on)) find_response(a);
      find_impulses(live);
      push();
    }
  }

 private:
  GYRE_INLINE void list() {
    for (std::uint32_t n = 0; n < b_.plain.node_count; ++n) {
      const LaneNode& node = b_.plain.nodes[n];
      if (node.has_twist) add(node, b_.joints[n].twist, true);
      if (node.has_swing) add(node, b_.joints[n].swing, false);
    }
  }
  GYRE_INLINE void add(const LaneNode& node, LinkedAxis<W>& axis, bool has_low) {
    LinkedStop<W>& stop = stops_[count_++];
    stop.axis = &axis, stop.node = &node;
    stop.low_on = stop.high_on = Mask<W>::splat(false);
    stop.has_low = has_low, stop.is_known = false;
    stop.low_asked = asked(axis.low_gap), stop.high_asked = asked(axis.high_gap);
  }
  GYRE_INLINE Wide<W> asked(Wide<W> gap) const {
    const Wide<W> rate = select(gap > 0.0f, Wide<W>(1.0f / s_.substep), Wide<W>(s_.rate));
    return Wide<W>(0.0f) - rate * max(gap, Wide<W>(-bounds_.turn));
  }

  // Finds the stops that are passed or bear an impulse; returns the lanes in which there is something to do.
  GYRE_INLINE Mask<W> look(bool first) {
    Mask<W> live = Mask<W>::splat(false);
    for (std::uint32_t a = 0; a < count_; ++a) {
      LinkedStop<W>& stop = stops_[a];
      const LinkedAxis<W>& axis = *stop.axis;
      stop.speed = dot(axis.about, b_.bodies[stop.node->b].angular - b_.bodies[stop.node->a].angular);
      // Those that nothing can turn have no stops.
      const Mask<W> turns = axis.mass > 0.0f;
      const auto consider = [&](Wide<W> speed, Wide<W> impulse, Mask<W>& on) {
        const Mask<W> bears = impulse > 0.0f, passed = speed < -kLaneCalm;
        const Mask<W> now = turns & (bears | passed);
        live = live | (first ? now & (passed | (bears & (speed > kLaneCalm))) : and_not(now, on));
        on = on | now;
      };
      if (stop.has_low) consider(stop.speed - stop.low_asked, axis.low_impulse, stop.low_on);
      consider(Wide<W>(0.0f) - stop.speed - stop.high_asked, axis.high_impulse, stop.high_on);
    }
    return live;
  }

  GYRE_INLINE Wide<W>* answer_of(std::uint32_t a) const {
    return answers_ + std::size_t(a) * b_.plain.row_count;
  }
  // Velocities of the bodies that move, six numbers each.
  GYRE_INLINE Wide<W>* change_of(std::uint32_t a) const {
    return changes_ + std::size_t(a) * 6 * b_.plain.moving_count;
  }
  GYRE_INLINE static Vec3W<W> at(const Wide<W>* change, std::uint32_t body, int part) {
    const Wide<W>* const v = change + 6 * body + 3 * part;
    return {v[0], v[1], v[2]};
  }
  GYRE_INLINE static void add(Wide<W>* change, std::uint32_t body, int part, Vec3W<W> by) {
    Wide<W>* const v = change + 6 * body + 3 * part;
    v[0] += by.x, v[1] += by.y, v[2] += by.z;
  }
  GYRE_INLINE Vec3W<W> moving(const Wide<W>* change, std::uint32_t body, int part) const {
    if (b_.moves(body)) return at(change, body, part);
    return {Wide<W>(0.0f), Wide<W>(0.0f), Wide<W>(0.0f)};
  }
  GYRE_INLINE Wide<W> speed_along(const LinkedStop<W>& stop, const Wide<W>* change) const {
    return dot(stop.axis->about, moving(change, stop.node->b, 1) - moving(change, stop.node->a, 1));
  }

  // What an impulse of one about the axis makes of all bodies, and what the equations answer.
  void find_response(std::uint32_t index) {
    LinkedStop<W>& stop = stops_[index];
    Wide<W>* const change = change_of(index);
    for (std::uint32_t i = 0; i < 6 * b_.plain.moving_count; ++i) change[i] = Wide<W>(0.0f);
    const LaneNode& own = *stop.node;
    if (b_.moves(own.a)) add(change, own.a, 1, -(b_.bodies[own.a].inverse * stop.axis->about));
    if (b_.moves(own.b)) add(change, own.b, 1, b_.bodies[own.b].inverse * stop.axis->about);
    for (std::uint32_t n = 0; n < b_.plain.node_count; ++n) {
      const LaneNode& node = b_.plain.nodes[n];
      const LinkedJoint<W>& joint = b_.joints[n];
      const Vec3W<W> turn_a = moving(change, node.a, 1), turn_b = moving(change, node.b, 1);
      const Vec3W<W> missing = cross(turn_a, joint.from_a) - cross(turn_b, joint.from_b);
      b_.set_row(node.row, missing.x);
      b_.set_row(node.row + 1, missing.y);
      b_.set_row(node.row + 2, missing.z);
      if (node.kind != JointKind::hinge) continue;
      b_.set_row(node.row + 3, dot(turn_a - turn_b, joint.perpendicular_1));
      b_.set_row(node.row + 4, dot(turn_a - turn_b, joint.perpendicular_2));
    }
    solve_lanes<W>(b_.plain);
    Wide<W>* const answer = answer_of(index);
    for (std::uint32_t row = 0; row < b_.plain.row_count; ++row) answer[row] = b_.row(row);
    for (std::uint32_t n = 0; n < b_.plain.node_count; ++n)
      answer_joint(b_.plain.nodes[n], b_.joints[n], answer, change);
    stop.is_known = true;
    for (std::uint32_t a = 0; a < count_; ++a) {
      if (!stops_[a].is_known) continue;
      entry(a, index) = speed_along(stops_[a], change);
      entry(index, a) = speed_along(stop, change_of(a));
    }
  }
  GYRE_INLINE Wide<W>& entry(std::uint32_t row, std::uint32_t column) const {
    return matrix_[std::size_t(row) * b_.plain.stop_count + column];
  }
  GYRE_INLINE static Vec3W<W> point_part(const LaneNode& node, const Wide<W>* rows) {
    return {rows[node.row], rows[node.row + 1], rows[node.row + 2]};
  }
  GYRE_INLINE static Vec3W<W> turn_part(const LaneNode& node, const LinkedJoint<W>& joint,
                                        const Wide<W>* rows) {
    if (node.kind != JointKind::hinge) return {Wide<W>(0.0f), Wide<W>(0.0f), Wide<W>(0.0f)};
    return rows[node.row + 3] * joint.perpendicular_1 + rows[node.row + 4] * joint.perpendicular_2;
  }
  GYRE_INLINE void answer_joint(const LaneNode& node, const LinkedJoint<W>& joint, const Wide<W>* rows,
                                Wide<W>* change) const {
    const Vec3W<W> p = point_part(node, rows), t = turn_part(node, joint, rows);
    if (b_.moves(node.a)) {
      const LinkedBody<W>& a = b_.bodies[node.a];
      add(change, node.a, 0, -(a.inverse_mass * p));
      add(change, node.a, 1, -(a.inverse * (cross(joint.from_a, p) + t)));
    }
    if (b_.moves(node.b)) {
      const LinkedBody<W>& b = b_.bodies[node.b];
      add(change, node.b, 0, b.inverse_mass * p);
      add(change, node.b, 1, b.inverse * (cross(joint.from_b, p) + t));
    }
  }

  // Projected Gauss-Seidel over the stops, in each lane until its impulses stand.
  void find_impulses(Mask<W> live) {
    for (std::uint32_t a = 0; a < count_; ++a) stops_[a].low_x = stops_[a].high_x = Wide<W>(0.0f);
    for (int sweep = 0; sweep < kLaneSweeps && any(live); ++sweep) {
      Wide<W> most(0.0f);
      for (std::uint32_t a = 0; a < count_; ++a) {
        LinkedStop<W>& stop = stops_[a];
        if (!stop.is_known) continue;
        const Wide<W> own = entry(a, a);
        const auto improve = [&](Wide<W> speed, Wide<W> impulse, Mask<W> on, Wide<W>& x, float sign) {
          const Wide<W> now = max(Wide<W>(0.0f) - impulse, x - speed / own);
          const Wide<W> by = keep(live & on & (own > 0.0f), now - x);
          if (!any(by != 0.0f)) return;
          x += by;
          most = max(most, max(by, Wide<W>(0.0f) - by) * own);
          for (std::uint32_t e = 0; e < count_; ++e)
            if (stops_[e].is_known) stops_[e].speed += (sign * by) * entry(e, a);
        };
        if (stop.has_low)
          improve(stop.speed - stop.low_asked, stop.axis->low_impulse, stop.low_on, stop.low_x, 1.0f);
        improve(Wide<W>(0.0f) - stop.speed - stop.high_asked, stop.axis->high_impulse, stop.high_on,
                stop.high_x, -1.0f);
      }
      live = live & (most > kLaneSettled);
    }
  }

  void push() {
    for (std::uint32_t a = 0; a < count_; ++a) {
      LinkedStop<W>& stop = stops_[a];
      if (!stop.is_known) continue;
      const Wide<W> x = stop.low_x - stop.high_x;
      stop.axis->low_impulse = max(stop.axis->low_impulse + stop.low_x, Wide<W>(0.0f));
      stop.axis->high_impulse = max(stop.axis->high_impulse + stop.high_x, Wide<W>(0.0f));
      const Mask<W> pushed = x != 0.0f;
      if (none(pushed)) continue;
      const Wide<W>*const change = change_of(a), *const answer = answer_of(a);
      for (std::uint32_t i = 0; i < b_.plain.moving_count; ++i) {
        b_.bodies[i].linear += keep(pushed, x * at(change, i, 0));
        b_.bodies[i].angular += keep(pushed, x * at(change, i, 1));
      }
      for (std::uint32_t n = 0; n < b_.plain.node_count; ++n) {
        const LaneNode& node = b_.plain.nodes[n];
        LinkedJoint<W>& joint = b_.joints[n];
        joint.linear_impulse += keep(pushed, x * point_part(node, answer));
        if (node.kind == JointKind::hinge)
          joint.angular_impulse += keep(pushed, x * turn_part(node, joint, answer));
      }
    }
  }

  const Bundle<W>& b_;
  const LaneSettings& s_;
  ErrorBounds bounds_;
  LinkedStop<W>* stops_;
  Wide<W>*answers_, *changes_, *matrix_;
  std::uint32_t count_ = 0;
};

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
