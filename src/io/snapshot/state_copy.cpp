// Packs a state and restores it. See state_copy.h.
//
// Most of a state are manifolds, and most manifolds are empty: every pair of overlapping fat boxes has one. The
// unused rest of a manifold equals that of a new one (find_fault in collision/contact/contact_store checks it), so it
// is not stored.
#include "io/snapshot/state_copy.h"

#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>

namespace gyre {

namespace {

using Manifolds = decltype(ContactStore::manifolds);

// Each count and each array begins at an address that suits any record.
std::size_t padded(std::size_t bytes) { return (bytes + kMemoryAlign - 1) / kMemoryAlign * kMemoryAlign; }

// A manifold with `count` points is stored as two runs of its bytes: from the start to its last point, and from
// behind the array of points to its last anchor.
constexpr std::size_t kHeadBytes = offsetof(Manifold, points);
constexpr std::size_t kTailOffset = offsetof(Manifold, load_age);
static_assert(kTailOffset == kHeadBytes + kMaxManifoldPoints * sizeof(ContactPointState) &&
                  offsetof(Manifold, anchors) + kMaxManifoldPoints * sizeof(PointAnchor) == sizeof(Manifold),
              "points and anchors end the runs, with all there is in one of them");

std::size_t point_bytes(int count) { return std::size_t(count) * sizeof(ContactPointState); }
std::size_t tail_bytes(int count) {
  return offsetof(Manifold, anchors) - kTailOffset + std::size_t(count) * sizeof(PointAnchor);
}
std::size_t manifold_bytes(int count) { return kHeadBytes + point_bytes(count) + tail_bytes(count); }

// Calls fn(manifold) for each used manifold, in the order of contacts, which is part of the state.
template <class Store, class Fn>
void for_each_manifold(Store& store, Fn&& fn) {
  for (const Contact& contact : store.contacts) {
    for (auto& manifold : manifolds_of(store, contact)) fn(manifold);
  }
}

bool equal(const Proxy& a, const Proxy& b) {
  return a.fat_box.low == b.fat_box.low && a.fat_box.high == b.fat_box.high && a.filter == b.filter &&
         a.body == b.body && a.motion == b.motion && a.sensor == b.sensor && a.pushes == b.pushes;
}

// Lists the proxies that differ, for an update of the broad phase. False if it must be rebuilt.
bool list_differing(std::span<const Proxy> now, std::span<const Proxy> then, Array<std::uint32_t>& out) {
  if (now.size() != then.size()) return false;
  for (std::uint32_t i = 0; i < now.size(); ++i) {
    if (!equal(now[i], then[i])) out.push_back(i);
  }
  return true;
}

// The size of the packed arrays.
struct PackedSize {
  const ContactStore& store;
  std::size_t bytes = 0;

  template <class T>
  void operator()(const char*, const Array<T>& column) {
    bytes += padded(sizeof(std::size_t)) + padded(column.size() * sizeof(T));
  }
  void operator()(const char*, const Manifolds&) {
    bytes += padded(sizeof(std::size_t));
    for_each_manifold(store, [&](const Manifold& manifold) { bytes += manifold_bytes(manifold.count); });
  }
  template <class Column>
  void operator()(const char*, const Column&) {}
};

struct Packer {
  const ContactStore& store;
  std::byte* to;

  template <class T>
  void operator()(const char*, const Array<T>& column) {
    static_assert(std::is_trivially_copyable_v<T>, "records are packed as bytes");
    write_count(column.size());
    if (!column.empty()) std::memcpy(to, column.data(), column.size() * sizeof(T));
    to += padded(column.size() * sizeof(T));
  }
  void operator()(const char*, const Manifolds& column) {
    write_count(column.size());
    for_each_manifold(store, [&](const Manifold& manifold) {
      const auto* const from = reinterpret_cast<const std::byte*>(&manifold);
      const std::size_t head = kHeadBytes + point_bytes(manifold.count), tail = tail_bytes(manifold.count);
      std::memcpy(to, from, head);
      std::memcpy(to + head, from + kTailOffset, tail);
      to += head + tail;
    });
  }
  template <class Column>
  void operator()(const char*, const Column&) {}

 private:
  void write_count(std::size_t count) {
    std::memcpy(to, &count, sizeof count);
    to += padded(sizeof count);
  }
};

// Requires columns in which no manifold is in use.
struct Unpacker {
  ContactStore& store;
  const std::byte* from;
  // Gets the proxies that differ from the present ones. If `same_count` is false, the list is incomplete.
  Array<std::uint32_t>& differing;
  bool same_count = false;

