// ShrinkPolicy: decides when memory that is kept between steps was far too large for long and should be released. It
// ignores small memory, so a small world never releases any and never allocates it again.
#pragma once

#include "base/container/array.h"

#include <cstddef>
#include <cstdint>

namespace gyre {

class ShrinkPolicy {
 public:
  // To be called once a step, with the bytes that the step needed and those allocated. True if for kSteps steps no more
  // than a quarter was needed; max_needed() then gives the most.
  bool should_shrink(std::size_t needed, std::size_t capacity) {
    if (capacity < kWorthGivingBack || needed > capacity / 4) {
      steps_ = 0;
      max_needed_ = 0;
      return false;
    }
    max_needed_ = max_needed_ < needed ? needed : max_needed_;
    if (++steps_ < kSteps) return false;
    steps_ = 0;
    return true;
  }
  // Bytes, over the steps before the last should_shrink().
  std::size_t max_needed() const { return max_needed_; }

  // The same for an array that held `needed` elements in this step and is empty now; trims it.
  template <class T>
  void trim(Array<T>& array, std::size_t needed) {
    if (!should_shrink(needed * sizeof(T), array.bytes())) return;
    array.trim(2 * max_needed_ / sizeof(T));
  }

  // The same for two arrays that are swapped every step, of which `next` is empty.
  template <class T>
  void trim(Array<T>& next, Array<T>& current) {
    if (!should_shrink(current.size() * sizeof(T), next.bytes() + current.bytes())) return;
    next = Array<T>();
    if (current.empty()) current = Array<T>();
  }

 private:
  static constexpr std::size_t kWorthGivingBack = 64 * 1024;  // bytes
  // Odd, so that each of two arrays that are swapped every step has its turn.
  static constexpr std::uint32_t kSteps = 63;

  std::uint32_t steps_ = 0;
  std::size_t max_needed_ = 0;
};

}  // namespace gyre
