// Arena: bump memory that lives for one step or less. make() returns uninitialised arrays. reset() takes all of them
// back at once and keeps the memory as one block, large enough for the last step and some more, so that after the first
// steps nothing is allocated. ArenaScope takes back the memory of one stage, so that stages use the same memory one
// after the other. Memory that was not needed for long is released. Each worker has its own arena; nothing here is
// shared between threads.
#pragma once

#include "base/arena/shrink_policy.h"
#include "base/check.h"
#include "base/memory/memory.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>

namespace gyre {

class Arena {
 public:
  Arena() = default;
  Arena(Arena&& other) noexcept;
  Arena& operator=(Arena&& other) noexcept;
  ~Arena();

  // `count` uninitialised elements, aligned to 64 bytes, valid until reset(). Wide loads may read (not use) beyond the
  // end up to the next multiple of 64 bytes. With asserts the memory is filled with 0xff, which is NaN in any float, so
  // that a read before a write shows.
  template <class T>
  std::span<T> make(std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>,
                  "an arena never runs destructors");
    static_assert(alignof(T) <= kMemoryAlign, "arrays are aligned to 64 bytes");
    if (count > (SIZE_MAX - kMemoryAlign) / sizeof(T)) out_of_memory(SIZE_MAX);
    return {static_cast<T*>(take(count * sizeof(T))), count};
  }

  // Takes back all memory handed out.
  void reset();
  // The most bytes in use at once since the last reset. expect() raises this peak, for arenas that may get each other's
  // work.
  std::size_t peak() const { return peak_ < bytes_used() ? bytes_used() : peak_; }
  void expect(std::size_t bytes) { peak_ = peak_ < bytes ? bytes : peak_; }

  // A mark; release() takes back everything handed out since then.
  struct Mark {
    const void* block = nullptr;
    std::size_t used = 0;
  };
  Mark mark() const { return {current_, used_}; }
  void release(Mark mark);

  // Bytes in use, in whole cache lines; the largest peak so far; bytes of all blocks.
  std::size_t bytes_used() const { return used_before_ + used_; }
  std::size_t high_water() const { return high_water_ < peak() ? peak() : high_water_; }
  std::size_t capacity() const { return capacity_; }

 private:
  // The header of a block, in its first cache line.
  struct Block {
    Block* previous;
    std::size_t used_in_previous;  // when this one was added
    std::size_t capacity;          // bytes after the header
  };

  void* take(std::size_t bytes);
  void add_block(std::size_t capacity);
  void resize_to(std::size_t capacity);
  void free_newest();
  void free_blocks();

  Block* current_ = nullptr;     // the newest; older blocks are linked behind it and full
  std::size_t used_ = 0;         // of the current block
  std::size_t used_before_ = 0;  // of all older blocks
  std::size_t capacity_ = 0;     // capacity of all blocks
  std::size_t peak_ = 0;         // of this step, at the last release
  std::size_t high_water_ = 0;
  ShrinkPolicy clock_;
  bool grew_ = false;  // when it last took another block
};

// Takes back, at the end of a scope, what was handed out in it.
class ArenaScope {
 public:
  explicit ArenaScope(Arena& arena) : arena_(arena), mark_(arena.mark()) {}
  ~ArenaScope() { arena_.release(mark_); }
  ArenaScope(const ArenaScope&) = delete;
  ArenaScope& operator=(const ArenaScope&) = delete;

 private:
  Arena& arena_;
  Arena::Mark mark_;
};

}  // namespace gyre
