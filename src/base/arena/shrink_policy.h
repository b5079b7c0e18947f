// ShrinkPolicy: tells when memory that is kept from step to step was far too large for long, so that it can be given back. Only
// large memory counts: a small world never gives anything back and so never has to take it again.
#pragma once

#include "base/container/array.h"

#include <cstddef>
#include <cstdint>

namespace gyre {

class ShrinkPolicy {
 public:
  // To be called once a step, with the bytes that the step needed and those that are held: whether for kSteps steps no more
  // than a quarter of them was needed. max_needed() then tells how much was.
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
  // Bytes; of the steps that the last rests() looked back on.
  std::size_t max_needed() const { return max_needed_; }

  // The same for an array that held `needed` elements in this step and is empty now: it gives back what it does not need.
  template <class T>
  void trim(Array<T>& array, std::size_t needed) {
    if (!should_shrink(needed * sizeof(T), array.bytes())) return;
    array.trim(2 * max_needed_ / sizeof(T));
  }

  // The same for two arrays that change places every step, of which `next` is empty.
  template <class T>
  void trim(Array<T>& next, Array<T>& current) {
    if (!should_shrink(current.size() * sizeof(T), next.bytes() + current.bytes())) return;
    next = Array<T>();
    if (current.empty()) current = Array<T>();
  }

 private:
  static constexpr std::size_t kWorthGivingBack = 64 * 1024;  // bytes
  // Odd, so that of two arrays that change places every step each has its turn.
  static constexpr std::uint32_t kSteps = 63;

  std::uint32_t steps_ = 0;
  std::size_t max_needed_ = 0;
};

}  // namespace gyre
