// Steps two worlds side by side. See difference.h.
//
// The first world steps and records a trace after each stage. The second is compared with the traces as it steps. So
// no world has to stop within a step, and a difference is found even if a second run would not show it again.
#include "io/recording/difference.h"

#include "base/hash.h"
#include "io/recording/recording.h"
#include "io/snapshot/state_copy.h"
#include "world/world_access.h"

#include <cstdio>
#include <cstring>

namespace gyre {

namespace {

constexpr const char* kBeforeStep = "before the step";
constexpr const char* kEndOfStep = "end of the step";
// Column name of a difference if two worlds of this build agree with each other.
constexpr const char* kOnlyRecorded = "none: only the recorded hash differs";

template <class Record>
std::uint64_t hash_record(const Record& record) {
  std::uint64_t hash = 0;
  for_each_field(record, [&](const auto& value) { hash = mix_bits(hash + std::uint64_t(to_bits(value))); });
  return hash;
}

struct Tracer {
  StateTrace& trace;

  template <class T>
  void operator()(const char* name, const Array<T>& column) {
    StateTrace::Column& out = add(name);
    out.rows.reserve(column.size());
    for (const T& record : column) out.rows.push_back(hash_record(record));
  }
  template <IsColumn T>
  void operator()(const char* name, const T& column) {
    StateTrace::Column& out = add(name);
    out.rows.reserve(column.size());
    for (std::size_t i = 0; i < column.size(); ++i) out.rows.push_back(hash_record(column[i]));
  }
  void operator()(const char* name, const IdPool& ids) {
    StateTrace::Column& out = add(name);
    for (const std::uint32_t generation : ids.generations()) out.rows.push_back(generation);
  }
  void operator()(const char* name, const std::vector<AnyShape>& shapes) {
    StateTrace::Column& out = add(name);
    ByteWriter bytes;
    for (const AnyShape& shape : shapes) {
      bytes.clear();
      write_shape(bytes, shape);
      out.rows.push_back(hash_bytes(bytes.view().data(), bytes.size()));
    }
  }
  // A row for each rope, cloth or solid.
  void operator()(const char* name, const SoftStore& soft) {
    StateTrace::Column& out = add(name);
    soft.for_each([&](const SoftEntry& entry) {
      std::uint64_t hash = std::uint64_t(entry.body.particles.count);
      const auto add_array = [&](const auto& array) {
        for (const auto& record : array) hash = mix_bits(hash + hash_record(record));
      };
      for_each_damage_array(entry, add_array);
      for_each_soft_array(entry, add_array);
      for_each_rare_array(entry, add_array);
      add_array(entry.faces);
      add_array(entry.points);
      out.rows.push_back(hash);
    });
  }
  // A row for each fluid.
  void operator()(const char* name, const FluidStore& fluids) {
    StateTrace::Column& out = add(name);
    fluids.for_each([&](const FluidEntry& entry) {
      std::uint64_t hash = std::uint64_t(entry.shape().count());
      const auto add_array = [&](const auto& array) {
        for (const auto& record : array) hash = mix_bits(hash + hash_record(record));
      };
      for_each_fluid_array(entry, add_array);
      for_each_later_fluid_array(entry, add_array);
      out.rows.push_back(hash);
    });
  }
  template <class Record>
  void operator()(const char* name, const Record& record) {
    add(name).rows.push_back(hash_record(record));
  }

 private:
  StateTrace::Column& add(const char* name) {
    StateTrace::Column& column = trace.columns.emplace_back();
    column.name = name;
    return column;
  }
};

void copy_name(char (&to)[48], const char* from) { std::snprintf(to, sizeof to, "%s", from); }

// Finds the first row in which the traces differ. True if there is one.
bool compare(const StateTrace& a, const StateTrace& b, Difference& out) {
  for (std::size_t c = 0; c < a.columns.size(); ++c) {
    const std::vector<std::uint64_t>& rows_a = a.columns[c].rows;
    const std::vector<std::uint64_t>& rows_b = b.columns[c].rows;
    std::size_t row = 0;
    while (row < rows_a.size() && row < rows_b.size() && rows_a[row] == rows_b[row]) ++row;
    if (row == rows_a.size() && row == rows_b.size()) continue;
    copy_name(out.stage, a.stage);
    copy_name(out.column, a.columns[c].name);
    out.row = row;
    return true;
  }
  return false;
}

// Installs a stage hook and restores the former one at the end.
class HookGuard {
 public:
  HookGuard(WorldState& state, StageHook hook) : state_(state), before_(state.stage_hook) {
    state.stage_hook = hook;
  }
  ~HookGuard() { state_.stage_hook = before_; }
  HookGuard(const HookGuard&) = delete;
  HookGuard& operator=(const HookGuard&) = delete;
  // Calls the former hook.
  void pass_on(const char* stage) const {
    if (before_.call != nullptr) before_.call(before_.context, stage);
  }

