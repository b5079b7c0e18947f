// SlotTable: finds the slot of a record by the record's 64-bit key. The keys stay in the records, and whoever asks tells how to read
// them: key_of(slot). Half of a key's hash stands beside the slot, so that only the record that is found is read, which lies
// anywhere in memory. Open addressing with linear probing; there is no order to walk, so none can leak into a result.
#pragma once

#include "base/array.h"
#include "base/hash.h"

#include <cstddef>
#include <cstdint>

namespace gyre {

class SlotTable {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  std::size_t size() const { return size_; }
  std::size_t bytes() const { return cells_.bytes(); }

  // The slot of a key; kNone if it is not there.
  template <class KeyOf>
  std::uint32_t find(std::uint64_t key, const KeyOf& key_of) const {
    if (cells_.empty()) return kNone;
    const std::uint32_t hash = hash_of(key);
    for (std::size_t i = hash & mask();; i = next(i)) {
      const Cell& cell = cells_[i];
      if (cell.slot == kNone || (cell.hash == hash && key_of(cell.slot) == key)) return cell.slot;
    }
  }

  // The slot of a key, or of another one with the same hash; kNone if it is not there. Reads no key.
  std::uint32_t likely_slot(std::uint64_t key) const {
    return find(key, [key](std::uint32_t) { return key; });
  }

  // The key must be new.
  void insert(std::uint64_t key, std::uint32_t slot) {
    if (size_ + 1 > cells_.size() / 4 * 3) enlarge(cells_.empty() ? kLeastCells : 2 * cells_.size());
    place({hash_of(key), slot});
    ++size_;
  }

  // It must be there, with this key.
  void erase(std::uint64_t key, std::uint32_t slot) {
    std::size_t gap = hash_of(key) & mask();
    while (cells_[gap].slot != slot) gap = next(gap);
    // Each later one of the run that could stand nearer its home moves into the gap (Knuth, The Art of Computer
    // Programming 3, 6.4, algorithm R).
    for (std::size_t i = next(gap); cells_[i].slot != kNone; i = next(i)) {
      const std::size_t from_home = (i - cells_[i].hash) & mask();
      if (from_home < ((i - gap) & mask())) continue;
      cells_[gap] = cells_[i];
      gap = i;
    }
    cells_[gap] = Cell{};
    --size_;
  }

  // Forgets all slots and keeps the memory.
  void clear() {
    for (Cell& cell : cells_) cell = Cell{};
    size_ = 0;
  }

 private:
  static constexpr std::size_t kLeastCells = 16;

  struct Cell {
    std::uint32_t hash = 0;
    std::uint32_t slot = kNone;
  };

  static std::uint32_t hash_of(std::uint64_t key) { return static_cast<std::uint32_t>(mix_bits(key) >> 32); }
  std::size_t mask() const { return cells_.size() - 1; }
  std::size_t next(std::size_t i) const { return (i + 1) & mask(); }

  void place(Cell cell) {
    std::size_t i = cell.hash & mask();
    while (cells_[i].slot != kNone) i = next(i);
    cells_[i] = cell;
  }

  void enlarge(std::size_t count) {
    Array<Cell> old = std::move(cells_);
    cells_ = Array<Cell>();
    cells_.reserve(count);
    cells_.resize(count, Cell{});
    for (const Cell& cell : old) {
      if (cell.slot != kNone) place(cell);
    }
  }

  Array<Cell> cells_;  // a power of two, at most three quarters full, or none
  std::size_t size_ = 0;
};

}  // namespace gyre
