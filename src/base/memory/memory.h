// The allocator of the engine's arrays: every block is aligned to 64 bytes, counted, and comes from hooks that the host
// application may replace (gyre/memory.h). Running out of memory ends the program, so callers never see null.
#pragma once

#include <gyre/memory.h>

#include <cstddef>

namespace gyre {

// Alignment of every block: a cache line, and the widest vector of any machine.
constexpr std::size_t kMemoryAlign = 64;

// `bytes` of memory aligned to kMemoryAlign (`align`, a power of two, may be at most that); null for 0 bytes.
[[nodiscard]] void* allocate(std::size_t bytes, std::size_t align = kMemoryAlign);
// Frees what allocate() or reallocate() returned for the same number of bytes. Null is fine.
void deallocate(void* memory, std::size_t bytes);
// Resizes a block and preserves its first `preserved` bytes (at most the smaller size). Large blocks keep their pages
// if the heap can do so: touching new pages would take longer than the work on them.
[[nodiscard]] void* reallocate(void* memory, std::size_t old_bytes, std::size_t bytes, std::size_t preserved);

// Calls the check handler, then aborts.
[[noreturn]] void out_of_memory(std::size_t bytes);

}  // namespace gyre
