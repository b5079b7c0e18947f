// Random numbers for tests: the same on every platform. (G. Marsaglia, "Xorshift RNGs", 2003.)
#pragma once

#include "math/rotation.h"

#include <gyre/math.h>

#include <cstdint>

namespace gyre::testing_random {

struct Random {
  std::uint64_t state = 88172645463325252ull;
  std::uint32_t next(std::uint32_t below) {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return std::uint32_t((state >> 11) % below);
  }
  float real(float low, float high) { return low + (high - low) * float(next(1u << 20)) / float(1u << 20); }
  Vec3 vector(float low, float high) {
    const float x = real(low, high), y = real(low, high);
    return {x, y, real(low, high)};
  }
  Quat turn(float most) { return from_rotation_vector(vector(-most, most)); }
};

}  // namespace gyre::testing_random
