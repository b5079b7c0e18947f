// Blocks of memory in pages of 2 MB, straight from the system, where it has such pages (Linux: transparent huge pages). What an
// array touches for the first time as a world grows, and what a larger array moves to, then costs a step one interruption for 512, and
// far fewer pages are looked up in piles larger than the caches. Where the system has none to spare it gives small ones.
#pragma once

#include <cstddef>

namespace gyre {

constexpr std::size_t kLargePage = std::size_t{2} << 20;  // bytes

// Not under the address sanitizer, which watches the heap's blocks.
#if !defined(__linux__) || defined(__SANITIZE_ADDRESS__)
constexpr bool kHasLargePages = false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
constexpr bool kHasLargePages = false;
#else
constexpr bool kHasLargePages = true;
#endif
#else
constexpr bool kHasLargePages = true;
#endif

// At least `bytes` (above 0) aligned to kLargePage and zero; null when there is no more. Only with kHasLargePages, as all of these.
void* map_large_pages(std::size_t bytes);
void unmap_large_pages(void* memory, std::size_t bytes);
// The block in another size, with what it held as far as both go: its pages move, not their bytes. Null, and the block as it was, when
// there is no more.
void* remap_large_pages(void* memory, std::size_t old_bytes, std::size_t bytes);

}  // namespace gyre
