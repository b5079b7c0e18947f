// SlotTable: finds the slot of a record by the record's 64-bit key. It stores only slots, four bytes each; the keys
// stay in the records, and the caller reads them with key_of(slot). Open addressing with linear probing; it cannot be
// iterated, so no order leaks into a result.
#pragma once

#include "base/container/array.h"
#include "base/hash.h"

#include <cstddef>
#include <cstdint>

namespace gyre {

class SlotTable {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  std::size_t size() const { return size_; }
  std::size_t bytes() const { return cells_.bytes(); }

  // The slot of a key, or kNone.
  template <class KeyOf>
  std::uint32_t find(std::uint64_t key, const KeyOf& key_of) const {
    if (cells_.empty()) return kNone;
    for (std::size_t i = home(key);; i = next(i)) {
      if (cells_[i] == kNone || key_of(cells_[i]) == key) return cells_[i];
    }
  }

  // The slot where the search for a key begins, often the right one; kNone if that cell is empty.
  std::uint32_t first_tried(std::uint64_t key) const { return cells_.empty() ? kNone : cells_[home(key)]; }

  // The key must be new, and key_of(slot) must return it already.
  template <class KeyOf>
  void insert(std::uint64_t key, std::uint32_t slot, const KeyOf& key_of) {
    if (size_ + 1 > cells_.size() / 4 * 3) enlarge(cells_.empty() ? kMinCells : 2 * cells_.size(), key_of);
    put_slot(key, slot);
    ++size_;
  }

  // The key must exist, and key_of must still return it.
  template <class KeyOf>
  void erase(std::uint64_t key, const KeyOf& key_of) {
    std::size_t gap = home(key);
    while (key_of(cells_[gap]) != key) gap = next(gap);
    // Each later slot of the run that could stand nearer its home moves into the gap (Knuth, The Art of Computer
    // Programming 3, 6.4, algorithm R).
    for (std::size_t i = next(gap); cells_[i] != kNone; i = next(i)) {
      const std::size_t from_home = (i - home(key_of(cells_[i]))) & mask();
      if (from_home < ((i - gap) & mask())) continue;
      cells_[gap] = cells_[i];
      gap = i;
    }
    cells_[gap] = kNone;
    --size_;
  }

  // Removes all slots and keeps the memory.
  void clear() {
    for (std::uint32_t& cell : cells_) cell = kNone;
    size_ = 0;
  }

 private:
  static constexpr std::size_t kMinCells = 16;

  std::size_t mask() const { return cells_.size() - 1; }
  std::size_t home(std::uint64_t key) const { return static_cast<std::size_t>(mix_bits(key) >> 32) & mask(); }
  std::size_t next(std::size_t i) const { return (i + 1) & mask(); }

  void put_slot(std::uint64_t key, std::uint32_t slot) {
    std::size_t i = home(key);
    while (cells_[i] != kNone) i = next(i);
    cells_[i] = slot;
  }

  template <class KeyOf>
  void enlarge(std::size_t count, const KeyOf& key_of) {
    Array<std::uint32_t> old = std::move(cells_);
    cells_ = Array<std::uint32_t>();
    cells_.reserve(count);
    cells_.resize(count, kNone);
    for (const std::uint32_t slot : old) {
      if (slot != kNone) put_slot(key_of(slot), slot);
    }
  }

  Array<std::uint32_t> cells_;  // a power of two, at most three quarters full, or none
  std::size_t size_ = 0;
};

}  // namespace gyre
