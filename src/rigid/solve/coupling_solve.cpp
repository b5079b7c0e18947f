#include "rigid/solve/coupling_solve.h"

#include "math/dense.h"

namespace gyre {

namespace {

// Sweeps over couplings that share a mechanism; one alone is solved in one.
constexpr int kSweeps = 4;
// Largest error of which a sub-step removes a part, rad or m.
constexpr double kMaxError = 0.2;

bool is_awake(const RigidWorld& w, const CouplingRecord& coupling) {
  bool awake = false;
  for_each_body_of_coupling(w, coupling,
                            [&](std::uint32_t body) { awake = awake || is_simulated(w.bodies.flags[body]); });
  return awake && is_coupling_enabled(w, coupling);
}

// The position of an axis, as joint_reading has it.
double position_of(const RigidWorld& w, std::uint32_t slot, JointAxis axis) {
  const JointRecord& joint = w.joints.records[slot];
  const JointDetail* const detail = detail_of(w.joints, slot);
  if (joint.kind <= JointKind::distance || detail == nullptr) return double(joint.position);
  return double(detail->axes[int(axis)].position);
}

// The tree that has the joint; found or made.
std::size_t tree_of(CouplingSolve& solve, const RigidWorld& w, std::uint32_t slot, std::size_t& used) {
  for (std::size_t i = 0; i < used; ++i) {
    for (const JointLink& link : solve.trees[i].links)
      if (link.joint == slot) return i;
  }
  const JointRecord& joint = w.joints.records[slot];
  const auto moves = [&](std::int32_t body) {
    return body != kNoBody && is_movable(w.bodies.flags[std::size_t(body)]);
  };
  const std::int32_t body = moves(joint.body_b) ? joint.body_b : joint.body_a;
  if (!moves(body)) return std::size_t(-1);
  if (used == solve.trees.size()) solve.trees.emplace_back(), solve.factors.emplace_back();
  if (!find_joint_space(w, std::uint32_t(body), solve.trees[used])) return std::size_t(-1);
  return used++;
}

// Fills the terms of a coupling; false if one of its axes is no coordinate, as that of a joint that closes a loop.
bool find_terms(CouplingSolve& solve, const RigidWorld& w, const CouplingRecord& coupling, CouplingWork& work,
                std::size_t& used) {
  work.terms.clear(), work.trees.clear();
  for (std::uint32_t i = 0; i < coupling.count; ++i) {
    const std::size_t tree = tree_of(solve, w, coupling.joints[i], used);
    if (tree == std::size_t(-1)) return false;
    const std::int32_t at = find_coordinate(solve.trees[tree], coupling.joints[i], coupling.axes[i]);
    if (at < 0) return false;
    work.terms.push_back({tree, std::size_t(at), double(coupling.coefficients[i])});
    bool is_new = true;
    for (const std::size_t one : work.trees) is_new = is_new && one != tree;
    if (is_new) work.trees.push_back(tree);
  }
  return true;
}

// Jacobians and responses at the present poses.
void measure(CouplingSolve& solve) {
  for (std::size_t i = 0; i < solve.trees.size(); ++i) {
    JointSpace& tree = solve.trees[i];
    if (tree.links.empty()) continue;
    measure_joint_space(*solve.w, tree, true);
    solve.factors[i] = tree.mass;
    factor_ldlt(solve.factors[i], int(tree.size()));
  }
  for (CouplingWork& work : solve.works) {
    work.responses.resize(work.trees.size());
    double inverse_mass = 0.0;
    for (std::size_t k = 0; k < work.trees.size(); ++k) {
      const JointSpace& tree = solve.trees[work.trees[k]];
      std::vector<double>& response = work.responses[k];
      response.assign(tree.size(), 0.0);
      for (const CouplingWork::Term& term : work.terms)
        if (term.tree == work.trees[k]) response[term.coordinate] += term.coefficient;
      solve_ldlt(solve.factors[work.trees[k]], int(tree.size()), response);
      for (const CouplingWork::Term& term : work.terms)
        if (term.tree == work.trees[k]) inverse_mass += term.coefficient * response[term.coordinate];
    }
    work.mass = inverse_mass > 1.0e-30 ? 1.0 / inverse_mass : 0.0;
  }
}

double speed_of(const CouplingSolve& solve, const CouplingWork& work) {
  double speed = 0.0;
  for (const CouplingWork::Term& term : work.terms)
    speed += term.coefficient * solve.trees[term.tree].speeds[term.coordinate];
  return speed;
}

// Reads the speeds of all coordinates from the bodies.
void read_speeds(CouplingSolve& solve) {
  for (JointSpace& tree : solve.trees)
    if (!tree.links.empty()) refresh_speeds(*solve.w, tree);
}

void apply(CouplingSolve& solve, const CouplingWork& work, double impulse) {
  if (impulse == 0.0) return;
  for (std::size_t k = 0; k < work.trees.size(); ++k) {
    JointSpace& tree = solve.trees[work.trees[k]];
    const std::vector<double>& response = work.responses[k];
    for (std::size_t c = 0; c < tree.size(); ++c) tree.speeds[c] += impulse * response[c];
    for (std::size_t i = 0; i < tree.links.size(); ++i) {
      double change[6] = {};
      for (std::size_t row = 0; row < 6; ++row) {
        const std::span<const double> jacobian = tree.row(i, row);
        for (std::size_t c = 0; c < tree.links[i].end; ++c) change[row] += jacobian[c] * response[c];
        change[row] *= impulse;
      }
      BodyMotion& motion = solve.w->bodies.motion[tree.links[i].body];
      motion.linear_velocity += to_float(DVec3{change[0], change[1], change[2]}) + Vec3{};
      motion.angular_velocity += to_float(DVec3{change[3], change[4], change[5]}) + Vec3{};
    }
  }
}

void solve_all(CouplingSolve& solve, bool with_bias) {
  read_speeds(solve);
  const int sweeps = solve.works.size() > 1 ? kSweeps : 1;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (CouplingWork& work : solve.works) {
      const double bias =
          with_bias ? double(solve.bias_rate) * clamp(work.error, -kMaxError, kMaxError) : 0.0;
      const double impulse = -work.mass * (speed_of(solve, work) + bias);
      work.impulse += impulse;
      apply(solve, work, impulse);
    }
  }
}

}  // namespace

