// Packs selected ones of eight numbers, after a test of eight things at once. A loop over the selected ones would have
// branches that a processor mispredicts every other time.
#pragma once

#include "math/wide.h"

#include <bit>
#include <cstdint>

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

constexpr int kPackedLanes = 8;

#if defined(__AVX2__)

// By bits: the lanes that are set, four bits each, the first one lowest.
struct LaneOrders {
  std::uint32_t of[1u << kPackedLanes] = {};

  constexpr LaneOrders() {
    for (unsigned bits = 0; bits < 1u << kPackedLanes; ++bits) {
      int count = 0;
      for (unsigned left = bits; left != 0; left &= left - 1)
        of[bits] |= std::uint32_t(std::countr_zero(left)) << (4 * count++);
    }
  }
};
inline constexpr LaneOrders kLaneOrders;

#endif

// Writes the numbers whose bits are set, in their order, to `to`, which must have room for eight. Returns their count.
GYRE_INLINE int pack_lanes(const std::uint32_t* from, unsigned bits, std::uint32_t* to) {
#if defined(__AVX2__)
  // Only the lowest three bits of each lane's number count.
  const __m256i order = _mm256_srlv_epi32(_mm256_set1_epi32(int(kLaneOrders.of[bits])),
                                          _mm256_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28));
  const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permutevar8x32_epi32(all, order));
#else
  for (unsigned left = bits; left != 0; left &= left - 1) *to++ = from[std::countr_zero(left)];
#endif
  return std::popcount(bits);
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
