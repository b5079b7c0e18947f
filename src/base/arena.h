// Arena: bump memory that lives for one step. make() hands out uninitialised arrays; reset() takes all of them back at
// once and keeps the memory, as one block large enough for what the last step needed, so that after the first steps
// nothing is allocated any more. One per worker: nothing here is shared between threads.
#pragma once

#include "base/check.h"
#include "base/memory.h"

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

  // Bytes handed out since the last reset, with rounding to whole cache lines; the most that ever was; bytes held.
  std::size_t bytes_used() const { return used_before_ + used_; }
  std::size_t high_water() const { return high_water_ < bytes_used() ? bytes_used() : high_water_; }
  std::size_t bytes_held() const { return held_; }

 private:
  // Sits at the start of each block and takes one cache line of it.
  struct Block {
    Block* previous;
    std::size_t capacity;  // bytes after the header
  };

  void* take(std::size_t bytes);
  void add_block(std::size_t capacity);
  void free_blocks();

  Block* current_ = nullptr;     // the newest; older ones hang behind it and are full
  std::size_t used_ = 0;         // of the current block
  std::size_t used_before_ = 0;  // of all older blocks
  std::size_t held_ = 0;         // capacity of all blocks
  std::size_t high_water_ = 0;
};

}  // namespace gyre
