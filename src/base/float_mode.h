// FloatMode: while one lives, its thread computes with the rounding that every result of the engine assumes: to nearest,
// denormals kept, no traps. Hosts often switch denormals off for audio or leave another rounding behind; without this
// the same step would give other bits on another thread. The host's mode comes back at the end.
#pragma once

#include <cstdint>

namespace gyre {

class FloatMode {
 public:
  FloatMode();
  ~FloatMode();
  FloatMode(const FloatMode&) = delete;
  FloatMode& operator=(const FloatMode&) = delete;

 private:
  std::uint64_t saved_;
};

}  // namespace gyre
