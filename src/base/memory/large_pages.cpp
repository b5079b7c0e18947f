// Pages move only between blocks of whole pages, so each block is cut out of one that is a page larger.
#include "base/memory/large_pages.h"

#if defined(__linux__)
#include <sys/mman.h>
#include <cstdint>

namespace gyre {

namespace {

// 0 if the result does not fit.
std::size_t whole_pages(std::size_t bytes) {
  return bytes > SIZE_MAX - 2 * kLargePage ? 0 : (bytes + kLargePage - 1) / kLargePage * kLargePage;
}

// Maps a block of `size` bytes, in whole pages, aligned to a page.
std::byte* map_block(std::size_t size, int access) {
  void* const found =
      mmap(nullptr, size + kLargePage, access, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (found == MAP_FAILED) return nullptr;
  const std::size_t before = (kLargePage - reinterpret_cast<std::uintptr_t>(found) % kLargePage) % kLargePage;
  std::byte* const block = static_cast<std::byte*>(found) + before;
  if (before != 0) munmap(found, before);
  munmap(block + size, kLargePage - before);
  return block;
}

}  // namespace

void* map_large_pages(std::size_t bytes) {
  const std::size_t size = whole_pages(bytes);
  if (size == 0) return nullptr;
  std::byte* const block = map_block(size, PROT_READ | PROT_WRITE);
  if (block != nullptr) madvise(block, size, MADV_HUGEPAGE);
  return block;
}

void unmap_large_pages(void* memory, std::size_t bytes) { munmap(memory, whole_pages(bytes)); }

void* remap_large_pages(void* memory, std::size_t old_bytes, std::size_t bytes) {
  const std::size_t old_size = whole_pages(old_bytes), size = whole_pages(bytes);
  if (size == old_size) return memory;
  if (size == 0) return nullptr;
  if (mremap(memory, old_size, size, 0) != MAP_FAILED) return memory;
  std::byte* const block = map_block(size, PROT_NONE);
  if (block == nullptr) return nullptr;
  void* const moved = mremap(memory, old_size, size, MREMAP_MAYMOVE | MREMAP_FIXED, block);
  if (moved != MAP_FAILED) return moved;
  munmap(block, size);
  return nullptr;
}

}  // namespace gyre

#else

namespace gyre {

void* map_large_pages(std::size_t) { return nullptr; }
void unmap_large_pages(void*, std::size_t) {}
void* remap_large_pages(void*, std::size_t, std::size_t) { return nullptr; }

}  // namespace gyre

#endif
