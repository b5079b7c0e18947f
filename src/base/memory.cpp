// Counts blocks and hands them through to the hooks; the default is the language's own aligned operator new.
#include "base/memory.h"

#include "base/check.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace gyre {

namespace {

void* default_allocate(std::size_t bytes, std::size_t align, void*) {
  return ::operator new (bytes, std::align_val_t{align}, std::nothrow);
}

void default_deallocate(void* memory, std::size_t, void*) {
  ::operator delete (memory, std::align_val_t{kMemoryAlign});
}

AllocatorHooks hooks{default_allocate, default_deallocate, nullptr};

// Statistics only: nothing is ordered by them.
std::atomic<std::uint64_t> bytes_out{0};
std::atomic<std::uint64_t> blocks_ever{0};

}  // namespace

bool set_allocator(const AllocatorHooks& wanted) {
  if (total_bytes() != 0) return false;
  const bool complete = wanted.allocate != nullptr && wanted.deallocate != nullptr;
  hooks = complete ? wanted : AllocatorHooks{default_allocate, default_deallocate, nullptr};
  return true;
}

void* allocate(std::size_t bytes, std::size_t align) {
  GYRE_ASSERT(align != 0 && (align & (align - 1)) == 0 && align <= kMemoryAlign,
              "alignment is a power of two up to kMemoryAlign");
  static_cast<void>(align);
  if (bytes == 0) return nullptr;
  void* const memory = hooks.allocate(bytes, kMemoryAlign, hooks.user);
  if (memory == nullptr) out_of_memory(bytes);
  GYRE_ASSERT(reinterpret_cast<std::uintptr_t>(memory) % kMemoryAlign == 0,
              "the allocator hook honours the alignment asked for");
  bytes_out.fetch_add(bytes, std::memory_order_relaxed);
  blocks_ever.fetch_add(1, std::memory_order_relaxed);
  return memory;
}

void deallocate(void* memory, std::size_t bytes) {
  if (memory == nullptr) return;
  bytes_out.fetch_sub(bytes, std::memory_order_relaxed);
  hooks.deallocate(memory, bytes, hooks.user);
}

void out_of_memory(std::size_t bytes) {
  static_cast<void>(bytes);
  check_failed("memory != nullptr", "there is memory for what the world holds", __FILE__, __LINE__);
  std::abort();
}

std::uint64_t total_bytes() { return bytes_out.load(std::memory_order_relaxed); }

std::uint64_t allocation_count() { return blocks_ever.load(std::memory_order_relaxed); }

}  // namespace gyre
