// The one door to the heap for the engine's own arrays: every block is aligned to 64 bytes, counted, and taken from
// hooks that the host application may replace (gyre/memory.h). Running out ends the program, so callers never see null.
#pragma once

#include <gyre/memory.h>

#include <cstddef>

namespace gyre {

// Alignment of every block: a cache line, and the widest vector of any machine.
constexpr std::size_t kMemoryAlign = 64;

// `bytes` of memory aligned to kMemoryAlign (`align`, a power of two, may ask for no more than that); null for 0 bytes.
[[nodiscard]] void* allocate(std::size_t bytes, std::size_t align = kMemoryAlign);
// Gives back what allocate() or reallocate() returned for the same number of bytes. Null is fine.
void deallocate(void* memory, std::size_t bytes);
// A block of another size that begins with the first `kept` bytes of this one (at most the lesser size), which is given back. Large
// blocks keep the pages they have where the heap can do so: to touch new ones takes longer than what is done with them.
[[nodiscard]] void* reallocate(void* memory, std::size_t old_bytes, std::size_t bytes, std::size_t preserved);

// Tells the check handler, then aborts.
[[noreturn]] void out_of_memory(std::size_t bytes);

}  // namespace gyre
