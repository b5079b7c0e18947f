// Replaces the columns of a world. See columns.h.
#include "io/codec/columns.h"

namespace gyre {

namespace {

void clear_events(RigidEvents& events) {
  events.begins.clear(), events.ends.clear(), events.hits.clear();
  events.sensors.clear(), events.broken.clear(), events.sleep_changes.clear();
}

void forget_batch(BatchScratch& batch) {
  batch.contacts.constraints.clear(), batch.contacts.slots.clear(), batch.contacts.pairs.clear();
  batch.joints.swept.clear(), batch.joints.pairs.clear();
}

}  // namespace

void adopt_columns(WorldState& state, StateColumns&& columns) {
  columns.rigid.broadphase = std::move(state.rigid.broadphase);
  columns.rigid.broadphase_stale = true;
  columns.rigid.world_number = state.number;
  state.rigid = std::move(columns.rigid);
  state.soft = std::move(columns.soft);
  state.fluids = std::move(columns.fluids);
  state.time = columns.time;
  state.step_count = columns.step_count;
  state.queried_changes.store(kNothingQueried, std::memory_order_relaxed);
  // Loaded columns may break rules that the engine never breaks, such as fat boxes that contain their shapes.
  // Stepping them is harmless. State validation would blame the engine for them.
  state.validates = false;
  clear_reports(state);
  if (state.log != nullptr) state.log->on_restored(state);
}

void clear_reports(WorldState& state) {
  note_change(state);
  clear_events(state.published_events);
  state.published_soft_events.clear();
  state.published_fluid_touches.clear();
  state.events = {};
  state.problems.clear();
  state.frozen.clear();
  state.quarantined_soft.clear();
  // The solver scratch still holds constraints of the replaced state.
  forget_batch(state.solve.together);
  for (const std::unique_ptr<WorkerContext>& worker : state.solve.workers) forget_batch(worker->scratch);
  state.solve.counts = {};
  state.solve.colors = 0;
  state.fluid_scratch.clear();
}

}  // namespace gyre
