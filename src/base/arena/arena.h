// Arena: bump memory that lives for one step or less. make() hands out uninitialised arrays; reset() takes all of them back
// at once and keeps the memory, as one block large enough for what the last step needed and some more, so that after the first
// steps nothing is allocated any more. A part of a step may take back what it used by itself (ArenaScope), so that the parts use
// the same memory one after the other. What was not needed for long is given back. One per worker: nothing here is shared
// between threads.
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

  // `count` uninitialised elements, aligned to 64 bytes, valid until reset(). The memory is good for whole cache lines:
  // wide loads may read (not use) beyond the end up to the next multiple of 64 bytes. Where asserts are active it is
  // filled with 0xff, which is NaN in any float, so that reading before writing shows.
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
  // The most that was out at once since the last reset, and that at least so much will be needed after the next: for arenas of
  // which any may be given the work of another.
  std::size_t peak() const { return peak_ < bytes_used() ? bytes_used() : peak_; }
  void expect(std::size_t bytes) { peak_ = peak_ < bytes ? bytes : peak_; }

  // A place to go back to: release() takes back what was handed out since then.
  struct Mark {
    const void* block = nullptr;
    std::size_t used = 0;
  };
  Mark mark() const { return {current_, used_}; }
  void release(Mark mark);

  // Bytes handed out and not taken back, with rounding to whole cache lines; the most that ever was; bytes held.
  std::size_t bytes_used() const { return used_before_ + used_; }
  std::size_t high_water() const { return high_water_ < peak() ? peak() : high_water_; }
  std::size_t capacity() const { return capacity_; }

 private:
  // Sits at the start of each block and takes one cache line of it.
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

  Block* current_ = nullptr;     // the newest; older ones hang behind it and are full
  std::size_t used_ = 0;         // of the current block
  std::size_t used_before_ = 0;  // of all older blocks
  std::size_t capacity_ = 0;     // capacity of all blocks
  std::size_t peak_ = 0;         // of this step, at the last release
  std::size_t high_water_ = 0;
  ShrinkPolicy clock_;
  bool grew_ = false;  // when it last took another block
};

// Takes back, at the end of a block of code, what was handed out in it.
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
