// FloatMode: while an object lives, its thread computes with the rounding that all results of the engine assume: to
// nearest, with denormals, without traps. Hosts often switch denormals off for audio or leave another rounding behind;
// the same step would then give other bits on another thread. The destructor restores the host's mode.
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
