// Prefetches memory that will be read soon, if the order of reads is known and the processor cannot guess it.
#pragma once

#include <cstddef>

namespace gyre {

constexpr std::size_t kCacheLine = 64;

inline void prefetch(const void* address, std::size_t bytes) {
  const char* const begin = static_cast<const char*>(address);
  for (std::size_t offset = 0; offset < bytes; offset += kCacheLine) __builtin_prefetch(begin + offset);
}

}  // namespace gyre
