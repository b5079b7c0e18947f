// A coupling as the world stores it. It occupies a slot with a generation, as fields do: odd while the slot is in use. A coupling is removed with
// any of its joints.
#pragma once

#include <gyre/coupling.h>

#include <cstdint>

namespace gyre {

struct CouplingRecord {
  std::uint32_t generation = 0;
  std::uint32_t count = 0;  // of terms
  std::uint32_t joints[kMaxCouplingTerms] = {};
  JointAxis axes[kMaxCouplingTerms] = {};
  float coefficients[kMaxCouplingTerms] = {};
  float offset = 0.0f;
  float impulse = 0.0f;  // of the last sub-step, for the warm start
  float total = 0.0f;    // over the last step

  bool is_live() const { return (generation & 1) != 0; }
};

}  // namespace gyre
