// FlatMap<V>: a map from 64-bit keys to values. Entries lie densely in an array, and only that array can be visited, so
// the order of a hash table never leaks into a result. A table of (hash, entry) pairs with linear probing finds them.
//
// Order: insertion order, except that erase() moves the last entry into the gap. So it is a function of the calls
// alone.
#pragma once

#include "base/container/array.h"
#include "base/hash.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace gyre {

template <class V>
class FlatMap {
 public:
  struct Entry {
    std::uint64_t key;
    V value;
  };

  std::size_t size() const { return entries_.size(); }
  bool empty() const { return entries_.empty(); }

  // The value of a key, or null. Valid until the next insert or erase.
  V* find(std::uint64_t key) {
    const std::size_t cell = find_cell(key);
    return cell != kNotFound ? &entries_[cells_[cell].entry].value : nullptr;
  }
  const V* find(std::uint64_t key) const {
    const std::size_t cell = find_cell(key);
    return cell != kNotFound ? &entries_[cells_[cell].entry].value : nullptr;
  }
  bool contains(std::uint64_t key) const { return find_cell(key) != kNotFound; }

  // Sets the value of a key. An existing key keeps its position in the order.
  V& insert(std::uint64_t key, V value) {
    if (V* const old = find(key)) {
      *old = std::move(value);
      return *old;
    }
    return add(key, std::move(value));
  }

  // The value of a key; inserts `fallback` if there is none.
  V& find_or_insert(std::uint64_t key, V fallback = V()) {
    if (V* const old = find(key)) return *old;
    return add(key, std::move(fallback));
  }

  // Removes a key; the last entry takes its position in the order. False if it was not there.
  bool erase(std::uint64_t key) {
    const std::size_t cell = find_cell(key);
    if (cell == kNotFound) return false;
    const std::uint32_t gone = cells_[cell].entry;
    const std::uint32_t last = static_cast<std::uint32_t>(entries_.size() - 1);
    if (gone != last) cells_[cell_of_entry(last)].entry = gone;
    close_gap(cell);
    entries_.swap_remove(gone);
    return true;
  }

  // Removes all entries and keeps the memory.
  void clear() {
    entries_.clear();
    for (Cell& cell : cells_) cell = Cell{};
  }

  // Makes room for `count` entries in all.
  void reserve(std::size_t count) {
    entries_.reserve(count);
    std::size_t cells = kMinCells;
    while (cells / 4 * 3 < count) cells *= 2;
    if (cells > cells_.size()) rebuild_cells(cells);
  }

  // All entries, in order.
  std::span<const Entry> entries() const { return entries_; }
  // Calls fn(std::uint64_t key, V& value) for each entry, in order. fn must not insert or erase.
  template <class Fn>
  void for_each(Fn&& fn) {
    for (Entry& entry : entries_) fn(std::as_const(entry.key), entry.value);
  }
  template <class Fn>
  void for_each(Fn&& fn) const {
    for (const Entry& entry : entries_) fn(entry.key, entry.value);
  }

  std::size_t bytes() const { return entries_.bytes() + cells_.bytes(); }

 private:
  static constexpr std::uint32_t kEmpty = 0xffffffff;
  static constexpr std::size_t kNotFound = SIZE_MAX;
  static constexpr std::size_t kMinCells = 16;

  // Half of the hash: it gives the home cell, and excludes most other keys without a read of the entry.
  struct Cell {
    std::uint32_t hash = 0;
    std::uint32_t entry = kEmpty;
  };

  static std::uint32_t hash_of(std::uint64_t key) { return static_cast<std::uint32_t>(mix_bits(key) >> 32); }
  std::size_t mask() const { return cells_.size() - 1; }

  std::size_t find_cell(std::uint64_t key) const {
    if (cells_.empty()) return kNotFound;
    const std::uint32_t hash = hash_of(key);
    for (std::size_t i = hash & mask();; i = (i + 1) & mask()) {
      const Cell& cell = cells_[i];
      if (cell.entry == kEmpty) return kNotFound;
      if (cell.hash == hash && entries_[cell.entry].key == key) return i;
    }
  }

  std::size_t cell_of_entry(std::uint32_t entry) const {
    for (std::size_t i = hash_of(entries_[entry].key) & mask();; i = (i + 1) & mask()) {
      if (cells_[i].entry == entry) return i;
    }
  }

  V& add(std::uint64_t key, V&& value) {
    GYRE_ASSERT(entries_.size() < kEmpty, "a map holds fewer than 2^32 - 1 entries");
    // At most three quarters full, so that an empty cell ends every search soon.
    if (entries_.size() + 1 > cells_.size() / 4 * 3) {
      rebuild_cells(cells_.empty() ? kMinCells : cells_.size() * 2);
    }
    put_cell({hash_of(key), static_cast<std::uint32_t>(entries_.size())});
    return entries_.push_back(Entry{key, std::move(value)}).value;
  }

  void put_cell(Cell cell) {
    std::size_t i = cell.hash & mask();
    while (cells_[i].entry != kEmpty) i = (i + 1) & mask();
    cells_[i] = cell;
  }

  void rebuild_cells(std::size_t count) {
    cells_.assign(count, Cell{});
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      put_cell({hash_of(entries_[i].key), static_cast<std::uint32_t>(i)});
    }
  }

  // Empties a cell. Each later cell of the run that could stand nearer its home moves into the gap, so no search ends
  // too early and no tombstones pile up (Knuth, The Art of Computer Programming 3, 6.4, algorithm R).
  void close_gap(std::size_t gap) {
    for (std::size_t i = (gap + 1) & mask(); cells_[i].entry != kEmpty; i = (i + 1) & mask()) {
      const std::size_t home = cells_[i].hash & mask();
      const std::size_t from_home = (i - home) & mask();
      const std::size_t from_gap = (i - gap) & mask();
      if (from_home >= from_gap) {
        cells_[gap] = cells_[i];
        gap = i;
      }
    }
    cells_[gap] = Cell{};
  }

  Array<Entry> entries_;
  Array<Cell> cells_;  // a power of two, or none
};

}  // namespace gyre
