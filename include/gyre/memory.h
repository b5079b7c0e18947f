// The engine's memory: an allocator of the host, and the amount in use. Arrays of bodies, shapes, contacts and joints, working memory of a
// step and cooked trees are allocated here. A few small objects (a world itself, names, lists made while geometry is cooked) come from
// operator new.
#pragma once

#include <cstddef>
#include <cstdint>

namespace gyre {

// An allocator of the host application. Functions may be called from any thread that steps, changes or reads a world.
struct AllocatorHooks {
  // At least `bytes` (never 0) aligned to `align` (64), or null when there is no more, which ends the program.
  void* (*allocate)(std::size_t bytes, std::size_t align, void* user) = nullptr;
  // Frees a block; `bytes` is the size it was allocated with.
  void (*deallocate)(void* memory, std::size_t bytes, void* user) = nullptr;
  // Optional; without it, blocks are allocated, copied and freed. Resizes a block of at least 128 KiB to at least 128 KiB, in place or
  // elsewhere, aligned to `align`, and keeps its content up to the smaller size; null if there is no memory. An allocator that moves pages
  // instead of bytes (`mremap`) shortens steps in which many contacts begin. Never called in WebAssembly, whose memory has no pages.
  void* (*reallocate)(void* memory, std::size_t old_bytes, std::size_t bytes, std::size_t align,
                      void* user) = nullptr;
  void* user = nullptr;  // passed to the functions
};

// Replaces the heap for the whole process. The default is C's heap, and on Linux the system's pages of 2 MB for blocks of 512 KiB or more.
// Without allocate or deallocate the default is restored. Returns false, and changes nothing, unless total_bytes() is 0 (before the first
// world and shape, or after the last), since every block must be freed by the allocator it came from. Do not call it while another thread
// uses the engine.
bool set_allocator(const AllocatorHooks& hooks);

// Bytes allocated at present, and the number of allocations and resizes so far. May be called from any thread.
std::uint64_t total_bytes();
std::uint64_t allocation_count();

}  // namespace gyre
