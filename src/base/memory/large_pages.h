// Blocks of memory in pages of 2 MB, directly from the system if it has such pages (Linux: transparent huge pages). The
// first touch of memory then costs one page fault instead of 512, and data larger than the caches needs far fewer page
// look-ups. Without free large pages the system gives small ones.
#pragma once

#include <cstddef>

namespace gyre {

constexpr std::size_t kLargePage = std::size_t{2} << 20;  // bytes

// Not under the address sanitizer, which watches the blocks of the heap.
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

// At least `bytes` (above 0), zeroed and aligned to kLargePage; null when there is no more. Only with kHasLargePages,
// like all functions here.
void* map_large_pages(std::size_t bytes);
void unmap_large_pages(void* memory, std::size_t bytes);
// Resizes a block and keeps its content: pages move, not bytes. Null, with the block unchanged, when there is no more.
void* remap_large_pages(void* memory, std::size_t old_bytes, std::size_t bytes);

}  // namespace gyre
