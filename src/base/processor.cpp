// Asks the processor for its instruction sets, its maker and its family. See processor.h.
#include "base/processor.h"

#if defined(__x86_64__)
#include <cpuid.h>

#include <cstring>
#endif

namespace gyre {

namespace {

#if defined(__x86_64__)
bool is_by_amd() {
  unsigned max_leaf = 0, b = 0, c = 0, d = 0;
  if (__get_cpuid(0, &max_leaf, &b, &c, &d) == 0) return false;
  char name[12];
  std::memcpy(name, &b, 4), std::memcpy(name + 4, &d, 4), std::memcpy(name + 8, &c, 4);
  return std::memcmp(name, "AuthenticAMD", 12) == 0;
}

// The family as processor makers count it: the extended family continues from 15.
unsigned family() {
  unsigned a = 0, b = 0, c = 0, d = 0;
  if (__get_cpuid(1, &a, &b, &c, &d) == 0) return 0;
  const unsigned base = a >> 8 & 0xfu;
  return base == 0xfu ? base + (a >> 20 & 0xffu) : base;
}

bool has_half_floats() {
  constexpr unsigned kFp16 = 1u << 23;
  unsigned a = 0, b = 0, c = 0, d = 0;
  return __get_cpuid_count(7, 0, &a, &b, &c, &d) != 0 && (d & kFp16) != 0;
}

int find_max_lanes() {
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw")) {
    return 16;
  }
  return __builtin_cpu_supports("avx2") ? 8 : kLanesOfAll;
}

int find_best_lanes() {
  constexpr unsigned kZen5 = 0x1a;
  const int lanes = find_max_lanes();
  if (lanes < 16) return lanes;
  return (is_by_amd() ? family() >= kZen5 : has_half_floats()) ? 16 : 8;
}
#else
int find_max_lanes() { return kLanesOfAll; }
int find_best_lanes() { return kLanesOfAll; }
#endif

}  // namespace

int max_lanes() {
  static const int lanes = find_max_lanes();
  return lanes;
}

int best_lanes() {
  static const int lanes = find_best_lanes();
  return lanes;
}

}  // namespace gyre