 private:
  WorldState& state_;
  StageHook before_;
};

std::vector<StateTrace> step_with_traces(WorldState& state, float seconds) {
  struct Context {
    WorldState& state;
    std::vector<StateTrace> traces;
    const HookGuard* guard = nullptr;
  } context{state, {}, nullptr};
  const HookGuard guard(state, {[](void* user, const char* stage) {
                                  Context& c = *static_cast<Context*>(user);
                                  c.guard->pass_on(stage);
                                  c.traces.push_back(trace_state(c.state, stage));
                                },
                                &context});
  context.guard = &guard;
  submit(state, Step{seconds});
  context.traces.push_back(trace_state(state, kEndOfStep));
  return std::move(context.traces);
}

bool step_against_traces(WorldState& state, float seconds, const std::vector<StateTrace>& traces,
                         Difference& out) {
  struct Context {
    WorldState& state;
    const std::vector<StateTrace>& traces;
    Difference& out;
    std::size_t next = 0;
    bool found = false;
    const HookGuard* guard = nullptr;
  } context{state, traces, out};
  const HookGuard guard(state, {[](void* user, const char* stage) {
                                  Context& c = *static_cast<Context*>(user);
                                  c.guard->pass_on(stage);
                                  if (c.found || c.next >= c.traces.size()) return;
                                  c.found = compare(c.traces[c.next++], trace_state(c.state, stage), c.out);
                                },
                                &context});
  context.guard = &guard;
  submit(state, Step{seconds});
  return context.found || compare(traces.back(), trace_state(state, kEndOfStep), out);
}

Difference no_difference() {
  Difference none;
  none.step = UINT64_MAX;
  return none;
}

// Plays the steps from `first` to `last`, whose hash differed, beside the simplest world. Hashes of earlier steps may
// cover the motion only, so the difference may have begun in any of them.
Difference explain_steps(const Recording& recording, std::uint64_t first, std::uint64_t last,
                         WorldState& suspect, WorldState& plain) {
  Difference found;
  for (found.step = first;; ++found.step) {
    const RecordedStep& step = recording.steps[std::size_t(found.step)];
    const float seconds = play_commands(recording, step, suspect);
    play_commands(recording, step, plain);
    if (step_and_compare(suspect, plain, seconds, found)) return found;
    if (found.step == last) break;
  }
  copy_name(found.stage, kOnlyRecorded);
  return found;
}

}  // namespace

StateTrace trace_state(const WorldState& state, const char* stage) {
  StateTrace trace;
  trace.stage = stage;
  for_each_column(state, Tracer{trace});
  return trace;
}

bool step_and_compare(WorldState& a, WorldState& b, float seconds, Difference& difference) {
  if (compare(trace_state(a, kBeforeStep), trace_state(b, kBeforeStep), difference)) return true;
  const std::vector<StateTrace> traces = step_with_traces(a, seconds);
  return step_against_traces(b, seconds, traces, difference);
}

Result<Difference> first_difference(std::span<const std::byte> snapshot, const WorldDef& a, const WorldDef& b,
                                    int steps, float seconds) {
  Result<World> first = load_snapshot(snapshot, a);
  if (!first) return first.error();
  Result<World> second = load_snapshot(snapshot, b);
  if (!second) return second.error();
  for (int i = 0; i < steps; ++i) {
    Difference found;
    if (!step_and_compare(state_of(*first), state_of(*second), seconds, found)) continue;
    found.step = std::uint64_t(i);
    return found;
  }
  return no_difference();
}

Result<Difference> first_difference(std::span<const std::byte> recording, const WorldDef& def) {
  Result<Recording> opened = open_recording({recording.begin(), recording.end()});
  if (!opened) return opened.error();
  WorldDef plain_def = def;
  plain_def.threads = 1;
  plain_def.simd_width = 1;
  plain_def.host_tasks = {};
  plain_def.stepping.broad_phase = BroadPhaseKind::brute_force;
  Result<World> suspect = make_recorded_world(*opened, def);
  if (!suspect) return suspect.error();
  Result<World> plain = make_recorded_world(*opened, plain_def);
  if (!plain) return plain.error();
  StateCopy before;  // the last state that is known to equal the recorded one
  std::uint64_t first = 0;
  before.save(state_of(*suspect));
  for (std::uint64_t i = 0; i < opened->steps.size(); ++i) {
    WorldState& state = state_of(*suspect);
    const RecordedStep& step = opened->steps[std::size_t(i)];
    const float seconds = play_commands(*opened, step, state);
    submit(state, Step{seconds});
    if (has_recorded_hash(step, state)) {
      if (!step.is_whole) continue;
      before.save(state);
      first = i + 1;
      continue;
    }
    before.restore(state);
    before.restore(state_of(*plain));
    return explain_steps(*opened, first, i, state, state_of(*plain));
  }
  return no_difference();
}

}  // namespace gyre