  template <class T>
  void operator()(const char*, Array<T>& column) {
    const std::span<const T> saved = next<T>();
    if constexpr (std::is_same_v<T, Proxy>) same_count = list_differing(column.view(), saved, differing);
    column.assign(saved);
  }
  void operator()(const char*, Manifolds& column) {
    column.resize(get_count());
    // The column of contacts comes before, so the contacts are those of these manifolds.
    for_each_manifold(store, [&](Manifold& manifold) {
      auto* const to = reinterpret_cast<std::byte*>(&manifold);
      std::memcpy(to, from, kHeadBytes);
      const std::size_t points = point_bytes(manifold.count), tail = tail_bytes(manifold.count);
      std::memcpy(to + kHeadBytes, from + kHeadBytes, points);
      std::memcpy(to + kTailOffset, from + kHeadBytes + points, tail);
      from += kHeadBytes + points + tail;
    });
  }
  template <class Column>
  void operator()(const char*, const Column&) {}

 private:
  std::size_t get_count() {
    std::size_t count = 0;
    std::memcpy(&count, from, sizeof count);
    from += padded(sizeof count);
    return count;
  }
  template <class T>
  std::span<const T> next() {
    const std::size_t count = get_count();
    const std::byte* const data = from;
    from += padded(count * sizeof(T));
    return {reinterpret_cast<const T*>(data), count};
  }
};

// The addresses of the columns that are not packed, in the order of for_each_column.
struct OtherColumns {
  static constexpr std::size_t kMaxColumns = 64;
  const void* columns[kMaxColumns];
  std::size_t count = 0;

  template <class Column>
  void operator()(const char*, const Column& column) {
    GYRE_ASSERT(count < kMaxColumns, "the list has room for every column");
    columns[count++] = &column;
  }
};

struct OtherCopier {
  const OtherColumns& from;
  std::size_t next = 0;

  template <class T>
  void operator()(const char*, Array<T>&) {
    ++next;
  }
  void operator()(const char*, Manifolds&) { ++next; }
  template <class Column>
  void operator()(const char*, Column& column) {
    // Both loops visit the columns in the same order, so the n-th columns have the same type.
    column = *static_cast<const Column*>(from.columns[next++]);
  }
};

template <class From, class To>
void copy_others(const From& from, To& to) {
  OtherColumns list;
  for_each_column(from, list);
  for_each_column(to, OtherCopier{list});
}

struct OtherSize {
  std::size_t bytes = 0;

  template <class T>
  void operator()(const char*, const Array<T>&) {}
  template <IsColumn T>
  void operator()(const char*, const T& column) {
    bytes += column.bytes();
  }
  void operator()(const char*, const IdPool& ids) { bytes += ids.bytes(); }
  void operator()(const char*, const SoftStore& soft) {
    soft.for_each([&](const SoftEntry& entry) {
      for_each_damage_array(entry, [&](const auto& array) { bytes += array.bytes(); });
      for_each_soft_array(entry, [&](const auto& array) { bytes += array.bytes(); });
      for_each_rare_array(entry, [&](const auto& array) { bytes += array.bytes(); });
      bytes += entry.faces.bytes() + entry.points.bytes();
    });
  }
  void operator()(const char*, const FluidStore& fluids) {
    fluids.for_each([&](const FluidEntry& entry) {
      for_each_fluid_array(entry, [&](const auto& array) { bytes += array.bytes(); });
      for_each_later_fluid_array(entry, [&](const auto& array) { bytes += array.bytes(); });
    });
  }
  void operator()(const char*, const std::vector<AnyShape>& shapes) { bytes += shapes.capacity() * sizeof(AnyShape); }
  template <class T>
  void operator()(const char*, const T&) {
    bytes += sizeof(T);
  }
};

}  // namespace

void StateCopy::save(const WorldState& state) {
  const ContactStore& store = state.rigid.contacts;
  PackedSize size{store};
  for_each_column(state, size);
  packed_.clear();  // growth would copy the old contents
  packed_.resize_uninitialized(size.bytes);
  for_each_column(state, Packer{store, packed_.data()});
  copy_others(state, others_);
  others_.rigid.events = state.rigid.events;
  changed_ = state.rigid.shapes.changed;
}

void StateCopy::restore(WorldState& state) const {
  RigidWorld& w = state.rigid;
  // The memory of both lists stays with the world, so that repeated restores allocate nothing.
  Array<std::uint32_t>& changed = state.changes_to_show;
  std::swap(changed, w.shapes.changed);
  for_each_manifold(w.contacts, [](Manifold& manifold) { manifold = Manifold{}; });
  Unpacker unpacker{w.contacts, packed_.data(), changed};
  for_each_column(state, unpacker);
  copy_others(others_, state);
  const bool can_keep_broadphase = !w.broadphase_stale && unpacker.same_count;
  derive_state(w);
  state.queried_changes.store(kNothingQueried, std::memory_order_relaxed);
  if (can_keep_broadphase) {
    // The broad phase has not seen the changed boxes of the present state, those of the saved one, and the
    // differences of the two.
    changed.append(changed_);
    std::swap(changed, w.shapes.changed);
    w.broadphase_stale = false;
  }
  w.events = others_.rigid.events;
  clear_reports(state);
  if (state.log != nullptr) state.log->on_restored(state);
}

std::size_t StateCopy::bytes() const {
  OtherSize size;
  for_each_column(others_, size);
  return size.bytes + packed_.bytes() + changed_.bytes();
}

}  // namespace gyre
