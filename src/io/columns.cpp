// Copying columns between worlds and copies. See columns.h.
#include "io/columns.h"

namespace gyre {

namespace {

// Where the columns of a state are, in the order of for_each_column.
struct ColumnList {
  static constexpr std::size_t kMost = 64;
  const void* columns[kMost];
  std::size_t count = 0;

  template <class Column>
  void operator()(const char*, const Column& column) {
    GYRE_ASSERT(count < kMost, "the list has room for every column");
    columns[count++] = &column;
  }
};

// Assigns each column from its like in a list.
struct ColumnCopier {
  const ColumnList& from;
  std::size_t next = 0;

  template <class Column>
  void operator()(const char*, Column& column) {
    // Both walks are of for_each_column, so the n-th columns are of one type.
    column = *static_cast<const Column*>(from.columns[next++]);
  }
};

template <class From, class To>
void copy_columns(const From& from, To& to) {
  ColumnList list;
  for_each_column(from, list);
  for_each_column(to, ColumnCopier{list});
}

void clear_events(RigidEvents& events) {
  events.begins.clear(), events.ends.clear(), events.hits.clear();
  events.sensors.clear(), events.broken.clear(), events.sleep_changes.clear();
}

void forget_batch(BatchScratch& batch) {
  batch.constraints.clear(), batch.constraint_contact.clear(), batch.pairs.clear();
  batch.swept_joints.clear(), batch.joint_pairs.clear();
}

// What a world tells about its last step is of another history now.
void forget_reports(WorldState& state) {
  clear_events(state.shown);
  state.events = {};
  state.problems.clear();
  state.frozen.clear();
  // What the solver had were constraints of the state that is replaced.
  forget_batch(state.solve.together);
  for (const std::unique_ptr<LoneSolver>& lone : state.solve.lone) forget_batch(lone->scratch);
  state.solve.counts = {};
  state.solve.colors = 0;
}

bool equal(const Proxy& a, const Proxy& b) {
  return a.fat_box.low == b.fat_box.low && a.fat_box.high == b.fat_box.high && a.filter == b.filter &&
         a.body == b.body && a.motion == b.motion && a.sensor == b.sensor && a.pushes == b.pushes;
}

// The proxies that differ, so that the broad phase need not be built anew. False if it must be.
bool list_differing(const Array<Proxy>& now, const Array<Proxy>& then, Array<std::uint32_t>& out) {
  if (now.size() != then.size()) return false;
  for (std::uint32_t i = 0; i < now.size(); ++i) {
    if (!equal(now[i], then[i])) out.push_back(i);
  }
  return true;
}

struct ByteCounter {
  std::size_t bytes = 0;

  template <class T>
  void operator()(const char*, const Array<T>& column) {
    bytes += column.bytes();
  }
  template <IsColumn T>
  void operator()(const char*, const T& column) {
    bytes += column.bytes();
  }
  void operator()(const char*, const IdPool& ids) { bytes += ids.bytes(); }
  void operator()(const char*, const std::vector<AnyShape>& shapes) {
    bytes += shapes.capacity() * sizeof(AnyShape);
  }
  template <class T>
  void operator()(const char*, const T&) {
    bytes += sizeof(T);
  }
};

}  // namespace

void adopt_columns(WorldState& state, StateColumns&& columns) {
  columns.rigid.broadphase = std::move(state.rigid.broadphase);
  columns.rigid.broadphase_stale = true;
  columns.rigid.world_number = state.number;
  state.rigid = std::move(columns.rigid);
  state.time = columns.time;
  state.step_count = columns.step_count;
  state.shown_changes.store(kNothingShown, std::memory_order_relaxed);
  forget_reports(state);
  // Bytes from outside can break rules that the engine never would (boxes that hold no shape, say), and are stepped without
  // harm. A walk that stops at them would blame the engine.
  state.walks = false;
  if (state.log != nullptr) state.log->on_restored(state);
}

void KeptState::keep(const WorldState& state) {
  copy_columns(state, columns_);
  columns_.rigid.events = state.rigid.events;
  changed_ = state.rigid.shapes.changed;
}

void KeptState::put_back(WorldState& state) const {
  RigidWorld& w = state.rigid;
  Array<std::uint32_t> changed = std::move(w.shapes.changed);
  const bool same_proxies =
      !w.broadphase_stale && list_differing(w.shapes.proxies, columns_.rigid.shapes.proxies, changed);
  copy_columns(columns_, state);
  derive_state(w);
  state.shown_changes.store(kNothingShown, std::memory_order_relaxed);
  if (same_proxies) {
    // What the broad phase has not seen of the present state, of the kept one, and what differs between the two.
    changed.append(changed_);
    w.shapes.changed = std::move(changed);
    w.broadphase_stale = false;
  }
  w.events = columns_.rigid.events;
  forget_reports(state);
  if (state.log != nullptr) state.log->on_restored(state);
}

std::size_t KeptState::bytes() const {
  ByteCounter counter;
  for_each_column(columns_, counter);
  return counter.bytes + changed_.bytes();
}

}  // namespace gyre