void list_coupled_bodies(const RigidWorld& w, Array<std::uint32_t>& out) {
  for (const CouplingRecord& coupling : w.couplings) {
    if (!coupling.is_live() || !is_awake(w, coupling)) continue;
    for_each_body_of_coupling(w, coupling, [&](std::uint32_t body) {
      if (is_simulated(w.bodies.flags[body])) out.push_back(body);
    });
  }
}

void begin_couplings(CouplingSolve& solve, RigidWorld& w, float h, float bias_rate, float warm_scale) {
  solve.w = &w, solve.h = h, solve.bias_rate = bias_rate, solve.warm_scale = warm_scale;
  solve.is_first = true;
  std::size_t used = 0, count = 0;
  for (std::uint32_t slot = 0; slot < w.couplings.size(); ++slot) {
    CouplingRecord& coupling = w.couplings[slot];
    coupling.total = 0.0f;
    if (!coupling.is_live() || !is_awake(w, coupling)) continue;
    if (count == solve.works.size()) solve.works.emplace_back();
    CouplingWork& work = solve.works[count];
    if (!find_terms(solve, w, coupling, work, used)) continue;
    ++count;
    work.slot = slot;
    work.impulse = double(coupling.impulse);
    work.error = -double(coupling.offset);
    for (std::uint32_t i = 0; i < coupling.count; ++i)
      work.error += double(coupling.coefficients[i]) * position_of(w, coupling.joints[i], coupling.axes[i]);
  }
  solve.works.resize(count);
  for (std::size_t i = used; i < solve.trees.size(); ++i) solve.trees[i].links.clear();
}

void warm_start_couplings(CouplingSolve& solve, int, int) {
  if (solve.is_first) measure(solve);
  for (CouplingWork& work : solve.works) {
    if (solve.is_first) work.impulse *= double(solve.warm_scale);
    apply(solve, work, work.impulse);
  }
  solve.is_first = false;
}

void solve_couplings(CouplingSolve& solve, int, int) { solve_all(solve, true); }

void solve_couplings_last(CouplingSolve& solve, int, int) {
  solve_all(solve, true);
  for (CouplingWork& work : solve.works) work.error += double(solve.h) * speed_of(solve, work);
}

void relax_couplings(CouplingSolve& solve, int, int) {
  measure(solve);
  solve_all(solve, false);
  for (CouplingWork& work : solve.works) {
    CouplingRecord& coupling = solve.w->couplings[work.slot];
    coupling.impulse = float(work.impulse);
    coupling.total += float(work.impulse);
  }
}

}  // namespace gyre
