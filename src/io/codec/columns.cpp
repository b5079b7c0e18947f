// Putting columns into a world. See columns.h.
#include "io/codec/columns.h"

namespace gyre {

namespace {

void clear_events(RigidEvents& events) {
  events.begins.clear(), events.ends.clear(), events.hits.clear();
  events.sensors.clear(), events.broken.clear(), events.sleep_changes.clear();
}

void forget_batch(BatchScratch& batch) {
  batch.constraints.clear(), batch.constraint_contact.clear(), batch.pairs.clear();
  batch.swept_joints.clear(), batch.joint_pairs.clear();
}

}  // namespace

void adopt_columns(WorldState& state, StateColumns&& columns) {
  columns.rigid.broadphase = std::move(state.rigid.broadphase);
  columns.rigid.broadphase_stale = true;
  columns.rigid.world_number = state.number;
  state.rigid = std::move(columns.rigid);
  state.time = columns.time;
  state.step_count = columns.step_count;
  state.queried_changes.store(kNothingQueried, std::memory_order_relaxed);
  // Bytes from outside can break rules that the engine never would (boxes that hold no shape, say), and are stepped without
  // harm. A walk that stops at them would blame the engine.
  state.walks = false;
  clear_reports(state);
  if (state.log != nullptr) state.log->on_restored(state);
}

void clear_reports(WorldState& state) {
  clear_events(state.published_events);
  state.events = {};
  state.problems.clear();
  state.frozen.clear();
  // What the solver had were constraints of the state that is replaced.
  forget_batch(state.solve.together);
  for (const std::unique_ptr<WorkerContext>& lone : state.solve.lone) forget_batch(lone->scratch);
  state.solve.counts = {};
  state.solve.colors = 0;
}

}  // namespace gyre
