// Counts blocks and forwards to the hooks. The default is C's heap, which resizes large blocks without a copy if the
// system can (operator new cannot), and for the largest blocks the system itself (large_pages.h).
#include "base/memory/memory.h"

#include "base/check.h"
#include "base/memory/large_pages.h"

#include <atomic>
#include <cstdlib>
#include <cstring>
#if defined(_WIN32)
#include <malloc.h>
#endif

namespace gyre {

namespace {

// Smaller blocks are copied: heaps move small blocks and lose their alignment.
constexpr std::size_t kLargeBlock = 128 * 1024;  // bytes

// WebAssembly has one flat memory without pages: every move there is a copy, and realloc() would only make modules
// larger.
#if defined(__wasm__)
constexpr bool kMovesPages = false;
#else
constexpr bool kMovesPages = true;
#endif

bool is_aligned(const void* memory, std::size_t align) {
  return reinterpret_cast<std::uintptr_t>(memory) % align == 0;
}

#if defined(_WIN32)

void* default_allocate(std::size_t bytes, std::size_t align, void*) { return _aligned_malloc(bytes, align); }

void default_deallocate(void* memory, std::size_t, void*) { _aligned_free(memory); }

void* default_reallocate(void* memory, std::size_t, std::size_t bytes, std::size_t align, void*) {
  return _aligned_realloc(memory, bytes, align);
}

#else

// Larger blocks have large pages of their own. Why not half or twice as much: docs/decisions/memory.md.
constexpr std::size_t kPagedBlock = kLargePage / 4;  // bytes

bool is_paged(std::size_t bytes) { return kHasLargePages && bytes >= kPagedBlock; }

// Rounded up to whole alignments, as C requires; null if the result does not fit.
void* default_allocate(std::size_t bytes, std::size_t align, void*) {
  if (is_paged(bytes)) return map_large_pages(bytes);
  if (bytes > SIZE_MAX - align) return nullptr;
  return std::aligned_alloc(align, (bytes + align - 1) / align * align);
}

void default_deallocate(void* memory, std::size_t bytes, void*) {
  if (is_paged(bytes)) {
    unmap_large_pages(memory, bytes);
  } else {
    std::free(memory);
  }
}

void* default_reallocate(void* memory, std::size_t old_bytes, std::size_t bytes, std::size_t align,
                         void* user) {
  if (is_paged(old_bytes) && is_paged(bytes)) return remap_large_pages(memory, old_bytes, bytes);
  if (!is_paged(old_bytes) && !is_paged(bytes)) {
    memory = std::realloc(memory, bytes);
    if (memory == nullptr || is_aligned(memory, align)) return memory;
    old_bytes = bytes;
  }
  void* const moved = default_allocate(bytes, align, user);
  if (moved == nullptr) return nullptr;
  std::memcpy(moved, memory, old_bytes < bytes ? old_bytes : bytes);
  default_deallocate(memory, old_bytes, user);
  return moved;
}

#endif

constexpr AllocatorHooks kDefaultHooks{default_allocate, default_deallocate,
                                       kMovesPages ? default_reallocate : nullptr, nullptr};
AllocatorHooks hooks = kDefaultHooks;

// Statistics only; they order nothing.
std::atomic<std::uint64_t> bytes_out{0};
std::atomic<std::uint64_t> blocks_ever{0};

}  // namespace

bool set_allocator(const AllocatorHooks& new_hooks) {
  if (total_bytes() != 0) return false;
  const bool complete = new_hooks.allocate != nullptr && new_hooks.deallocate != nullptr;
  hooks = complete ? new_hooks : kDefaultHooks;
  return true;
}

void* allocate(std::size_t bytes, std::size_t align) {
  GYRE_ASSERT(align != 0 && (align & (align - 1)) == 0 && align <= kMemoryAlign,
              "alignment is a power of two up to kMemoryAlign");
  static_cast<void>(align);
  if (bytes == 0) return nullptr;
  void* const memory = hooks.allocate(bytes, kMemoryAlign, hooks.user);
  if (memory == nullptr) out_of_memory(bytes);
  GYRE_ASSERT(is_aligned(memory, kMemoryAlign), "the allocator hook honours the alignment");
  bytes_out.fetch_add(bytes, std::memory_order_relaxed);
  blocks_ever.fetch_add(1, std::memory_order_relaxed);
  return memory;
}

void deallocate(void* memory, std::size_t bytes) {
  if (memory == nullptr) return;
  bytes_out.fetch_sub(bytes, std::memory_order_relaxed);
  hooks.deallocate(memory, bytes, hooks.user);
}

void* reallocate(void* memory, std::size_t old_bytes, std::size_t bytes, std::size_t preserved) {
  GYRE_ASSERT(preserved <= old_bytes && preserved <= bytes, "both sizes contain the preserved bytes");
  if (!kMovesPages || hooks.reallocate == nullptr || old_bytes < kLargeBlock || bytes < kLargeBlock) {
    // Without anything to copy, the two blocks never exist at once.
    if (preserved == 0) deallocate(memory, old_bytes);
    void* const moved = allocate(bytes);
    if (preserved == 0) return moved;
    std::memcpy(moved, memory, preserved);
    deallocate(memory, old_bytes);
    return moved;
  }
  void* const moved = hooks.reallocate(memory, old_bytes, bytes, kMemoryAlign, hooks.user);
  if (moved == nullptr) out_of_memory(bytes);
  GYRE_ASSERT(is_aligned(moved, kMemoryAlign), "the allocator hook honours the alignment");
  bytes_out.fetch_add(bytes - old_bytes, std::memory_order_relaxed);
  blocks_ever.fetch_add(1, std::memory_order_relaxed);
  return moved;
}

void out_of_memory(std::size_t bytes) {
  static_cast<void>(bytes);
  check_failed("memory != nullptr", "there is memory for what the world holds", __FILE__, __LINE__);
  std::abort();
}

std::uint64_t total_bytes() { return bytes_out.load(std::memory_order_relaxed); }

std::uint64_t allocation_count() { return blocks_ever.load(std::memory_order_relaxed); }

}  // namespace gyre
