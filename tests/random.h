// Random numbers for tests: the same on every platform. (Random: G. Marsaglia, "Xorshift RNGs", 2003. Mixed: SplitMix64 of
// G. Steele, D. Lea, C. Flood, "Fast Splittable Pseudorandom Number Generators", 2014.)
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

// All 53 bits of a double are random, for tests of arithmetic.
struct Mixed {
  std::uint64_t state;
  std::uint64_t next() {
    state += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double unit() { return double(next() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  float single(float low, float high) { return float(between(double(low), double(high))); }
};
// For tests of kernels, which work on floats.
struct MixedSingles : Mixed {
  float between(float low, float high) { return single(low, high); }
  Vec3 vector(float most) { return {between(-most, most), between(-most, most), between(-most, most)}; }
};

}  // namespace gyre::testing_random
