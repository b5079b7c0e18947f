// One step of the world as a list of stages. Each stage is a function from arrays to arrays in a lower layer.
#include "base/check.h"
#include "dynamics/fluid/fluid_reaction.h"
#include "dynamics/fluid/fluid_step.h"
#include "dynamics/fluid/fluid_visitors.h"
#include "dynamics/soft/soft_contacts.h"
#include "rigid/collision_bodies.h"
#include "rigid/integrate/spring_stability.h"
#include "rigid/rigid_step.h"
#include "rigid/sleep/island.h"
#include "rigid/time/step_error.h"
#include "soft/store/soft_quarantine.h"
#include "world/soft_commands.h"
#include "world/soft_events.h"
#include "world/stages.h"
#include "world/validate_state.h"
#include "world/world_state.h"

namespace gyre {

namespace {

#if defined(GYRE_VALIDATE) && GYRE_VALIDATE
// Large worlds are validated only now and then: a validation takes several times as long as a stage.
bool is_validated(const WorldState& s, StageName stage) {
  constexpr std::size_t kSmall = 2000;
  constexpr std::uint64_t kEvery = 16;
  const RigidWorld& w = s.rigid;
  const bool small = w.bodies.motion.size() + w.shapes.colliders.size() + w.contacts.live < kSmall;
  return s.validates && (small || (s.step_count % kEvery == 0 && int(stage) == kStageCount - 1));
}

void validate_after(const WorldState& s, StageName stage) {
  if (!is_validated(s, stage)) return;
  const Error fault = validate_state(s, stage);
  if (fault) check_failed(kStageNames[int(stage)], fault.message, __FILE__, __LINE__);
}
#endif

// Runs and times a stage, then calls the hook of tools.
template <class Fn>
void run_stage(WorldState& s, StageName stage, Fn&& fn) {
  {
    const StageZone zone(s.profile, int(stage));
    fn();
  }
  GYRE_VALIDATE_ONLY(validate_after(s, stage));
  if (s.stage_hook.call != nullptr) s.stage_hook.call(s.stage_hook.context, kStageNames[int(stage)]);
}

void begin_step(WorldState& s) {
  s.stepping = true;
  s.arena.reset();
  s.queried_changes.store(kNothingQueried, std::memory_order_relaxed);
  s.frozen.clear(), s.quarantined_soft.clear();
  s.problems.clear();
  s.profile.begin_step();
  refresh_awake(s.rigid.bodies);
  note_soft_before(s);
}

// Broken joints stay until the end of the step, because its results refer to them.
void remove_broken_joints(WorldState& s) {
  for (const JointBroken& broken : s.published_events.broken) remove_joint_now(s, broken.joint.index);
}

// The end of the stage `solve` where soft matter stands in fluids.
void push_back(WorldState& s) {
  const StageZone zone(s.profile, int(StageName::solve));
  push_fluids_back(s.soft, s.fluids, s.fluid_scratch);
}

void report_frozen(WorldState& s) {
  for (const std::uint32_t body : s.frozen) {
    report_problem(s, ErrorCode::invalid_data, body_id(s.rigid, body),
                   "body %u is no longer finite; it was frozen at its last good pose", body);
  }
}

void report_quarantined(WorldState& s) {
  for (const std::uint32_t slot : s.quarantined_soft)
    report_problem(s, ErrorCode::invalid_data, soft_id(s, slot),
                   "soft matter %d is no longer finite; it was frozen at its last good places", int(slot));
}

void report_fluids(WorldState& s) {
  for (std::size_t slot = 0; slot < s.fluid_scratch.size(); ++slot) {
    FluidReport& report = s.fluid_scratch[slot].report;
    if (report.failed)
      report_problem(s, ErrorCode::invalid_data, {},
                     "fluid %d is no longer finite; it was stilled and goes on at rest", int(slot));
    if (report.full)
      report_problem(s, ErrorCode::unsupported, {},
                     "liquid %d has %d particles, as many as it may; its sources give no more", int(slot),
                     s.fluids.entries[slot].liquid.particles());
    report.failed = report.full = false;
  }
}

// An explicit integrator must not explode silently: a step longer than the critical one is reported every time.
void report_stiffness(WorldState& s) {
  const RigidWorld& w = s.rigid;
  const MotionSettings motion = motion_settings(w);
  if (motion.springs != SpringKind::explicit_force) return;
  const SpringMode mode = find_fastest_mode(w, s.arena);
  if (mode.springs == 0) return;
  const double longest = critical_step(motion.integrator, mode.frequency, mode.decay);
  const double pieces = double(s.solve.report.parts);
  const double step = pieces > 0.0 ? double(w.settings.last_step) / pieces : double(w.settings.last_substep);
  if (step <= longest) return;
  const JointRecord& joint = w.joints.records[mode.joint];
  const std::int32_t body = joint.body_b != kNoBody ? joint.body_b : joint.body_a;
  constexpr double kRadiansPerTurn = 6.283185307179586;  // rad
  report_problem(s, ErrorCode::unstable, body_id(w, std::uint32_t(body)),
                 "%s cannot follow the explicit springs (%.4g Hz, most of it joint %u): it moves by %.4g s "
                 "at a time, the critical "
                 "step is %.4g s; use more sub-steps or springs 'implicit'",
                 to_string(motion.integrator), mode.frequency / kRadiansPerTurn, mode.joint, step, longest);
}

// A solver method that the user chose may not take islands of this size.
void report_large_islands(WorldState& s) {
  const RowStats& rows = s.solve.rows;
  if (rows.too_large == 0) return;
  const SolverSettings& solver = s.rigid.solver[0];
  report_problem(s, ErrorCode::unsupported, {},
                 "%d islands of up to %d rows are beyond direct_rows %d of %s: Newton's method solved them",
                 rows.too_large, rows.largest, solver.options.direct_rows,
                 to_string(solver.options.lcp_method));
}

// Sequential impulses converge slowly where heavy bodies hang on light ones, or in loops. Joints open then.
void report_missed_impulses(WorldState& s) {
  constexpr double kMissed = 2.0;  // times the speed of a fall for a sub-step
  const RowStats& rows = s.solve.rows;
  if (!(rows.missed_share > kMissed)) return;
  report_problem(s, ErrorCode::unstable, {},
                 "sequential_impulses: after %d iterations joints still open %.3g times as fast as a body "
                 "that falls for a sub-step; "
                 "use more iterations, or the solver soft_step or lcp",
                 rows.sweeps, rows.missed_share);
}

// Cloths and solids that cross are told for as long as they do; and those that stay crossed for longer than untangling takes.
void report_crossings(WorldState& s, float seconds) {
  constexpr float kUntangling = 10.0f;  // s: a sheet of 2 m that lies half through another is out of it by then
  for (std::size_t slot = 0; slot < s.soft.entries.size(); ++slot) {
    SoftEntry& entry = s.soft.entries[slot];
    if (entry.def == nullptr || entry.crossings.count == 0) {
      entry.crossed_for = 0.0f;
      continue;
    }
    entry.crossed_for += seconds;
    const bool is_late = entry.crossed_for > kUntangling;
    report_problem(s, ErrorCode::unstable, soft_id(s, std::uint32_t(slot)),
                   is_late ? "soft matter %d crosses itself or others in %d places and could not be untangled "
                             "within %.3g s"
                           : "soft matter %d crosses itself or others in %d places; it is being untangled, for "
                             "%.3g s so far",
                   int(slot), entry.crossings.count, double(is_late ? kUntangling : entry.crossed_for));
  }
}

void count(WorldState& s, CounterName counter, std::size_t amount) { s.profile.count(int(counter), amount); }

// Must run right after the stage `collide`, which leaves contacts that it did not update as they were.
void count_manifold_updates(WorldState& s) {
  if (!s.profile.enabled()) return;
  std::size_t updates = 0;
  for (const Contact& contact : s.rigid.contacts.contacts) {
    if (contact.manifold_room == 0 || contact.ended != 0 || contact.recycled != 0) continue;
    if (can_move(s.rigid, contact.body_a) || can_move(s.rigid, contact.body_b)) ++updates;
  }
  count(s, CounterName::full_looks, updates);
}

// Reports the work of a step to the profiler.
void count_work(WorldState& s) {
  if (!s.profile.enabled()) return;
  const RigidWorld& w = s.rigid;
  count(s, CounterName::contacts, w.contacts.live);
  count(s, CounterName::manifolds, s.solve.counts.manifolds);
  count(s, CounterName::colors, std::size_t(s.solve.colors));
  count(s, CounterName::joints, s.solve.counts.joints);
  count(s, CounterName::swept_joints, s.solve.counts.swept_joints);
  count(s, CounterName::awake_bodies, w.bodies.awake.size());
  count(s, CounterName::fast_bodies, s.continuous.fast.size());
}

// The collision stages: fat boxes, pairs, manifolds, touches. Fluids move for the step of `flow` seconds; 0: they have moved already.
void detect_collisions(WorldState& s, float seconds, float flow) {
  RigidWorld& w = s.rigid;
  run_stage(s, StageName::refit, [&] { refit(w, *s.tasks, seconds); });
  count(s, CounterName::refitted_boxes, w.shapes.changed.size());
  run_stage(s, StageName::find_pairs, [&] { count(s, CounterName::new_pairs, find_pairs(w, *s.tasks)); });
  run_stage(s, StageName::flow, [&] {
    if (s.fluids.empty() || flow == 0.0f) return;
    step_fluids(w, s.soft, s.fluids, s.fluid_scratch, *s.gas_kernels, *s.tasks, s.time, flow);
    clear_fluid_impulses(s.soft);
  });
  run_stage(s, StageName::touch_soft, [&] {
    if (flow > 0.0f) damage_soft(s, flow);
    if (!s.soft.empty()) find_soft_contacts(w, s.soft, s.solve.soft.shapes_near, s.arena, *s.tasks, seconds);
  });
  run_stage(s, StageName::collide, [&] { collide_pairs(w, s.arena, *s.tasks, s.recycle_contacts, seconds); });
  count_manifold_updates(s);
  run_stage(s, StageName::link_islands, [&] { link_islands(w); });
  keep_good_places(s.soft);
}

// The stages after the solve of `seconds`, which is the last piece of a step of `whole` seconds or not.
void finish_step(WorldState& s, float seconds, float whole, bool last) {
  RigidWorld& w = s.rigid;
  if (last && !s.fluids.empty() && !s.soft.empty()) push_back(s);
  run_stage(s, StageName::clamp_fast_bodies,
            [&] { clamp_fast_bodies(w, s.continuous, *s.kernels, s.arena, *s.tasks); });
  run_stage(s, StageName::finish_bodies, [&] { finish_bodies(w, s.arena, *s.tasks, whole, s.frozen, last); });
  run_stage(s, StageName::break_joints, [&] { break_joints(w, seconds); });
  run_stage(s, StageName::put_to_sleep, [&] {
    put_to_sleep(w, s.arena, seconds);
    quarantine_soft(s.soft, s.quarantined_soft);
    if (!s.soft.empty()) rest_soft(w, s.soft, s.arena, seconds);
  });
}

// Saves and restores the state with which a step that is tried again begins.
void save_before(WorldState& s) {
  s.impacts.before.save(s.rigid);
  if (!s.soft.empty()) s.soft_before = s.soft;
}
void restore_before(WorldState& s) {
  s.impacts.before.restore(s.rigid);
  if (!s.soft.empty()) s.soft = s.soft_before;
}

// Solves with as many sub-steps, at least those of the settings, as keep the error of constrained bodies within the
// tolerance.
void solve_to_tolerance(WorldState& s, float seconds) {
  RigidWorld& w = s.rigid;
  MotionSettings& motion = w.motion_settings[0];
  const std::int32_t min_substeps = w.settings.substeps;
  const std::size_t hits = w.events.hits.size();
  std::int32_t substeps = clamp(motion.planned_substeps, min_substeps, max(min_substeps, kMaxPlanned / 2));
  save_before(s);
  const auto solve = [&] {
    w.settings.substeps = substeps;
    solve_step(w, s.soft, s.fluids, s.solve, s.arena, *s.tasks, *s.kernels, seconds);
    w.settings.substeps = min_substeps;
  };
  solve();
  motion.planned_substeps = 0;
  if (!is_anything_constrained(w)) return;
  double error = 0.0;
  while (2 * substeps <= kMaxPlanned) {
    s.impacts.other = w.bodies.motion;
    restore_before(s);
    w.events.hits.resize(hits);
    substeps *= 2;
    solve();
    error = step_difference(w, s.impacts.other, seconds);
    if (!(error > double(motion.tolerance))) break;
  }
  // The next step begins with half of these, or with a quarter if the error is small.
  const std::int32_t planned = error < 0.25 * double(motion.tolerance) ? substeps / 4 : substeps / 2;
  if (planned > min_substeps) motion.planned_substeps = planned;
  const int a_substep = w.solver.empty() ? 2 : 1;
  s.solve.report.parts = max(s.solve.report.parts, a_substep * substeps);
  s.solve.report.error = max(s.solve.report.error, float(error));
}

void step_undivided(WorldState& s, float seconds) {
  detect_collisions(s, seconds, seconds);
  s.rigid.now = s.time;
  run_stage(s, StageName::solve, [&] {
    if (motion_settings(s.rigid).time == TimeStepping::error_controlled)
      return solve_to_tolerance(s, seconds);
    solve_step(s.rigid, s.soft, s.fluids, s.solve, s.arena, *s.tasks, *s.kernels, seconds);
  });
  finish_step(s, seconds, seconds, true);
}

// How often a piece of an adaptive step is tried until it ends at an impact, and the shortest piece as a share of the
// step.
constexpr int kMaxTries = 8;
constexpr double kShortest = 1.0e-7;

// Solves up to the first impact, but at most `left` seconds. Returns the length of the piece, s; `is_impact` tells
// whether it ends at an impact.
double solve_to_impact(WorldState& s, double left, float seconds, bool& is_impact) {
  RigidWorld& w = s.rigid;
  const std::int32_t substeps = w.settings.substeps;
  const std::size_t hits = w.events.hits.size();
  const bool bounded = w.inactive_contacts.empty();
  if (!bounded) save_before(s);
  double length = left;
  is_impact = false;
  for (int n = 0;; ++n) {
    w.settings.substeps =
        clamp(std::int32_t(std::ceil(double(substeps) * length / double(seconds))), 1, substeps);
    solve_step(w, s.soft, s.fluids, s.solve, s.arena, *s.tasks, *s.kernels, float(length));
    if (bounded || n + 1 == kMaxTries) break;
    const FirstImpact first = find_first_impact(w, s.impacts.before, length);
    if (!(first.time < length)) break;
    is_impact = !first.is_turning_point;
    restore_before(s);
    w.events.hits.resize(hits);
    length = max(first.time, kShortest * double(seconds));
  }
  w.settings.substeps = substeps;
  return length;
}

// Resolves impacts. Bodies that got an impulse may meet other shapes, so collisions are then detected again.
void apply_impacts(WorldState& s, float threshold, float seconds, float left) {
  RigidWorld& w = s.rigid;
  if (!resolve_impacts(w, s.impacts, threshold)) return;
  for (const std::uint32_t body : s.impacts.hit_bodies) {
    for (const ShapeId id : w.bodies.shapes[body]) refit_shape(w, id.index, seconds);
  }
  detect_collisions(s, left, 0.0f);
}

// Steps from impact to impact. A bounce that would last less than 1/64 of the step is suppressed, so a ball with
// infinitely many bounces in finite time comes to rest.
void step_to_impacts(WorldState& s, float seconds) {
  RigidWorld& w = s.rigid;
  const std::int32_t max_impacts = motion_settings(w).max_impacts;
  const float threshold = max(length(w.settings.gravity) * seconds / 128.0f, 1.0e-6f);
  StepStats report;
  double left = double(seconds);
  for (int piece = 0; left > 0.0; ++piece) {
    w.now = s.time + (double(seconds) - left);
    detect_collisions(s, float(left), piece == 0 ? seconds : 0.0f);
    report.bounded = report.impacts >= max_impacts || piece > 3 * max_impacts;
    if (report.bounded) {
      w.inactive_contacts.clear();
    } else {
      apply_impacts(s, threshold, seconds, float(left));
      list_inactive_contacts(w, threshold);
    }
    double length = left;
    bool is_impact = false;
    run_stage(s, StageName::solve, [&] { length = solve_to_impact(s, left, seconds, is_impact); });
    report.parts = max(report.parts, s.solve.report.parts);
    report.error += s.solve.report.error;
    const bool last = length >= left;
    if (is_impact && !last) ++report.impacts;
    finish_step(s, float(length), seconds, last);
    left = last ? 0.0 : left - length;
  }
  w.inactive_contacts.clear();
  s.solve.report = report;
}

void end_step(WorldState& s, float seconds) {
  s.time += double(seconds);
  ++s.step_count;
  // Events of later commands belong to the next step.
  std::swap(s.published_events, s.rigid.events);
  RigidEvents& next = s.rigid.events;
  next.begins.clear(), next.ends.clear(), next.hits.clear();
  next.sensors.clear(), next.broken.clear(), next.sleep_changes.clear();
  const RigidEvents& e = s.published_events;
  ScratchClocks& clocks = s.rigid.clocks;
  clocks.begins.trim(next.begins, s.published_events.begins);
  clocks.ends.trim(next.ends, s.published_events.ends);
  clocks.hits.trim(next.hits, s.published_events.hits);
  clocks.sensors.trim(next.sensors, s.published_events.sensors);
  clocks.broken.trim(next.broken, s.published_events.broken);
  clocks.sleep_changes.trim(next.sleep_changes, s.published_events.sleep_changes);
  report_soft_events(s);
  if (!s.fluids.entries.empty()) {
    update_fluid_visitors(s.rigid, s.soft, s.fluids);
    std::swap(s.published_fluid_touches, s.fluids.events);
    s.fluids.events.clear();
  }
  const SoftEvents& soft = s.published_soft_events;
  s.events = {e.begins,        e.ends,      e.hits,    e.sensors,     e.broken,
              e.sleep_changes, soft.begins, soft.ends, soft.inverted, soft.torn, s.published_fluid_touches};
  s.stepping = false;
}

}  // namespace

void step_world(WorldState& s, float seconds) {
  begin_step(s);
  s.rigid.steps = s.step_count;
  {
    const StageZone whole(s.profile, kWholeStep);
    const TaskSystem::Busy busy(*s.tasks);
    if (motion_settings(s.rigid).time == TimeStepping::adaptive)
      step_to_impacts(s, seconds);
    else
      step_undivided(s, seconds);
  }
  end_step(s, seconds);
  report_frozen(s);
  report_quarantined(s);
  report_fluids(s);
  report_crossings(s, seconds);
  report_stiffness(s);
  report_large_islands(s);
  report_missed_impulses(s);
  remove_broken_joints(s);
  count_work(s);
}

}  // namespace gyre
