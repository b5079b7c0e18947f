// Where the engine takes its memory from, and how much it has. Arrays of bodies, shapes, contacts and joints, what a step works with and
// cooked trees come through here; a few small objects (a world itself, names, lists that are made while geometry is cooked) come from
// operator new.
#pragma once

#include <cstddef>
#include <cstdint>

namespace gyre {

// An allocator of the host application. Functions may be called from any thread that steps, changes or reads a world.
struct AllocatorHooks {
  // At least `bytes` (never 0) aligned to `align` (64), or null when there is no more, which ends the program.
  void* (*allocate)(std::size_t bytes, std::size_t align, void* user) = nullptr;
  // Takes back a block, with the size it was asked for.
  void (*deallocate)(void* memory, std::size_t bytes, void* user) = nullptr;
  // May be left out: blocks are then taken, copied and given back. Makes a block of 128 KiB or more, and that stays as large, larger or
  // smaller, where it is or elsewhere, aligned to `align`, with what it held as far as both sizes go; null when there is no more.
  // A heap that moves pages and not bytes (`mremap`) shortens steps in which much comes into contact. Never called in WebAssembly, whose
  // memory has no pages.
  void* (*reallocate)(void* memory, std::size_t old_bytes, std::size_t bytes, std::size_t align,
                      void* user) = nullptr;
  void* user = nullptr;  // handed to the functions
};

// Replaces the heap for the whole process: C's, and on Linux for blocks of 512 KiB or more the system's pages of 2 MB. Without allocate or
// deallocate the default comes back. Only while no block is out (total_bytes() is 0: before the first world and shape, or after the
// last), since blocks must go back where they came from: otherwise nothing changes, and the answer is false. Not to be called while
// another thread uses the engine.
bool set_allocator(const AllocatorHooks& hooks);

// Bytes in blocks that are out now, and how many blocks were ever handed out or changed in size. From any thread.
std::uint64_t total_bytes();
std::uint64_t allocation_count();

}  // namespace gyre
