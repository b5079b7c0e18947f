// The one door to the heap for the engine's own arrays: every block is aligned to 64 bytes, counted, and taken from
// hooks that the host application may replace. Running out ends the program, so callers never see null.
#pragma once

#include <cstddef>
#include <cstdint>

namespace gyre {

// Alignment of every block: a cache line, and the widest vector of any machine.
constexpr std::size_t kMemoryAlign = 64;

struct AllocatorHooks {
  // At least `bytes` (never 0) aligned to `align`, or null when there is no more.
  void* (*allocate)(std::size_t bytes, std::size_t align, void* user) = nullptr;
  // Takes back a block, with the size it was asked for.
  void (*deallocate)(void* memory, std::size_t bytes, void* user) = nullptr;
  void* user = nullptr;
};

// Replaces the heap for the whole process; null functions bring back the default. Only while no block is out
// (total_bytes() is 0), since blocks must go back where they came from: otherwise nothing changes, and the answer is
// false. Not to be called while another thread allocates.
bool set_allocator(const AllocatorHooks& hooks);

// `bytes` of memory aligned to kMemoryAlign (`align`, a power of two, may ask for no more than that); null for 0 bytes.
[[nodiscard]] void* allocate(std::size_t bytes, std::size_t align = kMemoryAlign);
// Gives back what allocate() returned for the same number of bytes. Null is fine.
void deallocate(void* memory, std::size_t bytes);

// Tells the check handler, then aborts.
[[noreturn]] void out_of_memory(std::size_t bytes);

// Bytes in blocks that are out now, and how many blocks were ever handed out.
std::uint64_t total_bytes();
std::uint64_t allocation_count();

}  // namespace gyre
