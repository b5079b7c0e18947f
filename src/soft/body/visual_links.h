// Links and tethers of the visual scheme (soft/solver/visual_step.h): derived from the springs of a body, and kept for as long as these and the held particles
// stay the same.
#pragma once

#include "base/container/array.h"

#include <cstdint>

namespace gyre {

struct VisualLink {
  std::uint32_t a = 0, b = 0;
  float rest_length = 0.0f;  // m
  float compliance = 0.0f;   // m/N
};

// A particle is no further from a held one than along the links at rest.
struct Tether {
  std::uint32_t particle = 0, held = 0;
  float length = 0.0f;  // m
};

struct VisualLinks {
  Array<VisualLink> links;  // colour by colour: those of one colour share no particle
  Array<Tether> tethers;
  Array<std::uint32_t> held;  // for which the tethers were found
  bool made = false;
};

}  // namespace gyre
