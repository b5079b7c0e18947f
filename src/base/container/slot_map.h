// IdPool: tracks which slots of a dense storage are in use, and by which owner. acquire() always returns the lowest
// free slot, so slots are a function of the history of calls alone.
//
// Generations: a slot's number grows by one when it is acquired and again when it is released. Live ones are odd, and 0
// is never live: the all-zero id is null. They fit in 16 bits, as in public ids. A slot whose numbers are used up is
// retired and never handed out again, so an id that outlived its object can never refer to another.
#pragma once

#include "base/container/array.h"
#include "base/container/bitset.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace gyre {

class IdPool {
 public:
  struct Slot {
    std::uint32_t index = 0;
    std::uint32_t generation = 0;
  };

  // The generation of a retired slot: one more than the last live one.
  static constexpr std::uint32_t kRetired = 0x10000;

  Slot acquire() {
    std::size_t index = free_.find_next(lowest_free_);
    if (index == free_.size()) {
      index = generations_.size();
      generations_.push_back(0u);
      free_.resize(index + 1);
    } else {
      free_.clear(index);
    }
    lowest_free_ = index + 1;
    ++size_;
    return {static_cast<std::uint32_t>(index), ++generations_[index]};
  }

  void release(std::uint32_t index) {
    GYRE_ASSERT(live(index), "a slot is released once, by its owner");
    if (!live(index)) return;
    --size_;
    if (++generations_[index] == kRetired) return;
    free_.set(index);
    if (index < lowest_free_) lowest_free_ = index;
  }

  // True if the slot still belongs to the owner with this generation.
  bool alive(std::uint32_t index, std::uint32_t generation) const {
    return index < generations_.size() && generations_[index] == generation && (generation & 1) != 0;
  }
  // True if the slot has an owner.
  bool live(std::uint32_t index) const {
    return index < generations_.size() && (generations_[index] & 1) != 0;
  }
  std::uint32_t generation(std::uint32_t index) const { return generations_[index]; }

  // The number of slots in use; the number of slots that ever were (indices are below it).
  std::size_t size() const { return size_; }
  std::size_t capacity() const { return generations_.size(); }
  std::size_t bytes() const { return generations_.bytes() + free_.bytes(); }

  void reserve(std::size_t count) { generations_.reserve(count); }

  // Releases every slot in use.
  void release_all() {
    for (std::uint32_t i = 0; i < generations_.size(); ++i) {
      if (live(i)) release(i);
    }
  }

  // Calls fn(std::uint32_t index) for each slot in use, ascending.
  template <class Fn>
  void for_each_live(Fn&& fn) const {
    for (std::uint32_t i = 0; i < generations_.size(); ++i) {
      if (live(i)) fn(i);
    }
  }

  // The whole state, for snapshots: the free slots follow from the generations (even and not retired).
  std::span<const std::uint32_t> generations() const { return generations_; }
  const Bitset& free_slots() const { return free_; }

  // Restores a saved state. False, without a change, if a generation is larger than kRetired.
  bool restore(std::span<const std::uint32_t> generations) {
    for (const std::uint32_t generation : generations) {
      if (generation > kRetired) return false;
    }
    generations_.assign(generations);
    free_.resize(0);
    free_.resize(generations.size());
    size_ = 0;
    lowest_free_ = 0;
    for (std::size_t i = 0; i < generations.size(); ++i) {
      size_ += generations[i] & 1;
      if ((generations[i] & 1) == 0 && generations[i] != kRetired) free_.set(i);
    }
    return true;
  }

 private:
  Array<std::uint32_t> generations_;
  Bitset free_;
  std::size_t lowest_free_ = 0;  // no free slot is below; acquire starts here
  std::size_t size_ = 0;
};

}  // namespace gyre
